// A cut in many small steps is the cut of one big step, wherever the steps end: on nodes, edges,
// faces and planes of the mesh, too.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "blade_stops.h"

#include "support/num_cases.h"

namespace incise::sim {
namespace {

/// Places at which a step can end, in spacings: planes of the mesh, what lies half and a quarter
/// between them, and the numbers next to these.
std::vector<double> coincidences() {
    std::vector<double> stops;
    for (int k = 0; k <= 4 * StoppedCut::num_cells[0]; ++k) {
        const double x = 0.25 * k;
        stops.insert(stops.end(), {std::nextafter(x, -9.0), x, x, std::nextafter(x, 9.0)});
    }
    return stops;
}

/// Stops on up to four planes or between them. The blade may also go back.
std::vector<double> random_stops(test::Random& random) {
    std::vector<double> stops(1 + random.below(4));
    for (double& x : stops) x = 0.25 * static_cast<double>(random.below(17));
    if (random.below(3) > 0) std::ranges::sort(stops);
    // Short steps between the stops, and a rest at each.
    std::vector<double> steps;
    double from = -1.0;
    for (const double to : stops) {
        for (int i = 1; i <= 5; ++i) steps.push_back(std::lerp(from, to, i / 5.0));
        steps.push_back(to);
        from = to;
    }
    return steps;
}

void expect_whole_cut(const StoppedCut& c, std::span<const double> stops, std::uint64_t seed = 0) {
    SCOPED_TRACE(testing::Message() << c << ", seed " << seed);
    const StoppedOutcome outcome = cut_with_stops(c, stops, seed);
    EXPECT_EQ(outcome.num_contradictory, 0u);
    EXPECT_EQ(outcome.num_components, c.has_second_blade ? 4 : 2);
    const double h = StoppedCut::spacing;
    const double area = h * h * StoppedCut::num_cells[0] * StoppedCut::num_cells[1];
    if (!c.has_second_blade && c.gravity == 0.0) {
        // Nodes that are off the plane by the snap make the cut a little larger.
        const double tolerance = c.snap > 0.0 ? 0.02 : 1e-9;
        EXPECT_NEAR(outcome.cut_area, area, tolerance * area);
    }
}

constexpr Solver solvers[] = {Solver::semi_implicit_euler, Solver::implicit_euler, Solver::statics};

TEST(BladeStops, EveryCoincidenceLeavesTheCutWhole) {
    const std::vector<double> stops = coincidences();
    for (const Solver solver : solvers)
        for (const double height : {2.0, 2.5, 2.3})
            expect_whole_cut({.solver = solver, .snap = 0.0, .height = height}, stops);
    expect_whole_cut({}, stops);
}

TEST(BladeStops, RandomStopsLeaveTheCutWhole) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::num_cases(64)); ++seed) {
        test::Random random(seed);
        const StoppedCut c{.solver = solvers[seed % 3],
                           .snap = seed % 2 == 0 ? 0.0 : cutting::default_snap,
                           .jitter = seed % 4 == 3 ? 0.2 : 0.0,
                           .gravity = seed % 5 == 4 ? 3.0 : 0.0,
                           .height = 0.25 * static_cast<double>(5 + random.below(9)),
                           .has_second_blade = seed % 7 == 5,
                           .is_resumed = seed % 4 == 1};
        expect_whole_cut(c, random_stops(random), seed);
    }
}

}  // namespace
}  // namespace incise::sim
