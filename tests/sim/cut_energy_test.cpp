// Energy across a cut of boxes with hybrid springs, which become cells of HEML.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "incise/physics/elements/spectrum.h"
#include "incise/sim/world.h"
#include "support/fragment_shape.h"
#include "support/mesh_families.h"
#include "tests/physics/balance.h"

namespace incise::sim {
namespace {

using physics::HybridSprings;
using test::Bricks;

/// What a run of a world has made of energy: what comes in less what goes out, J.
struct EnergyRun {
    double missing, jump, kept;
    double of_divided;  ///< elastic energy before the cut of the cells that it divides
};

/// Draws a block of hybrid springs out by `stretch`, cuts it, and lets it swing without damping.
EnergyRun run_with_cut(double stretch, double stiffness_ratio, int n) {
    WorldDef def;
    def.mesh = test::brick_cube(Bricks::hexahedra, n, 0.0, 1);
    def.materials = {{1000.0, HybridSprings{3e3, 1e4, stiffness_ratio}}};
    World world(std::move(def));
    const auto end = [&](double x) {
        return physics::VertexSet(physics::nodes_where(
            world.mesh(), [&](const Vec3& X) { return std::abs(X.x() - x) < 1e-9; }));
    };
    world.add_constraint({.name = "left", .nodes = end(0.0)});
    physics::Constraint drawn{.name = "right", .nodes = end(1.0)};
    drawn.displacement =
        physics::TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {2.0, stretch * Vec3::UnitX()}});
    world.add_constraint(drawn);
    world.set_damping(2.0);
    while (world.time() < 3.0) world.step(0.5 * world.stable_step());
    world.set_damping(0.0);

    EnergyRun run{};
    std::vector<double> energies(world.model().fragments().element_capacity());
    for (const ElementId e : world.model().fragments().elements())
        energies[e.index()] = world.model().element_result(e).energy;
    const ToolId plane = world.add_tool(
        {"plane", cutting::PlaneCut{Vec3(0.5 * (1.0 + stretch), 0.52, 0.5), Vec3(0.4, 1.0, 0.3)}});
    const double dt = 0.25 * world.stable_step();
    const BodyTotals start = world.ledger().body_totals();
    const StepReport& report = world.step(dt, StepInputs().move(plane, Pose()).withdraw(plane));
    EXPECT_EQ(report.edits.size(), 1u);
    const EditRecord edit = report.edits.at(0).record;
    const auto& fragments = world.model().fragments();
    for (const ElementId e : fragments.elements())
        if (e.index() < energies.size() && test::is_divided(fragments, e))
            run.of_divided += energies[e.index()];
    run.jump = edit.after.totals.elastic_energy - edit.before.totals.elastic_energy;
    EXPECT_NEAR(edit.before.totals.mass, edit.after.totals.mass, 1e-12 * edit.after.totals.mass);
    EXPECT_EQ(edit.before.external_work, edit.after.external_work);
    while (world.time() < 4.0) world.step(dt);

    const auto energy = [](const physics::Totals& totals) {
        return totals.kinetic_energy + totals.elastic_energy;
    };
    const BodyTotals now = world.ledger().body_totals();
    const double removed = energy(edit.before.totals) - energy(edit.after.totals);
    run.kept = energy(now.totals);
    run.missing = energy(start.totals) + (now.external_work - start.external_work) -
                  (now.dissipated_energy - start.dissipated_energy) - removed - run.kept;
    EXPECT_LE(world.ledger().energy_error(), 0.01);
    return run;
}

// The energy that the conversion of divided cells takes or gives is in the record of the cut, and
// with it the sum of all energies balances. It is a small part of theirs, which vanishes at rest.
TEST(CutEnergy, OfHybridSpringsBalanceTheirEnergyAcrossACut) {
    for (const double ratio : {1.0, std::numeric_limits<double>::infinity()}) {
        SCOPED_TRACE(ratio);
        std::vector<double> jumps;
        for (const double stretch : {0.0, 0.1, 0.2}) {
            const EnergyRun run = run_with_cut(stretch, ratio, 4);
            jumps.push_back(std::abs(run.jump));
            if (stretch == 0.0) continue;
            EXPECT_LE(std::abs(run.missing), 4e-3 * run.kept);  // by the length of steps
            EXPECT_LE(std::abs(run.jump), 0.2 * run.of_divided);
            EXPECT_GT(std::abs(run.jump), 5.0 * std::abs(run.missing));
        }
        EXPECT_LE(jumps[0], 1e-12);
    }
}

}  // namespace
}  // namespace incise::sim
