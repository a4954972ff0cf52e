// The options of a cut, and what it did.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>

#include "incise/topology/change_set.h"

namespace incise::cutting {

/// The default of `snap`. The longest edges of a mesh are about twice as long as the mean, so that
/// nodes of the cut are off the surface by at most 0.03 of a mean edge.
inline constexpr double default_snap = 0.015;
/// The least tolerance of a cut through cells of any shape: some ten times the distance by which
/// blades are moved aside so that none is exactly on a node (Cutter), and more than rounding.
inline constexpr double least_tolerance = 2e-6;

/// The options of a cut.
struct SplitOptions {
    /// The tolerance of a cut, as a share of an edge that the surface crosses. The range is
    /// [0, 0.5]. An end of such an edge that is nearer to the surface counts as on it. No node is
    /// moved. Without a tolerance, a cut leaves parts of any size. In a body with other cells than
    /// tetrahedra, a node counts as on the surface if it is nearer than half of this share of the
    /// longest edge there, at rest: see Cutter for the range.
    double snap = default_snap;
};

/// The report of a cut.
struct SplitReport {
    std::size_t elements_crossed = 0;  ///< elements before the edit that the surface crosses
    std::size_t nodes_snapped = 0;  ///< nodes before the edit that came to count as on the surface
    std::size_t edges_divided = 0;
    std::size_t faces_opened = 0;
    double cut_area = 0.0;  ///< of one side of the opened faces, at rest, m2
};

/// An edit by a cut, with its report.
struct Split {
    topology::ChangeSet changes;
    SplitReport report;
};

}  // namespace incise::cutting
