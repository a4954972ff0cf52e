// The kinds of tools, one line for each. Internal to the folder.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/scenario/tools/tool_kind.h"

namespace incise::scenario {

const ToolKind& carver_kind();
const ToolKind& blade_kind();
const ToolKind& cut_kind();
const ToolKind& probe_kind();
const ToolKind& grasper_kind();
const ToolKind& suture_kind();

/// All kinds, in the order in which messages name them.
inline constexpr const ToolKind& (*all_kinds[])() = {carver_kind, blade_kind,   cut_kind,
                                                     probe_kind,  grasper_kind, suture_kind};

}  // namespace incise::scenario
