// The shortest way into a corner, against alternating projections.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/shortest_inside.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

/// Dykstra's algorithm: it converges to the point of an intersection of convex sets that is nearest
/// to the origin.
Vec3 by_projections(const std::vector<InnerSide>& sides) {
    Vec3 x = Vec3::Zero();
    std::vector<Vec3> corrections(sides.size(), Vec3::Zero());
    for (int turn = 0; turn < 20000; ++turn)
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const Vec3 y = x + corrections[i];
            const double outside = sides[i].normal.dot(y) + sides[i].depth;
            x = outside > 0.0 ? Vec3(y - outside * sides[i].normal) : y;
            corrections[i] = y - x;
        }
    return x;
}

TEST(ShortestInside, IsThatOfAlternatingProjections) {
    test::Random random(1);
    for (int i = 0; i < test::num_cases(300); ++i) {
        SCOPED_TRACE(i);
        std::vector<InnerSide> sides(1 + random.below(6));
        for (InnerSide& side : sides)  // no corner is very sharp
            side = {(Vec3::UnitZ() + random.vector(0.8)).normalized(), random.uniform(0.2, 1.0)};
        const Vec3 x = shortest_inside(sides, 20.0);
        for (const InnerSide& side : sides) EXPECT_LE(side.normal.dot(x), -side.depth + 1e-7);
        EXPECT_NEAR(x.norm(), by_projections(sides).norm(), 1e-5);
    }
}

TEST(ShortestInside, IsZeroWhereThereIsNone) {
    const std::vector<InnerSide> slot{{Vec3::UnitX(), 1.0}, {-Vec3::UnitX(), 1.0}};
    EXPECT_EQ(shortest_inside(slot, 10.0), Vec3::Zero().eval());
    const std::vector<InnerSide> far{{Vec3::UnitX(), 3.0}};
    EXPECT_EQ(shortest_inside(far, 2.0), Vec3::Zero().eval());
    EXPECT_EQ(shortest_inside(far, 4.0), Vec3(-3.0, 0.0, 0.0));
    EXPECT_EQ(shortest_inside({}, 1.0), Vec3::Zero().eval());
}

}  // namespace
}  // namespace incise::cutting
