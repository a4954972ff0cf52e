// Cuts a block, hands it to CGAL as a linear cell complex, works on it with CGAL's own operations,
// writes it to CGAL's own file, and simulates what it has read from there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <CGAL/Combinatorial_map_save_load.h>
#include <incise/fragments/carriers.h>
#include <incise/sim/world.h>
#include <incise/topology/box_mesh.h>
#include <incise/topology/linear_cell_complex.h>

#include <iostream>

using namespace incise;

int main() {
    sim::WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {0.04, 0.02, 0.02},
                                  {8, 4, 4});
    def.materials = {{.density = 1060.0,
                      .method = physics::HyperElasticLinks{physics::NeoHookean{1000.0, 8000.0}}}};
    sim::World world(def);
    const sim::ToolId knife = world.add_tool(
        {.name = "knife", .shape = cutting::Blade{{{0.021, -0.01, 0}, {0.022, 0.03, 0}}}});
    world.place_tool(knife, {Eigen::Quaterniond::Identity(), {0, 0, 0.03}});
    for (int i = 1; i <= 100; ++i)
        world.step_to(2e-4 * i, sim::StepInputs().move(knife, {Eigen::Quaterniond::Identity(),
                                                               {0, 0, 0.03 - 4e-4 * i}}));

    // The body as it was cut: a volume for each cell. Polyhedra know of which cell they are a part.
    auto complex = topology::to_linear_cell_complex(
        world.mesh(), fragments::carriers_of(world.mesh(), world.model().fragments()));
    std::size_t num_polyhedra = 0;
    for (auto cell = complex.attributes<3>().begin(); cell != complex.attributes<3>().end(); ++cell)
        num_polyhedra += complex.info_of_attribute<3>(cell).carrier ? 1 : 0;
    std::cout << "volumes " << complex.attributes<3>().size() << ", polyhedra " << num_polyhedra
              << ", vertices " << complex.attributes<0>().size() << ", pieces "
              << complex.one_dart_per_cell<4>().size() << ", valid " << complex.is_valid() << '\n';

    // Take cells of one end away.
    std::vector<decltype(complex)::Dart_handle> at_the_end;
    for (auto cell = complex.attributes<3>().begin(); cell != complex.attributes<3>().end(); ++cell)
        if (CGAL::to_double(complex.point(cell->dart()).x()) < 0.004)
            at_the_end.push_back(cell->dart());
    for (const auto dart : at_the_end) complex.remove_cell<3>(dart);

    if (!CGAL::save_combinatorial_map(complex, "block.xml")) return 1;
    topology::LinearCellComplex read;
    if (!CGAL::load_combinatorial_map("block.xml", read)) return 1;
    def.mesh = topology::from_linear_cell_complex(read).mesh;
    sim::World rest(std::move(def));
    rest.step_to(5e-4);
    std::cout << "after " << rest.time() << " s: cells " << rest.mesh().num_elements()
              << ", pieces " << topology::components(rest.mesh()).count << '\n';
}
