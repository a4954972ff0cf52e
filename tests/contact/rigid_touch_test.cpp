// Where rigid shapes and triangles are closest, against many points of the triangle.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/rigid_touch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "incise/cutting/tools/probe_shape.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::contact {
namespace {

using cutting::ProbeShape;
using Corners = std::array<Vec3, 3>;

double distance_to(const cutting::Sphere& ball, const Vec3& x) { return x.norm() - ball.radius; }
double distance_to(const cutting::Capsule& capsule, const Vec3& x) {
    const Vec3 along = capsule.to - capsule.from;
    const double s = std::clamp(along.dot(x - capsule.from) / along.squaredNorm(), 0.0, 1.0);
    return (x - capsule.from - s * along).norm() - capsule.radius;
}
double distance_to(const cutting::HalfSpace& half_space, const Vec3& x) {
    return half_space.normal.dot(x - half_space.point);
}
// See rigid_solid_test.cpp.
double distance_to(const cutting::Cuboid&, const Vec3&) { return 0.0; }
double distance_to(const cutting::Solid&, const Vec3&) { return 0.0; }
double distance_to(const ProbeShape& shape, const Vec3& x) {
    return std::visit([&](const auto& one) { return distance_to(one, x); }, shape);
}

double least_distance(const ProbeShape& shape, const Corners& x) {
    constexpr int n = 60;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j)
            least = std::min(
                least, distance_to(shape, x[0] + (i * (x[1] - x[0]) + j * (x[2] - x[0])) / n));
    return least;
}

const std::vector<ProbeShape>& shapes() {
    static const std::vector<ProbeShape> all{
        cutting::Sphere{0.3}, cutting::Capsule{{-0.4, 0.1, 0.0}, {0.3, 0.0, 0.2}, 0.15},
        cutting::HalfSpace{{0.0, 0.1, 0.0}, {0.6, 0.0, 0.8}}};
    return all;
}

// Triangles outside the axis of the shape, facing it.
TEST(RigidTouch, IsWhereATriangleIsClosest) {
    for (std::size_t s = 0; s < shapes().size(); ++s)
        for (std::uint64_t seed = 0; seed < test::num_cases(300); ++seed) {
            SCOPED_TRACE(testing::Message() << "shape " << s << ", seed " << seed);
            test::Random random(seed);
            const Vec3 centre = random.vector(0.6);
            Corners x;
            for (Vec3& corner : x) corner = centre + random.vector(0.4);
            // The tissue is on the side that is away from the origin.
            if ((x[1] - x[0]).cross(x[2] - x[0]).dot(centre) > 0.0) std::swap(x[1], x[2]);
            const double least = least_distance(shapes()[s], x);
            const bool is_round = s < 2;
            if (is_round && least < -0.5 * cutting::half_width_of(shapes()[s])) continue;
            std::vector<RigidTouch> touches;
            append_touches(shapes()[s], x, 10.0, touches);
            if (is_round && touches.empty()) continue;  // an axis beside and behind the triangle
            ASSERT_FALSE(touches.empty());
            double gap = std::numeric_limits<double>::infinity();
            for (const RigidTouch& touch : touches) {
                EXPECT_NEAR(touch.weights.sum(), 1.0, 1e-12);
                EXPECT_GE(touch.weights.minCoeff(), -1e-12);
                EXPECT_NEAR(touch.normal.norm(), 1.0, 1e-9);
                const double distance = distance_to(shapes()[s], touch.point);
                EXPECT_NEAR(touch.gap, distance, 1e-9);
                gap = std::min(gap, distance);
            }
            EXPECT_LE(gap, least + 1e-9);
            EXPECT_GE(gap, least - 0.01);  // the samples are so far apart
        }
}

TEST(RigidTouch, OfABallWithItsCentreInTheTissuePushesItOut) {
    const Corners x{Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};  // outward: up
    std::vector<RigidTouch> touches;
    // The tissue is below the triangle, here above the centre of the ball: it is 0.1 deep.
    const Corners below{x[0] + Vec3(0, 0, 0.1), x[1] + Vec3(0, 0, 0.1), x[2] + Vec3(0, 0, 0.1)};
    append_touches(cutting::Sphere{0.3}, below, 1.0, touches);
    ASSERT_EQ(touches.size(), 1u);
    EXPECT_NEAR(touches[0].gap, -0.4, 1e-12);
    EXPECT_LE((touches[0].normal + Vec3::UnitZ()).norm(), 1e-12);
}

TEST(RigidTouch, FartherThanAskedForIsNone) {
    const Corners x{Vec3(-1, -1, 2), Vec3(0, 1, 2), Vec3(1, -1, 2)};
    for (const ProbeShape& shape : shapes()) {
        std::vector<RigidTouch> touches;
        append_touches(shape, x, 0.5, touches);
        EXPECT_TRUE(touches.empty());
    }
}

}  // namespace
}  // namespace incise::contact
