// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/loop/live_loop.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <sstream>
#include <utility>
#include <variant>

#include "incise/base/error.h"
#include "incise/base/number_format.h"

namespace incise::live {

namespace {

using std::chrono::milliseconds;

/// A page may name no files of this machine.
void refuse_files(const Json& definition) {
    for (const auto& [key, value] : definition.items()) {
        if (key == "surface")
            throw InputError(
                "'surface': a page takes tools without files; put it into the scenario");
        if (value.is_structured()) refuse_files(value);
    }
}

constexpr int most_failures = 3;
constexpr const char* looks_on = "another page holds the tools; take over from it first";

}  // namespace

LiveLoop::LiveLoop(Session& session, Recorder& recorder, Server& server)
    : session_(session),
      recorder_(recorder),
      server_(server),
      pictures_(session),
      messages_(session, pictures_),
      downloads_(session, recorder, server),
      pace_(session.tick_length()),
      num_warnings_told_(session.simulation().warnings().size()) {}

void LiveLoop::run(const std::function<bool()>& is_to_stop) {
    bool was_opened = !devices_.empty();
    auto due = Pace::Clock::now();
    while (!is_to_stop()) {
        handle_requests(is_to_stop);
        downloads_.answer();
        was_opened = was_opened || !pages_.empty();
        const auto now = Pace::Clock::now();
        const bool rests = !was_opened || (is_paused_ && steps_wanted_ == 0);
        if (rests || now < due) {
            if (rests) rest(now);
            // However much pages say in a pause, they are told of it as often as in motion.
            constexpr auto between_pictures = milliseconds(16);
            const bool is_to_show = rests && is_changed_;
            if (is_to_show && now >= last_shown_ + between_pictures) show();
            const auto until = rests ? now + milliseconds(is_changed_ ? 16 : 100)
                                     : std::min(due, now + milliseconds(100));
            if (requests_.empty()) server_.wait_for_request(until);
            continue;
        }
        if (!tick(is_to_stop)) return;
        if (is_paused_ && steps_wanted_ > 0) --steps_wanted_;
        due = pace_.note_tick(Pace::Clock::now());
        warn_if_slow();
        show();
    }
}

void LiveLoop::rest(Pace::Clock::time_point now) {
    pace_.rest(now);
    for (Device* device : devices_) {
        device->rest();
        tell_complaints(*device);
    }
}

/// Handles what pages want, for a part of a tick at most: the rest waits for the next one.
/// Meanwhile the server takes no more from pages that flood.
void LiveLoop::handle_requests(const std::function<bool()>& is_to_stop) {
    constexpr auto longest = milliseconds(2);
    const auto begin = Pace::Clock::now();
    if (requests_.empty())
        for (Request& request : server_.take_requests()) requests_.push_back(std::move(request));
    while (!requests_.empty() && Pace::Clock::now() < begin + longest && !is_to_stop()) {
        const Request request = std::move(requests_.front());
        requests_.pop_front();
        handle(request);
    }
}

void LiveLoop::handle(const Request& request) {
    try {
        switch (request.kind) {
            case Request::Kind::opened:
                open(request.page);
                break;
            case Request::Kind::closed:
                close(request.page);
                break;
            case Request::Kind::download:
                return downloads_.add(request);
            case Request::Kind::text:
                read(request);
                break;
        }
        is_changed_ = true;
    } catch (const std::exception& error) {  // whatever a page wants, the session goes on
        server_.send(request.page, message_text("error", error.what()));
    }
}

void LiveLoop::open(std::uint64_t page) {
    pages_.push_back(page);
    if (operator_ == 0) operator_ = page;
    say_hello(page);
    for (const std::string& warning : session_.simulation().warnings())
        server_.send(page, message_text("warning", warning));
}

void LiveLoop::close(std::uint64_t page) {
    std::erase(pages_, page);
    put_tool_away(page);
    if (operator_ != page) return;
    operator_ = pages_.empty() ? 0 : pages_.front();
    if (operator_ != 0) say_hello(operator_);
}

/// Reads what a page says. Of one that only looks on, no long text is worth the time.
void LiveLoop::read(const Request& request) {
    constexpr std::size_t longest_of_watcher = 256;
    if (request.page != operator_ && request.text.size() > longest_of_watcher)
        throw InputError(looks_on);
    execute_wish(request.page, parse_object(request.text));
}

void LiveLoop::execute_wish(std::uint64_t page, const Json& wish) {
    const std::string what = text_in(wish, "do");
    if (what == "take_over") {
        if (operator_ == page) return;
        put_tool_away(operator_);
        operator_ = page;
        return say_hello_to_all();
    }
    if (operator_ != page) throw InputError(looks_on);
    if (what == "take") return take_tool(page, wish);
    if (what == "move") return execute(MoveTool{in_hand(page), pose_in(member(wish, "pose"))});
    if (what == "drop") return put_tool_away(page);
    if (what == "close") return execute(CloseTool{in_hand(page)});
    if (what == "open") return execute(OpenTool{in_hand(page)});
    if (what == "sew") return tie_suture(wish);
    if (what == "tighten") return tighten(wish);
    if (what == "untie") return execute(UntieSuture{text_in(wish, "name")});
    if (what == "undo") return undo();
    if (what == "reset") return reset();
    if (what == "pause") {
        is_paused_ = flag_in(wish, "on");
        steps_wanted_ = 0;
    } else if (what == "step") {
        if (!is_paused_) throw InputError("single steps are for a pause");
        steps_wanted_ = std::min(steps_wanted_ + 1, 60);
    } else if (what == "speed") {
        const double speed = number_in(wish, "factor");
        if (!(speed >= 0.01 && speed <= 100.0))
            throw InputError("'factor': must be from 0.01 to 100");
        pace_.set_speed(speed);
    } else if (what == "show") {
        if (!pictures_.show(text_in(wish, "field")))
            throw InputError("'field': there is no field '" + text_in(wish, "field") + "'");
    } else {
        throw InputError("'do': '" + what + "' is not known here");
    }
}

void LiveLoop::execute(const Order& order) {
    for (const std::string& warning : session_.execute(order)) send_message("warning", warning);
    const auto* added = std::get_if<AddTool>(&order);
    const bool keeps_holds = std::holds_alternative<MoveTool>(order) ||
                             std::holds_alternative<WithdrawTool>(order) ||
                             (added && session_.find(added->name)->kind != "suture");
    has_changed_hold_ = has_changed_hold_ || !keeps_holds;
}

const std::string& LiveLoop::in_hand(std::uint64_t page) const {
    const auto found = hands_.find(page);
    if (found == hands_.end()) throw InputError("there is no tool in the hand: take one first");
    return found->second;
}

std::string LiveLoop::new_name(const std::string& kind) {
    const sim::World& world = session_.world();
    while (true) {
        std::string name = kind + "_" + std::to_string(++last_numbers_[kind]);
        if (!world.find_tool(name)) return name;
    }
}

void LiveLoop::take_tool(std::uint64_t page, const Json& wish) {
    const Json& definition = member(wish, "tool");
    if (!definition.is_object()) throw InputError("'tool': must be an object");
    const std::string kind = text_in(definition, "kind");
    require_few_tools();
    if (kind == "suture") throw InputError("a suture is sewn, not led by hand");
    refuse_files(definition);
    const AddTool order{new_name(kind), value_of(definition), pose_in(member(wish, "pose"))};
    session_.check(order);  // a state is costly
    auto before = point_before_stroke();
    execute(order);
    put_tool_away(page);  // what was in the hand
    keep_stroke(std::move(before));
    hands_[page] = order.name;
}

void LiveLoop::tie_suture(const Json& wish) {
    Json definition = {{"kind", "suture"},
                       {"points", member(wish, "points")},
                       {"stiffness", number_in(wish, "stiffness")}};
    require_few_tools();
    const AddTool order{new_name("suture"), value_of(definition), {}};
    session_.check(order);
    auto before = point_before_stroke();
    execute(order);
    keep_stroke(std::move(before));
    has_changed_hold_ = true;
}

/// A session keeps all tools that were taken: a page that takes them for ever would fill the
/// memory.
void LiveLoop::require_few_tools() const {
    constexpr std::size_t most_tools = 2000;
    if (session_.tools().size() >= most_tools)
        throw InputError(std::to_string(most_tools) +
                         " tools were taken in this session, and it takes no more: reset it, or "
                         "begin another one");
}

void LiveLoop::keep_stroke(std::optional<Session::UndoPoint> before) {
    if (!before) return;
    undo_points_.keep_stroke(std::move(*before));
    has_changed_hold_ = false;
}

/// Returns the present state, if undo does not lead to it already: nothing has moved since the last
/// stroke began, and no jaws or threads have taken hold or let go.
std::optional<Session::UndoPoint> LiveLoop::point_before_stroke() const {
    if (undo_points_.is_stroke_at(session_.num_ticks()) && !has_changed_hold_) return std::nullopt;
    return session_.undo_point();
}

void LiveLoop::tighten(const Json& wish) {
    const std::string name = text_in(wish, "name");
    const LedTool* tool = session_.find(name);
    if (!tool) throw InputError("there is no tool '" + name + "'");
    const double length = wish.contains("length") ? number_in(wish, "length")
                                                  : number_in(wish, "factor") *
                                                        session_.world().suture_length(tool->id);
    execute(DrawSuture{name, length});
}

void LiveLoop::put_tool_away(std::uint64_t page) {
    const auto found = hands_.find(page);
    if (found == hands_.end()) return;
    const std::string name = found->second;
    hands_.erase(found);
    execute(WithdrawTool{name});
}

void LiveLoop::go_back(const Session::UndoPoint& point) {
    session_.undo(point);
    follow_return();
}

void LiveLoop::go_back_to_start() {
    session_.reset();
    undo_points_.forget_all();
    follow_return();
}

/// Follows the session, which went back.
void LiveLoop::follow_return() {
    note([&] { recorder_.note_return(session_); });
    undo_points_.forget_after(session_.num_ticks());
    pictures_.forget_surface();
    messages_.forget_edits();
    has_changed_hold_ = true;
    num_warnings_told_ = session_.simulation().warnings().size();
    hands_.clear();
    for (const LedTool& tool : session_.tools())
        if (tool.is_in_hand && tool.kind != "suture") execute(WithdrawTool{tool.name});
    is_changed_ = true;
}

void LiveLoop::undo() {
    if (!undo_points_.has_stroke()) throw InputError("there is nothing to undo");
    go_back(undo_points_.take_stroke());
}

void LiveLoop::reset() {
    go_back_to_start();
    say_hello_to_all();
}

bool LiveLoop::tick(const std::function<bool()>& is_to_stop) {
    keep_good_point();
    execute_device_orders();
    try {
        if (!session_.tick(is_to_stop)) return false;
    } catch (const std::exception& error) {  // a motion is lost, or a tool meets what it cannot cut
        recover(error.what());
        return true;
    }
    note([&] { recorder_.note_tick(session_); });
    tell_warnings();
    for (Device* device : devices_) device->publish(session_, pictures_.follow(session_));
    return true;
}

/// Notes something in the recording. A session outlives a disk that is full.
void LiveLoop::note(const std::function<void()>& in_recording) {
    try {
        in_recording();
    } catch (const OutputError& error) {
        send_message("error", std::string(error.what()) +
                                  ". The recording goes on in memory: save it from the page");
    }
}

/// Keeps the state now and then: each second, or less often if that would take more than a
/// hundredth of the time.
void LiveLoop::keep_good_point() {
    const auto begin = Pace::Clock::now();
    if (begin < next_point_) return;
    undo_points_.keep_good(session_.undo_point());
    const auto end = Pace::Clock::now();
    next_point_ =
        end + std::max<Pace::Clock::duration>(std::chrono::seconds(1), 100 * (end - begin));
}

/// Executes the orders of devices. They may come a thousand times a second: the same complaint is
/// told once.
void LiveLoop::execute_device_orders() {
    for (Device* device : devices_) {
        std::set<std::string> refused;  // tools that are not there: what else they do is not asked
        for (const Order& order : device->orders(session_)) {
            const std::string& name =
                std::visit([](const auto& one) -> const std::string& { return one.name; }, order);
            if (refused.contains(name)) continue;
            try {
                execute(order);
            } catch (const InputError& error) {
                if (std::holds_alternative<AddTool>(order)) refused.insert(name);
                const std::string text = "tool '" + name + "' of a device: " + error.what();
                if (std::exchange(last_complaints_[device], text) != text)
                    send_message("error", text);
            }
        }
        tell_complaints(*device);
    }
}

void LiveLoop::tell_complaints(Device& device) {
    for (const std::string& complaint : device.complaints()) send_message("warning", complaint);
}

/// Goes back to the last state of now and then; if that leads to the same end, farther back.
void LiveLoop::recover(const std::string& reason) {
    const std::uint64_t failure = session_.num_ticks();
    num_failures_ = failure <= last_failure_ + 1 ? num_failures_ + 1 : 1;
    last_failure_ = failure;
    if (undo_points_.has_good())
        go_back(undo_points_.take_good());
    else
        go_back_to_start();
    std::string text = reason +
                       ". The body went back to t = " + format_number(session_.world().time()) +
                       " s, and all tools are put away";
    if (num_failures_ >= most_failures) {
        is_paused_ = true;
        num_failures_ = 0;
        text += "; it pauses, as this happens again and again";
    }
    send_message("error", text);
}

void LiveLoop::send_message(std::string_view level, const std::string& text) {
    server_.send_to_all(message_text(level, text));
    if (on_message) on_message(level, text);
}

void LiveLoop::tell_warnings() {
    const auto& warnings = session_.simulation().warnings();
    for (; num_warnings_told_ < warnings.size(); ++num_warnings_told_)
        send_message("warning", warnings[num_warnings_told_]);
}

/// Says once, after the first seconds, if the body is too much for this machine.
void LiveLoop::warn_if_slow() {
    constexpr double enough = 0.9, known_after = 2.0;  // s
    if (has_told_pace_ || session_.world().time() < known_after * std::min(1.0, pace_.factor()))
        return;
    has_told_pace_ = true;
    if (pace_.factor() >= enough * pace_.speed()) return;
    std::ostringstream text;
    text.precision(2);
    text << "on this machine the body runs at " << pace_.factor()
         << " times real time, in steps of " << session_.simulation().time_step() * 1e3
         << " ms. Faster "
         << (session_.simulation().scenario().dynamics.is_explicit()
                 ? "are a coarser mesh, softer materials, fewer small elements, and "
                   "dynamics.precision = \"single\""
                 : "is a coarser mesh");
    send_message("warning", text.str());
}

void LiveLoop::say_hello(std::uint64_t page) {
    server_.send(page, messages_.hello(page == operator_));
}

void LiveLoop::say_hello_to_all() {
    for (const std::uint64_t page : pages_) say_hello(page);
}

void LiveLoop::show() {
    is_changed_ = false;
    last_shown_ = Pace::Clock::now();
    if (pages_.empty()) return;
    const auto hand = hands_.find(operator_);
    auto picture = pictures_.make(session_);
    picture->state = messages_.state({.is_paused = is_paused_,
                                      .can_undo = undo_points_.has_stroke(),
                                      .speed = pace_.speed(),
                                      .factor = pace_.factor(),
                                      .in_hand = hand == hands_.end() ? "" : hand->second});
    server_.show(std::move(picture));
}

}  // namespace incise::live
