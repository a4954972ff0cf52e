// Parsing of numbers and points in options of the command line.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "incise/base/types.h"

namespace incise::app {

/// The largest allowed absolute value of a coordinate. With larger values, rounding errors in
/// distances would be visible for a body of usual size.
inline constexpr double largest_coordinate = 1e12;

/// Returns the parts of a text between separators, without blanks at their ends. There is one part
/// more than separators.
std::vector<std::string_view> parts_of(std::string_view text, char separator);

/// Parses numbers with commas between them, such as "1,2.5,-3e-2".
/// @param what  name of the option for messages, such as "--plane"
/// @param text  the text to parse
/// @param form  names of the numbers with commas between them, such as "px,py,pz,nx,ny,nz"
/// Throws InputError if there are more or fewer numbers than names in `form`, or if a part is no
/// number from -largest_coordinate to largest_coordinate.
std::vector<double> parse_numbers(const std::string& what, std::string_view text,
                                  std::string_view form);

/// Parses points of the form "x,y,z;x,y,z". Throws as parse_numbers().
std::vector<Vec3> parse_points(const std::string& what, std::string_view text);

}  // namespace incise::app
