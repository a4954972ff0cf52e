// The same cut again changes nothing, at rest and in pressed tissue.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "soft_world.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::sim {
namespace {

struct Pressed {
    double strain = 0.0;
    int cells = 1;
    double snap = cutting::default_snap;
    double friction = 0.5;
    std::optional<test::Bricks> bricks = {};  // tetrahedra if there are none
};

World pressed_world(const Pressed& c) {
    constexpr double height = 0.04;
    WorldDef def;
    if (c.bricks) {
        topology::MeshData data = test::brick_cube(*c.bricks, c.cells, 0.0, 1);
        for (Vec3& x : data.points) x *= height;
        def.mesh = std::move(data);
    } else {
        def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                      Vec3::Constant(height), {c.cells, c.cells, c.cells});
    }
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1785.0, 14286.0}}}};
    def.damping = 20.0;
    def.contact.friction = c.friction;
    World world(std::move(def));
    world.add_constraint({.name = "floor",
                          .nodes = physics::VertexSet(
                              nodes_where(world, [](const Vec3& x) { return x.z() < 1e-9; }))});
    const auto top = nodes_where(world, [&](const Vec3& x) { return x.z() > height - 1e-9; });
    const ConstraintId plate = world.grasp("plate", top, at({0, 0, height}));
    while (world.time() < 0.2) {
        const double strain = c.strain * std::min(1.0, world.time() / 0.15);
        world.step(0.8 * world.stable_step(),
                   StepInputs().move(plate, at({0, 0, height * (1.0 - strain)})));
    }
    return world;
}

void cut(World& world, const cutting::PlaneCut& plane) {
    const ToolId tool = world.add_tool({"plane", plane});
    world.step(0.8 * world.stable_step(), StepInputs().move(tool, Pose()).withdraw(tool));
}
void cut(World& world, double snap) {
    cut(world, cutting::PlaneCut{{0.02, 0.02, 0.0201}, Vec3(0.2, 0.1, 1), snap});
}

std::string name_of(const Pressed& c) {
    return (testing::Message() << "bricks " << (c.bricks ? static_cast<int>(*c.bricks) : -1)
                               << ", strain " << c.strain << ", " << c.cells << " cells, snap "
                               << c.snap << ", friction " << c.friction)
        .GetString();
}

/// Bodies of each kind of cells but tetrahedra, pressed in several ways.
std::vector<Pressed> in_all_bricks(std::initializer_list<Pressed> ways) {
    std::vector<Pressed> all;
    for (const test::Bricks bricks :
         {test::Bricks::hexahedra, test::Bricks::wedges, test::Bricks::pyramids,
          test::Bricks::mixed, test::Bricks::joined})
        for (Pressed c : ways) {
            c.bricks = bricks;
            all.push_back(c);
        }
    return all;
}

void cut_again_and_again(const Pressed& c) {
    SCOPED_TRACE(name_of(c));
    World world = pressed_world(c);
    cut(world, c.snap);
    const std::size_t num_elements = world.mesh().num_elements();
    EXPECT_EQ(topology::components(world.mesh()).count, 2);
    for (int again = 0; again < 3; ++again) {
        run_until(world, world.time() + 0.01);
        cut(world, c.snap);
        EXPECT_EQ(world.mesh().num_elements(), num_elements);
        EXPECT_EQ(topology::components(world.mesh()).count, 2);
    }
}

TEST(CutAgain, ChangesNothingInPressedTissue) {
    for (const Pressed& c : std::initializer_list<Pressed>{
             {0.0}, {0.005}, {0.1}, {0.15, 3}, {0.1, 3, 0.0}, {0.1, 3, 0.015, 0.0}})
        cut_again_and_again(c);
}

TEST(CutAgain, ChangesNothingInPressedCellsOfAnyKind) {
    for (const Pressed& c :
         in_all_bricks({{0.0, 2}, {0.005, 2}, {0.1, 2}, {0.15, 3}, {0.15, 3, 0.015, 0.0}}))
        cut_again_and_again(c);
}

/// Three planes that cross near the middle. Those of seed 0 pass through nodes of a mesh of 8
/// cells.
std::vector<cutting::PlaneCut> crossing_planes(unsigned seed, double snap) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto any_vector = [&] { return Vec3(any(random), any(random), any(random)); };
    const double varied = seed > 0 ? 1.0 : 0.0;
    std::vector<cutting::PlaneCut> planes;
    for (int i = 0; i < 3; ++i) {
        const Vec3 point = Vec3::Constant(0.02) + varied * 0.004 * any_vector();
        planes.push_back({point, Vec3::Unit(2 - i) + varied * 0.3 * any_vector(), snap});
    }
    return planes;
}

/// Cuts by three planes, and by some of them again.
void cut_across_and_again(World& world, unsigned seed, double snap) {
    const auto planes = crossing_planes(seed, snap);
    std::set<std::size_t> done;
    for (const std::size_t i : {0, 1, 0, 2, 1, 0, 2}) {
        const std::size_t num_elements = world.mesh().num_elements();
        cut(world, planes[i]);
        if (!done.insert(i).second) {
            EXPECT_EQ(world.mesh().num_elements(), num_elements);
        }
        EXPECT_EQ(topology::components(world.mesh()).count, 1 << done.size());
        run_until(world, world.time() + 0.005);
    }
}

TEST(CutAgain, ChangesNothingAfterOtherCuts) {
    for (const Pressed& c : std::initializer_list<Pressed>{{0.005}, {0.05, 2}, {0.1}}) {
        World world = pressed_world(c);
        const std::string pressed = world.save();
        for (const double snap : {cutting::default_snap, 0.0})
            for (unsigned seed = 0; seed < (c.cells == 1 ? 3 : 1); ++seed) {
                SCOPED_TRACE(name_of(c) + ", seed " + std::to_string(seed));
                world.restore(pressed);
                cut_across_and_again(world, seed, snap);
            }
    }
}

TEST(CutAgain, ChangesNothingAfterOtherCutsInCellsOfAnyKind) {
    for (const Pressed& c : in_all_bricks({{0.005, 2}, {0.02, 3}, {0.05, 3}})) {
        World world = pressed_world(c);
        const std::string pressed = world.save();
        for (unsigned seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE(name_of(c) + ", seed " + std::to_string(seed));
            world.restore(pressed);
            cut_across_and_again(world, seed, c.snap);
        }
    }
}

}  // namespace
}  // namespace incise::sim
