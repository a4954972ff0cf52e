// Which surfaces are one sheet, and what is said of those that are not.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/surface_check.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "split_body.h"
#include "support/mesh_families.h"

namespace incise::cutting {
namespace {

using test::Random;
using topology::SurfaceData;

using Corners = std::array<Vec3, 3>;

/// Triangles with points of their own.
SurfaceData loose(const std::vector<Corners>& triangles) {
    SurfaceData surface;
    for (const Corners& corners : triangles) {
        const auto first = static_cast<std::int64_t>(surface.points.size());
        surface.points.insert(surface.points.end(), corners.begin(), corners.end());
        surface.triangles.push_back({first, first + 1, first + 2});
    }
    return surface;
}

/// A parallelogram of n x n pieces of two triangles each.
std::vector<Corners> parallelogram(const Vec3& origin, const Vec3& u, const Vec3& v, int n) {
    std::vector<Corners> triangles;
    const auto at = [&](int i, int j) { return Vec3(origin + i * u / n + j * v / n); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return triangles;
}

std::vector<Corners> together(std::vector<Corners> a, const std::vector<Corners>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// "pass", "lie" or "share", one of them for each defect.
std::string kinds_of_defects(const SurfaceData& surface) {
    std::string kinds;
    for (const std::string& defect : defects_of_surface(surface))
        for (const std::string kind : {"pass", "lie", "share"})
            if (defect.find(" " + kind + " ") != std::string::npos)
                kinds += (kinds.empty() ? "" : " ") + kind;
    return kinds;
}

TEST(SurfaceCheck, FindsNothingInSheets) {
    EXPECT_EQ(kinds_of_defects({}), "");
    EXPECT_EQ(kinds_of_defects(icosphere(Vec3::Zero(), 1.0, 3)), "");
    EXPECT_EQ(kinds_of_defects(box_surface(Box(Vec3::Zero(), Vec3::Ones()))), "");
    EXPECT_EQ(kinds_of_defects(loose(parallelogram({0.1, 0.2, 0.3}, {1, 0.3, 0.2}, {0, 1, 1}, 8))),
              "");
    auto roof =
        parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0.3}, 4);  // 4 pieces meet 2 at the ridge
    roof = together(roof, parallelogram({0, 2, 0}, {1, 0, 0}, {0, -1, 0.3}, 2));
    EXPECT_EQ(kinds_of_defects(loose(roof)), "");
    auto two = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
    two = together(two, parallelogram({0, 0, 0.1}, {1, 0, 0}, {0, 1, 0}, 3));
    EXPECT_EQ(kinds_of_defects(loose(two)), "");
    two.push_back({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)});  // without area
    EXPECT_EQ(kinds_of_defects(loose(two)), "");
}

TEST(SurfaceCheck, FindsSheetsThatCross) {
    const auto floor = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
    // Through corners, along edges of one of them, beside edges, ending within triangles.
    const std::vector<std::pair<double, double>> places{
        {0.5, -0.3}, {0.5, -0.7}, {0.4, -0.5}, {0.4, -0.25}, {0.0625, -0.5}, {0.0625, -0.3}};
    for (const int n : {1, 2, 3, 4, 5})
        for (const auto& [x, z] : places) {
            SCOPED_TRACE(testing::Message() << n << " pieces at " << x << " from " << z);
            const auto wall = parallelogram({x, 0.1, z}, {0, 0.6, 0}, {0, 0, 1}, n);
            EXPECT_EQ(kinds_of_defects(loose(together(floor, wall))), "pass");
            EXPECT_EQ(kinds_of_defects(loose(together(wall, floor))), "pass");
        }
    auto spheres = icosphere(Vec3::Zero(), 1.0, 2);
    const auto other = icosphere({0.7, 0.2, 0.1}, 1.0, 2);
    const auto first = static_cast<std::int64_t>(spheres.points.size());
    for (const auto& [a, b, c] : other.triangles)
        spheres.triangles.push_back({a + first, b + first, c + first});
    spheres.points.insert(spheres.points.end(), other.points.begin(), other.points.end());
    EXPECT_EQ(kinds_of_defects(spheres), "pass");
}

TEST(SurfaceCheck, FindsBranches) {
    auto sheets = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
    sheets = together(sheets, parallelogram({0, 1, 0}, {1, 0, 0}, {0, 1, 0}, 2));
    sheets = together(sheets, parallelogram({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 2));
    const auto defects = defects_of_surface(loose(sheets));
    ASSERT_EQ(defects.size(), 1u);
    EXPECT_EQ(defects[0],
              "more than two triangles share 2 edges, the first at (0.25, 1, 0): there a cut may "
              "leave tissue joined; give the sheets that meet as cuts of their own");
}

TEST(SurfaceCheck, FindsTrianglesUponOthers) {
    const auto floor = parallelogram({0, 0, 0}, {1, 0.3, 0}, {0, 1, 0.7}, 3);
    auto twice = floor;
    twice.push_back({floor[4][1], floor[4][2], floor[4][0]});
    EXPECT_EQ(kinds_of_defects(loose(twice)), "share lie");
    EXPECT_EQ(kinds_of_defects(loose({floor[0], floor[0]})), "lie");  // two triangles an edge
    EXPECT_EQ(kinds_of_defects(loose({{Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 1)},
                                      {Vec3(1, 1, 1), Vec3(2, 1, 1), Vec3(1, 2, 1)}})),
              "lie");
    EXPECT_EQ(kinds_of_defects(loose({{Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 1)},
                                      {Vec3(4, 0, 1), Vec3(0, 0, 1), Vec3(3, 2, 1)}})),
              "lie");  // folded back
    EXPECT_EQ(kinds_of_defects(loose({{Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 1)},
                                      {Vec3(4, 0, 1), Vec3(0, 4, 1), Vec3(3, 2, 1)}})),
              "");
}

/// Whether the segment passes through the triangle, by the weights of where it meets the plane.
bool passes(const Vec3& p, const Vec3& q, const Corners& t) {
    Eigen::Matrix3d m;
    m << q - p, t[0] - t[1], t[0] - t[2];
    const Vec3 s = m.inverse() * (t[0] - p);
    return s[0] > 0 && s[0] < 1 && s[1] > 0 && s[2] > 0 && s[1] + s[2] < 1;
}

TEST(SurfaceCheck, AgreesWithSolvedIntersectionsOfRandomTriangles) {
    Random random(5);
    int num_meeting = 0;
    for (int i = 0; i < 20000; ++i) {
        std::array<Corners, 2> pair;
        for (Corners& corners : pair)
            for (Vec3& x : corners) x = random.vector(1.0);
        if (i % 4 == 0) pair[1][1] = pair[0][2];
        if (i % 8 == 0) pair[1][0] = pair[0][1];
        bool do_meet = false;
        for (std::size_t s = 0; s < 2; ++s)
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 &p = pair[s][k], &q = pair[s][(k + 1) % 3];
                const Corners& other = pair[1 - s];
                const bool shares = std::find(other.begin(), other.end(), p) != other.end() ||
                                    std::find(other.begin(), other.end(), q) != other.end();
                do_meet = do_meet || (!shares && passes(p, q, other));
            }
        num_meeting += do_meet;
        SCOPED_TRACE(i);
        EXPECT_EQ(kinds_of_defects(loose({pair[0], pair[1]})), do_meet ? "pass" : "");
    }
    EXPECT_GT(num_meeting, 1000);
}

}  // namespace
}  // namespace incise::cutting
