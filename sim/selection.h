// Selection of nodes, faces and elements of a mesh: by rest position, by number, by region.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::sim {

/// A box with sides parallel to the axes.
struct BoxRegion {
    Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< m
};
/// A closed ball.
struct SphereRegion {
    Vec3 center = Vec3::Zero();  ///< m
    double radius = 0.0;         ///< m
};
/// The points x with (x - point) . normal >= 0.
struct HalfSpaceRegion {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< m; normal: unit length
};

/// Conditions on nodes, faces or elements at rest. All conditions that are set must hold. If none
/// is set, everything is selected.
struct Selection {
    std::optional<BoxRegion> box = std::nullopt;  ///< closed; rest positions
    std::optional<SphereRegion> sphere = std::nullopt;
    std::optional<HalfSpaceRegion> half_space = std::nullopt;
    std::optional<std::vector<std::int64_t>> nodes =
        std::nullopt;  ///< numbers in the source, from 0, ascending
    std::optional<std::vector<int>> regions = std::nullopt;  ///< regions of the elements, ascending
    bool surface = false;                                    ///< only what lies on the boundary

    bool selects_all() const {
        return !box && !sphere && !half_space && !nodes && !regions && !surface;
    }
};

/// Returns the nodes for which all conditions hold, in ascending order. A region contains all nodes
/// of its elements, including the nodes that it shares with other regions.
/// Throws InputError if no element has a node that `where.nodes` names, or if a number of a region
/// is not finite.
std::vector<VertexId> select_nodes(const topology::Mesh& mesh, const Selection& where);

/// Returns the boundary faces whose element is in `where.regions` and whose nodes all meet the
/// other conditions, in ascending order. Throws InputError as select_nodes() does.
std::vector<FaceId> select_faces(const topology::Mesh& mesh, const Selection& where);

/// Returns the elements that are in `where.regions` and whose nodes all meet the other conditions,
/// in ascending order. Throws InputError as select_nodes() does.
std::vector<CellId> select_elements(const topology::Mesh& mesh, const Selection& where);

/// Throws InputError if `count` is zero. The message gives the bounding box of the mesh.
/// @param what    what selects, such as "constraint 'clamp'"
/// @param things  what is selected, such as "node"
void require_selected(std::size_t count, const topology::Mesh& mesh, const std::string& what,
                      const std::string& things);

}  // namespace incise::sim
