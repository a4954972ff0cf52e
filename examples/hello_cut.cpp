// Cuts a soft block in two with a blade that is moved from outside, and writes the result.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <incise/io/mesh/mesh_writer.h>
#include <incise/sim/selection.h>
#include <incise/sim/world.h>
#include <incise/topology/box_mesh.h>

#include <iomanip>
#include <iostream>

using namespace incise;

int main() {
    // A block of 10 x 5 x 5 cm in 1,500 tetrahedra, of soft tissue.
    sim::WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {0.1, 0.05, 0.05},
                                  {10, 5, 5});
    def.materials = {{.density = 1060.0,
                      .method = physics::HyperElasticLinks{physics::NeoHookean{1000.0, 8000.0}}}};
    def.gravity = {0, 0, -9.81};
    def.damping = 5.0;
    sim::World world(std::move(def));

    // Both ends are held.
    const sim::Selection left{.box = sim::BoxRegion{{0, 0, 0}, {0, 0.05, 0.05}}};
    const sim::Selection right{.box = sim::BoxRegion{{0.1, 0, 0}, {0.1, 0.05, 0.05}}};
    world.add_constraint({.name = "left", .nodes = sim::select_nodes(world.mesh(), left)});
    world.add_constraint({.name = "right", .nodes = sim::select_nodes(world.mesh(), right)});

    // A blade along y goes down through the middle in 0.1 s, in steps of 0.2 ms.
    const Pose above{Eigen::Quaterniond::Identity(), {0, 0, 0.06}};
    const Pose below{Eigen::Quaterniond::Identity(), {0, 0, -0.04}};
    const sim::ToolId scalpel = world.add_tool(
        {.name = "scalpel", .shape = cutting::Blade{{{0.055, -0.01, 0}, {0.056, 0.06, 0}}}});
    world.place_tool(scalpel, above);
    double cut_area = 0.0;
    for (int i = 1; i <= 500; ++i) {
        const double time = 2e-4 * i;
        const Pose there = interpolate(above, below, time / 0.1);
        const auto& report = world.step_to(time, sim::StepInputs().move(scalpel, there));
        for (const sim::Edit& edit : report.edits) cut_area += edit.record.cut_area;
    }

    const auto& edited = world.mesh();
    const int num_components = topology::components(edited).count;
    std::cout << std::setprecision(5) << "elements: " << edited.num_elements()
              << "\ncomponents: " << num_components << "\ncut area, m2: " << cut_area;
    // More digits hang on the last bits of the pose: by them faces of the cut touch, or do not yet.
    std::cout << "\nkinetic energy, J: " << std::setprecision(2)
              << world.model().energetics().totals().kinetic_energy << '\n';
    io::write_mesh("hello_cut.vtu", topology::to_mesh_data(edited, world.positions()));
    return num_components == 2 ? 0 : 1;
}
