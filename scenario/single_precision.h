// Warning of elements that are too thin for single precision.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "incise/topology/mesh.h"

namespace incise::scenario {

/// Returns a warning if there are tetrahedra that are too thin at rest for forces in single
/// precision: see docs/theory.md, Accuracy. Cost: O(#elements).
std::optional<std::string> warning_of_thin_elements(const topology::Mesh& mesh);

}  // namespace incise::scenario
