// Readers of the tools that touch tissue, and of shapes. Internal to the reader of scenarios.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "incise/cutting/tools/tool.h"
#include "incise/scenario/scenario.h"
#include "incise/scenario/table_reader.h"

namespace incise::scenario {

/// Reads the key `shape` of a carver, a probe or a grasper. Returns nothing if it is missing or
/// faulty.
std::optional<cutting::CarverShape> read_shape_of(const TableReader& tool);

/// @param folder  of the scenario, to which the name of a surface file is relative
ProbeSpec read_probe(const TableReader& tool, const std::filesystem::path& folder);
ProbeSpec read_obstacle(const TableReader& obstacle, const std::filesystem::path& folder);
GrasperSpec read_grasper(const TableReader& tool);
SutureSpec read_suture(const TableReader& tool);

/// Reports times of jaws that are not within the path, from `first` to `last`, s.
void check_jaws(const TableReader& tool, const GrasperSpec& grasper, double first, double last);

}  // namespace incise::scenario
