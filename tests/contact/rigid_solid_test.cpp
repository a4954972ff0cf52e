// Closed surfaces as rigid tools: which are sound, and where they touch triangles.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/rigid_solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "incise/cutting/tools/probe_shape.h"
#include "incise/cutting/tools/solid.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "support/surfaces.h"

namespace incise::contact {
namespace {

using cutting::Solid;
using SolidCorners = std::array<Vec3, 3>;

Solid solid_of(const topology::SurfaceData& surface) {
    bool was_turned = false;
    return cutting::make_solid(surface, was_turned);
}

const Box brick(Vec3(-0.25, -0.15, -0.35), Vec3(0.25, 0.15, 0.35));

double distance_to_brick(const Vec3& x) {
    const Vec3 q = x.cwiseAbs() - brick.max();
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

SolidCorners random_triangle(test::Random& random, double size) {
    const Vec3 centre = random.vector(0.5);
    return {centre + random.vector(size), centre + random.vector(size),
            centre + random.vector(size)};
}

TEST(RigidSolid, KnowsHowFarCornersAreAndOnWhichSide) {
    const RigidSolid solid(solid_of(test::box_surface(brick)));
    for (std::uint64_t seed = 0; seed < test::num_cases(500); ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        const SolidCorners x = random_triangle(random, 0.1);
        std::vector<RigidTouch> touches;
        solid.append_touches(x, 0.2, touches);
        for (int k = 0; k < 3; ++k) {
            const Vec3& corner = x[static_cast<std::size_t>(k)];
            const double distance = distance_to_brick(corner);
            // Inside, the side that faces the triangle may be farther.
            const double farther = distance < 0.0 ? 0.05 : 0.0;
            const auto found = std::ranges::find_if(touches, [&](const RigidTouch& touch) {
                return touch.weights == Vec3(Vec3::Unit(k)) && touch.gap < distance + 1e-9 &&
                       touch.gap > distance - farther - 1e-9;
            });
            if (std::abs(distance) < 0.199) {
                ASSERT_NE(found, touches.end());
                EXPECT_NEAR((corner - found->point - found->gap * found->normal).norm(), 0.0, 1e-9);
                EXPECT_NEAR(found->normal.norm(), 1.0, 1e-12);
            }
        }
    }
}

// A ball of many triangles is a ball but for its chords.
TEST(RigidSolid, TouchesAsTheBallThatItApproximates) {
    constexpr double radius = 0.3;
    const cutting::Sphere ball{radius};
    const RigidSolid solid(solid_of(test::icosphere(Vec3::Zero(), radius, 4)));
    for (std::uint64_t seed = 0; seed < test::num_cases(300); ++seed) {
        SCOPED_TRACE(seed);
        // A triangle that is large, faces the ball, and has it above its middle.
        test::Random random(seed);
        const Vec3 down = random.vector(1.0).normalized(), u = down.unitOrthogonal();
        const Vec3 v = down.cross(u);
        const double gap = random.vector(0.05).x();
        const Vec3 middle = (radius + gap) * down + 0.02 * (u - v);
        const SolidCorners x = {middle + 0.3 * u, middle - 0.15 * u - 0.3 * v,
                                middle - 0.15 * u + 0.3 * v};
        std::vector<RigidTouch> of_ball, of_solid;
        append_touches(ball, x, 0.1, of_ball);
        solid.append_touches(x, 0.1, of_solid);
        ASSERT_EQ(of_ball.size(), 1u);
        const auto least = std::ranges::min_element(of_solid, {}, &RigidTouch::gap);
        ASSERT_NE(least, of_solid.end());
        // The nearest point of the ball lies between points of the solid, 0.02 apart.
        EXPECT_NEAR(of_ball[0].gap, gap, 1e-12);
        EXPECT_NEAR(least->gap, gap, 0.001);
        EXPECT_GT(least->normal.dot(down), 0.99);
    }
}

TEST(RigidSolid, SeesASharpPointOnTheMiddleOfATriangle) {
    const RigidSolid solid(solid_of(test::box_surface(brick)));
    // A corner of the brick comes to a large triangle that faces it.
    const Vec3 corner = brick.max(), outward = -corner.normalized();
    const Vec3 u = outward.unitOrthogonal(), v = outward.cross(u);
    for (const double gap : {0.01, -0.01}) {
        const Vec3 middle = corner - gap * outward;
        const SolidCorners x = {middle + u, middle - 0.5 * u + v, middle - 0.5 * u - v};
        std::vector<RigidTouch> touches;
        solid.append_touches(x, 0.05, touches);
        const auto least = std::ranges::min_element(touches, {}, &RigidTouch::gap);
        ASSERT_NE(least, touches.end());
        EXPECT_NEAR(least->gap, gap, 1e-12);
        EXPECT_NEAR(least->normal.dot(-outward), 1.0, 1e-9);
        EXPECT_NEAR((least->weights - Vec3::Constant(1.0 / 3)).norm(), 0.0, 1e-9);
    }
}

// An edge of the brick comes to an edge of the tissue, at any angle; the middles of both are where
// they meet.
TEST(RigidSolid, SeesEdgesThatCross) {
    const RigidSolid solid(cutting::solid_of(cutting::Cuboid{brick.sizes()}));
    const Vec3 edge(brick.max().x(), brick.max().y(), 0.0);  // the middle of one along z
    for (std::uint64_t seed = 0; seed < test::num_cases(200); ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        const double angle = random.uniform(0.1, 1.4);  // of the normal, from x to y
        const Vec3 normal(std::cos(angle), std::sin(angle), 0.0);
        const Vec3 across(-normal.y(), normal.x(), 0.0);
        const double slope = random.uniform(-1.0, 1.0);
        const Vec3 along = (across + slope * Vec3::UnitZ()).normalized();
        const double gap = random.uniform(-0.02, 0.02);
        // A ridge of tissue whose back is towards the edge.
        const Vec3 middle = edge + gap * normal;
        const SolidCorners x = {middle - 0.3 * along, middle + 0.3 * along,
                                middle + 0.2 * normal + 0.1 * normal.cross(along)};
        const Vec3 outward = (x[1] - x[0]).cross(x[2] - x[0]);
        const SolidCorners facing = outward.dot(normal) < 0.0 ? x : SolidCorners{x[1], x[0], x[2]};
        std::vector<RigidTouch> touches;
        solid.append_touches(facing, 0.05, touches);
        const auto found = std::ranges::find_if(
            touches, [](const RigidTouch& touch) { return touch.tool_feature >= 8; });
        ASSERT_NE(found, touches.end());
        EXPECT_NEAR(found->gap, gap, 1e-12);
        EXPECT_NEAR(found->normal.dot(normal), 1.0, 1e-12);
        EXPECT_NEAR(std::max(found->weights[0], found->weights[1]), 0.5, 1e-9);
        EXPECT_NEAR((found->point - edge).norm(), 0.0, 1e-9);
    }
}

// A corner of the tissue at an edge of the brick, a little deeper under its lower side than beside
// it.
TEST(RigidSolid, IsLeftByTheSideThatFacesTheTissue) {
    const RigidSolid solid(cutting::solid_of(cutting::Cuboid{Vec3::Ones()}));
    const SolidCorners x{Vec3(0.499, 0, -0.498), Vec3(0.8, 0, -0.51), Vec3(0.6, 0.3, -0.51)};
    std::vector<RigidTouch> touches;
    solid.append_touches(x, 0.01, touches);
    const auto corner = std::ranges::find_if(
        touches, [](const RigidTouch& touch) { return touch.weights == Vec3(Vec3::UnitX()); });
    ASSERT_NE(corner, touches.end());
    EXPECT_EQ(corner->normal, Vec3(-Vec3::UnitZ()));
    EXPECT_NEAR(corner->gap, -0.002, 1e-12);
}

// A box of triangles is a box, and its diagonals are no edges.
TEST(RigidSolid, OfABoxIsSound) {
    const Solid box = cutting::solid_of(cutting::Cuboid{brick.sizes()});
    EXPECT_EQ(cutting::fault_of(box), "");
    EXPECT_NEAR(cutting::volume_of(box.surface), brick.volume(), 1e-15);
}

TEST(RigidSolid, KnowsWhatIsInside) {
    const cutting::ProbeShape shape = solid_of(test::box_surface(brick));
    for (std::uint64_t seed = 0; seed < test::num_cases(500); ++seed) {
        test::Random random(seed);
        const Vec3 x = random.vector(0.6);
        EXPECT_EQ(cutting::is_inside(shape, x), distance_to_brick(x) < 0.0) << x.transpose();
    }
}

TEST(RigidSolid, IsSoundOnlyIfItIsClosed) {
    topology::SurfaceData surface = test::box_surface(brick);
    EXPECT_EQ(cutting::fault_of(Solid{surface}), "");
    EXPECT_NEAR(cutting::volume_of(surface), 0.5 * 0.3 * 0.7, 1e-15);

    topology::SurfaceData inside_out = surface;
    for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
    EXPECT_NE(cutting::fault_of(Solid{inside_out}).find("face inwards"), std::string::npos);
    bool was_turned = false;
    EXPECT_EQ(cutting::fault_of(cutting::make_solid(inside_out, was_turned)), "");
    EXPECT_TRUE(was_turned);

    // Two boxes, of which one is inside out; and one with a cavity.
    const auto with = [&](const Box& box, bool is_turned) {
        topology::SurfaceData both = surface;
        const topology::SurfaceData second = test::box_surface(box);
        for (auto t : second.triangles) {
            for (auto& p : t) p += static_cast<std::int64_t>(surface.points.size());
            if (is_turned) std::swap(t[0], t[1]);
            both.triangles.push_back(t);
        }
        both.points.insert(both.points.end(), second.points.begin(), second.points.end());
        return both;
    };
    const Box beside(Vec3::Ones(), 1.1 * Vec3::Ones()),
        within(-0.1 * Vec3::Ones(), 0.1 * Vec3::Ones());
    EXPECT_EQ(cutting::fault_of(Solid{with(beside, false)}), "");
    EXPECT_NE(cutting::fault_of(Solid{with(beside, true)}).find("face inwards"), std::string::npos);
    EXPECT_EQ(cutting::fault_of(cutting::make_solid(with(beside, true), was_turned)), "");
    EXPECT_TRUE(was_turned);
    EXPECT_EQ(cutting::fault_of(cutting::make_solid(with(within, true), was_turned)), "");
    EXPECT_FALSE(was_turned);

    topology::SurfaceData open = surface;
    open.triangles.pop_back();
    EXPECT_NE(cutting::fault_of(Solid{open}).find("its surface is open: it ends at [0.25, "),
              std::string::npos);

    topology::SurfaceData mixed = surface;
    std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
    EXPECT_NE(cutting::fault_of(Solid{mixed}).find("face opposite sides"), std::string::npos);

    topology::SurfaceData three = surface;
    three.points.push_back(Vec3::Ones());
    three.triangles.push_back({0, 1, 8});
    EXPECT_NE(cutting::fault_of(Solid{three}).find("more than two triangles"), std::string::npos);

    EXPECT_EQ(cutting::fault_of(Solid{}), "its surface has no triangle");
    surface.triangles[0][0] = 99;
    EXPECT_NE(cutting::fault_of(Solid{surface}).find("names point 99"), std::string::npos);
}

TEST(RigidSolid, IsMadeOfTrianglesThatShareNoPoints) {
    const topology::SurfaceData box = test::box_surface(brick);
    topology::SurfaceData soup;
    for (const auto& t : box.triangles) {
        const auto first = static_cast<std::int64_t>(soup.points.size());
        for (const std::int64_t p : t)
            soup.points.push_back(box.points[static_cast<std::size_t>(p)]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    soup.triangles.push_back({0, 0, 1});  // no area
    const Solid solid = solid_of(soup);
    EXPECT_EQ(cutting::fault_of(solid), "");
    EXPECT_EQ(solid.surface.points.size(), 8u);
    EXPECT_EQ(solid.surface.triangles.size(), 12u);
}

}  // namespace
}  // namespace incise::contact
