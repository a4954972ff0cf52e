// Flat triangles of closed surfaces: they go, and the surfaces stay closed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/flat_triangles.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "incise/topology/surface_parts.h"
#include "support/surfaces.h"

namespace incise::topology {
namespace {

const Box edge_of_eight(Vec3(0, 0, 0), Vec3(8, 8, 8));

/// Divides one of the two triangles at an edge at points of the edge, and closes the gap with flat
/// triangles: a fan from the first end of the edge, or from the last one.
void add_flat_triangles(SurfaceData& surface, std::size_t t, std::size_t corner,
                        const std::vector<double>& parameters, bool is_fan_from_last) {
    const auto triangle = surface.triangles[t];
    const auto a = triangle[corner], b = triangle[(corner + 1) % 3], c = triangle[(corner + 2) % 3];
    const Vec3 from = surface.points[static_cast<std::size_t>(a)],
               to = surface.points[static_cast<std::size_t>(b)];
    std::vector<std::int64_t> line = {a};
    for (const double s : parameters) {
        line.push_back(static_cast<std::int64_t>(surface.points.size()));
        surface.points.push_back(from + s * (to - from));
    }
    line.push_back(b);
    surface.triangles[t] = {line[0], line[1], c};
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
        surface.triangles.push_back({line[i], line[i + 1], c});
    // The fan lies on the edge, and faces the triangle across it.
    const auto apex = is_fan_from_last ? b : a;
    const std::size_t first = is_fan_from_last ? 0 : 1;
    for (std::size_t i = first; i + 2 < line.size() + first; ++i)
        surface.triangles.push_back({line[i + 1], line[i], apex});
}

SurfaceData moved_and_scaled(SurfaceData surface, const Vec3& by, double scale) {
    for (Vec3& x : surface.points) x = scale * (x + by);
    return surface;
}

TEST(FlatTriangles, GoAndLeaveTheSurfaceClosed) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        SurfaceData surface = test::box_surface(edge_of_eight);
        for (int i = 0; i < 4; ++i) {
            const bool has_three = random() % 2 == 0, is_fan_from_last = random() % 2 == 0;
            const double by = i / 64.0;  // no two points are at the same position
            add_flat_triangles(
                surface, random() % 12, random() % 3,
                has_three ? std::vector{0.25 + by, 0.5 + by, 0.875 + by} : std::vector{0.5 + by},
                is_fan_from_last);
        }
        // Any unit and place in which the points stay on the edges.
        const double scale = std::exp2(static_cast<double>(random() % 600) - 300.0);
        surface = moved_and_scaled(surface, Vec3(1, 2, 3) * static_cast<double>(random() % 1000000),
                                   scale);
        const auto parts = parts_of(surface);
        EXPECT_EQ(fault_of(parts), "");
        ASSERT_EQ(parts.parts.size(), 1u);
        EXPECT_DOUBLE_EQ(parts.parts[0].signed_volume, 512.0 * scale * scale * scale);
        EXPECT_EQ(parts.num_turned, 0u);
        EXPECT_LE(parts.surface.triangles.size(), surface.triangles.size());
        const auto mended = without_flat_triangles(surface);
        EXPECT_EQ(without_flat_triangles(mended).triangles, mended.triangles);
    }
}

TEST(FlatTriangles, DivideNeighboursOfNeedles) {
    // Turned, the points are beside the edges by their last digits.
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    SurfaceData surface = test::box_surface(edge_of_eight);
    for (std::size_t t = 0; t < 12; t += 2) add_flat_triangles(surface, t, t % 3, {0.3, 0.6}, true);
    for (Vec3& x : surface.points) x = (turn * x).cast<float>().cast<double>();
    const auto mended = without_flat_triangles(surface, 1e-5);
    EXPECT_EQ(mended.triangles.size(), surface.triangles.size());
    for (const auto& t : mended.triangles) {
        const auto at = [&](std::size_t k) {
            return mended.points[static_cast<std::size_t>(t[k])];
        };
        EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).norm(), 1.0);
    }
    const auto parts = parts_of(mended);
    EXPECT_EQ(fault_of(parts), "");
    EXPECT_NEAR(parts.parts.at(0).signed_volume, 512.0, 1e-3);
}

TEST(FlatTriangles, AreLeftOutWhereNothingIsAcross) {
    SurfaceData surface = test::box_surface(edge_of_eight);
    const auto box = surface.triangles;
    surface.points.emplace_back(16, 0, 0);
    surface.triangles.push_back({0, 1, 8});  // in line
    surface.triangles.push_back({0, 1, 1});
    EXPECT_EQ(without_flat_triangles(surface).triangles, box);
}

}  // namespace
}  // namespace incise::topology
