// Straight ways through deformed bodies, against points along the way.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/way_inside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "incise/cutting/exact/loop_splitter.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/topology/boundary_surface.h"
#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::contact {
namespace {

using topology::Mesh;

/// True if a point is in a tetrahedron of the mesh, or outside it by a rounding error.
bool is_in_mesh(const Mesh& mesh, std::span<const Vec3> positions, const Vec3& x) {
    return std::ranges::any_of(mesh.elements(), [&](CellId e) {
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
    int num_inside = 0, num_outside = 0, num_entering_again = 0;
    for (const test::MeshFamily* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        const Mesh mesh = Mesh::build(family->data).mesh;
        const topology::BoundarySurface surface(mesh);
        std::vector<Vec3> positions;
        for (const Vec3& x : mesh.rest_positions())
            positions.emplace_back(x.x() + 0.2 * x.y() * x.y(), 1.3 * x.y(), x.z() - 0.1 * x.x());
        Box box;
        for (const Vec3& x : positions) box.extend(x);
        for (std::uint64_t seed = 0; seed < test::num_cases(100); ++seed) {
            SCOPED_TRACE(seed);
            test::Random random(seed);
            const std::size_t t = random.below(surface.triangles().size());
            const auto& [a, b, c] = surface.triangles()[t];
            const Vec3 weights(0.5, 0.3, 0.2);
            const Vec3 from = weights[0] * positions[a.index()] +
                              weights[1] * positions[b.index()] + weights[2] * positions[c.index()];
            const Vec3 outward = (positions[b.index()] - positions[a.index()])
                                     .cross(positions[c.index()] - positions[a.index()])
                                     .normalized();
            Vec3 along =
                random.uniform(0.05, 1.0) * box.sizes().norm() * random.vector(1.0).normalized();
            if (seed % 2 == 1) {  // to the middle of an element, maybe out of the body and in again
                const auto corners = mesh.corners(CellId(random.below(mesh.num_elements())));
                along = -from;
                for (const VertexId n : corners) along += 0.25 * positions[n.index()];
            }
            if (along.dot(outward) > -0.1 * along.norm()) continue;
            constexpr int num_points = 400;
            bool expected = true;
            for (int i = 1; i < num_points && expected; ++i)
                expected = is_in_mesh(mesh, positions, from + i * along / num_points);
            // The points miss a way that only leaves near its end.
            const bool ends_inside = is_in_mesh(mesh, positions, from + 0.98 * along);
            if (ends_inside != is_in_mesh(mesh, positions, from + 1.02 * along)) continue;
            const bool found = is_way_inside(mesh, positions, surface.faces()[t],
                                             surface.triangles()[t], weights, from + along);
            EXPECT_EQ(found, expected);
            (found ? num_inside : num_outside) += 1;
            num_entering_again += !expected && ends_inside;
        }
    }
    EXPECT_GT(num_inside, test::num_cases(40));
    EXPECT_GT(num_outside, test::num_cases(40));
    if (!test::is_sanitized) {
        EXPECT_GT(num_entering_again, 10);
    }
}

// From corners and edges too, where rounding decides which face is next. Turned meshes, whose faces
// are in no plane of the axes.
TEST(WayInside, MayBeginAtACorner) {
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron}) {
        const Mesh mesh =
            Mesh::build(topology::box_mesh(kind, Vec3::Zero(), Vec3::Ones(), {4, 4, 4})).mesh;
        const topology::BoundarySurface surface(mesh);
        for (std::uint64_t seed = 0; seed < test::num_cases(20); ++seed) {
            test::Random random(seed);
            const Eigen::Matrix3d turn =
                Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.vector(1.0).normalized())
                    .toRotationMatrix();
            std::vector<Vec3> positions;
            for (const Vec3& x : mesh.rest_positions()) positions.push_back(turn * x);
            for (std::size_t t = 0; t < surface.triangles().size(); ++t)
                for (const Vec3& weights :
                     {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.5, 0.5, 0)}) {
                    const auto& [a, b, c] = surface.triangles()[t];
                    const Vec3 &A = mesh.rest_position(a), &B = mesh.rest_position(b),
                               &C = mesh.rest_position(c);
                    const Vec3 from = weights[0] * A + weights[1] * B + weights[2] * C;
                    const Vec3 inwards = -(B - A).cross(C - A).normalized();
                    const auto num_sides =
                        ((from - Vec3::Constant(0.5)).cwiseAbs().array() > 0.499).count();
                    if (num_sides > 1) continue;  // ways along another side of the cube
                    const auto is_inside = [&](double depth) {
                        return is_way_inside(mesh, positions, surface.faces()[t],
                                             surface.triangles()[t], weights,
                                             turn * (from + depth * inwards));
                    };
                    EXPECT_TRUE(is_inside(0.3)) << from.transpose();
                    EXPECT_FALSE(is_inside(1.2)) << from.transpose();
                }
        }
    }
}

// Whether it is in a face, on an edge or at a corner, and also along the side where the way begins.
TEST(WayInside, NeverEndsOnTheSurface) {
    for (const test::MeshFamily& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        const Mesh mesh = Mesh::build(family.data).mesh;
        const topology::BoundarySurface surface(mesh);
        test::Random random(1);
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.vector(1.0).normalized())
                .toRotationMatrix();
        std::vector<Vec3> positions;
        for (const Vec3& x : mesh.rest_positions()) positions.push_back(turn * x);
        const auto at = [&](std::size_t t, const Vec3& weights) {
            Vec3 x = Vec3::Zero();
            for (int k = 0; k < 3; ++k)
                x += weights[k] *
                     positions[surface.triangles()[t][static_cast<std::size_t>(k)].index()];
            return x;
        };
        for (std::uint64_t i = 0; i < test::num_cases(200); ++i) {
            const std::size_t from = random.below(surface.triangles().size()),
                              to = random.below(surface.triangles().size());
            const Vec3 weights = i % 3 == 0   ? Vec3(0.2, 0.3, 0.5)
                                 : i % 3 == 1 ? Vec3(0.4, 0.6, 0.0)
                                              : Vec3(0.0, 1.0, 0.0);
            EXPECT_FALSE(is_way_inside(mesh, positions, surface.faces()[from],
                                       surface.triangles()[from], Vec3(0.5, 0.5, 0.0),
                                       at(to, weights)))
                << "from triangle " << from << " to " << to << ", " << weights.transpose();
        }
    }
}

TEST(WayInside, GoesThroughHexahedra) {
    const Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(),
                                                     Vec3::Ones(), {4, 4, 4}))
                          .mesh;
    const topology::BoundarySurface surface(mesh);
    for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
        Vec3 from = Vec3::Zero();
        for (const VertexId n : surface.triangles()[t]) from += mesh.rest_position(n) / 3.0;
        const auto inside = [&](const Vec3& to) {
            return is_way_inside(mesh, mesh.rest_positions(), surface.faces()[t],
                                 surface.triangles()[t], Vec3::Constant(1.0 / 3), to);
        };
        EXPECT_TRUE(inside(Vec3(0.51, 0.52, 0.53)));
        EXPECT_FALSE(inside(from + 2.2 * (Vec3(0.51, 0.52, 0.53) - from)));
    }
}

// Where a cut ends, faces have corners on straight sides. A way from a face of the surface to the
// middle of its cell stays in it, whatever the faces look like.
TEST(WayInside, LeadsToTheMiddleOfCellsBesideACut) {
    using test::Bricks;
    for (const auto bricks :
         {Bricks::hexahedra, Bricks::wedges, Bricks::pyramids, Bricks::mixed, Bricks::joined})
        for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
            test::Random random(seed);
            Mesh mesh = Mesh::build(test::brick_cube(bricks, 3, 0.0, 1)).mesh;
            const Vec3 point = Vec3::Constant(0.5) + random.vector(0.2),
                       normal = random.vector(1.0).normalized(), u = normal.unitOrthogonal(),
                       v = normal.cross(u);
            // A copy: the mesh takes more memory for its nodes as it is cut.
            const std::vector<Vec3> rest(mesh.rest_positions().begin(),
                                         mesh.rest_positions().end());
            cutting::LoopFront front;
            cutting::split_cells(
                mesh, {mesh, rest, rest},
                cutting::SweptEdge({point - 3.0 * u - 3.0 * v, point + 3.0 * u - 3.0 * v},
                                   {point - 3.0 * u, point + 3.0 * u}),
                front, {}, {});
            const Eigen::Matrix3d turn =
                Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.vector(1.0).normalized())
                    .toRotationMatrix();
            std::vector<Vec3> positions;
            for (const Vec3& x : mesh.rest_positions()) positions.push_back(turn * x);
            const topology::BoundarySurface surface(mesh);
            for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
                const FaceId face = surface.faces()[t];
                EXPECT_TRUE(is_way_inside(
                    mesh, positions, face, surface.triangles()[t], Vec3(0.5, 0.3, 0.2),
                    cutting::TissueMotion::centre(mesh, face.cell, positions)))
                    << "bricks " << static_cast<int>(bricks) << ", seed " << seed << ", face "
                    << face.face << " of " << face.cell.value;
            }
        }
}

}  // namespace
}  // namespace incise::contact
