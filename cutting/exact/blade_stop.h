// Where a blade has stopped inside the body: which way it goes on, and which carriers it parts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "incise/cutting/exact/blade_end.h"
#include "incise/cutting/exact/loop_front.h"
#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/fragments/fragment_mesh.h"

namespace incise::cutting {

/// A node of a cut in progress.
struct FrontNode {
    Vec3 x;                    ///< m
    double local_edge_length;  ///< m
};
/// Returns the living nodes of a front in ascending order, so that sums over them do not depend on
/// its history.
/// @param positions  by vertex id, m
template <class Front>
std::vector<FrontNode> nodes_of(const Front& front, const topology::Mesh& mesh,
                                std::span<const Vec3> positions) {
    std::vector<VertexId> ids;
    front.for_each([&](VertexId n) {
        if (mesh.is_alive(n)) ids.push_back(n);
    });
    std::ranges::sort(ids);
    std::vector<FrontNode> nodes;
    for (const VertexId n : ids)
        nodes.push_back({positions[n.index()], front.local_edge_length(n)});
    return nodes;
}

/// Returns the same blade if its cut is behind it, else one that goes on away from its cut. A blade
/// may also cut because the tissue moves, and its own motion then does not give the direction.
BladeEnd away_from_cut(const BladeEnd& blade, std::span<const FrontNode> nodes);

/// Returns the cells of the same carrier that hang together with a cell inside it, this one first.
/// @param carrier_of  by cell
template <class CarrierOf>
std::vector<CellId> part_of_carrier(const topology::Mesh& mesh, CellId e, CarrierOf carrier_of) {
    std::vector<CellId> part{e};
    for (std::size_t next = 0; next < part.size(); ++next)
        for (int f = 0; f < mesh.num_faces(part[next]); ++f) {
            const CellId other = mesh.neighbor({part[next], f}).cell;
            if (other.is_valid() && carrier_of(other) == carrier_of(e) &&
                std::ranges::find(part, other) == part.end())
                part.push_back(other);
        }
    return part;
}

/// The parts of carriers that a blade's edge is in.
struct BladePlace {
    std::vector<std::vector<CellId>> parts;  ///< cells of each, in ascending order
    double exit_distance = 0.0;  ///< how far the edge must go on to be past all of them, m
};
/// Returns where the blade's edge is. An edge in the face between two cells counts as in one of
/// them (space_time.h).
/// @param tissue  at rest
BladePlace place_of(const BladeEnd& blade, const TissueMotion& tissue,
                    const fragments::FragmentMesh& fragments);

/// Returns the cells of those parts through whose section the blade has passed by half or more. A
/// carrier that is cut in part moves as if it were whole: so these are to be parted, and the others
/// to stay whole.
/// @param positions  by vertex id, m
std::unordered_set<CellId> cells_to_part(const BladeEnd& blade, const BladePlace& place,
                                         const topology::Mesh& mesh,
                                         std::span<const Vec3> positions, const LoopFront& front);

}  // namespace incise::cutting
