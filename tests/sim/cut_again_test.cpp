// The same cut again changes nothing, at rest and in pressed tissue.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "soft_world.h"

namespace incise::sim {
namespace {

struct Pressed {
    double strain = 0.0;
    int cells = 1;
    double snap = cutting::default_snap;
    double friction = 0.5;
};

World pressed_world(const Pressed& c) {
    constexpr double height = 0.04;
    WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                  Vec3::Constant(height), {c.cells, c.cells, c.cells});
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1785.0, 14286.0}}}};
    def.damping = 20.0;
    def.contact.friction = c.friction;
    World world(std::move(def));
    world.add_constraint({.name = "floor",
                          .nodes = physics::NodeSet(
                              nodes_where(world, [](const Vec3& x) { return x.z() < 1e-9; }))});
    const auto top = nodes_where(world, [&](const Vec3& x) { return x.z() > height - 1e-9; });
    const ConstraintId plate = world.grasp("plate", top, at({0, 0, height}));
    while (world.time() < 0.2) {
        world.set_grasp_pose(
            plate, at({0, 0, height * (1.0 - c.strain * std::min(1.0, world.time() / 0.15))}));
        world.step(0.8 * world.stable_step());
    }
    return world;
}

void cut(World& world, double snap) {
    const ToolId plane =
        world.add_tool({"plane", cutting::PlaneCut{{0.02, 0.02, 0.0201}, Vec3(0.2, 0.1, 1), snap}});
    world.set_tool_pose(plane, Pose());
    world.withdraw_tool(plane);
    world.step(0.8 * world.stable_step());
}

TEST(CutAgain, ChangesNothingInPressedTissue) {
    for (const Pressed& c : std::initializer_list<Pressed>{
             {0.0}, {0.005}, {0.1}, {0.15, 3}, {0.1, 3, 0.0}, {0.1, 3, 0.015, 0.0}}) {
        SCOPED_TRACE(testing::Message()
                     << "strain " << c.strain << ", " << c.cells << " cells, snap " << c.snap
                     << ", friction " << c.friction);
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
}

}  // namespace
}  // namespace incise::sim
