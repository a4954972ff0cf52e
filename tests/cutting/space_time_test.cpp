// Crossings of moving segments: the plain cases, and the promise that carries the cut: chains of
// tissue and blade that belong together are counted together, in every degenerate position.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/space_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Random;

MovingSegment still(const Vec3& a, const Vec3& b) { return {{a, a}, {b, b}}; }
MovingSegment shifted(const Vec3& a, const Vec3& b, const Vec3& by) {
    return {{a, a + by}, {b, b + by}};
}
MovingSegment reversed(const MovingSegment& s) { return {s.b, s.a}; }
/// The same motion, run backwards.
MovingSegment backwards(const MovingSegment& s) { return {{s.a[1], s.a[0]}, {s.b[1], s.b[0]}}; }

/// Along x at y = 0, moving up from z = -1 to z = 1: it sweeps a square of side 2 about the origin.
const MovingSegment rising_blade = shifted({-1, 0, -1}, {1, 0, -1}, {0, 0, 2});

TEST(Crossing, BladePassesThroughAStillSegment) {
    EXPECT_TRUE(cross(still({0.3, -1, 0.2}, {0.1, 1, 0.4}), rising_blade));
    EXPECT_FALSE(cross(still({0.3, -1, 1.2}, {0.1, 1, 1.4}), rising_blade));   // not yet
    EXPECT_FALSE(cross(still({1.3, -1, 0.2}, {1.1, 1, 0.4}), rising_blade));   // beside it
    EXPECT_FALSE(cross(still({0.3, 0.1, 0.2}, {0.1, 1, 0.4}), rising_blade));  // too short
}

TEST(Crossing, TissuePassesThroughAStillBlade) {
    const auto blade = still({-1, 0, 0}, {1, 0, 0});
    EXPECT_TRUE(cross(shifted({0.3, -1, 1}, {0.2, 1, 1.1}, {0, 0, -2}), blade));
    EXPECT_FALSE(cross(shifted({0.3, -1, 1}, {0.2, 1, 1.1}, {0, 0, -0.9}), blade));
    EXPECT_FALSE(cross(shifted({0.3, -1, 1}, {0.2, 1, 1.1}, {2, 0, -2}), blade));  // past its end
}

TEST(Crossing, OnlyTheMotionRelativeToEachOtherCounts) {
    const Vec3 wind(0.25, -3, 17);
    const auto with = [&](MovingSegment s) {
        s.a[1] += wind;
        s.b[1] += wind;
        return s;
    };
    const auto tissue = still({0.5, -1, 0.25}, {0.25, 1, 0.5});
    EXPECT_TRUE(cross(with(tissue), with(rising_blade)));
    // Side by side, however near or even touching, they never pass through each other.
    EXPECT_FALSE(cross(with(tissue), with(still({-1, 0, 0.3}, {1, 0, 0.3}))));
    EXPECT_FALSE(cross(with(still({0, -1, 0}, {0, 1, 0})), with(still({-1, 0, 0}, {1, 0, 0}))));
}

TEST(Crossing, ThereAndBackIsNoCrossing) {
    const auto tissue = still({0.3, -1, 0.2}, {0.1, 1, 0.4});
    EXPECT_TRUE(cross(tissue, rising_blade));
    EXPECT_TRUE(cross(tissue, backwards(rising_blade)));
}

TEST(Crossing, DegenerateSegmentsCrossNothing) {
    const auto tissue = still({0.3, -1, 0.2}, {0.1, 1, 0.4});
    EXPECT_FALSE(cross(still({0.3, 0, 0.2}, {0.3, 0, 0.2}), rising_blade));  // a point
    EXPECT_FALSE(cross(tissue, shifted({0.2, 0, -1}, {0.2, 0, -1}, {0, 0, 2})));
    EXPECT_FALSE(cross(still({-2, 0, 0}, {2, 0, 0}), rising_blade));      // parallel
    EXPECT_FALSE(cross(still({0.1, 0, -2}, {0.3, 0, 2}), rising_blade));  // in the swept plane
    EXPECT_FALSE(cross(still({-1, 0, -1}, {1, 0, -1}), rising_blade));    // the blade itself
    EXPECT_FALSE(cross(shifted({-1, 0, -1}, {1, 0, -1}, {0, 0, 2}), rising_blade));
    EXPECT_FALSE(cross(tissue, shifted({-1, 0, 0.3}, {1, 0, 0.3}, {0.5, 0, 0})));  // along itself
}

TEST(Crossing, TouchingIsDecidedAsAfterATinyShift) {
    // First by a hair along x, then by a hair of that along y, then along z.
    const auto tissue = [](double x, double from_y, double to_y, double z) {
        return still({x, from_y, z}, {x, to_y, z});
    };
    const auto below = [](double x) { return std::nextafter(x, -10.0); };
    const auto above = [](double x) { return std::nextafter(x, 10.0); };
    const auto is_crossed = [&](double x, double from_y, double to_y, double z) {
        const auto segment = tissue(x, from_y, to_y, z);
        const bool result = cross(segment, rising_blade);
        EXPECT_EQ(cross(backwards(segment), backwards(rising_blade)), result);
        EXPECT_EQ(cross(reversed(segment), rising_blade), result);
        EXPECT_EQ(cross(segment, reversed(rising_blade)), result);
        return result;
    };
    // The lower end belongs to the blade, the upper one does not; as for numbers a hair above.
    for (const double end : {-1.0, 1.0}) {
        const bool is_lower = end < 0.0;
        EXPECT_EQ(is_crossed(end, -1, 1, 0.5), is_lower);
        EXPECT_EQ(is_crossed(above(end), -1, 1, 0.5), is_lower);
        EXPECT_EQ(is_crossed(below(end), -1, 1, 0.5), !is_lower);
        EXPECT_EQ(is_crossed(0.5, -1, 1, end), is_lower);
        EXPECT_EQ(is_crossed(0.5, -1, 1, above(end)), is_lower);
        EXPECT_EQ(is_crossed(0.5, -1, 1, below(end)), !is_lower);
    }
    EXPECT_FALSE(is_crossed(0.5, 0, 1, 0.5));  // starts on the swept plane: just beyond it
    EXPECT_TRUE(is_crossed(0.5, below(0), 1, 0.5));
    EXPECT_TRUE(is_crossed(0.5, -1, 0, 0.5));
    EXPECT_FALSE(is_crossed(0.5, -1, below(0), 0.5));
}

TEST(Crossing, IsExactNextToASlantedSweep) {
    // Whole numbers of some 50 bits, whose products are rounded: the tissue starts on the plane
    // that the blade sweeps, or a few units, the last bits, beside it.
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Random random(seed);
        const auto whole = [&](double low, double high) {
            return std::floor(random.uniform(low, high));
        };
        const auto direction = [&] {
            const double x = whole(0x1p22, 0x1p23), y = whole(0x1p22, 0x1p23);
            return Vec3(x, y, whole(0x1p22, 0x1p23));
        };
        const Vec3 a(whole(-0x1p48, 0x1p48), whole(-0x1p48, 0x1p48), whole(-0x1p48, 0x1p48));
        const Vec3 along = direction(), by = direction();
        if (along.cross(by).x() == 0.0) continue;
        const auto blade = shifted(a, a + 0x1.8p26 * along, whole(0x1p26, 0x1p27) * by);
        for (const int offset : {-2, -1, 0, 1, 2}) {
            const Vec3 start =
                a + whole(0x1p24, 0x1p26) * along + whole(0x1p24, 0x1p25) * by + Vec3(offset, 0, 0);
            // On the plane is a hair along x beyond it.
            EXPECT_EQ(cross(still(start, start + Vec3(0x1p20, 0, 0)), blade), offset < 0)
                << seed << ", " << offset;
        }
    }
}

TEST(Crossing, TakesTheLargestAndSmallestNumbers) {
    for (const double scale : {1e-300, 1e-160, 1e-80, 1.0, 1e80, 1e160, 1e300}) {
        SCOPED_TRACE(scale);
        const auto scaled = [&](MovingSegment s) {
            for (auto* end : {&s.a, &s.b})
                for (Vec3& x : *end) x *= scale;
            return s;
        };
        const auto blade = scaled(rising_blade);
        EXPECT_TRUE(cross(scaled(still({0.3, -1, 0.2}, {0.1, 1, 0.4})), blade));
        EXPECT_FALSE(cross(scaled(still({0.3, -1, 1.2}, {0.1, 1, 1.4})), blade));
        EXPECT_TRUE(cross(scaled(still({-1, -1, 0.5}, {-1, 1, 0.5})), blade));
        EXPECT_FALSE(cross(scaled(still({1, -1, 0.5}, {1, 1, 0.5})), blade));
    }
}

/// Where the points of a polygonal chain are at the beginning and after each step.
using History = std::vector<std::vector<Vec3>>;

/// Crossings of all tissue segments with all blade segments in all steps, modulo two.
bool parity(const History& tissue, const History& blade) {
    const auto segment = [](const History& h, std::size_t step, std::size_t i) {
        return MovingSegment{{h[step][i], h[step + 1][i]}, {h[step][i + 1], h[step + 1][i + 1]}};
    };
    bool is_odd = false;
    for (std::size_t step = 0; step + 1 < tissue.size(); ++step)
        for (std::size_t i = 0; i + 1 < tissue[step].size(); ++i)
            for (std::size_t j = 0; j + 1 < blade[step].size(); ++j)
                is_odd ^= cross(segment(tissue, step, i), segment(blade, step, j));
    return is_odd;
}

/// A point halfway between neighbours of each chain.
History with_middles(const History& history) {
    History result;
    for (const auto& points : history) {
        result.push_back({points[0]});
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            result.back().push_back(0.5 * (points[i] + points[i + 1]));
            result.back().push_back(points[i + 1]);
        }
    }
    return result;
}

/// Each step in two halves.
History with_half_steps(const History& history) {
    History result{history[0]};
    for (std::size_t step = 0; step + 1 < history.size(); ++step) {
        result.push_back(history[step]);
        for (std::size_t i = 0; i < history[step].size(); ++i)
            result.back()[i] = 0.5 * (history[step][i] + history[step + 1][i]);
        result.push_back(history[step + 1]);
    }
    return result;
}

/// A chain that jumps about on the grid. A closed one ends where it begins.
History grid_chain(Random& random, std::size_t size, std::size_t num_points, std::size_t num_steps,
                   bool is_closed) {
    History history(num_steps + 1);
    for (auto& points : history) {
        for (std::size_t i = 0; i < num_points; ++i) points.push_back(random.grid_point(size));
        if (is_closed) points.push_back(points.front());
    }
    return history;
}

constexpr double far_away = 64.0;

/// An edge that comes from far above and goes far below, its ends always far out along x.
History passing_blade(Random& random, std::size_t size, std::size_t num_steps) {
    History blade = grid_chain(random, size, 3, num_steps, false);
    for (auto& points : blade) {
        points.front().x() = -far_away;
        points.back().x() = far_away;
    }
    for (Vec3& x : blade.front()) x.z() += far_away;
    for (Vec3& x : blade.back()) x.z() -= far_away;
    return blade;
}

TEST(Crossing, ClosedPathsAreCrossedEvenly) {
    int num_crossed = 0;
    for (const std::size_t size : {2u, 3u, 5u})
        for (std::uint64_t seed = 0; seed < test::num_cases(400); ++seed) {
            Random random(1000 * size + seed);
            const auto loop = grid_chain(random, size, 3 + random.below(3), 3, true);
            const auto blade = passing_blade(random, size, 3);
            ASSERT_FALSE(parity(loop, blade)) << "size " << size << ", seed " << seed;
            for (std::size_t i = 0; i + 1 < loop[0].size(); ++i) {
                History piece;
                for (const auto& points : loop) piece.push_back({points[i], points[i + 1]});
                num_crossed += parity(piece, blade);
            }
        }
    EXPECT_GT(num_crossed, test::num_cases(500));  // its segments for themselves are crossed often
}

TEST(Crossing, PathsBetweenTheSidesAreCrossedOddly) {
    for (const std::size_t size : {2u, 3u, 5u})
        for (std::uint64_t seed = 0; seed < test::num_cases(400); ++seed) {
            Random random(1000 * size + seed);
            auto path = grid_chain(random, size, 3 + random.below(3), 3, false);
            for (auto& points : path) {  // held where the blade never comes
                points.front() = Vec3(1, -far_away, 1);
                points.back() = Vec3(1, far_away, 0);
            }
            const auto blade = passing_blade(random, size, 3);
            ASSERT_TRUE(parity(path, blade)) << "size " << size << ", seed " << seed;
        }
}

TEST(Crossing, ClosedBladesThatComeAndGoCrossEvenly) {
    for (const std::size_t size : {2u, 3u, 5u})
        for (std::uint64_t seed = 0; seed < test::num_cases(300); ++seed) {
            Random random(1000 * size + seed);
            const auto loop = grid_chain(random, size, 4, 3, true);
            auto blade = grid_chain(random, size, 4, 3, true);
            for (Vec3& x : blade.front()) x.z() += far_away;
            for (Vec3& x : blade.back()) x.z() -= far_away;
            ASSERT_FALSE(parity(loop, blade)) << "size " << size << ", seed " << seed;
        }
}

TEST(Crossing, IgnoresHowChainsAndStepsAreDivided) {
    // Both ends of the path are held out of the blade's reach, and those of the blade are far out:
    // whatever is put in between, it is the same intersection.
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        auto path = grid_chain(random, 3, 4, 2, false);
        const double side = random.below(2) == 0 ? 1.0 : -1.0;
        for (auto& points : path) {
            points.front() = Vec3(1, -far_away, 1);
            points.back() = Vec3(1, side * far_away, 0);
        }
        const auto blade = passing_blade(random, 3, 2);
        const bool expected = side > 0.0;
        ASSERT_EQ(parity(path, blade), expected);
        ASSERT_EQ(parity(with_middles(path), blade), expected);
        ASSERT_EQ(parity(path, with_middles(blade)), expected);
        ASSERT_EQ(parity(with_middles(path), with_middles(blade)), expected);
        ASSERT_EQ(parity(with_half_steps(path), with_half_steps(blade)), expected);
    }
}

TEST(Crossing, OfStraightSweepsIsTheSameHoweverDivided) {
    // Segments that keep their direction sweep parallelograms, which stay the same sets when they
    // are divided; then each crossing for itself is kept, free ends and touching ones included.
    int num_crossed = 0;
    for (const std::size_t size : {3u, 4u, 6u})
        for (std::uint64_t seed = 0; seed < test::num_cases(1500); ++seed) {
            Random random(1000 * size + seed);
            const auto swept = [&] {
                const Vec3 a = random.grid_point(size), b = random.grid_point(size);
                const Vec3 by = random.grid_point(size) - random.grid_point(size);
                return History{{a, b}, {a + by, b + by}};
            };
            const History tissue = swept(), blade = swept();
            const bool expected = parity(tissue, blade);
            num_crossed += expected;
            SCOPED_TRACE("size " + std::to_string(size) + ", seed " + std::to_string(seed));
            ASSERT_EQ(parity(with_middles(tissue), blade), expected);
            ASSERT_EQ(parity(tissue, with_middles(blade)), expected);
            ASSERT_EQ(parity(with_half_steps(tissue), with_half_steps(blade)), expected);
            ASSERT_EQ(parity(with_half_steps(with_half_steps(with_middles(tissue))),
                             with_half_steps(with_half_steps(blade))),
                      expected);
        }
    EXPECT_GT(num_crossed, test::num_cases(100));
}

TEST(Crossing, AgreesWithPlainArithmeticInGeneralPosition) {
    // A still tissue segment against a blade that keeps its direction: a segment and a
    // parallelogram in space.
    int num_crossed = 0;
    for (std::uint64_t seed = 0; seed < test::num_cases(3000); ++seed) {
        Random random(seed);
        const Vec3 p = random.vector(1), q = random.vector(1);
        const Vec3 a = random.vector(1), b = random.vector(1), by = 3.0 * random.vector(1);
        Eigen::Matrix3d m;
        m << b - a, by, p - q;
        const Vec3 s = m.inverse() * (p - a);  // along the blade, in time, along the tissue
        const bool expected = s.minCoeff() > 0.0 && s.maxCoeff() < 1.0;
        num_crossed += expected;
        ASSERT_EQ(cross(still(p, q), shifted(a, b, by)), expected) << seed;
    }
    EXPECT_GT(num_crossed, test::num_cases(100));
}

}  // namespace
}  // namespace incise::cutting
