// The figures of `incise bench`: that there are all of them, and that they fit each other. How high
// they are is no affair of tests.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/bench/throughput.h"

#include <gtest/gtest.h>

#include "support/num_cases.h"

namespace incise::app {
namespace {

TEST(Throughput, HasRowsForAllBodiesLawsAndThreads) {
    bench::ThroughputPlan plan;
    const std::size_t num_tetrahedra = test::is_sanitized ? 1'500 : 3'000;
    plan.tetrahedra = {400, num_tetrahedra};
    plan.hexahedra = {64};
    plan.edited_tetrahedra = {num_tetrahedra};
    plan.edited_hexahedra = {1000};
    plan.touching_tetrahedra = {1000};
    plan.seconds = 0.0;
    plan.num_threads = 2;
    double last = -1.0;
    const bench::Throughput throughput =
        bench::measure_throughput(plan, [&](double share, const std::string&) {
            EXPECT_GT(share, last);
            EXPECT_LT(share, 1.0);
            last = share;
        });
    ASSERT_EQ(throughput.machine.limits.size(), 2u);
    for (const auto& [threads, limit] : throughput.machine.limits) {
        EXPECT_GT(limit.gigaflops, 0.0);
        EXPECT_GT(limit.gigabytes_per_second, 0.0);
    }
    ASSERT_EQ(throughput.steps.size(), 2u * 3u * 2u + 2u);
    for (const bench::StepRate& rate : throughput.steps) {
        EXPECT_GT(rate.forces, 0.0);
        EXPECT_GE(rate.step, rate.forces);
        EXPECT_GT(rate.single_forces, 0.0);
        EXPECT_GE(rate.single_step, rate.single_forces);
        EXPECT_NEAR(rate.step * 1e-9 * static_cast<double>(rate.elements) * rate.steps_per_second,
                    1.0, 1e-9);
        EXPECT_EQ(rate.reference.has_value(), rate.num_threads == 1);
        EXPECT_EQ(rate.arithmetic.has_value(), rate.num_threads == 1 && rate.method == "heml");
        EXPECT_GT(rate.arithmetic.value_or(1.0), 0.0);
        EXPECT_GT(rate.real_time_factor, 0.0);
        EXPECT_GT(rate.gigaflops, 0.0);
        const auto& limit = throughput.machine.limits.at(rate.num_threads);
        EXPECT_NEAR(rate.share_of_peak * limit.gigaflops, rate.gigaflops, 1e-9 * rate.gigaflops);
        EXPECT_NEAR(rate.share_of_bandwidth * limit.gigabytes_per_second, rate.gigabytes_per_second,
                    1e-9 * rate.gigabytes_per_second);
    }
    EXPECT_EQ(throughput.steps.back().method, "hybmss");
    EXPECT_EQ(throughput.steps.back().elements, 64u);
    std::string edits;
    for (const bench::EditRate& rate : throughput.edits) {
        edits += std::string(rate.method) + " " + std::string(rate.kind) + ", ";
        EXPECT_GT(rate.items, 20u) << rate.kind;
    }
    EXPECT_EQ(edits,
              "heml split, heml separate, heml carve, heml remove, "
              "hybmss separate, hybmss carve, hybmss remove, ");
    EXPECT_EQ(throughput.edits[3].items, 1000u);
    EXPECT_EQ(throughput.edits.back().elements, 1000u);
    ASSERT_EQ(throughput.edited.size(), 3u);
    EXPECT_GT(throughput.edited[0].elements, throughput.edited[0].elements_before);
    for (const std::size_t i : {1u, 2u}) {
        const bench::EditedRate& halved = throughput.edited[i];
        EXPECT_NEAR(static_cast<double>(halved.elements),
                    0.5 * static_cast<double>(halved.elements_before),
                    0.1 * static_cast<double>(halved.elements_before));
        EXPECT_GT(halved.nodes, halved.nodes_before);  // fewer elements share them
    }
    for (const bench::EditedRate& rate : throughput.edited) {
        EXPECT_GT(rate.forces_before, 0.0);
        EXPECT_GT(rate.forces, 0.0);
        EXPECT_GT(rate.forces_built_anew, 0.0);
    }
    ASSERT_EQ(throughput.contact.size(), 2u);  // without and with friction
    for (const bench::ContactRate& rate : throughput.contact) {
        EXPECT_GT(rate.points, 20u);
        EXPECT_GT(rate.surface_nodes, 200u);
        EXPECT_GT(rate.step_without, 0.0);
        EXPECT_GT(rate.step, 0.0);
        EXPECT_GT(rate.search, 0.0);
    }
}

// Steps of a few bricks are so fast that hours of simulated time pass.
TEST(Throughput, IsMeasuredForAnyTime) {
    const bench::ThroughputPlan plan{.tetrahedra = {},
                                     .hexahedra = {8},
                                     .edited_tetrahedra = {},
                                     .edited_hexahedra = {},
                                     .touching_tetrahedra = {},
                                     .seconds = 0.05};
    EXPECT_FALSE(bench::measure_throughput(plan, [](double, const std::string&) {}).steps.empty());
}

}  // namespace
}  // namespace incise::app
