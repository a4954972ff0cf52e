// SPDX-License-Identifier: LGPL-3.0-or-later
#include "data/organs/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "incise/topology/geometry.h"

namespace incise::organs {

MeshQuality measure(const topology::MeshData& mesh) {
    constexpr auto infinity = std::numeric_limits<double>::infinity();
    MeshQuality q;
    q.min_edge = q.min_altitude = infinity;
    double largest_cosine = -1.0, smallest_cosine = 1.0;
    std::set<std::pair<std::int64_t, std::int64_t>> edges;
    for (const Vec3& p : mesh.points) q.box.extend(p);

    const auto& tetrahedron = topology::traits(topology::CellKind::tetrahedron);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        const auto corners = mesh.cell(c);
        const auto at = [&](int i) -> const Vec3& {
            return mesh.points[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])];
        };
        const double volume = topology::tetrahedron_volume(at(0), at(1), at(2), at(3));
        q.volume_of_region[mesh.regions[c]] += volume;

        std::array<Vec3, 4> normals;
        for (int f = 0; f < tetrahedron.num_faces; ++f) {
            const auto face = tetrahedron.face(f);
            const Vec3 area = 0.5 * (at(face[1]) - at(face[0])).cross(at(face[2]) - at(face[0]));
            q.min_altitude = std::min(q.min_altitude, 3.0 * volume / area.norm());
            normals[static_cast<std::size_t>(f)] = area.normalized();
        }
        for (std::size_t f = 0; f < 4; ++f)
            for (std::size_t g = 0; g < f; ++g) {
                const double cosine = -normals[f].dot(normals[g]);
                largest_cosine = std::max(largest_cosine, cosine);
                smallest_cosine = std::min(smallest_cosine, cosine);
            }
        for (int e = 0; e < tetrahedron.num_edges; ++e) {
            const auto [i, j] = tetrahedron.edges[static_cast<std::size_t>(e)];
            edges.insert(std::minmax(corners[static_cast<std::size_t>(i)],
                                     corners[static_cast<std::size_t>(j)]));
        }
    }
    for (const auto& [a, b] : edges) {
        const double length =
            (mesh.points[static_cast<std::size_t>(a)] - mesh.points[static_cast<std::size_t>(b)])
                .norm();
        q.mean_edge += length / static_cast<double>(edges.size());
        q.min_edge = std::min(q.min_edge, length);
    }
    constexpr double degrees = 180.0 / std::numbers::pi;
    q.min_dihedral = std::acos(std::min(largest_cosine, 1.0)) * degrees;
    q.max_dihedral = std::acos(std::max(smallest_cosine, -1.0)) * degrees;
    return q;
}

}  // namespace incise::organs
