// Numbers and points as options of the command line hold them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "incise/base/types.h"

namespace incise::app {

/// Beyond this, of either sign, rounding would show in distances from a body of usual size.
inline constexpr double largest_coordinate = 1e12;

/// The parts between separators, without blanks at their ends; one more than separators.
std::vector<std::string_view> parts_of(std::string_view text, char separator);

/// The numbers of "1,2.5,-3e-2".
/// @param what  for messages, such as "--plane"
/// @param form  names of the numbers, with commas between: "px,py,pz,nx,ny,nz"
/// Throws InputError if it has more or less than `form` names, or if one is no number between
/// -largest_coordinate and largest_coordinate.
std::vector<double> parse_numbers(const std::string& what, std::string_view text,
                                  std::string_view form);

/// The points of "x,y,z;x,y,z". Throws as above.
std::vector<Vec3> parse_points(const std::string& what, std::string_view text);

}  // namespace incise::app
