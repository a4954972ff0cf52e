// How a kind of tool makes itself known. Internal to the folder.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>

#include "incise/sim/tools/tool_actor.h"

namespace incise::sim {

/// The class of the actors with a shape. The file of each kind specializes it, and instantiates
/// make_actor_of() for the shape: a shape without that does not link.
template <class Shape>
struct ActorFor;

template <class Shape>
std::unique_ptr<ToolActor> make_actor_of(const ToolDef& def) {
    return std::make_unique<typename ActorFor<Shape>::type>(def);
}

}  // namespace incise::sim
