// Straight ways through deformed bodies, against points along the way.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/way_inside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "incise/topology/boundary_surface.h"
#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::contact {
namespace {

using topology::Mesh;

/// True if a point is in a tetrahedron of the mesh, or outside it by a rounding error.
bool is_in_mesh(const Mesh& mesh, std::span<const Vec3> positions, const Vec3& x) {
    return std::ranges::any_of(mesh.elements(), [&](ElementId e) {
        const auto corners = mesh.corners(e);
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k)
            edges.col(k) = positions[corners[static_cast<std::size_t>(k)].index()] -
                           positions[corners[3].index()];
        const Vec3 weights = edges.inverse() * (x - positions[corners[3].index()]);
        return std::min(weights.minCoeff(), 1.0 - weights.sum()) > -1e-9;
    });
}

TEST(WayInside, AgreesWithPointsAlongTheWay) {
    int num_inside = 0, num_outside = 0;
    for (const test::MeshFamily* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        const Mesh mesh = Mesh::build(family->data).mesh;
        const topology::BoundarySurface surface(mesh);
        std::vector<Vec3> positions;
        for (const Vec3& x : mesh.rest_positions())
            positions.emplace_back(x.x() + 0.2 * x.y() * x.y(), 1.3 * x.y(), x.z() - 0.1 * x.x());
        Box box;
        for (const Vec3& x : positions) box.extend(x);
        for (std::uint64_t seed = 0; seed < test::num_cases(60); ++seed) {
            SCOPED_TRACE(seed);
            test::Random random(seed);
            const std::size_t t = random.below(surface.triangles().size());
            const auto& [a, b, c] = surface.triangles()[t];
            const Vec3 from = 0.5 * positions[a.index()] + 0.3 * positions[b.index()] +
                              0.2 * positions[c.index()];
            const Vec3 outward = (positions[b.index()] - positions[a.index()])
                                     .cross(positions[c.index()] - positions[a.index()])
                                     .normalized();
            Vec3 along = random.vector(1.0).normalized();
            if (along.dot(outward) > -0.1) continue;
            along *= random.uniform(0.05, 1.0) * box.sizes().norm();
            constexpr int num_points = 400;
            bool expected = true;
            for (int i = 1; i < num_points && expected; ++i)
                expected = is_in_mesh(mesh, positions, from + i * along / num_points);
            // A way that only touches a corner of the outside is neither.
            const bool ends_near = expected != is_in_mesh(mesh, positions, from + 1.02 * along);
            const bool found =
                is_way_inside(mesh, positions, surface.faces()[t], from, from + along);
            if (!ends_near) {
                EXPECT_EQ(found, expected);
            }
            (found ? num_inside : num_outside) += 1;
        }
    }
    EXPECT_GT(num_inside, 20);
    EXPECT_GT(num_outside, 20);
}

TEST(WayInside, GoesThroughHexahedra) {
    const Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(),
                                                     Vec3::Ones(), {4, 4, 4}))
                          .mesh;
    const topology::BoundarySurface surface(mesh);
    for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
        Vec3 from = Vec3::Zero();
        for (const NodeId n : surface.triangles()[t]) from += mesh.rest_position(n) / 3.0;
        const auto inside = [&](const Vec3& to) {
            return is_way_inside(mesh, mesh.rest_positions(), surface.faces()[t], from, to);
        };
        EXPECT_TRUE(inside(Vec3(0.51, 0.52, 0.53)));
        EXPECT_FALSE(inside(from + 2.2 * (Vec3(0.51, 0.52, 0.53) - from)));
    }
}

}  // namespace
}  // namespace incise::contact
