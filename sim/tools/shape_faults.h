// Why values of tools are invalid, for messages. All functions return nothing if they are valid.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "incise/cutting/tools/tool.h"

namespace incise::sim {

std::string fault_of_snap(double snap);
/// @param what     such as "edge"
/// @param subject  such as "the edge of a blade"
std::string fault_of_line(std::span<const Vec3> points, const std::string& what,
                          const std::string& subject);
std::string fault_of_max_force(double max_force);
std::string fault_of_shape(const cutting::CarverShape& shape);
std::string fault_of_shape(const cutting::ProbeShape& shape);

}  // namespace incise::sim
