// Which nodes, faces and elements of a mesh: by where they are at rest, by number, by region.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::sim {

/// A place and an extent along the axes.
struct BoxRegion {
    Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< m
};
struct SphereRegion {
    Vec3 center = Vec3::Zero();  ///< m
    double radius = 0.0;
};
/// The points x with (x - point) . normal >= 0.
struct HalfSpaceRegion {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< the normal is of unit length
};

/// Nodes or faces for which everything given holds, at rest. Nothing given: all.
struct Selection {
    std::optional<BoxRegion> box = std::nullopt;  ///< closed
    std::optional<SphereRegion> sphere = std::nullopt;
    std::optional<HalfSpaceRegion> half_space = std::nullopt;
    std::optional<std::vector<std::int64_t>> nodes =
        std::nullopt;  ///< numbers in the source, from 0; ascending
    std::optional<std::vector<int>> regions =
        std::nullopt;      ///< in an element of one of these; ascending
    bool surface = false;  ///< on the boundary

    bool selects_all() const {
        return !box && !sphere && !half_space && !nodes && !regions && !surface;
    }
};

/// Nodes for which everything given holds, at rest; in a region are all nodes of its elements, also
/// those that it shares with another. Ascending.
std::vector<NodeId> select_nodes(const topology::Mesh& mesh, const Selection& where);

/// Faces of the boundary whose element is in `where.regions` and for all of whose nodes the rest
/// holds; ascending.
std::vector<FaceId> select_faces(const topology::Mesh& mesh, const Selection& where);

/// Elements that are in `where.regions` and for all of whose nodes the rest holds; ascending.
std::vector<ElementId> select_elements(const topology::Mesh& mesh, const Selection& where);

/// Throws InputError that says where the mesh is, if `count` is zero.
/// @param what  such as "constraint 'clamp'"
/// @param things  such as "node"
void require_selected(std::size_t count, const topology::Mesh& mesh, const std::string& what,
                      const std::string& things);

}  // namespace incise::sim
