// Drops a cube with a cut, and checks that what it has is what the library says.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <incise/sim/world.h>
#include <incise/topology/box_mesh.h>

#include <cmath>
#include <cstdio>

int main() {
    using namespace incise;
    sim::WorldDef def;
    def.mesh =
        topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {0.1, 0.1, 0.1}, {4, 4, 4});
    def.materials = {{.density = 1000.0,
                      .method = physics::HyperElasticLinks{physics::NeoHookean{500.0, 2000.0}}}};
    def.gravity = {0, 0, -9.81};
    sim::World world(std::move(def));
    const sim::ToolId knife =
        world.add_tool({.name = "knife", .shape = cutting::PlaneCut{{0, 0, 0.052}, Vec3::UnitZ()}});
    const Pose turned{Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vec3::UnitX())), {1, 2, 3}};
    const auto inputs = sim::StepInputs().move(knife, turned).withdraw(knife);
    const auto num_edits = world.step(0.5 * world.stable_step(), inputs).edits.size();
    const std::string bytes = world.save();
    for (int i = 0; i < 20; ++i) world.step(0.5 * world.stable_step());
    const double fall = world.model().energetics().totals().momentum.z() + 9.81 * world.time();
    const int num_pieces = world.ledger().last().components;
    world.restore(bytes);
    std::printf("%zu edit, %d pieces, momentum off by %g\n", num_edits, num_pieces, fall);
    const bool is_there = world.tool_pose(knife).position == turned.position;
    return num_edits == 1 && num_pieces == 2 && std::abs(fall) < 1e-9 && is_there ? 0 : 1;
}
