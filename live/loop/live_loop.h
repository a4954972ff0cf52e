// The loop of a live session: what pages want, ticks, pictures.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "incise/live/json_values.h"
#include "incise/live/loop/device.h"
#include "incise/live/loop/downloads.h"
#include "incise/live/loop/pace.h"
#include "incise/live/loop/page_messages.h"
#include "incise/live/loop/picture_maker.h"
#include "incise/live/loop/undo_points.h"
#include "incise/live/recording.h"
#include "incise/live/server/server.h"
#include "incise/live/session.h"

namespace incise::live {

/// Runs a session in real time, lets pages take part, and shows it to them.
///
/// One page is the operator: the first that opens, or one that takes over. The others look on.
class LiveLoop {
  public:
    /// @lifetime  all must outlive the loop
    LiveLoop(Session& session, Recorder& recorder, Server& server);

    /// Adds a device. With one, the body moves from the start on.
    /// @lifetime  the device must outlive the loop
    void add_device(Device& device) { devices_.push_back(&device); }

    /// Runs until `is_to_stop` returns true, which is asked after each step. The tick that it falls
    /// in is given up. Nothing moves before the first page has opened, unless there is a device.
    /// Failures of the motion, of a page's wishes and of the recording are told, and it goes on.
    void run(const std::function<bool()>& is_to_stop);

    /// Is called with each message that pages get too: its level (info, warning, error), its text.
    /// Warnings of the body are not repeated.
    std::function<void(std::string_view, const std::string&)> on_message;

  private:
    void rest(Pace::Clock::time_point now);
    void handle_requests(const std::function<bool()>& is_to_stop);
    void handle(const Request& request);
    void open(std::uint64_t page);
    void close(std::uint64_t page);
    void read(const Request& request);
    void execute_wish(std::uint64_t page, const Json& wish);

    void take_tool(std::uint64_t page, const Json& wish);
    void tie_suture(const Json& wish);
    void tighten(const Json& wish);
    void put_tool_away(std::uint64_t page);
    void require_few_tools() const;
    std::optional<Session::UndoPoint> point_before_stroke() const;
    void keep_stroke(std::optional<Session::UndoPoint> before);
    void undo();
    void reset();
    void execute(const Order& order);
    const std::string& in_hand(std::uint64_t page) const;
    std::string new_name(const std::string& kind);

    bool tick(const std::function<bool()>& is_to_stop);
    void note(const std::function<void()>& in_recording);
    void execute_device_orders();
    void tell_complaints(Device& device);
    void keep_good_point();
    void go_back(const Session::UndoPoint& point);
    void go_back_to_start();
    void follow_return();
    void recover(const std::string& reason);
    void send_message(std::string_view level, const std::string& text);
    void tell_warnings();
    void warn_if_slow();
    void say_hello(std::uint64_t page);
    void say_hello_to_all();
    void show();

    Session& session_;
    Recorder& recorder_;
    Server& server_;
    PictureMaker pictures_;
    PageMessages messages_;
    Downloads downloads_;
    Pace pace_;
    UndoPoints undo_points_;
    Pace::Clock::time_point next_point_ = {}, last_shown_ = {};
    std::deque<Request> requests_;  // not handled yet
    std::vector<Device*> devices_;
    std::map<const Device*, std::string> last_complaints_;  // about their orders
    std::vector<std::uint64_t> pages_;                      // in the order of opening
    std::uint64_t operator_ = 0;                            // 0: none
    std::map<std::uint64_t, std::string> hands_;            // the tool in the hand of a page
    std::map<std::string, int> last_numbers_;               // of tools, by kind
    bool is_paused_ = false, is_changed_ = true;
    int steps_wanted_ = 0;           // while paused
    bool has_changed_hold_ = false;  // since the last stroke: jaws, or a thread
    std::size_t num_warnings_told_;
    bool has_told_pace_ = false;
    std::uint64_t last_failure_ = 0;  // tick
    int num_failures_ = 0;            // that got no farther than the last one
};

}  // namespace incise::live
