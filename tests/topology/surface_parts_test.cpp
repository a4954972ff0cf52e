// The parts of surfaces: what is connected, closed, and which way it faces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/surface_parts.h"

#include <gtest/gtest.h>

#include "support/surfaces.h"

namespace incise::topology {
namespace {

using test::box_surface;
using test::icosphere;

const SurfaceData box = box_surface(Box(Vec3(0, 0, 0), Vec3(1, 2, 3)));

TEST(SurfaceParts, AreClosedAndMeasured) {
    const auto both = parts_of(test::joined(box, icosphere({5, 5, 5}, 1.0, 3)));
    EXPECT_EQ(fault_of(both), "");
    ASSERT_EQ(both.parts.size(), 2u);
    EXPECT_EQ(both.parts[0].num_triangles, 12u);
    EXPECT_DOUBLE_EQ(both.parts[0].signed_volume, 6.0);
    EXPECT_EQ(both.parts[0].box.max(), Vec3(1, 2, 3));
    EXPECT_EQ(both.parts[1].num_triangles, 1280u);
    EXPECT_NEAR(both.parts[1].signed_volume, 4.19, 0.05);
    EXPECT_NEAR(both.area, 22.0 + 12.57, 0.1);
    EXPECT_LT(parts_of(test::turned(box)).parts[0].signed_volume, 0.0);
}

TEST(SurfaceParts, JoinEqualPointsAndTurnTriangles) {
    SurfaceData soup;
    for (const auto& triangle : box.triangles) {
        soup.triangles.push_back({static_cast<std::int64_t>(soup.points.size()),
                                  static_cast<std::int64_t>(soup.points.size()) + 1,
                                  static_cast<std::int64_t>(soup.points.size()) + 2});
        for (const auto p : triangle)
            soup.points.push_back(box.points[static_cast<std::size_t>(p)]);
    }
    std::swap(soup.triangles[5][0], soup.triangles[5][1]);
    const auto found = parts_of(soup);
    EXPECT_EQ(found.surface.points.size(), 8u);
    EXPECT_EQ(found.num_turned, 1u);
    EXPECT_EQ(fault_of(found), "");
    EXPECT_DOUBLE_EQ(found.parts.at(0).signed_volume, 6.0);
}

TEST(SurfaceParts, TellWhereASurfaceIsOpen) {
    auto open = box;
    open.triangles.erase(open.triangles.begin());
    const auto found = parts_of(open);
    EXPECT_EQ(found.open_edges.count, 3u);
    EXPECT_FALSE(found.parts.at(0).is_closed);
    EXPECT_EQ(fault_of(found).find("the surface is open at 3 edges, the first at ("), 0u)
        << fault_of(found);
}

TEST(SurfaceParts, TellWhereTrianglesBranch) {
    const auto other = box_surface(Box(Vec3(1, 0, 0), Vec3(2, 2, 3)));
    const auto found = parts_of(test::joined(box, other));
    EXPECT_EQ(found.open_edges.count, 0u);
    EXPECT_GE(found.branching_edges.count, 4u);
    EXPECT_EQ(fault_of(found).find("more than two triangles meet at "), 0u) << fault_of(found);
}

TEST(SurfaceParts, RefuseSurfacesWithOneSide) {
    SurfaceData strip;  // a Moebius strip of five triangles, as on five points
    strip.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (std::int64_t i = 0; i < 5; ++i) strip.triangles.push_back({i, (i + 1) % 5, (i + 2) % 5});
    EXPECT_GT(parts_of(strip).one_sided_edges.count, 0u);
    EXPECT_FALSE(parts_of(strip).is_closed());
}

}  // namespace
}  // namespace incise::topology
