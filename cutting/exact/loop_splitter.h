// The exact cut through cells of any shape: it divides them along a surface and separates the
// parts. See docs/cutting.md, Cells of any shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <unordered_set>

#include "incise/cutting/exact/blade_end.h"
#include "incise/cutting/exact/loop_front.h"
#include "incise/cutting/exact/split.h"
#include "incise/cutting/exact/suspended_cut.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

using SuspendedLoops = SuspendedCutOf<LoopFront>;

/// What cuts that are over have left.
struct EarlierCuts {
    const std::unordered_set<VertexId>* on_surface = nullptr;  ///< nodes that the surface has made
    /// Cuts that have ended inside the body, with blades far away. A blade that comes to a node of
    /// such a cut, and goes along it, goes on with it.
    std::span<SuspendedLoops> unfinished;
};

/// Cuts along a surface, or along what a blade's edge sweeps in this step. A crossed cell becomes
/// two cells, whatever its kind; a cell beside it keeps its place and gains nodes and edges in its
/// faces. A cell that the surface crosses in part stays whole until the cut goes on.
/// Returns the edit, which may be empty.
/// @param mesh     the body
/// @param tissue   its motion in this step
/// @param surface  what the cut follows
/// @param front    of the cut, from its earlier steps; of a surface at once, it then has all nodes
///                 of the cut
/// @param options  of the cut
/// @param resting  the other cuts in progress
/// @param earlier  cuts that are over; one that is taken up again is left empty
/// Cost: some microseconds a crossed cell, and the search for them.
Split split_cells(topology::Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
                  LoopFront& front, const SplitOptions& options, std::span<SuspendedLoops> resting,
                  const EarlierCuts& earlier = {});

/// Ends a cut at a blade that has stopped, in tissue at rest, and takes the blade out of it. A
/// carrier that is cut in part moves as if it were whole: so those through whose section the blade
/// has passed by half or more are parted along the straight continuation of its path, and the
/// others stay whole. Returns the edit, which may be empty.
/// @param fragments  of the mesh
/// @param earlier    cuts that are over, of which none is taken up
/// Cost: as split_cells(), and the search for the cells at the blade's edge.
Split finish_cells(topology::Mesh& mesh, const fragments::FragmentMesh& fragments,
                   const TissueMotion& tissue, const BladeEnd& blade, LoopFront& front,
                   const SplitOptions& options, std::span<SuspendedLoops> resting,
                   const EarlierCuts& earlier = {});

}  // namespace incise::cutting
