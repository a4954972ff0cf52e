// What a hand does with a tool, as values.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "incise/scenario/document.h"
#include "incise/topology/pose.h"

namespace incise::live {

/// Takes a new tool into the hand. It is at a pose at once, and cuts and pushes nothing on the way
/// there. A suture has no pose: its thread is drawn through its points.
struct AddTool {
    std::string name;            ///< that no other tool has
    scenario::Value definition;  ///< see scenario::build_hand_tool()
    Pose pose = {};
};
/// Leads a tool: the pose is that at the end of the next tick.
struct MoveTool {
    std::string name;
    Pose pose;
};
/// Withdraws a tool at the end of the next tick.
struct WithdrawTool {
    std::string name;
};
struct CloseTool {
    std::string name;
};
struct OpenTool {
    std::string name;
};
/// Draws a thread: its length without tension at the end of the next tick, m.
struct DrawSuture {
    std::string name;
    double length = 0.0;
};
struct UntieSuture {
    std::string name;
};

using Order =
    std::variant<AddTool, MoveTool, WithdrawTool, CloseTool, OpenTool, DrawSuture, UntieSuture>;

/// Returns an order as one JSON object, such as {"move":"blade_1","at":[0,0,0],
/// "rotation":[0,0,0,1]}. Numbers keep all their bits.
std::string to_json(const Order& order);
/// Reads what to_json() returns. Throws InputError that says what is wrong.
Order order_from_json(std::string_view text);

/// Throws InputError if the pose is not finite or its rotation has not unit length.
void require_sound(const Pose& pose);

}  // namespace incise::live
