// Bodies of hexahedra, and of both kinds of elements, through whole runs: they deform, lose
// elements, open along faces and keep their balances.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/base/error.h"
#include "incise/scenario/body.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/validate.h"
#include "run_folder.h"
#include "support/mesh_families.h"

namespace incise::runner {
namespace {

using topology::CellKind;

/// Pulled up from a floor that holds it.
const std::string pulled_block = R"(
[mesh]
box = { size = [0.1, 0.1, 0.1], cells = [6, 6, 6], element = "hex" }
[[material]]
method = "hybmss"
density = 1000
young = 1000
poisson = 0.45
stiffness_ratio = inf
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[constraint]]
name = "ceiling"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.1, by = [0, 0, 0.01] }]
[dynamics]
end_time = 0.4
damping = 10
)";

const std::string knife = R"(
[[tool]]
kind = "blade"
name = "knife"
edge = [[0, -0.1, 0.06], [0, 0.2, 0.06]]
path = [{ time = 0.15, at = [-0.02, 0, 0] }, { time = 0.3, at = [0.15, 0, 0] }]
)";

TEST(HexahedralBody, IsPartedAndCarvedWhileItDeforms) {
    const RunFolder folder;
    Simulation simulation(folder.scenario(pulled_block + knife + R"(mode = "separate"
[[tool]]
kind = "carver"
name = "burr"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0, at = [0.05, 0.05, 0.13] }, { time = 0.1, at = [0.05, 0.05, 0.09] }]
)"));
    run(simulation);
    EXPECT_TRUE(topology::validate(simulation.mesh()).empty());
    EXPECT_EQ(topology::components(simulation.mesh()).count, 2);
    EXPECT_LE(simulation.ledger().mass_error(), 1e-12);
    EXPECT_LE(simulation.ledger().energy_error(), 0.02);
    std::size_t removed = 0, opened = 0, split = 0;
    for (const EditRecord& edit : simulation.edits()) {
        removed += edit.elements_removed;
        opened += edit.faces_opened;
        split += edit.elements_split;
    }
    EXPECT_GT(removed, 4u);
    EXPECT_GE(opened, 30u);
    EXPECT_EQ(split, 0u);
    EXPECT_GT(simulation.model().energetics().min_volume_ratio(), 0.5);
}

TEST(HexahedralBody, IsSplitExactly) {
    const RunFolder folder;
    for (const std::string& tool :
         {knife + "mode = \"split\"\n",
          std::string("[[tool]]\nkind = \"cut\"\nname = \"knife\"\ntime = 0.1\nplane = { point = "
                      "[0, 0, 0.051], normal = [0, 0, 1] }\n")}) {
        Simulation simulation(folder.scenario(pulled_block + tool));
        run(simulation);
        EXPECT_EQ(topology::components(simulation.mesh()).count, 2);
        EXPECT_LE(simulation.ledger().mass_error(), 1e-12);
        std::size_t split = 0;
        for (const EditRecord& edit : simulation.edits()) split += edit.elements_split;
        EXPECT_GT(split, 0u);
    }
}

// One file with a body of hexahedra, that falls on nothing, and one of tetrahedra beside it.
TEST(HexahedralBody, MovesBesideOneOfTetrahedra) {
    const RunFolder folder;
    topology::MeshData both =
        topology::box_mesh(CellKind::hexahedron, Vec3::Zero(), Vec3::Constant(0.1), {3, 3, 3});
    const auto num_hexahedra = both.num_cells();
    const auto tetrahedra =
        topology::box_mesh(CellKind::tetrahedron, {0.2, 0, 0}, Vec3::Constant(0.1), {2, 2, 2});
    const auto offset = static_cast<std::int64_t>(both.points.size());
    both.points.insert(both.points.end(), tetrahedra.points.begin(), tetrahedra.points.end());
    for (std::size_t c = 0; c < tetrahedra.num_cells(); ++c) {
        std::vector<std::int64_t> corners(tetrahedra.cell(c).begin(), tetrahedra.cell(c).end());
        for (auto& corner : corners) corner += offset;
        both.add_cell(CellKind::tetrahedron, corners);
        both.regions.back() = 7;
    }
    io::write_mesh(folder / "both.vtu", both);
    const std::string head = R"([mesh]
file = "both.vtu"
[dynamics]
end_time = 0.2
gravity = [0, 0, -9.81]
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
)";
    const std::string soft = "density = 1000\nyoung = 5000\npoisson = 0.4\n";
    Simulation simulation(folder.scenario(
        head + "[[material]]\nregions = 7\n" + soft + "[[material]]\nmethod = \"hybmss\"\n" + soft +
        "[[tool]]\nkind = \"blade\"\nmode = \"separate\"\nedge = [[0, -1, 0.05], [0, 1, "
        "0.05]]\npath = [{ time = 0, at "
        "= [-0.1, 0, 0] }, { time = 0.15, at = [0.5, 0, 0] }]\n"));
    run(simulation);
    EXPECT_EQ(topology::components(simulation.mesh()).count, 4);  // each is parted
    EXPECT_LE(simulation.ledger().mass_error(), 1e-12);
    EXPECT_LE(simulation.ledger().energy_error(), 0.05);
    EXPECT_EQ(simulation.mesh().num_elements(), num_hexahedra + tetrahedra.num_cells());

    // One law serves both kinds, but not with viscosity by the nodal rule.
    EXPECT_NO_THROW(Simulation(folder.scenario(head + "[[material]]\n" + soft)));
    try {
        Simulation other(folder.scenario(head + "[[material]]\n" + soft +
                                         "prony = [{ alpha = 0.3, tau = 0.1 }]\n"
                                         "prony_rule = \"nodal\"\n"));
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what())
                        .ends_with(" is a hexahedron; the nodal rule of a Prony series needs "
                                   "tetrahedra: leave out prony_rule = \"nodal\""))
            << error.what();
    }
    try {
        Simulation other(folder.scenario(head + "[[material]]\nmethod = \"mass-spring\"\n"
                                                "density = 1000\nyoung = 1000\n"));
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what())
                        .ends_with(" is a hexahedron; the method mass-spring needs tetrahedra: "
                                   "give the region a material with method = \"heml\""))
            << error.what();
    }
}

}  // namespace
}  // namespace incise::runner
