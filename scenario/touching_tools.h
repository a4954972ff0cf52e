// Readers of the tools that touch tissue, and of shapes. Internal to the reader of scenarios.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "incise/cutting/tools/tool.h"
#include "incise/scenario/scenario.h"
#include "incise/scenario/table_reader.h"

namespace incise::scenario {

/// Reads the key `shape` of a carver, a probe or a grasper. Returns nothing if it is missing or
/// faulty.
std::optional<cutting::CarverShape> read_shape_of(const TableReader& tool);

cutting::Probe read_probe(const TableReader& tool);
cutting::Probe read_obstacle(const TableReader& obstacle);
GrasperSpec read_grasper(const TableReader& tool);
SutureSpec read_suture(const TableReader& tool);

/// Reports times of jaws that are not within the path, from `first` to `last`, s.
void check_jaws(const TableReader& tool, const GrasperSpec& grasper, double first, double last);

}  // namespace incise::scenario
