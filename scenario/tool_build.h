// Builds the tools of a scenario, and finds their problems before a run.
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

/// A tool with its path.
struct ScriptedTool {
    std::string name;
    cutting::ToolShape shape;
    ToolPath path;
    std::shared_ptr<const cutting::CutSurface> surface;  ///< of a cut; null for other tools
    std::optional<double> close = {}, open = {};         ///< see ToolSpec
    double over = 0.0;                                   ///< see ToolSpec
    std::optional<double> length = {};                   ///< see ToolSpec
};

/// Builds a tool, and reads the file of its surface if it has one. A blade without a mode splits.
/// If the path is not known, the tool has a path without keys. Warnings name the file.
/// Throws InputError if the file cannot be read.
ScriptedTool build_tool(const ToolSpec& spec, std::vector<std::string>& warnings);

/// Returns false only if no part of the tool is ever in the box.
/// Cost: proportional to the size of its path or of its surface.
/// @pre  the tool has a surface, or a path with a key
bool may_meet(const ScriptedTool& tool, const Box& box);

/// True if the tool divides elements: it cuts, and is no carver and no blade with mode "separate".
bool divides(const cutting::ToolShape& shape);
/// Returns advice for messages: how to change the tool if its edits make the stable step too short.
std::string for_longer_steps(const cutting::ToolShape& shape);

}  // namespace incise::scenario
