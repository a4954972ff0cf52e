// The kinds of tools: one function for each. Internal to sim.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>

#include "incise/cutting/tools/tool.h"
#include "incise/sim/tools/tool_actor.h"

namespace incise::sim {

/// Makes an actor from its definition, which has the shape of the first argument. Throws InputError
/// if the shape is invalid.
std::unique_ptr<ToolActor> make_actor_of(const cutting::Blade&, const ToolDef& def);
std::unique_ptr<ToolActor> make_actor_of(const cutting::Carver&, const ToolDef& def);
std::unique_ptr<ToolActor> make_actor_of(const cutting::PlaneCut&, const ToolDef& def);
std::unique_ptr<ToolActor> make_actor_of(const cutting::SurfaceCut&, const ToolDef& def);
std::unique_ptr<ToolActor> make_actor_of(const cutting::Probe&, const ToolDef& def);
std::unique_ptr<ToolActor> make_actor_of(const cutting::Grasper&, const ToolDef& def);
std::unique_ptr<ToolActor> make_actor_of(const cutting::Suture&, const ToolDef& def);

}  // namespace incise::sim
