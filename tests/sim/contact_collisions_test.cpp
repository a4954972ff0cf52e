// Contact in motion: bars against waves, and what a collision keeps.
// Sources: one-dimensional waves; Doyen, Ern, Piperno 2011 for the bar that bounces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/num_cases.h"
#include "support/present_energy.h"
#include "tests/sim/contact_answers.h"

namespace incise::sim {
namespace {

constexpr double bar_length = 0.1, bar_area = 4e-6, bar_speed = 0.01;  // m, m2, m/s
constexpr Solid bar_solid{.young = 1e5};
constexpr double bar_mass = bar_solid.density * bar_length * bar_area;

/// A bar along x, without Poisson's effect: waves in it have one dimension.
World bar(double length, int cells, double gravity = 0.0) {
    WorldDef def;
    const double width = std::sqrt(bar_area);
    def.mesh = box(Vec3::Zero(), {length, width, width}, {cells, 2, 2});
    def.materials = {bar_solid};
    def.gravity = -gravity * Vec3::UnitX();
    return World(std::move(def));
}

/// Waves lag behind in few elements.
constexpr double bar_tolerance = test::is_sanitized ? 0.05 : 0.01;

double wave_speed() { return std::sqrt(bar_solid.young / bar_solid.density); }
double contact_time() { return 2.0 * bar_length / wave_speed(); }
double wave_pressure(double speed) { return bar_solid.density * wave_speed() * speed; }

std::vector<CellId> all_of(const World& world) {
    return elements_where(world, [](const Vec3&) { return true; });
}

ToolId add_wall(World& world, bool is_there = true) {
    const ToolId wall =
        world.add_tool({"wall", cutting::Probe{cutting::HalfSpace{.normal = Vec3::UnitX()}}});
    if (is_there) world.place_tool(wall, Pose());
    return wall;
}

// One half flies at the other one, which rests.
TEST(ContactCollisions, EqualBarsCutFromOneSwapVelocities) {
    const int cells = test::num_cases(120);
    World world = bar(2.0 * bar_length, 2 * cells);
    const double dt = 0.5 * world.rest_stable_step();
    world.step(dt, cut_along(world, {bar_length, 0, 0}, Vec3::UnitX()));
    const auto left = elements_where(world, [](const Vec3& x) { return x.x() < bar_length; });
    const auto right = elements_where(world, [](const Vec3& x) { return x.x() > bar_length; });
    const auto velocity = [&](const std::vector<CellId>& of) {
        return mean_motion(world, of, bar_solid.density).velocity.x();
    };
    const double start = world.time();
    launch(world, left, bar_solid.density, bar_speed * Vec3::UnitX(), dt);
    const double given = 0.5 * bar_mass * bar_speed * bar_speed;
    double least = given;
    const auto run_to = [&](double part) {
        while (world.time() < start + part * contact_time()) {
            world.step(dt);
            const double energy = test::present_energy(world.model(), dt);
            EXPECT_LT(energy, least + 3e-4 * given);
            least = std::min(least, energy);
        }
    };
    run_to(0.25);
    const double early = velocity(right);
    run_to(0.75);
    const double pressure =
        (velocity(right) - early) * bar_mass / (0.5 * contact_time()) / bar_area;
    run_to(1.5);
    EXPECT_EQ(world.report().contact.num_points, 0u);
    EXPECT_NEAR(world.model().energetics().totals().momentum.x(), bar_mass * bar_speed,
                1e-13 * bar_mass * bar_speed);
    expect_answer("C10 equal bars: velocity of the other one, m/s", velocity(right), bar_speed,
                  bar_tolerance);
    EXPECT_NEAR(velocity(left), 0.0, bar_tolerance * bar_speed);
    expect_answer("C10 equal bars: pressure, Pa", pressure, wave_pressure(0.5 * bar_speed),
                  bar_tolerance);
    expect_answer("C10 equal bars: duration, s", velocity(right) * bar_mass / bar_area / pressure,
                  contact_time(), bar_tolerance);
}

TEST(ContactCollisions, BarThatHitsAWallBouncesAsAWaveDoes) {
    World world = bar(bar_length, test::num_cases(320));
    const ToolId wall = add_wall(world);
    const double dt = 0.5 * world.rest_stable_step();
    const auto all = all_of(world);
    launch(world, all, bar_solid.density, -bar_speed * Vec3::UnitX(), dt);
    double impulse = 0.0, impulse_between = 0.0, time_between = 0.0, last_touch = 0.0;
    while (world.time() < 1.5 * contact_time()) {
        world.step(dt);
        const double force = -world.report().tools[wall.index].force.x();
        impulse += force * dt;
        if (force > 0.0) last_touch = world.time();
        if (world.time() > 0.25 * contact_time() && world.time() < 0.75 * contact_time()) {
            impulse_between += force * dt;
            time_between += dt;
        }
    }
    const double force = impulse_between / time_between;
    expect_answer("C10 wall: pressure, Pa", force / bar_area, wave_pressure(bar_speed),
                  bar_tolerance);
    expect_answer("C10 wall: duration, impulse over force, s", impulse / force, contact_time(),
                  bar_tolerance);
    expect_answer("C10 wall: duration, last touch, s", last_touch, contact_time(), bar_tolerance);
    expect_answer("C10 wall: velocity after, m/s",
                  mean_motion(world, all, bar_solid.density).velocity.x(), bar_speed,
                  bar_tolerance);
}

// The bar falls, bounces and falls again. Each impact of a continuous bar keeps its energy.
TEST(ContactCollisions, BouncingBarNeverGainsEnergy) {
    constexpr double height = 1e-4, gravity = 0.5;  // m, m/s2
    World world = bar(bar_length, test::num_cases(48), gravity);
    const ToolId wall = add_wall(world, false);
    world.place_tool(wall, at(-height * Vec3::UnitX()));
    const double dt = 0.5 * world.rest_stable_step();
    const auto energy = [&] {  // above that of the bar that lies on the wall undeformed
        const double rise = mean_motion(world, all_of(world), bar_solid.density).displacement.x();
        return test::present_energy(world.model(), dt) + bar_mass * gravity * (rise + height);
    };
    const double begin = energy();
    int num_impacts = 0;
    bool touched = false;
    for (std::size_t apart = 0; num_impacts < 10 && world.time() < 100.0 * contact_time();) {
        world.step(dt);
        const bool touches = world.report().contact.num_points > 0;
        // It has bounced when it has not touched for a quarter of the time of an impact.
        apart = touches ? 0 : apart + 1;
        touched = touched || touches;
        if (touched && static_cast<double>(apart) * dt > 0.25 * contact_time()) {
            ++num_impacts;
            touched = false;
            EXPECT_LT(energy(), (1.0 + 1e-3) * begin);
        }
    }
    EXPECT_EQ(num_impacts, 10);
    record_result("C11 bouncing bar: energy after 10 impacts, part", energy() / begin, 1.0);
}

/// Lets two halves of a soft cube fly obliquely at each other. Returns the part of the energy that
/// the collision takes.
double loss_of_a_collision(double friction) {
    constexpr Solid solid{.young = 5e3, .poisson = 0.3};
    SCOPED_TRACE(testing::Message() << "friction " << friction);
    WorldDef def;
    def.mesh = cube(test::is_sanitized ? 3 : 6);
    def.materials = {solid};
    def.contact.friction = friction;
    World world(std::move(def));
    const Vec3 point(0.05, 0.05, 0.049), normal(0.2, 0.1, 1.0);
    const double dt = 0.2 * world.rest_stable_step();
    world.step(dt, cut_along(world, point, normal));
    const auto part = [&](double side) {
        return elements_where(world,
                              [&](const Vec3& x) { return side * (x - point).dot(normal) > 0.0; });
    };
    const auto above = part(1.0), below = part(-1.0);
    const auto throw_halves = [&](const Vec3& of_above, const Vec3& of_below) {
        launch(world, above, solid.density, of_above, dt);
        launch(world, below, solid.density, of_below, dt);
    };
    throw_halves({0, 0, 0.1}, {0, 0, -0.1});  // apart
    run_until(world, 0.02);
    throw_halves({0.1, 0.05, -0.3}, {-0.05, 0, 0.2});
    world.step(dt);
    const physics::Totals before = world.model().energetics().totals();
    const double begin = test::present_energy(world.model(), dt);
    const double booked = world.report().contact.dissipation;
    double scale = 0.0;
    for (std::size_t n = 0; n < world.model().masses().size(); ++n)
        scale += world.model().masses()[n] * world.model().velocities()[n].norm();
    double most = 0.0;
    std::size_t num_points = 0;
    for (const double end = world.time() + 0.3; world.time() < end;) {
        world.step(dt);
        num_points = std::max(num_points, world.report().contact.num_points);
        most = std::max(most, test::present_energy(world.model(), dt));
    }
    const physics::Totals after = world.model().energetics().totals();
    EXPECT_GT(num_points, 10u);
    EXPECT_EQ(world.report().contact.num_points, 0u);
    EXPECT_LE((after.momentum - before.momentum).norm(), 1e-13 * scale);
    EXPECT_LE((after.angular_momentum - before.angular_momentum).norm(),
              (friction > 0.0 ? 1e-4 : 1e-13) * scale * size);
    EXPECT_LT(most, (1.0 + 1e-4) * begin);
    const double lost = world.report().contact.dissipation - booked;
    expect_answer(friction > 0.0 ? "C16 collision with friction: energy and loss, J"
                                 : "C16 collision: energy and loss, J",
                  test::present_energy(world.model(), dt) + lost, begin, 5e-4);
    return lost / begin;
}

TEST(ContactCollisions, OfSoftHalvesKeepMomentaAndBookTheirLoss) {
    const double without = loss_of_a_collision(0.0), with = loss_of_a_collision(0.3);
    EXPECT_GT(without, 0.05);  // of the nodes that stop
    EXPECT_LT(without, 0.3);
    EXPECT_GT(with, without + 0.03);
}

}  // namespace
}  // namespace incise::sim
