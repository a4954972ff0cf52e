// Pairs of nodes and triangles that are near each other, against a search through all.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/touching_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "incise/topology/boundary_surface.h"
#include "support/exact_plane.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::contact {
namespace {

using topology::Mesh;

using Pair = std::pair<VertexId, std::uint32_t>;

Vec3 area_of(const Triangle& t, std::span<const Vec3> x) {
    return 0.5 * (x[t[1].index()] - x[t[0].index()]).cross(x[t[2].index()] - x[t[0].index()]);
}

/// The normal of each node, by the angles of its triangles.
std::vector<Vec3> normals_of(std::span<const Triangle> triangles, std::span<const Vec3> x) {
    std::vector<Vec3> normals(x.size(), Vec3::Zero());
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = (x[t[(k + 1) % 3].index()] - x[t[k].index()]).normalized(),
                       b = (x[t[(k + 2) % 3].index()] - x[t[k].index()]).normalized();
            normals[t[k].index()] +=
                std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * area_of(t, x).normalized();
        }
    return normals;
}

// A body in two pieces that overlap a little and are bent: pieces have no common nodes.
TEST(TouchingPairs, AreThoseThatASearchThroughAllFinds) {
    for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        Mesh mesh = Mesh::build(test::jittered_cube(4, 0.1, seed)).mesh;
        fragments::FragmentMesh fragments(mesh);
        topology::BoundarySurface surface(mesh);
        const auto changes = test::cut_along_plane(mesh, Vec3::Constant(0.5), random.vector(1.0));
        fragments.apply(mesh, changes);
        surface.apply(mesh, changes);
        const auto pieces = topology::components(mesh);
        ASSERT_EQ(pieces.count, 2);
        const Vec3 shift = random.vector(0.05);
        std::vector<Vec3> x(mesh.rest_positions().begin(), mesh.rest_positions().end());
        for (const VertexId n : mesh.nodes()) {
            if (pieces.of_element[mesh.incident_element(n).index()] == 0) x[n.index()] += shift;
            x[n.index()].z() += 0.2 * x[n.index()].x() * x[n.index()].x();
        }
        const std::vector<std::uint8_t> all(surface.triangles().size(), 1);
        const ContactBody body{mesh, fragments, surface.faces(), all};
        SurfaceTree tree;
        tree.set_triangles(surface.triangles(), mesh.rest_positions());
        tree.fit(x);
        TouchingPairs pairs;
        pairs.set_surface(tree, body);
        constexpr double reach = 0.1;
        pairs.find(tree, body, x, reach, {});

        std::set<Pair> found, expected;
        for (std::size_t i = 0; i < pairs.nodes().size(); ++i)
            for (const std::uint32_t t : pairs.triangles_of(i)) found.emplace(pairs.nodes()[i], t);
        const auto normals = normals_of(surface.triangles(), x);
        const auto piece_of = [&](VertexId n) {
            return pieces.of_element[mesh.incident_element(n).index()];
        };
        for (std::uint32_t t = 0; t < surface.triangles().size(); ++t) {
            const Triangle& triangle = surface.triangles()[t];
            for (const VertexId n : mesh.nodes()) {
                if (normals[n.index()].isZero(0.0) || piece_of(n) == piece_of(triangle[0]))
                    continue;
                const double distance =
                    std::sqrt(squared_distance(x[n.index()], x[triangle[0].index()],
                                               x[triangle[1].index()], x[triangle[2].index()]));
                if (distance < reach && normals[n.index()].dot(area_of(triangle, x)) < -1e-12)
                    expected.emplace(n, t);
            }
        }
        for (const Pair& pair : expected) EXPECT_TRUE(found.contains(pair));
        EXPECT_GT(expected.size(), 100u);
        // In one piece, bent so little, nothing faces anything else.
        for (const auto& [n, t] : found)
            EXPECT_NE(piece_of(n), piece_of(surface.triangles()[t][0]));
    }
}

TEST(TouchingPairs, OfAWholeConvexBodyAreNone) {
    for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) {
        const Mesh mesh = Mesh::build(test::jittered_cube(5, 0.1, seed)).mesh;
        const fragments::FragmentMesh fragments(mesh);
        const topology::BoundarySurface surface(mesh);
        const std::vector<std::uint8_t> all(surface.triangles().size(), 1);
        const ContactBody body{mesh, fragments, surface.faces(), all};
        SurfaceTree tree;
        tree.set_triangles(surface.triangles(), mesh.rest_positions());
        tree.fit(mesh.rest_positions());
        TouchingPairs pairs;
        pairs.set_surface(tree, body);
        pairs.find(tree, body, mesh.rest_positions(), 0.3, {});
        EXPECT_TRUE(pairs.nodes().empty());
    }
}

}  // namespace
}  // namespace incise::contact
