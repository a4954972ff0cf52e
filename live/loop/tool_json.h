// Tools of a scenario as a page reads them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "incise/cutting/tools/tool.h"
#include "incise/live/json_values.h"

namespace incise::live {

/// Returns the kind and the shape of a tool, with the keys of a [[tool]] section. A shape from a
/// file comes as {"mesh": {"points", "triangles"}}, and a half space as {"plane": {"point",
/// "normal"}}. Returns nothing for tools that a page does not draw: cuts at once, and sutures.
std::optional<Json> json_of(const cutting::ToolShape& shape);

}  // namespace incise::live
