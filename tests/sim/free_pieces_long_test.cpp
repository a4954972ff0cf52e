// Cubes that three planes cut while they are stretched, let go without damping.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "incise/cutting/cutter.h"
#include "incise/sim/world.h"
#include "support/mesh_families.h"
#include "support/present_energy.h"

namespace incise::sim {
namespace {

/// A cube of 750 elements, drawn out by a tenth, held so, and cut along three planes.
World stretched_and_cut(double jitter, std::uint64_t seed) {
    const Vec3 stretch(1.1, 0.95, 0.95);
    constexpr double drawn_at = 0.1, held_until = 0.15;  // s
    WorldDef def;
    topology::Mesh mesh = topology::Mesh::build(test::jittered_cube(5, jitter, seed)).mesh;
    for (const VertexId n : mesh.nodes()) {
        physics::Constraint drawn{.name = "drawn"};
        drawn.nodes = physics::VertexSet({n});
        drawn.displacement = physics::TimeCurve<Vec3>(
            {{0.0, Vec3::Zero()},
             {drawn_at, (stretch - Vec3::Ones()).cwiseProduct(mesh.rest_position(n))}});
        def.constraints.push_back(std::move(drawn));
    }
    def.mesh = std::move(mesh);
    def.contact.enabled = false;  // it takes energy where pieces meet
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1.5e3, 4e3}}}};
    World world(std::move(def));
    while (world.time() < held_until) world.step_to(std::min(held_until, world.time() + 0.01));
    test::Random random(seed);
    StepInputs inputs;
    for (int i = 0; i < 3; ++i) {
        const Vec3 point = Vec3::Constant(0.5) + random.vector(0.15);
        const Vec3 normal = random.vector(1.0);
        const ToolId knife =
            world.add_tool({"knife", cutting::PlaneCut{point.cwiseProduct(stretch), normal}});
        inputs.move(knife, Pose()).withdraw(knife);
    }
    world.step(1e-6, inputs);
    while (!world.constraints().empty()) world.release(world.constraints()[0]);
    return world;
}

class FreePieces : public testing::TestWithParam<int> {};

TEST_P(FreePieces, KeepTheirEnergy) {
    constexpr int num_steps = 100'000;
    for (int seed = GetParam(); seed < GetParam() + 5; ++seed) {
        const double jitter = 0.1 * (seed % 3);
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", jitter " << jitter);
        World world = stretched_and_cut(jitter, static_cast<std::uint64_t>(seed));
        double start = 0.0, third = 0.0, last = 0.0;  // sums over fifths of the run
        for (int i = 0; i < num_steps; ++i) {
            const double dt = 0.8 * world.stable_step();
            ASSERT_NO_THROW(world.step(dt));
            if (i % 50 != 0) continue;
            const double now = test::present_energy(world.model(), dt);
            if (i == 0) start = now;
            const int fifth = 5 * i / num_steps;
            if (fifth == 2) third += now;
            if (fifth == 4) last += now;
            ASSERT_NEAR(now, start, 0.02 * start) << "step " << i;
        }
        constexpr double num_samples = num_steps / 5.0 / 50.0;
        EXPECT_NEAR(third / num_samples, last / num_samples, 1e-3 * start);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FreePieces, testing::Values(0, 5, 10, 15));

}  // namespace
}  // namespace incise::sim
