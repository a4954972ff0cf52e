// Prisms that are not convex, and bricks at the front of a cut, in tetrahedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/star_filling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "incise/topology/mesh.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/tetrahedral_division.h"
#include "support/cut_bricks.h"
#include "support/mesh_families.h"

namespace incise::topology {
namespace {

using Outline = std::vector<std::array<double, 2>>;

/// Returns a prism of height 1 as one polyhedron.
/// @param outline  anticlockwise
MeshData prism(const Outline& outline) {
    MeshData data;
    const auto n = std::ssize(outline);
    for (const double z : {0.0, 1.0})
        for (const auto& [x, y] : outline) data.points.emplace_back(x, y, z);
    std::vector<std::int64_t> faces{0}, top, bottom;
    for (std::int64_t p = 0; p < n; ++p) {
        top.push_back(n + p);
        bottom.push_back(n - 1 - p);
        const std::int64_t q = (p + 1) % n;
        test::add_face(faces, {p, q, n + q, n + p});
    }
    test::add_face(faces, top);
    test::add_face(faces, bottom);
    data.add_polyhedron(faces);
    return data;
}

/// Expects that tetrahedra with their right side out fill a prism of height 1.
void expect_filled(const TetrahedralDivision& division, double area, double perimeter) {
    EXPECT_EQ(division.inverted, std::vector<std::size_t>());
    // Throws if a tetrahedron is turned inside out.
    const MeshMetrics metrics = measure(division.mesh);
    EXPECT_NEAR(metrics.volume, area, 1e-13);
    EXPECT_NEAR(metrics.surface_area, 2.0 * area + perimeter, 1e-13);
    EXPECT_EQ(components(Mesh::build(division.mesh).mesh).count, 1);
}

TEST(TetrahedralDivision, MovesTheCentreToWhereItSeesAll) {
    const Outline l = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    const TetrahedralDivision division = divide_into_tetrahedra(prism(l));
    expect_filled(division, 3.0, 8.0);
    // The triangles of both hexagons, those about the middle of each other face, and no more.
    EXPECT_EQ(division.mesh.num_cells(), 2u * 4 + 6 * 4);
    const Vec3& centre = division.mesh.points.back();
    EXPECT_LT(std::max(centre.x(), centre.y()), 1.0);
}

TEST(TetrahedralDivision, FillsShapesThatNoPointSeesWhole) {
    for (const double gap : {0.0, 0.01, 0.1}) {
        SCOPED_TRACE(gap);
        const double y = 1.0 - gap;
        const Outline z = {{0, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {1, 2}, {1, y}, {0, y}};
        expect_filled(divide_into_tetrahedra(prism(z)), 4.0 - gap, 10.0);
    }
}

TEST(TetrahedralDivision, OfRandomStarsHasTheirRightSideOut) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        Outline star;
        double area = 0.0, perimeter = 0.0;
        constexpr int n = 9;
        for (int k = 0; k < n; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / n, r = random.uniform(0.3, 1.0);
            star.push_back({r * std::cos(angle), r * std::sin(angle)});
        }
        for (int k = 0; k < n; ++k) {
            const auto [ax, ay] = star[static_cast<std::size_t>(k)];
            const auto [bx, by] = star[static_cast<std::size_t>((k + 1) % n)];
            area += 0.5 * (ax * by - bx * ay);
            perimeter += std::hypot(bx - ax, by - ay);
        }
        expect_filled(divide_into_tetrahedra(prism(star)), area, perimeter);
    }
}

TEST(StarFilling, LeavesASurfaceThatCrossesItself) {
    // A tetrahedron whose fourth corner is pushed out through the face across.
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}};
    EXPECT_FALSE(
        fill_surface({{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, points, Vec3(0.3, 0.3, -0.2)));
}

// Both sides of the cut have the same points at the front, and stay apart there.
TEST(TetrahedralDivision, KeepsACutOpenWhoseSidesHaveTheSamePoints) {
    MeshData bricks = test::cut_bricks();
    // Joins the cut again, but for its marks.
    for (std::int64_t& p : bricks.faces)
        if (p == 14 || p == 15) p -= 2;
    for (std::int64_t& p : bricks.corners)
        if (p == 14 || p == 15) p -= 2;
    const TetrahedralDivision division = divide_into_tetrahedra(bricks);
    const MeshMetrics metrics = measure(division.mesh);
    EXPECT_NEAR(metrics.volume, 2.0, 1e-14);
    EXPECT_NEAR(metrics.surface_area, 10.0 + 2.0, 1e-13);
    EXPECT_EQ(components(Mesh::build(division.mesh).mesh).count, 1);
}

}  // namespace
}  // namespace incise::topology
