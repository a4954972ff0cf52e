// What pages are told of a session: what it is, and its state at each picture.
// docs/live.md lists the messages.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "incise/live/json_values.h"
#include "incise/live/loop/picture_maker.h"
#include "incise/live/session.h"

namespace incise::live {

/// Returns a message for the person in front of a page.
/// @param level  "info", "warning" or "error"
std::string message_text(std::string_view level, const std::string& text);

/// What the loop adds to the state of a session.
struct LoopState {
    bool is_paused, can_undo;
    double speed, factor;  ///< that are wanted, and that there are: see Pace
    std::string in_hand;   ///< the tool of the operator; empty: none
};

/// Writes the messages of one session.
class PageMessages {
  public:
    /// @lifetime  both must outlive the object
    PageMessages(const Session& session, const PictureMaker& pictures);

    /// Returns what a page needs to know once.
    std::string hello(bool is_operator) const;
    /// Returns the present state. Cost: proportional to the tools, and to the edits since the last
    /// call.
    std::string state(const LoopState& loop);
    /// Says that the session went back: the edits are others.
    void forget_edits();

  private:
    /// A tool of the scenario that pages draw.
    struct ScriptedTool {
        sim::ToolId id;
        std::string name;
        bool is_obstacle;
        Json definition;
    };
    Json state_of(const ScriptedTool& tool) const;
    Json state_of(const LedTool& tool, const LoopState& loop) const;

    const Session& session_;
    const PictureMaker& pictures_;
    std::vector<ScriptedTool> scripted_tools_;
    double cut_area_ = 0.0;  // of the first edits, m2
    std::size_t num_edits_counted_ = 0;
};

}  // namespace incise::live
