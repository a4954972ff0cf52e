// Where a blade stops inside a body, its cut ends at its edge.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/blade_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_metrics.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "support/plane_section.h"

namespace incise::cutting {
namespace {

using test::Random;

TEST(BladeEnd, TellsWhatIsAheadOfAStraightEdge) {
    // Slantwise: only the motion across the edge counts.
    const BladeEnd end({{0, 0, 0}, {2, 0, 0}}, {{3, 1, 0}, {3, 1, 0}});
    EXPECT_DOUBLE_EQ(end.distance_ahead({1, 0.5, 0}), 0.5);
    EXPECT_DOUBLE_EQ(end.distance_ahead({1, -0.25, 0}), -0.25);
    EXPECT_DOUBLE_EQ(end.distance_ahead({5, 0.5, 0.1}), 0.5);  // beyond its end
    EXPECT_EQ(end.distance_ahead({0.5, 0, 0}), 0.0);
}

TEST(BladeEnd, TellsWhatIsAheadOfABentEdge) {
    const Vec3 motion(0, 0, -2);
    const BladeEnd end({{0, 0, 1}, {1, 0, 0}, {2, 0, 1}}, {motion, motion, motion});
    EXPECT_GT(end.distance_ahead({1, 0, -0.1}), 0.0);
    EXPECT_LT(end.distance_ahead({1, 0, 0.5}), 0.0);
    EXPECT_NEAR(end.distance_ahead({0.5, 0, 0}), std::sqrt(0.125), 1e-15);
    EXPECT_NEAR(end.distance_ahead({1.5, 0, 1}), -std::sqrt(0.125), 1e-15);
}

// What is ahead of a sharp apex is behind the lines of both segments.
TEST(BladeEnd, TellsWhatIsAheadOfASharpEdge) {
    const Vec3 motion(0, 0, -1);
    const BladeEnd first({{-0.2, 0, 1}, {0, 0, 0}, {0.2, 0, 1}}, {motion, motion, motion});
    for (const double x : {-0.01, 0.0, 0.01}) EXPECT_GT(first.distance_ahead({x, 0, -0.5}), 0.0);
    for (const double x : {-0.01, 0.0, 0.01}) EXPECT_LT(first.distance_ahead({x, 0, 0.5}), 0.0);
    // It gets out of what the edge is in: as far across each of its segments.
    const SweptEdge ahead = first.continuation(0.1);
    const auto end = ahead.ends_inside({MovingPoint{Vec3(0, -1, -9), Vec3(0, -1, -9)},
                                        MovingPoint{Vec3(0, 1, -9), Vec3(0, 1, -9)},
                                        MovingPoint{Vec3(0.001, 0, -0.5), Vec3(0.001, 0, -0.5)}});
    EXPECT_TRUE(*end);
}

TEST(BladeEnd, RestingPointsGoOnAsTheirNeighbours) {
    const Vec3 still = Vec3::Zero();
    const BladeEnd turning({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {still, {0, 1, 0}, {0, 2, 0}});
    EXPECT_DOUBLE_EQ(turning.distance_ahead({0, 0.3, 0}), 0.3);
    const BladeEnd resting({{0, 0, 0}, {1, 0, 0}}, {still, still});
    EXPECT_EQ(resting.distance_ahead({0.5, 0.3, 0}), 0.0);
    // Along itself, too, it cuts nothing.
    const BladeEnd along({{0, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {1, 0, 0}});
    EXPECT_EQ(along.distance_ahead({0.5, 0.3, 0}), 0.0);
}

TEST(BladeEnd, GoesOnByADistanceAcrossTheEdge) {
    const BladeEnd end({{-1, 0, 0}, {1, 0, 0}}, {{0.1, 0.2, 0}, {0.1, 0.2, 0}});
    const SweptEdge ahead = end.continuation(0.5);
    const auto crosses = [&](double y) {
        std::vector<Crossing> crossings;
        const Vec3 below(0.1, y, -1), above(0.1, y, 1);
        ahead.append_crossings({below, below}, {above, above}, crossings);
        return crossings.size();
    };
    EXPECT_EQ(crosses(-0.01), 0u);
    EXPECT_EQ(crosses(0.01), 1u);
    EXPECT_EQ(crosses(0.49), 1u);
    EXPECT_EQ(crosses(0.51), 0u);
}

/// A blade whose straight edge overhangs the unit cube and stops in it.
struct StoppingBlade {
    Vec3 normal, along, ahead;  // of its plane; its edge; its way: of unit length
    Vec3 stop;                  // the middle of its edge at last

    explicit StoppingBlade(Random& random) {
        normal = random.vector(1.0).normalized();
        along = (random.vector(1.0).cross(normal)).normalized();
        ahead = normal.cross(along);
        stop = Vec3::Constant(0.5) + random.vector(0.2);
    }

    Polyline edge(double way_left) const {
        const Vec3 middle = stop - way_left * ahead;
        return {middle - 3.0 * along, middle + 3.0 * along};
    }
    BladeEnd end() const { return {edge(0.0), {ahead, ahead}}; }

    /// Of its plane in the cube, as far as it gets, m2.
    double swept_area() const {
        Polyline polygon;
        for (const auto& [s, t] : {std::pair(-3.0, -3.0), {-3.0, 3.0}, {0.0, 3.0}, {0.0, -3.0}})
            polygon.push_back(stop + s * ahead + t * along);
        for (int c = 0; c < 3; ++c)
            for (const double side : {0.0, 1.0}) {
                const auto inside = [&](const Vec3& x) { return side == 0.0 ? x[c] : 1.0 - x[c]; };
                Polyline rest;
                for (std::size_t i = 0; i < polygon.size(); ++i) {
                    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                    if (inside(a) >= 0.0) rest.push_back(a);
                    if (inside(a) * inside(b) < 0.0)
                        rest.push_back(a + inside(a) / (inside(a) - inside(b)) * (b - a));
                }
                polygon = rest;
            }
        return test::polygon_area(polygon);
    }

    /// Of its plane in a tetrahedron: as far as it gets, and all of it, m2.
    struct Section {
        double behind, whole;
    };
    Section section_of(const std::array<Vec3, 4>& corners) const {
        const Polyline all = test::plane_section(corners, stop, normal);
        Polyline behind;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Vec3 &x = all[i], &y = all[(i + 1) % all.size()];
            const double a = ahead.dot(x - stop), b = ahead.dot(y - stop);
            if (a <= 0.0) behind.push_back(x);
            if (a * b < 0.0) behind.push_back(x + a / (a - b) * (y - x));
        }
        return {test::polygon_area(behind), test::polygon_area(all)};
    }
};

/// Opens faces as far as the blade gets, in so many steps.
std::vector<Split> cut_to_the_stop(SplitBody& body, const StoppingBlade& blade, int num_steps,
                                   const SplitOptions& options) {
    std::optional<CutId> front;
    std::vector<Split> parts;
    for (const auto& surface : sweep(blade.edge(6.0), blade.edge(0.0), num_steps))
        parts.push_back(body.cut(surface, front, options));
    parts.push_back(body.finish(blade.end(), front));
    EXPECT_FALSE(body.cutter().is_in_tissue(*front));
    return parts;
}

/// Of the opened faces, seen along the normal, m2.
double projected_area(const SplitBody& body, const Vec3& normal) {
    double area = 0.0;
    for (const auto& [face, other] : cut_faces(body.mesh)) {
        std::array<Vec3, 3> x;
        for (int p = 0; p < 3; ++p)
            x[static_cast<std::size_t>(p)] = body.positions[body.mesh.face_corner(face, p).index()];
        area += 0.5 * std::abs(normal.dot((x[1] - x[0]).cross(x[2] - x[0])));
    }
    return area;
}

// It opens to the blade's edge exactly, and through the carriers that it has cut by half or more.
TEST(FinishedCut, OpensToTheEdgeAndThroughCarriersCutByHalf) {
    std::size_t num_opened_whole = 0;
    for (std::uint64_t seed = 0; seed < test::num_cases(12); ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SplitBody body(test::jittered_cube(3 + static_cast<int>(seed % 4), 0.2, seed));
        const StoppingBlade blade(random);
        double expected = 0.0, swept = 0.0;
        for (const CellId e : body.mesh.elements()) {
            std::array<Vec3, 4> corners;
            for (std::size_t k = 0; k < 4; ++k)
                corners[k] = body.positions[body.mesh.corners(e)[k].index()];
            const auto [behind, whole] = blade.section_of(corners);
            const bool is_opened_whole = behind >= 0.5 * whole;
            num_opened_whole += is_opened_whole && behind < 0.99 * whole;
            expected += is_opened_whole ? whole : behind;
            swept += behind;
        }
        ASSERT_NEAR(swept, blade.swept_area(), 1e-9);
        const auto parts = cut_to_the_stop(body, blade, 3, {0.0});
        EXPECT_NEAR(sum(parts).cut_area, expected, 1e-6);
        EXPECT_EQ(topology::components(body.mesh).count, 1);
    }
    EXPECT_GT(num_opened_whole, test::num_cases(12));
}

TEST(FinishedCut, EndsWithinAnElementOfTheEdgeWithoutBias) {
    const auto num_seeds = test::num_cases(24);
    double missing = 0.0;  // in bricks over the width of the cube
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const int num_bricks = 5 + static_cast<int>(seed % 4);
        SplitBody body(test::jittered_cube(num_bricks, 0.2, seed));
        const StoppingBlade blade(random);
        const SplitOptions options = SplitOptions{default_snap};
        const double farthest = longest_edge(body.mesh, body.positions);
        cut_to_the_stop(body, blade, 4, options);
        missing += (blade.swept_area() - projected_area(body, blade.normal)) * num_bricks;
        for (const auto& [face, other] : cut_faces(body.mesh))
            for (int p = 0; p < 3; ++p) {
                const Vec3& x = body.positions[body.mesh.face_corner(face, p).index()];
                EXPECT_LE(blade.ahead.dot(x - blade.stop), farthest * (1.0 + 1e-9));
            }
    }
    // Without an end it is 0.58; of planes right through the body, 0.1, as the rough boundary of a
    // cut does not quite fill it.
    EXPECT_LT(std::abs(missing) / static_cast<double>(num_seeds), 0.2);
}

TEST(FinishedCut, IsTheSameInManySteps) {
    for (const double snap : {0.0, default_snap})
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(testing::Message() << "snap " << snap << ", seed " << seed);
            std::array<std::size_t, 3> expected{};
            for (const int num_steps : {1, 2, 7, 30}) {
                Random random(seed);
                SplitBody body(test::jittered_cube(5, 0.2, seed));
                const StoppingBlade blade(random);
                const auto parts = cut_to_the_stop(body, blade, num_steps, SplitOptions{snap});
                const std::array now{body.mesh.num_elements(), body.mesh.num_nodes(),
                                     sum(parts).faces_opened};
                if (num_steps == 1) expected = now;
                EXPECT_EQ(now, expected) << num_steps << " steps";
            }
        }
}

TEST(FinishedCut, DoesNothingWhereTheBladeIsOutside) {
    SplitBody body(test::jittered_cube(5, 0.2, 1));
    Random random(1);
    StoppingBlade blade(random);
    blade.stop += 3.0 * blade.ahead;
    const auto parts = cut_to_the_stop(body, blade, 5, SplitOptions{default_snap});
    EXPECT_TRUE(parts.back().changes.is_empty());
    EXPECT_EQ(topology::components(body.mesh).count, 2);
    std::optional<CutId> none;
    EXPECT_TRUE(body.finish(blade.end(), none).changes.is_empty());
}

// In faces and nodes of the mesh, a hair beside them, and at the side of the body, which it parts.
TEST(FinishedCut, EndsWhereFacesOfTheMeshAre) {
    for (const double snap : {0.0, default_snap})
        for (const double height : {0.5, 0.4731})
            for (const double stop : {0.25, 0.5, 0.25 - 1e-12, 0.5 + 1e-12, 1.0 - 1e-9, 1.0}) {
                SCOPED_TRACE(testing::Message()
                             << "snap " << snap << ", height " << height << ", to " << stop);
                SplitBody body(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                  Vec3::Ones(), {4, 4, 4}));
                const auto edge = [&](double x) {
                    return Polyline{{x, -1.0, height}, {x, 2.0, height}};
                };
                const SplitOptions options = SplitOptions{snap};
                std::optional<CutId> front;
                for (const auto& surface : sweep(edge(-0.3), edge(stop), 1))
                    body.cut(surface, front, options);
                body.finish({edge(stop), {Vec3::UnitX(), Vec3::UnitX()}}, front);
                EXPECT_NEAR(projected_area(body, Vec3::UnitZ()), stop, 1e-8);
                EXPECT_EQ(topology::components(body.mesh).count, stop > 0.9 ? 2 : 1);
            }
}

// A second blade begins a hair before where the first one stopped: together they part the body.
TEST(FinishedCut, IsCarriedOnByAnotherBlade) {
    for (std::uint64_t seed = 0; seed < test::num_cases(12); ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SplitBody body(test::jittered_cube(5, 0.2, seed));
        const StoppingBlade blade(random);
        cut_to_the_stop(body, blade, 4, {0.0});
        EXPECT_EQ(topology::components(body.mesh).count, 1);
        body.cut(sweep(blade.edge(0.002), blade.edge(-3.0), 4));
        EXPECT_EQ(topology::components(body.mesh).count, 2);
    }
}

}  // namespace
}  // namespace incise::cutting
