// Coulomb's friction in contact: blocks on slopes, wedges, and inclined cuts. Friction makes
// elastic bodies vibrate: the blocks are viscous, so that they move as rigid ones do. Sources:
// NAFEMS CGS-4 (code_aster V6.04.167); statics of a block on a slope. SPDX-License-Identifier:
// LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "support/num_cases.h"
#include "tests/sim/contact_answers.h"

namespace incise::sim {
namespace {

constexpr double gravity = 9.81;  // m/s2
constexpr Solid block_solid{.young = 2e5, .poisson = 0.2, .relaxation_time = 0.0005};

/// The acceleration of a block on a slope, over gravity, and its velocity at the end, m/s.
struct SlideOnSlope {
    double acceleration, velocity;
};

/// The slope is level here, and gravity is oblique.
SlideOnSlope slide_down(double slope, double friction) {
    WorldDef def;
    def.mesh = box(Vec3::Zero(), {0.04, 0.04, 0.02}, {4, 4, 2});
    def.materials = {block_solid};
    const double angle = std::atan(slope);
    def.gravity = gravity * Vec3(std::sin(angle), 0.0, -std::cos(angle));
    World world(std::move(def));
    const ToolId table = world.add_tool({"table", cutting::Probe{cutting::HalfSpace{}, friction}});
    world.place_tool(table, Pose());
    const auto all = elements_where(world, [](const Vec3&) { return true; });
    const auto velocity = [&] { return mean_motion(world, all, block_solid.density).velocity.x(); };
    run_until(world, 0.1);
    const double from = world.time(), before = velocity();
    run_until(world, 0.25);
    return {(velocity() - before) / (world.time() - from) / gravity, velocity()};
}

TEST(ContactFriction, OfABlockOnASlopeIsCoulombs) {
    constexpr double friction = 0.4;
    constexpr std::array slopes{0.6, 0.42, 0.41, 1.0};
    for (const double slope : test::some_of(slopes)) {
        const double angle = std::atan(slope);
        const std::string what = "slope " + short_text(slope);
        const double with = slide_down(slope, friction).acceleration;
        const double without = slide_down(slope, 0.0).acceleration;
        expect_answer("C9 " + what + ", friction 0.4: a/g", with,
                      std::sin(angle) - friction * std::cos(angle), 1e-3);
        expect_answer("C9 " + what + ", friction 0: a/g", without, std::sin(angle), 1e-3);
        record_point("incline friction 0.4", slope, with);
        record_point("incline friction 0", slope, without);
    }
    constexpr std::array flat_slopes{0.38, 0.2, 0.39};
    for (const double slope : test::some_of(flat_slopes)) {
        const SlideOnSlope still = slide_down(slope, friction);
        EXPECT_NEAR(still.acceleration, 0.0, 1e-6);
        EXPECT_NEAR(still.velocity, 0.0, 1e-9);
        record_point("incline friction 0.4", slope, still.acceleration);
    }
}

/// A block on a table of friction 0.4, whose slope grows slowly, so that nothing else shakes it. As
/// above, it is gravity that turns.
World slowly_tilted(double degrees) {
    constexpr Solid solid{.young = 1e5, .poisson = 0.3};
    WorldDef def;
    def.mesh = box(Vec3::Zero(), {0.04, 0.04, 0.02}, {4, 4, 2});
    physics::Material material = solid;
    std::get<physics::HyperElasticLinks>(material.method).prony = {{0.4, 0.003}};
    def.materials = {material};
    World world(std::move(def));
    const double angle = degrees * std::numbers::pi / 180.0;
    const auto pull = [&](const Vec3& force, double from, double to) {
        const auto all = elements_where(world, [](const Vec3&) { return true; });
        world.add_load(
            {.name = "gravity",
             .kind = physics::BodyLoad{physics::CellSet(all), solid.density * gravity * force},
             .factor = physics::TimeCurve<double>({{from, 0.0}, {to, 1.0}})});
    };
    pull(-std::cos(angle) * Vec3::UnitZ(), 0.0, 0.15);
    pull(std::sin(angle) * Vec3::UnitX(), 0.2, 0.8);
    const ToolId table = world.add_tool({"table", cutting::Probe{cutting::HalfSpace{}, 0.4}});
    world.place_tool(table, Pose());
    return world;
}

TEST(ContactFriction, HoldsASlowlyTiltedBlock) {
    World world = slowly_tilted(21.7);  // it slides from 21.80 degrees
    run_until(world, 1.2);
    EXPECT_LT(world.ledger().body_totals().totals.momentum.norm(), 1e-9);
}

// A block that slides steadily is unstable: friction couples its swaying with its bouncing, and
// they grow. The numbers are an eigenvalue of the linear model, by
//     data/validation/friction_flutter.py 4 4 2 22.2 0.008
TEST(ContactFriction, SlidingFluttersAsItsEigenvaluesTell) {
    constexpr double frequency = 102.3, growth = 11.0;  // Hz, 1/s
    constexpr double window = 5.0 / frequency, delay = 0.06;
    World world = slowly_tilted(22.2);
    run_until(world, 0.84);
    const double from = world.time();
    std::array<std::complex<double>, 2> sums{};
    while (world.time() < from + window + delay) {
        world.step(2e-4);
        const double momentum = world.ledger().body_totals().totals.momentum.z();
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const double t = world.time() - from - delay * static_cast<double>(k);
            if (t < 0.0 || t > window) continue;
            const double hann = 1.0 - std::cos(2.0 * std::numbers::pi * t / window);
            sums[k] += hann * momentum * std::polar(1.0, -2.0 * std::numbers::pi * frequency * t);
        }
    }
    EXPECT_NEAR(std::log(std::abs(sums[1] / sums[0])) / delay, growth, 1.5);
}

/// Moves nodes along x with a constant velocity.
void push_along_x(World& world, double speed, const Part& part) {
    physics::Constraint push{.name = "push"};
    push.nodes = physics::VertexSet(nodes_where(world, part));
    push.components = {true, false, false};
    push.displacement =
        physics::TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, speed * Vec3::UnitX()}});
    world.add_constraint(std::move(push));
}

/// The force along x of the last constraint in steady motion, over a weight. It begins with a jerk.
double steady_push(World& world, std::size_t constraint, double mass) {
    run_until(world, 0.1);
    return mean_until(world, 0.15,
                      [&] { return world.reaction(world.constraints()[constraint]).force.x(); }) /
           (gravity * mass);
}

constexpr double wedge_slope = 0.1;
double wedge_force(double friction) {
    return (wedge_slope + friction) / (1.0 - wedge_slope * friction);
}

/// The horizontal force that pushes a block up a rigid slope, over its weight.
double push_up_a_rigid_slope(double friction) {
    WorldDef def;
    topology::MeshData mesh = box(Vec3::Zero(), {0.04, 0.02, 0.02}, {4, 2, 2});
    const Eigen::AngleAxisd turn(-std::atan(wedge_slope), Vec3::UnitY());
    for (Vec3& x : mesh.points) x = turn * x;
    def.mesh = std::move(mesh);
    def.materials = {block_solid};
    def.gravity = -gravity * Vec3::UnitZ();
    World world(std::move(def));
    const ToolId slope = world.add_tool(
        {"slope", cutting::Probe{cutting::HalfSpace{.normal = turn * Vec3::UnitZ()}, friction}});
    world.place_tool(slope, Pose());
    push_along_x(world, 0.01, [&](const Vec3& x) { return (turn.inverse() * x).x() < 1e-9; });
    return steady_push(world, 0, world.model().energetics().totals().mass);
}

/// The same for a wedge and a block that are cut from one body.
double push_up_a_cut(double friction) {
    constexpr Solid solid{.young = 2e6, .poisson = 0.2, .relaxation_time = 1.6e-4};
    constexpr double width = 0.02, length = 0.04;  // m
    WorldDef def;
    def.mesh = box(Vec3::Zero(), {length, width, length}, {4, 2, 4});
    def.materials = {solid};
    def.gravity = -gravity * Vec3::UnitZ();
    def.contact.friction = friction;
    World world = held(World(std::move(def)));
    const Vec3 point(0.02, 0.01, 0.0195), normal(-wedge_slope, 0.0, 1.0);
    world.step(0.8 * world.stable_step(), cut_along(world, point, normal));
    const auto block =
        elements_where(world, [&](const Vec3& x) { return (x - point).dot(normal) > 0.0; });
    push_along_x(world, 0.005, [](const Vec3& x) { return x.x() < 1e-9 && x.z() > 0.02; });
    return steady_push(world, 1, mean_motion(world, block, solid.density).mass);
}

TEST(ContactFriction, OfAWedgeUnderLoadIsThatOfNafems) {
    constexpr std::array frictions{0.2, 0.0, 0.1, 0.3};
    for (const double friction : frictions) {
        const double rigid = push_up_a_rigid_slope(friction);
        expect_answer("C8 rigid wedge, friction " + short_text(friction) + ": F/G", rigid,
                      wedge_force(friction), 1e-3);
        record_point("wedge rigid", friction, rigid);
    }
    for (const double friction : test::some_of(frictions)) {
        const double cut = push_up_a_cut(friction);
        expect_answer("C8 cut wedge, friction " + short_text(friction) + ": F/G", cut,
                      wedge_force(friction), 1e-3);
        record_point("wedge cut", friction, cut);
    }
}

/// How far the upper part of a block that an inclined cut divides slips under a pressure, m. There
/// is no Poisson's effect, so that the stress is the same everywhere.
double slip_of_a_cut(double slope, double friction) {
    constexpr double edge = 0.04, height = 0.08, pressure = 1000.0;
    constexpr Solid solid{.young = 1e6, .relaxation_time = 5e-4};
    WorldDef def;
    def.mesh = box(Vec3::Zero(), {edge, edge, height}, {3, 3, 6});
    def.materials = {solid};
    def.contact.friction = friction;
    World world = held(World(std::move(def)));
    const Vec3 point(0.02, 0.02, 0.034), normal(-slope, 0.0, 1.0);
    world.step(0.8 * world.stable_step(), cut_along(world, point, normal));
    physics::Load load{.name = "pressure"};
    load.kind = physics::TractionLoad{
        physics::FaceSet(faces_where(world, [](const Vec3& x) { return x.z() > height - 1e-9; })),
        -pressure * Vec3::UnitZ()};
    load.factor = physics::TimeCurve<double>({{0.0, 0.0}, {0.05, 1.0}});
    world.add_load(std::move(load));
    run_until(world, 0.15);
    const auto upper =
        elements_where(world, [&](const Vec3& x) { return (x - point).dot(normal) > 0.0; });
    return std::abs(mean_motion(world, upper, solid.density).displacement.x());
}

TEST(ContactFriction, OfAnInclinedCutHoldsUpToItsSlope) {
    constexpr std::array slopes{0.3, 0.1, 0.6};
    for (const double slope : test::some_of(slopes)) {
        SCOPED_TRACE(testing::Message() << "slope " << slope);
        const double holds = slip_of_a_cut(slope, slope + 0.005);
        const double slips = slip_of_a_cut(slope, slope - 0.005);
        EXPECT_LT(holds, 1e-5);
        EXPECT_GT(slips, 1e-4);
        EXPECT_GT(slip_of_a_cut(slope, 0.0), 1e-2);
        record_result("C12 slope " + short_text(slope) + ", friction 0.005 above: slip, m", holds,
                      0.0);
        record_result("C12 slope " + short_text(slope) + ", friction 0.005 below: slip, m", slips,
                      INFINITY);
    }
}

}  // namespace
}  // namespace incise::sim
