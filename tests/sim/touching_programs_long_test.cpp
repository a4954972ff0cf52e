// Contact holds in random programs of cuts, probes, graspers and sutures.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/num_cases.h"
#include "tests/sim/touching_programs.h"

namespace incise::sim {
namespace {

/// Mass times speed, summed over the nodes: what errors of the momentum are compared with.
double speed_of(const World& world) {
    const physics::Model& model = world.model();
    double sum = 0.0;
    for (const NodeId n : model.fragments().nodes())
        sum += model.masses()[n.index()] * model.velocities()[n.index()].norm();
    return sum;
}

/// True for tools whose force is exerted, and has another body to act on.
bool exerts(const cutting::ToolShape& shape) {
    const auto* blade = std::get_if<cutting::Blade>(&shape);
    return !std::holds_alternative<cutting::Suture>(shape) &&
           (!blade || blade->cutting_force == cutting::CuttingForce::apply);
}

// The tools change the momentum by their impulses, and nothing else does. A thread changes it by
// nothing. Energy comes from the tools alone, but for what the explicit step adds and takes.
class TouchingPrograms : public testing::TestWithParam<int> {};

constexpr int num_parts = 4;
constexpr double least_energy = 1e-12;  // J: that of a body that nothing has touched

TEST_P(TouchingPrograms, KeepMomentumAndTakeEnergyFromToolsOnly) {
    const int num_seeds = test::num_cases(1000) / num_parts, first = GetParam() * num_seeds;
    std::size_t num_edits = 0, num_touched = 0, num_fine = 0, num_deep = 0;
    double fracture_energy = 0.0;
    for (int seed = first; seed < first + num_seeds; ++seed) {
        TouchingProgram program(static_cast<std::uint64_t>(seed));
        World& world = program.world();
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << program.name());
        double scale = 1e-12, energy_scale = 0.0, rise = 0.0;
        int deep = 0, longest = 0;  // steps with a deep overlap
        for (int i = 0; i < TouchingProgram::num_steps; ++i) {
            const Vec3 before = world.model().energetics().totals().momentum;
            const StepReport& report = program.step(i);
            Vec3 impulse = Vec3::Zero();
            for (const ToolState& tool : report.tools)
                if (exerts(world.tool(tool.tool).shape))
                    impulse -= (report.to - report.from) * tool.force;
            const Vec3 error = world.model().energetics().totals().momentum - before - impulse;
            scale = std::max(scale, speed_of(world));
            ASSERT_TRUE(std::isfinite(scale)) << "step " << i;
            ASSERT_LE(error.norm(), 1e-13 * scale) << "step " << i;
            const double dt = (report.to - report.from) / static_cast<double>(report.num_substeps);
            const double energy = test::present_energy(world.model(), dt);
            const double work = world.ledger().body_totals().external_work;
            energy_scale = std::max({energy_scale, energy, std::abs(work)});
            rise = std::max(rise, energy - work);
            num_touched += report.contact.num_points > 0;
            deep = report.contact.max_penetration > 0.1 * program.size() ? deep + 1 : 0;
            longest = std::max(longest, deep);
        }
        num_deep += longest > 10;
        num_edits += world.ledger().num_edits();
        fracture_energy += world.report().contact.fracture_energy;
        // The explicit step lets the energy of few and large elements fluctuate more.
        const bool is_fine = world.mesh().num_elements() > 200;
        num_fine += is_fine;
        EXPECT_LE(rise, (is_fine ? 0.06 : 0.2) * energy_scale + least_energy);
    }
    EXPECT_GT(num_fine, static_cast<std::size_t>(num_seeds / 4));
    // Bodies of one or two tetrahedra that are smaller than the tool, or cut to small pieces.
    EXPECT_LE(num_deep, static_cast<std::size_t>(num_seeds / 20 + (test::is_sanitized ? 3 : 0)));
    EXPECT_GT(fracture_energy, 0.0);
    EXPECT_GT(num_edits, static_cast<std::size_t>(num_seeds));
    EXPECT_GT(num_touched, 30u * static_cast<std::size_t>(num_seeds));
}

INSTANTIATE_TEST_SUITE_P(Contact, TouchingPrograms, testing::Range(0, num_parts));

// In a new world, or in one that has gone on since and goes back; on one thread and on two.
TEST(TouchingProgram, GoesOnBitForBitAfterARestore) {
    for (int seed = 0; seed < test::num_cases(60); ++seed) {
        SCOPED_TRACE(seed);
        const auto number = static_cast<std::uint64_t>(seed);
        TouchingProgram straight(number), halted(number);
        for (int i = 0; i < TouchingProgram::num_steps; ++i) {
            straight.step(i);
            halted.step(i);
            if (i % 70 != 69) continue;
            const std::string bytes = halted.world().save();
            if (seed % 2 == 0)
                halted.world() = TouchingProgram::empty_world(number);
            else
                for (int k = 0; k < 5; ++k) halted.world().step(0.8 * halted.world().stable_step());
            halted.world().restore(bytes);
            halted.world().set_num_threads(2);
        }
        EXPECT_EQ(straight.world().save(), halted.world().save());
    }
}

}  // namespace
}  // namespace incise::sim
