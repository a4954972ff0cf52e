// Tools of a scenario: what they are made of, and what is at fault with them before they run.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "incise/cutting/tools/tool.h"
#include "incise/scenario/scenario.h"
#include "incise/scenario/tool_path.h"
#include "incise/topology/mesh.h"
#include "incise/topology/spatial/element_boxes.h"

namespace incise::scenario {

/// How blades cut if they are not told: they split, unless the mesh has other elements than
/// tetrahedra. Cost: O(#elements).
CutMode usual_mode(const topology::Mesh& mesh);

/// Blades get a mode that suits the mesh, unless they have one.
/// Throws InputError for what is to split a mesh without tetrahedra.
ToolSpec with_mode(ToolSpec spec, const topology::Mesh& mesh);

/// A tool and its way.
struct ScriptedTool {
    std::string name;
    cutting::ToolShape shape;
    ToolPath path;
    std::shared_ptr<const cutting::CutSurface> surface;  ///< of a cut at once, else null
};

/// Reads the file of its surface. A blade without a mode splits. A tool of which no path is known
/// gets one without keys. Warnings name the file.
/// Throws InputError if the file cannot be read.
ScriptedTool build_tool(const ToolSpec& spec, std::vector<std::string>& warnings);

/// False only if nothing of the tool is ever in the box. Cost: that of its path, or of its surface.
bool may_meet(const ScriptedTool& tool, const Box& box);

/// Throws InputError if the tool is to divide elements and meets one on its path that it cannot
/// divide, where the body rests: a run would stop there. Its path after `end_time`, s, is not
/// looked at. Cost: O(#elements) for each key.
void require_divisible(const ScriptedTool& tool, const topology::Mesh& mesh, double end_time);
/// A warning of elements that it cannot divide and comes near to at rest, if it is to divide and
/// there are any: tissue that moves may come into its way.
/// @pre  require_divisible() throws nothing
/// Cost: as there.
std::optional<std::string> warning_of_near_misses(const ScriptedTool& tool,
                                                  const topology::Mesh& mesh, double end_time);
/// True if the tool divides elements: a cut, or a blade in the mode "split".
bool divides(const cutting::ToolShape& shape);
/// What to do where the edits of a tool leave a stable step that is too short.
std::string for_longer_steps(const cutting::ToolShape& shape);
/// What to do about such an element.
std::string instead_of_dividing(const cutting::ToolShape& shape);

}  // namespace incise::scenario
