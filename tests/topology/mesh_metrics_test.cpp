// The figures of topology/mesh_metrics.h against shapes whose figures are known.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "incise/base/error.h"
#include "incise/topology/box_mesh.h"

namespace incise::topology {
namespace {

constexpr double round_off = 1e-13;  // relative; sums of some hundred terms

MeshData one_cell(CellKind kind, std::vector<Vec3> points) {
    MeshData data;
    data.points = std::move(points);
    std::vector<std::int64_t> corners(data.points.size());
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::int64_t>(i);
    data.add_cell(kind, corners);
    return data;
}

TEST(MeshMetrics, OfABoxAreAlikeForBothKinds) {
    const Vec3 origin(-1.0, 2.0, 0.5), size(1.0, 2.0, 3.0);
    for (const auto kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
        SCOPED_TRACE(traits(kind).name);
        const auto metrics = measure(box_mesh(kind, origin, size, {2, 3, 4}));
        EXPECT_NEAR(metrics.volume, 6.0, 6.0 * round_off);
        EXPECT_NEAR(metrics.surface_area, 22.0, 22.0 * round_off);
        EXPECT_NEAR((metrics.box_min - origin).norm(), 0.0, round_off);
        EXPECT_NEAR((metrics.box_max - origin - size).norm(), 0.0, round_off);
        const std::size_t cells = 24 * (kind == CellKind::tetrahedron ? 6u : 1u);
        EXPECT_EQ(metrics.num_of_kind[static_cast<std::size_t>(kind)], cells);
        EXPECT_EQ(metrics.cells_of_region, (std::map<int, std::size_t>{{0, cells}}));
        EXPECT_NEAR(metrics.min_edge_length, 0.5, round_off);
    }
}

TEST(MeshMetrics, OfARegularTetrahedron) {
    const double s = 1.0 / std::sqrt(8.0);  // half the side of the cube round it: edges are 1
    const auto metrics = measure(one_cell(
        CellKind::tetrahedron, {Vec3(s, s, s), Vec3(-s, s, -s), Vec3(s, -s, -s), Vec3(-s, -s, s)}));
    EXPECT_NEAR(metrics.volume, 1.0 / (6.0 * std::sqrt(2.0)), round_off);
    EXPECT_NEAR(metrics.surface_area, std::sqrt(3.0), round_off);
    EXPECT_NEAR(metrics.min_altitude, std::sqrt(2.0 / 3.0), round_off);
    EXPECT_NEAR(metrics.min_dihedral_angle, std::acos(1.0 / 3.0), round_off);
    EXPECT_NEAR(metrics.min_edge_length, 1.0, round_off);
    EXPECT_NEAR(metrics.mean_edge_length, 1.0, round_off);
    EXPECT_NEAR(metrics.max_edge_length, 1.0, round_off);
}

TEST(MeshMetrics, SeeASliver) {
    const double height = 1e-3;
    const auto metrics =
        measure(one_cell(CellKind::tetrahedron,
                         {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.25, 0.25, height)}));
    EXPECT_NEAR(metrics.min_altitude, height, round_off);
    EXPECT_NEAR(metrics.min_dihedral_angle, std::atan(height / (0.5 / std::sqrt(2.0))), round_off);
}

TEST(MeshMetrics, OfABrickAreThicknessAndRightAngles) {
    const auto metrics =
        measure(box_mesh(CellKind::hexahedron, Vec3::Zero(), Vec3(1.0, 2.0, 3.0), {1, 1, 1}));
    EXPECT_NEAR(metrics.min_altitude, 1.0, round_off);
    EXPECT_NEAR(metrics.min_dihedral_angle, std::numbers::pi / 2.0, round_off);
    EXPECT_NEAR(metrics.mean_edge_length, 2.0, round_off);
}

TEST(MeshMetrics, OfAWedgeAndAPyramid) {
    const auto wedge =
        measure(one_cell(CellKind::wedge, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                           Vec3(0, 0, -2), Vec3(1, 0, -2), Vec3(0, 1, -2)}));
    EXPECT_NEAR(wedge.volume, 1.0, round_off);
    EXPECT_NEAR(wedge.surface_area, 1.0 + 2.0 * (2.0 + std::sqrt(2.0)), 10.0 * round_off);
    EXPECT_NEAR(wedge.min_dihedral_angle, std::numbers::pi / 4.0, round_off);
    EXPECT_NEAR(wedge.min_altitude, 1.0 / std::sqrt(2.0), round_off);

    const auto pyramid =
        measure(one_cell(CellKind::pyramid, {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0),
                                             Vec3(-1, 1, 0), Vec3(0, 0, 1)}));
    EXPECT_NEAR(pyramid.volume, 4.0 / 3.0, round_off);
    EXPECT_NEAR(pyramid.surface_area, 4.0 + 4.0 * std::sqrt(2.0), 10.0 * round_off);
    EXPECT_NEAR(pyramid.min_dihedral_angle, std::numbers::pi / 4.0, round_off);
}

TEST(MeshMetrics, LeaveOutUnusedPointsAndCountRegions) {
    auto data = box_mesh(CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {1, 1, 1});
    data.points.push_back(Vec3(9.0, 9.0, 9.0));
    data.regions = {1, 1, 2, 2, 2, 7};
    const auto metrics = measure(data);
    EXPECT_EQ(metrics.box_max, Vec3(1.0, 1.0, 1.0));
    EXPECT_EQ(metrics.cells_of_region, (std::map<int, std::size_t>{{1, 2}, {2, 3}, {7, 1}}));
}

TEST(MeshMetrics, RefuseABrokenMesh) {
    auto data = box_mesh(CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {1, 1, 1});
    data.corners[0] = 99;
    EXPECT_THROW(measure(data), InputError);
}

}  // namespace
}  // namespace incise::topology
