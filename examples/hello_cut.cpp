// Cuts a soft block in two with a blade that is moved from outside, and writes the result.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <incise/io/mesh/mesh_writer.h>
#include <incise/sim/selection.h>
#include <incise/sim/world.h>
#include <incise/topology/box_mesh.h>

#include <iostream>

using namespace incise;

int main() {
    // A block of 10 x 5 x 5 cm in 1,500 tetrahedra, of soft tissue.
    sim::WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {0.1, 0.05, 0.05},
                                  {10, 5, 5});
    def.materials = {{.density = 1060.0,
                      .method = physics::HyperElasticLinks{physics::NeoHookean{1000.0, 8000.0}}}};
    def.damping = 5.0;
    sim::World world(std::move(def));

    // Both ends are held.
    const sim::Selection left{.box = sim::BoxRegion{{0, 0, 0}, {0, 0.05, 0.05}}};
    const sim::Selection right{.box = sim::BoxRegion{{0.1, 0, 0}, {0.1, 0.05, 0.05}}};
    world.add_constraint({.name = "left", .nodes = sim::select_nodes(world.mesh(), left)});
    world.add_constraint({.name = "right", .nodes = sim::select_nodes(world.mesh(), right)});

    // A blade along y goes down through the middle in 0.1 s.
    const sim::ToolId scalpel = world.add_tool(
        {.name = "scalpel", .shape = cutting::Blade{{{0.052, -0.01, 0}, {0.052, 0.06, 0}}}});
    world.place_tool(scalpel, {Eigen::Quaterniond::Identity(), {0, 0, 0.06}});
    while (world.time() < 0.1) {
        const double dt = 0.8 * world.stable_step();
        const double height = 0.06 - 0.7 * (world.time() + dt);
        world.set_tool_pose(scalpel, {Eigen::Quaterniond::Identity(), {0, 0, height}});
        for (const sim::Edit& edit : world.step(dt).edits)
            if (edit.record.after.components != edit.record.before.components)
                std::cout << "in " << edit.record.after.components
                          << " pieces at t = " << edit.record.time << " s\n";
    }
    const auto& edited = world.mesh();
    std::cout << edited.num_elements() << " elements, mass error " << world.ledger().mass_error()
              << '\n';
    io::write_mesh("hello_cut.vtu", topology::to_mesh_data(edited, world.model().positions()));
    return topology::components(edited).count == 2 ? 0 : 1;
}
