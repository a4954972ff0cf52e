// The exact cut: elements are divided along a surface and parted there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "incise/cutting/exact/blade_end.h"
#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/exact/step_length.h"
#include "incise/cutting/exact/suspended_cut.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Measured: docs/measurements/cutting.md.
inline constexpr double default_snap = 0.6;

/// Of the uncut body's step length (step_length.h), what cuts try to leave every element: 0.55 from
/// a snap of 0.6 on, less in proportion below.
double least_step_share(double snap);

struct SplitOptions {
    /// How far off the surface nodes of the cut may be, in mean edge lengths of the uncut body;
    /// nothing is moved. In [0, 1]. A node nearer to the surface than a third of `snap` of an edge
    /// that the surface crosses counts as lying on it; up to `snap` away it does where elements
    /// would otherwise be left with too little of the uncut body's step length: less than
    /// least_step_share(), or half of that where all that is nearer would be smaller still.
    double snap = default_snap;
    UncutBody uncut = {};
};

/// What a cut did.
struct SplitReport {
    std::size_t elements_crossed = 0;  ///< of before, those through which the surface passed
    std::size_t nodes_snapped = 0;     ///< nodes of before that count as on the surface
    std::size_t edges_divided = 0;
    std::size_t faces_opened = 0;
    double cut_area = 0.0;  ///< of one side of the opened faces, at rest, m2
};

struct Split {
    topology::ChangeSet changes;
    SplitReport report;
};

/// Divides the tetrahedra that the surface passes through and opens the faces on it, in one
/// transaction.
///
/// Edges that the surface crosses are divided there, in the order in which it comes to them, of
/// those that it meets at once the longest first; each division takes every element round the edge
/// in two, so the mesh stays conforming, and no volume is lost. Then the faces open whose three
/// nodes lie on the surface and whose elements are on different sides of it. A body through which
/// the surface passes right across is parted; where the surface ends, so do the opened faces,
/// within one element. Small pieces at its end wait in the front, for the step in which the blade
/// has gone on or away: separation.h.
///
/// @param front  what is left of the cut so far, if it goes on (a blade), else an empty one; it is
///               brought up to date
/// @param snap_history  of all cuts of this body so far; brought up to date
/// @param resting  the blades that are in the body besides; their fronts know of what is divided,
///                 but not yet of nodes that the edit copies: CutFront::follow. What comes to lie
///                 on their cuts behind them opens too.
/// Throws InputError, and leaves the mesh as it was, if a crossed element is no tetrahedron.
/// Cost: a few microseconds for each element that is crossed, and the search for them: what is near
/// the surface, if the motion has boxes, else O(#elements).
Split split(topology::Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
            CutFront& front, const SplitOptions& options, SnapHistory& snap_history,
            std::span<SuspendedCut> resting = {});

/// Ends the cut of a blade whose way has ended, at its edge: elements that the edge is in are
/// divided along the continuation of its way, the faces on the cut at the edge, to the same limits,
/// and those behind it open. Small pieces that have waited come off or stay. The front is empty
/// afterwards.
///
/// @param tissue  at rest: before and after are the same
/// Else as split(). Nothing happens if the front is empty.
Split finish(topology::Mesh& mesh, const TissueMotion& tissue, const BladeEnd& blade,
             CutFront& front, const SplitOptions& options, SnapHistory& snap_history,
             std::span<SuspendedCut> resting = {});

}  // namespace incise::cutting
