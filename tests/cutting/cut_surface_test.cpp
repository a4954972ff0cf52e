// Where surfaces pass through segments: places against plain geometry, signs against whole numbers,
// and the promise that a closed path is crossed an even number of times.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/cut_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/cutting/surfaces/triangle_surface.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Random;
using topology::SurfaceData;

MovingPoint still(const Vec3& x) { return {x, x}; }

std::vector<Crossing> crossings(const CutSurface& surface, const Vec3& a, const Vec3& b) {
    std::vector<Crossing> found;
    surface.append_crossings(still(a), still(b), found);
    std::sort(found.begin(), found.end());
    return found;
}

/// The angle between two lines through the origin.
double angle(const Vec3& u, const Vec3& v) {
    return std::atan2(u.cross(v).norm(), std::abs(u.dot(v)));
}

// ---- the edge of a blade in space and time

TEST(CrossingPositions, FollowTheRelativeMotionOfBladeAndTissue) {
    // Both move straight, each as a whole: seen from the tissue the blade sweeps a parallelogram.
    int num_crossed = 0;
    for (std::uint64_t seed = 0; seed < test::num_cases(4000); ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Vec3 p = random.vector(1), q = random.vector(1);
        const Vec3 a = random.vector(1), b = random.vector(1);
        const Vec3 tissue_by = random.vector(2), blade_by = random.vector(2);
        std::vector<Crossing> found;
        append_crossings({{p, p + tissue_by}, {q, q + tissue_by}},
                         {{a, a + blade_by}, {b, b + blade_by}}, found);
        Eigen::Matrix3d m;
        m << b - a, blade_by - tissue_by, p - q;
        const Vec3 s = m.inverse() * (p - a);  // along the blade, in time, along the tissue
        const bool is_crossed = s.minCoeff() > 0.0 && s.maxCoeff() < 1.0;
        ASSERT_EQ(found.size(), is_crossed ? 1u : 0u);
        if (!is_crossed) continue;
        ++num_crossed;
        const double steepness = std::abs(m.determinant());
        EXPECT_NEAR(found[0].place, s[2], 1e-14 / steepness);
        EXPECT_LE(angle(found[0].normal, (b - a).cross(blade_by - tissue_by)), 1e-14 / steepness);
    }
    EXPECT_GT(num_crossed, test::num_cases(200));
}

TEST(CrossingPositions, ReverseWithTheTissueButNotTheBlade) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const auto moving = [&] { return MovingPoint{random.vector(1), random.vector(1)}; };
        const MovingSegment tissue{moving(), moving()};
        const MovingSegment blade{{random.vector(1), random.vector(1) + Vec3(0, 0, 3)}, moving()};
        const auto places = [](const MovingSegment& of, const MovingSegment& by) {
            std::vector<Crossing> found;
            append_crossings(of, by, found);
            std::vector<double> sorted;
            for (const Crossing& crossing : found) sorted.push_back(crossing.place);
            std::sort(sorted.begin(), sorted.end());
            return sorted;
        };
        // Only where neither segment turns do its two triangles not depend on the direction.
        const MovingSegment rigid{{tissue.a[0], tissue.a[0] + Vec3(1, 0, -1)},
                                  {tissue.b[0], tissue.b[0] + Vec3(1, 0, -1)}};
        const MovingSegment straight{{blade.a[0], blade.a[1]},
                                     {blade.b[0], blade.b[0] + blade.a[1] - blade.a[0]}};
        const auto found = places(rigid, straight);
        const auto turned = places({rigid.b, rigid.a}, straight);
        const auto other = places(rigid, {straight.b, straight.a});
        ASSERT_EQ(turned.size(), found.size());
        ASSERT_EQ(other.size(), found.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(turned[i], 1.0 - found[i], 1e-9);
            EXPECT_NEAR(other[i], found[i], 1e-9);
        }
        for (const double place : places(tissue, blade)) {
            EXPECT_GE(place, 0.0);
            EXPECT_LE(place, 1.0);
        }
    }
}

TEST(CrossingPositions, AreOnePerPassingSegmentOfTheBlade) {
    // A zigzag in the plane z = 0 that moves up along z, and a segment of tissue along x over it.
    const Polyline from = {{0, -1, -1}, {1, 1, -1}, {2, -1, -1}, {3, 1, -1}};
    Polyline to = from;
    for (Vec3& x : to) x.z() += 2.0;
    const SweptEdge swept(from, to);
    const auto all = crossings(swept, {-0.5, 0, 0.25}, {3.5, 0, 0.25});
    ASSERT_EQ(all.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(all[i].place, (1.0 + static_cast<double>(i)) / 4.0, 1e-15);
    EXPECT_EQ(crossings(swept, {0.7, 0, 0.25}, {3.5, 0, 0.25}).size(), 2u);
    EXPECT_EQ(crossings(swept, {-0.5, 0, 1.25}, {3.5, 0, 1.25}).size(), 0u);  // not yet there
}

TEST(SweptEdge, IsFoundInEachHullThatItPasses) {
    int num_crossed = 0, num_ruled_out = 0;
    for (std::uint64_t seed = 0; seed < test::num_cases(4000); ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        // Of each two one on whole numbers, where much is in one plane or does not move.
        const auto place = [&] { return seed % 2 == 0 ? random.vector(2) : random.grid_point(4); };
        std::vector<Vec3> before, after;
        for (int i = 0; i < 3; ++i) {
            before.push_back(place());
            after.push_back(random.below(4) == 0 ? before.back() : place());
        }
        std::array<MovingPoint, 4> points;
        Box box;
        for (MovingPoint& x : points) {
            x[0] = place();
            x[1] = random.below(2) == 0 ? x[0] : place();
            box.extend(x[0]).extend(x[1]);
        }
        std::vector<Crossing> found;
        for (std::size_t s = 0; s < 2; ++s)
            for (std::size_t k = 0; k < 4; ++k)
                for (std::size_t l = 0; l < k; ++l)
                    append_crossings({points[k], points[l]},
                                     {{before[s], after[s]}, {before[s + 1], after[s + 1]}}, found);
        const SweptEdge edge(before, after);
        if (!found.empty()) {
            ++num_crossed;
            EXPECT_TRUE(edge.may_meet(box));
            EXPECT_TRUE(edge.may_meet_hull(points));
        } else if (edge.may_meet(box) && !edge.may_meet_hull(points)) {
            ++num_ruled_out;
        }
    }
    EXPECT_GT(num_crossed, 0);
    EXPECT_GT(num_ruled_out, 0);
}

TEST(Pierces, AgreesWithPlainArithmeticInGeneralPosition) {
    int num_pierced = 0;
    for (std::uint64_t seed = 0; seed < test::num_cases(4000); ++seed) {
        Random random(seed);
        const Vec3 p = random.vector(1), q = random.vector(1);
        const std::array<Vec3, 3> t = {random.vector(1), random.vector(1), random.vector(1)};
        Eigen::Matrix3d m;
        m << t[1] - t[0], t[2] - t[0], p - q;
        const Vec3 s = m.inverse() * (p - t[0]);
        const bool expected = s.minCoeff() > 0.0 && s[2] < 1.0 && s[0] + s[1] < 1.0;
        num_pierced += expected;
        ASSERT_EQ(pierces(p, q, t), expected) << seed;
    }
    EXPECT_GT(num_pierced, test::num_cases(200));
}

TEST(Pierces, AClosedSurfaceAnEvenNumberOfTimes) {
    // Tetrahedra of grid points, where everything touches everything; the ends are far away.
    int num_pierced = 0;
    for (std::uint64_t seed = 0; seed < test::num_cases(3000); ++seed) {
        Random random(seed);
        const std::size_t size = 2 + random.below(3);
        std::array<Vec3, 4> x;
        for (Vec3& corner : x) corner = random.grid_point(size);
        const auto parity = [&](const Vec3& p, const Vec3& q) {
            bool is_odd = false;
            for (std::size_t k = 0; k < 4; ++k) {
                const bool hit = pierces(p, q, {x[(k + 1) % 4], x[(k + 2) % 4], x[(k + 3) % 4]});
                is_odd ^= hit;
                num_pierced += hit;
            }
            return is_odd;
        };
        const Vec3 direction = random.grid_point(5) - Vec3(2, 2, 2);
        const Vec3 through = random.grid_point(size);
        ASSERT_FALSE(parity(through - 64 * direction, through + 64 * direction)) << seed;
    }
    EXPECT_GT(num_pierced, test::num_cases(100));
}

// ---- planes

TEST(PlaneSide, IsExactHoweverNearThePlane) {
    // Coordinates are whole multiples of 2^-52 below 2 and normals small whole numbers, so that
    // the height over the plane is a whole number that fits in 64 bits.
    constexpr double unit = 0x1.0p-52;
    int num_zero = 0, num_near = 0;
    for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
        Random random(seed);
        std::array<std::int64_t, 3> point{}, x{}, normal{};
        std::int64_t height = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            normal[c] = static_cast<std::int64_t>(random.below(9)) - 4;
            point[c] = static_cast<std::int64_t>(random.uniform(-1.0, 1.0) / unit);
            x[c] = static_cast<std::int64_t>(random.uniform(-1.0, 1.0) / unit);
        }
        if (normal[2] == 0) normal[2] = 1;
        if (random.below(4) > 0) {  // near: what the other coordinates ask for, and a hair
            x[2] = point[2] -
                   (normal[0] * (x[0] - point[0]) + normal[1] * (x[1] - point[1])) / normal[2];
            x[2] += static_cast<std::int64_t>(random.below(5)) - 2;
        }
        if (std::abs(x[2]) > (std::int64_t{1} << 53)) continue;
        for (std::size_t c = 0; c < 3; ++c) height += normal[c] * (x[c] - point[c]);
        num_zero += height == 0;
        num_near += std::abs(height) < 16;
        const auto vec = [&](const std::array<std::int64_t, 3>& v, double by) {
            return Vec3(static_cast<double>(v[0]) * by, static_cast<double>(v[1]) * by,
                        static_cast<double>(v[2]) * by);
        };
        const Plane plane(vec(point, unit), vec(normal, 1.0));
        ASSERT_EQ(plane.side(vec(x, unit)), height < 0 ? -1 : 1) << "seed " << seed;
    }
    EXPECT_GT(num_zero, 500);  // they count as above
    EXPECT_GT(num_near, 5000);
}

TEST(PlaneSide, IsExactForTinyAndHugeNumbers) {
    constexpr double least = std::numeric_limits<double>::denorm_min();
    for (const double scale : {1e-300, 1e-150, 1.0, 1e150}) {
        const Plane plane(Vec3::Zero(), scale * Vec3(1, 1, 1));
        EXPECT_EQ(plane.side({scale, -scale, 0}), 1);
        EXPECT_EQ(plane.side({scale, -scale, -scale * 0x1.0p-50}), -1);
        EXPECT_EQ(plane.side({1.0, -1.0, -least}), -1);
        EXPECT_EQ(plane.side({1.0, -1.0, least}), 1);
        EXPECT_EQ(plane.side({1e16, -1e16, -1.0}), -1);
        EXPECT_EQ(plane.side({1.0, 1e-16, -1.0}), 1);
    }
}

TEST(PlaneCrossing, IsWhereTheSegmentMeetsIt) {
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        const Vec3 point = random.vector(0.3), normal = random.vector(1);
        const Plane plane(point, normal);
        const Vec3 a = random.vector(1), b = random.vector(1);
        const auto found = crossings(plane, a, b);
        ASSERT_EQ(found.size(), plane.side(a) == plane.side(b) ? 0u : 1u);
        Box box(a);
        box.extend(b);
        if (found.empty()) continue;
        EXPECT_TRUE(plane.may_meet(box));
        const Vec3 x = a + found[0].place * (b - a);
        EXPECT_LE(std::abs(normal.normalized().dot(x - point)), 1e-14);
        EXPECT_EQ(found[0].normal, normal);
        const auto turned = crossings(plane, b, a);
        ASSERT_EQ(turned.size(), 1u);
        EXPECT_NEAR(turned[0].place, 1.0 - found[0].place, 1e-15);
    }
    const Plane plane({0, 0, 0.5}, {0, 0, 2});
    const auto box = [](double low, double high) {
        return Box(Vec3(-1, -1, low), Vec3(1, 1, high));
    };
    EXPECT_TRUE(plane.may_meet(box(0.5, 0.6)));  // touching
    EXPECT_TRUE(plane.may_meet(box(0.0, 0.5)));
    EXPECT_FALSE(plane.may_meet(box(0.51, 0.6)));
    EXPECT_FALSE(plane.may_meet(box(-1.0, 0.49)));
}

// ---- triangulated surfaces

/// Closed surfaces with many corners on the grid of whole numbers.
std::vector<SurfaceData> closed_surfaces() {
    const SurfaceData octahedron = {
        {{2, 2, 0}, {2, 2, 4}, {4, 2, 2}, {0, 2, 2}, {2, 4, 2}, {2, 0, 2}},
        {{0, 2, 4}, {0, 4, 3}, {0, 3, 5}, {0, 5, 2}, {1, 4, 2}, {1, 3, 4}, {1, 5, 3}, {1, 2, 5}}};
    return {box_surface(Box(Vec3(1, 1, 1), Vec3(3, 3, 3))),
            box_surface(Box(Vec3(0, 1, 0), Vec3(4, 2, 3))), octahedron,
            icosphere({2, 2, 2}, 1.5, 1)};
}

TEST(TriangleSurface, IsCrossedEvenlyByClosedOrOutsidePaths) {
    int num_crossed = 0;
    for (const SurfaceData& data : closed_surfaces()) {
        const TriangleSurface surface(data);
        for (std::uint64_t seed = 0; seed < test::num_cases(1500); ++seed) {
            Random random(seed);
            // Between grid points, through corners and along edges and faces.
            std::vector<Vec3> loop;
            for (std::size_t i = 0; i < 3 + random.below(3); ++i)
                loop.push_back(random.grid_point(5));
            std::size_t count = 0;
            for (std::size_t i = 0; i < loop.size(); ++i)
                count += crossings(surface, loop[i], loop[(i + 1) % loop.size()]).size();
            ASSERT_EQ(count % 2, 0u) << "a loop, seed " << seed;
            num_crossed += count > 0;
            const Vec3 by = 64 * (random.grid_point(5) - Vec3(2, 2, 2));
            const Vec3 through = random.grid_point(5);
            ASSERT_EQ(crossings(surface, through - by, through + by).size() % 2, 0u)
                << "right through, seed " << seed;
        }
        // From the inside out: an odd number.
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            Random random(seed);
            const Vec3 inside(1.75, 1.5, 1.75);
            Vec3 by = random.grid_point(5) - Vec3(2, 2, 2);
            if (by.isZero()) by.x() = 1;
            ASSERT_EQ(crossings(surface, inside, inside + 64 * by).size() % 2, 1u) << seed;
        }
    }
    EXPECT_GT(num_crossed, test::num_cases(1000));
}

TEST(TriangleSurface, HasTheIdentityOfItsTriangles) {
    const auto identity = [](const SurfaceData& surface) {
        return TriangleSurface(surface).identity();
    };
    const SurfaceData sphere = icosphere(Vec3::Zero(), 1.0, 1);
    EXPECT_EQ(identity(sphere), identity(sphere));
    for (std::size_t i = 0; i < sphere.points.size(); ++i) {
        SurfaceData other = sphere;
        other.points[i].z() = std::nextafter(other.points[i].z(), 2.0);
        EXPECT_NE(identity(other), identity(sphere));
    }
    for (const SurfaceData& surface : {sphere, SurfaceData{}}) {
        EXPECT_NE(identity(surface), no_identity);
        EXPECT_NE(identity(surface), identity_of_planes);
    }
}

TEST(TriangleSurface, IsCrossedWhereItIs) {
    for (std::uint64_t seed = 0; seed < test::num_cases(500); ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Vec3 centre = random.vector(0.5), half = random.vector(0.2) + Vec3::Constant(0.5);
        const Box box(centre - half, centre + half);
        const TriangleSurface surface(box_surface(box));
        const Vec3 a = random.vector(2), b = random.vector(2);
        // Where the segment enters and leaves the slabs between opposite sides.
        double enters = 0.0, leaves = 1.0;
        for (int c = 0; c < 3; ++c) {
            const double s = (box.min()[c] - a[c]) / (b[c] - a[c]);
            const double t = (box.max()[c] - a[c]) / (b[c] - a[c]);
            enters = std::max(enters, std::min(s, t));
            leaves = std::min(leaves, std::max(s, t));
        }
        std::vector<double> expected;
        if (enters < leaves && enters > 0.0) expected.push_back(enters);
        if (enters < leaves && leaves < 1.0) expected.push_back(leaves);
        const auto found = crossings(surface, a, b);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i].place, expected[i], 1e-13);
            const Vec3 x = (a + found[i].place * (b - a) - centre).cwiseQuotient(half);
            int side = 0;
            x.cwiseAbs().maxCoeff(&side);
            EXPECT_LE(angle(found[i].normal, Vec3::Unit(side)), 1e-12);
        }
        if (!found.empty()) {
            Box around(a);
            around.extend(b);
            EXPECT_TRUE(surface.may_meet(around));
        }
    }
    const TriangleSurface surface(icosphere({0, 0, 0}, 1.0, 2));
    EXPECT_FALSE(surface.may_meet(Box(Vec3::Constant(-0.3), Vec3::Constant(0.3))));
    EXPECT_FALSE(surface.may_meet(Box(Vec3(1.1, -9, -9), Vec3(9, 9, 9))));
    EXPECT_TRUE(surface.may_meet(Box(Vec3::Constant(-9), Vec3::Constant(9))));
    EXPECT_FALSE(TriangleSurface(SurfaceData{}).may_meet(Box(Vec3::Constant(-9), Vec3::Ones())));
}

TEST(TriangleSurface, TellsItsDistance) {
    for (std::uint64_t seed = 0; seed < test::num_cases(500); ++seed) {
        Random random(seed);
        const Vec3 half = random.vector(0.2) + Vec3::Constant(0.5), x = random.vector(2);
        const TriangleSurface surface(box_surface(Box(-half, half)));
        const Vec3 beyond = x.cwiseAbs() - half;
        const double expected =
            (beyond.array() < 0.0).all() ? -beyond.maxCoeff() : beyond.cwiseMax(0.0).norm();
        ASSERT_NEAR(surface.distance(x), expected, 1e-14) << seed;
    }
    const SurfaceData sphere = icosphere({1, 2, 3}, 0.5, 3);
    for (const Vec3& x : sphere.points) EXPECT_LE(TriangleSurface(sphere).distance(x), 1e-15);
    EXPECT_NEAR(TriangleSurface(sphere).distance({1, 2, 5}), 1.5, 3e-3);
    // Of triangles without area: as of what they have shrunk to.
    const TriangleSurface needle(SurfaceData{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}});
    EXPECT_EQ(needle.distance({1.5, 3, 4}), 5.0);
    EXPECT_EQ(needle.distance({-3, 4, 0}), 5.0);
    EXPECT_EQ(TriangleSurface(SurfaceData{}).distance({0, 0, 0}),
              std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace incise::cutting
