// The key `shape` of tools, and what tools of several kinds have in common. Internal to the folder.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "incise/cutting/tools/tool.h"
#include "incise/scenario/document.h"
#include "incise/scenario/limits.h"
#include "incise/scenario/table_reader.h"
#include "incise/scenario/tools/tool_kind.h"

namespace incise::scenario {

inline constexpr std::string_view shape_hint = "as in shape = { sphere = { radius = 0.008 } }";

/// Reads the shape that one of the keys sphere, capsule and box of a table gives. Returns nothing
/// without one.
std::optional<cutting::CarverShape> read_simple_shape(const TableReader& shape);
/// Reads the key `shape` of a tool with a simple shape. Returns nothing if it is missing or faulty.
std::optional<cutting::CarverShape> read_shape_of(const TableReader& tool);
/// Reads the key `snap` of a tool that divides cells.
double read_snap(const TableReader& tool);
/// Reads a line of at least two points, and reports those that follow each other and are the same.
std::vector<Vec3> read_line(const TableReader& tool, std::string_view key);

/// Reads the keys `close` and `open` of a tool with jaws.
void read_jaw_times(const TableReader& tool, ToolSpec& spec);
/// Reports times of jaws that are not within the path.
void check_jaw_times(const TableReader& tool, const ToolSpec& spec);

Extent extent_of(const cutting::CarverShape& shape);

/// Returns a value for describe().
Value value_of(double number);
Value value_of(const Vec3& vector);
Value value_of(std::span<const Vec3> points);
Value value_of(Table table);
/// Returns the entry {"shape": ...} of a simple shape.
Entry shape_entry(const cutting::CarverShape& shape);

}  // namespace incise::scenario
