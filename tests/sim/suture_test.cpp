// Threads through the tissue of a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

constexpr double gap = 0.2 * size;  // between the two cubes, m

/// Two free cubes of soft tissue side by side.
WorldDef two_cubes(topology::CellKind kind = topology::CellKind::tetrahedron) {
    WorldDef def = soft_body();
    def.gravity.setZero();
    def.damping = 0.0;
    topology::MeshData body =
        topology::box_mesh(kind, Vec3::Zero(), Vec3::Constant(size), {3, 3, 3});
    const topology::MeshData one = body;
    const auto num_points = static_cast<std::int64_t>(one.points.size());
    for (const Vec3& x : one.points) body.points.push_back(x + Vec3(size + gap, 0, 0));
    for (std::size_t c = 0; c < one.num_cells(); ++c) {
        std::vector<std::int64_t> corners(one.cell(c).begin(), one.cell(c).end());
        for (std::int64_t& corner : corners) corner += num_points;
        body.add_cell(one.kinds[c], corners);
    }
    def.mesh = body;
    if (kind == topology::CellKind::hexahedron)
        def.materials = {{1000.0, physics::HybridSprings{200.0, 600.0}}};
    return def;
}

/// A thread from the middle of one cube to that of the other, 0.4 sizes above the floor.
cutting::Suture thread(double stiffness = 20.0,
                       double max_force = std::numeric_limits<double>::infinity()) {
    return {{{0.8 * size, 0.45 * size, 0.4 * size}, {1.4 * size, 0.5 * size, 0.45 * size}},
            stiffness,
            max_force};
}

double tension_of(const World& world) { return world.report().tools.at(0).force.norm(); }

/// Draws a thread to a length while the world makes some steps. Returns the largest tension.
/// @param inputs  what else happens in the first step
double draw(World& world, ToolId suture, double length, int num_steps, StepInputs inputs = {}) {
    const double from = world.suture_length(suture);
    double largest = 0.0;
    for (int i = 1; i <= num_steps; ++i, inputs.clear()) {
        inputs.draw(suture, from + (length - from) * i / num_steps);
        world.step(0.8 * world.stable_step(), inputs);
        largest = std::max(largest, tension_of(world));
    }
    return largest;
}

double way_of(World& world, const cutting::Suture& suture) {
    double sum = 0.0;
    std::vector<Vec3> points;
    for (const Vec3& x : suture.points) {
        const auto rest = world.mesh().rest_positions();
        points.push_back(
            topology::find_point(world.mesh(), rest, x, 1e-9).value().position(world.positions()));
    }
    for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
    return sum;
}

class SutureOn : public testing::TestWithParam<topology::CellKind> {};

TEST_P(SutureOn, AnyMeshDrawsTwoBodiesTogetherAndKeepsTheirMomentum) {
    World world(two_cubes(GetParam()));
    const ToolId suture = world.add_tool({"thread", thread()});
    EXPECT_EQ(world.tie_suture(suture), 2u);
    EXPECT_NEAR(world.suture_length(suture), way_of(world, thread()), 1e-15);
    world.step(0.8 * world.stable_step());
    EXPECT_LT(tension_of(world), 1e-15);  // it is as long as its way
    EXPECT_GT(draw(world, suture, 0.45 * size, 150), 1e-3);
    const physics::Totals totals = world.ledger().body_totals().totals;
    double scale = 0.0, mass = 0.0;
    for (const VertexId n : world.mesh().nodes()) {
        const double m = world.masses()[n.index()];
        mass += m;
        scale += m * world.velocities()[n.index()].norm();
    }
    EXPECT_GT(scale, 1e-4 * mass);
    EXPECT_LE(totals.momentum.norm(), 1e-13 * scale);
    EXPECT_LE(totals.angular_momentum.norm(), 1e-12 * scale * size);
    EXPECT_LT(way_of(world, thread()), 0.6 * size);
}

INSTANTIATE_TEST_SUITE_P(Contact, SutureOn,
                         testing::Values(topology::CellKind::tetrahedron,
                                         topology::CellKind::hexahedron));

/// The two cubes, each held at its outer side, with damping.
World held_cubes() {
    WorldDef def = two_cubes();
    def.damping = 40.0;
    World world(std::move(def));
    world.add_constraint(
        {.name = "sides", .nodes = physics::VertexSet(nodes_where(world, [](const Vec3& x) {
                              return x.x() < 1e-9 || x.x() > 2 * size + gap - 1e-9;
                          }))});
    return world;
}

TEST(Suture, AtRestBearsItsStiffnessTimesItsStretch) {
    for (const double stiffness : {2.0, 2e9}) {
        World world = held_cubes();
        const ToolId suture = world.add_tool({"thread", thread(stiffness)});
        world.tie_suture(suture);
        draw(world, suture, 0.55 * size, 400);
        draw(world, suture, 0.55 * size, 1500);
        const double stretch = way_of(world, thread()) - 0.55 * size;
        EXPECT_GT(tension_of(world), 1e-3);
        if (stiffness < 1e3) {
            EXPECT_NEAR(tension_of(world), stiffness * stretch, 1e-3 * tension_of(world));
        } else {
            EXPECT_NEAR(stretch, 0.0, 1e-6 * size);
        }
        EXPECT_LT(world.ledger().energy_error(), 0.02);
    }
}

/// Two held cubes that do not touch each other.
World held_cubes_apart(double damping) {
    WorldDef def = two_cubes();
    def.damping = damping;
    def.contact.self = false;
    World world(std::move(def));
    world.add_constraint(
        {.name = "sides", .nodes = physics::VertexSet(nodes_where(world, [](const Vec3& x) {
                              return x.x() < 1e-9 || x.x() > 2 * size + gap - 1e-9;
                          }))});
    return world;
}

/// A thread that passes from one cube to the other and back.
cutting::Suture zigzag(std::size_t num_points, double stiffness, double height = 0.8) {
    cutting::Suture suture{{}, stiffness};
    for (std::size_t i = 0; i < num_points; ++i) {
        const double y = 0.2 + 0.6 * static_cast<double>(i) / static_cast<double>(num_points - 1);
        suture.points.push_back({(i % 2 == 0 ? 0.8 : 1.4) * size, y * size, height * size});
    }
    return suture;
}

// A segment whose ends meet has no direction, and a short one is stiff against motion across it.
TEST(Suture, DrawnToNothingComesToRest) {
    for (const std::size_t num_points : {2u, 3u, 6u, 20u})
        for (const double stiffness : {1.0, 1e3, 1e5}) {
            SCOPED_TRACE(std::to_string(num_points) + " points, " + std::to_string(stiffness));
            World world = held_cubes_apart(20.0);
            const ToolId suture = world.add_tool({"thread", zigzag(num_points, stiffness)});
            const ToolId other = world.add_tool({"other", zigzag(3, stiffness, 0.7)});
            for (const ToolId one : {suture, other}) world.tie_suture(one);
            draw(world, suture, 0.0, 200, StepInputs().draw(other, 0.3 * size));
            run_until(world, world.time() + 2.0);
            const physics::Totals totals = world.ledger().body_totals().totals;
            EXPECT_GT(totals.elastic_energy, 1e-4);
            EXPECT_LT(totals.kinetic_energy, 1e-8 * totals.elastic_energy);
        }
}

// Drawn together, faces of a cut press each other in a few places, and nodes are at the edge of two
// triangles. Pushed out of either in turn, they would keep the body in motion.
TEST(Suture, DrawsACutTogetherThatComesToRest) {
    for (const double stiffness : {300.0, 1000.0}) {
        SCOPED_TRACE(stiffness);
        const Vec3 edges(0.06, 0.04, 0.02);
        WorldDef def;
        def.mesh =
            topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), edges, {6, 4, 2});
        def.materials = {
            {1000.0, physics::HyperElasticLinks{physics::NeoHookean{3571.0, 28571.0}}}};
        def.damping = 40.0;
        def.contact.friction = 0.3;
        World world(std::move(def));
        world.add_constraint(
            {.name = "sides", .nodes = physics::VertexSet(nodes_where(world, [&](const Vec3& x) {
                                  return x.x() == 0.0 || x.x() == edges.x();
                              }))});
        const StepInputs cut = cut_along(world, {0.0303, 0.0, 0.0}, Vec3::UnitX());
        cutting::Suture thread{{}, stiffness};
        for (int i = 0; i < 6; ++i)
            thread.points.push_back({i % 2 == 0 ? 0.024 : 0.036, 0.01 * (1 + i / 2), 0.018});
        const ToolId suture = world.add_tool({"thread", thread});
        world.step(0.8 * world.stable_step(), cut);
        world.tie_suture(suture);
        draw(world, suture, 0.0, 1500);
        run_until(world, 1.4);
        EXPECT_GT(world.ledger().body_totals().totals.elastic_energy, 1e-2);
        EXPECT_LT(world.ledger().body_totals().totals.kinetic_energy, 1e-10);
    }
}

TEST(Suture, NeverAddsEnergy) {
    for (const double stiffness : {1.0, 1e3, 1e5}) {
        SCOPED_TRACE(stiffness);
        const cutting::Suture thread = zigzag(6, stiffness);
        World world = held_cubes_apart(0.0);
        const ToolId suture = world.add_tool({"thread", thread});
        world.tie_suture(suture);
        draw(world, suture, 0.0, 50);
        const auto energy = [&] {
            const physics::Totals totals = world.ledger().body_totals().totals;
            const double length = way_of(world, thread);
            return totals.kinetic_energy + totals.elastic_energy +
                   0.5 * stiffness * length * length;
        };
        const double at_first = energy();
        for (int i = 0; i < 1000; ++i) {
            world.step(0.8 * world.stable_step());
            ASSERT_LT(energy(), 1.001 * at_first) << i;
        }
    }
}

TEST(Suture, ThatIsSlackExertsNothing) {
    World world = held_cubes();
    const ToolId suture = world.add_tool({"thread", thread()});
    world.tie_suture(suture);
    draw(world, suture, size, 20);
    EXPECT_EQ(tension_of(world), 0.0);
    for (const VertexId n : world.mesh().nodes())
        ASSERT_LT((world.positions()[n.index()] - world.mesh().rest_position(n)).norm(),
                  1e-14 * size);
}

TEST(Suture, TearsAtItsLargestForce) {
    World world = held_cubes();
    const ToolId suture = world.add_tool({"thread", thread(20.0, 0.01)});
    world.tie_suture(suture);
    EXPECT_NEAR(draw(world, suture, 0.12 * size, 400), 0.01, 1e-5);
    EXPECT_FALSE(world.is_suture_tied(suture));
    EXPECT_EQ(tension_of(world), 0.0);
}

// The points stay where they are in the material, whatever is cut there.
TEST(Suture, FollowsTheMaterialThroughCuts) {
    World world = held_cubes();
    const ToolId suture = world.add_tool({"thread", thread()});
    world.tie_suture(suture);
    const ToolId plane = world.add_tool(
        {"plane", cutting::PlaneCut{{0.8 * size, 0.45 * size, 0.405 * size}, {0.1, 0.2, 1.0}}});
    draw(world, suture, 0.58 * size, 20, StepInputs().move(plane, Pose()).withdraw(plane));
    ASSERT_EQ(world.ledger().num_edits(), 1u);
    draw(world, suture, 0.58 * size, 2000);
    EXPECT_TRUE(world.is_suture_tied(suture));
    const double stretch = way_of(world, thread()) - 0.58 * size;
    EXPECT_GT(stretch, 0.0);
    EXPECT_NEAR(tension_of(world), 20.0 * stretch, 1e-2 * tension_of(world));
}

TEST(Suture, LosesPointsWhoseTissueIsRemoved) {
    World world = held_cubes();
    const ToolId suture = world.add_tool({"thread", thread()});
    world.tie_suture(suture);
    const ToolId burr = world.add_tool({"burr", cutting::Carver{cutting::Sphere{0.2 * size}}});
    world.place_tool(burr, at(thread().points[0]));
    world.step(0.8 * world.stable_step());
    EXPECT_FALSE(world.is_suture_tied(suture));
    draw(world, suture, 0.1 * size, 10);
    EXPECT_EQ(tension_of(world), 0.0);
}

TEST(Suture, ReachesForTissueNearItsPoints) {
    World world(two_cubes());
    cutting::Suture far = thread();
    far.points[0] = {0.5 * size, 0.5 * size, size + 0.004};
    far.reach = 0.005;
    far.points[1] = {0.5 * size, 0.5 * size, size + 0.006};
    const ToolId suture = world.add_tool({"thread", far});
    EXPECT_EQ(world.tie_suture(suture), 1u);
    EXPECT_FALSE(world.is_suture_tied(suture));
    EXPECT_NO_THROW(world.step(0.8 * world.stable_step()));
}

TEST(Suture, GoesOnBitForBitAfterARestore) {
    World world = held_cubes();
    const ToolId suture = world.add_tool({"thread", thread()});
    world.tie_suture(suture);
    draw(world, suture, 0.5 * size, 60);
    World other(two_cubes());
    other.restore(world.save());
    for (World* one : {&world, &other}) draw(*one, suture, 0.45 * size, 60);
    EXPECT_EQ(world.save(), other.save());
    EXPECT_GT(tension_of(other), 0.0);
}

TEST(Suture, RefusesWhatItCannotDo) {
    World world(two_cubes());
    const auto refusal_of = [&](cutting::Suture suture) {
        return input_error_of([&] { world.add_tool({"thread", std::move(suture)}); });
    };
    cutting::Suture one_point = thread();
    one_point.points.pop_back();
    EXPECT_NE(refusal_of(one_point).find("at least 2 points"), std::string::npos);
    EXPECT_NE(refusal_of(thread(0.0)).find("stiffness is 0"), std::string::npos);
    EXPECT_NE(refusal_of(thread(1.0, 0.0)).find("largest force is 0"), std::string::npos);
    const ToolId suture = world.add_tool({"thread", thread()});
    EXPECT_NE(input_error_of([&] {
                  world.require_possible(StepInputs().move(suture, Pose()));
              }).find("has no pose"),
              std::string::npos);
    EXPECT_NE(input_error_of([&] {
                  world.require_possible(StepInputs().draw(suture, 0.1));
              }).find("not tied"),
              std::string::npos);
    WorldDef without = two_cubes();
    without.contact.enabled = false;
    World lonely(std::move(without));
    EXPECT_NE(input_error_of([&] {
                  lonely.add_tool({"thread", thread()});
              }).find("needs"),
              std::string::npos);
}

}  // namespace
}  // namespace incise::sim
