// Runs with elements that are far thinner than they are long: needles of the mesh, and what exact
// cuts leave beside faces of it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/topology/box_mesh.h"
#include "run_folder.h"

namespace incise::runner {
namespace {

using topology::CellKind;

const std::string statics = "mode = \"static\"\nsteps = 4\n";
const std::string implicit_steps = "integrator = \"implicit-euler\"\ntime_step = 0.005\n";

/// A needle along x with its tip, node 0, at the origin.
void write_needle(const std::filesystem::path& path, double length, double width) {
    topology::MeshData data;
    data.points = {{0, 0, 0},
                   {length, 0.3 * width, 0.2 * width},
                   {length, 1.3 * width, 0.2 * width},
                   {length, 0.3 * width, 1.2 * width}};
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{0, 1, 2, 3});
    io::write_mesh(path, data);
}

std::string needle_scenario(const std::string& tip) {
    return R"([mesh]
file = "needle.vtu"
[[material]]
density = 1000
young = 1e4
poisson = 0.3
[[constraint]]
where = { nodes = [1, 2, 3] }
fix = "xyz"
[[constraint]]
where = { nodes = 0 }
)" + tip + dynamics(1, statics);
}

TEST(Needle, TakesTheEnergyOfUniaxialStrain) {
    const RunFolder folder;
    write_needle(folder / "needle.vtu", 0.01, 1e-5);
    Simulation simulation(folder.scenario(needle_scenario(
        "move = [{ time = 0, by = [0, 0, 0] }, { time = 1, by = [1e-6, 0, 0] }]\n")));
    run(simulation);
    // The strain is the same everywhere: base held, tip moved along the needle.
    const double lambda = 1e4 * 0.3 / (1.3 * 0.4), mu = 1e4 / 2.6, strain = 1e-4;
    const double volume = 0.01 * 1e-5 * 1e-5 / 6.0;
    const double energy = (0.5 * lambda + mu) * strain * strain * volume;
    EXPECT_NEAR(simulation.model().energetics().elastic_energy(), energy,
                1e-3 * energy);  // of second order
}

TEST(Needle, StaysWhereAllItsNodesAreHeld) {
    const RunFolder folder;
    write_needle(folder / "needle.vtu", 0.01, 1e-7);
    Simulation simulation(folder.scenario(needle_scenario("fix = \"xyz\"\n")));
    run(simulation);
    EXPECT_EQ(simulation.model().positions()[0], simulation.mesh().rest_positions()[0]);
}

/// All nodes up to x = 0.021 are held, and the first cut is among them.
TEST(Sliver, StaysWhereAllItsNodesAreHeld) {
    Simulation simulation(scenario_of(R"([mesh]
box = { size = [0.05, 0.02, 0.02], cells = [5, 2, 2] }
[[material]]
density = 1000
young = 1e4
poisson = 0.3
[[constraint]]
where = { box = { min = [-1, -1, -1], max = [0.021, 1, 1] } }
fix = "xyz"
[[tool]]
kind = "cut"
time = 0.3
snap = 0
plane = { point = [0.0151, 0, 0], normal = [1, 0, 0] }
[[tool]]
kind = "cut"
time = 0.6
snap = 0
plane = { point = [0, 1e-7, 0], normal = [0, 1, 1] }
)" + dynamics(1, statics)));
    run(simulation);
    EXPECT_EQ(simulation.edits().size(), 2u);
    EXPECT_LE(simulation.ledger().mass_error(), 1e-12);
}

/// A bar held at both ends, of one material or of two that meet in its middle, which a blade parts
/// there exactly, or nearly so, while it sags.
std::string bar(const std::string& materials, const std::string& x) {
    return "[mesh]\nfile = \"bar.vtu\"\n" + materials + R"([[constraint]]
where = { half_space = { point = [0, 0, 0], normal = [-1, 0, 0] } }
fix = "xyz"
[[constraint]]
where = { half_space = { point = [0.06, 0, 0], normal = [1, 0, 0] } }
fix = "xyz"
[[tool]]
kind = "blade"
snap = 0
edge = [[0, -0.01, 0], [0, 0.03, 0]]
path = [{ time = 0, at = [)" +
           x + ", 0, 0.03] }, { time = 0.06, at = [" + x + ", 0, -0.03] }]\n";
}

void expect_parted(const std::string& materials) {
    const RunFolder folder;
    auto mesh =
        topology::box_mesh(CellKind::tetrahedron, Vec3::Zero(), {0.06, 0.02, 0.02}, {6, 2, 2});
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        double x = 0.0;
        for (const auto p : mesh.cell(c)) x += mesh.points[static_cast<std::size_t>(p)].x() / 4;
        mesh.regions[c] = x < 0.03 ? 1 : 2;
    }
    io::write_mesh(folder / "bar.vtu", mesh);
    for (const std::string& solver : {statics, implicit_steps})
        for (const char* x : {"0.03", "0.0300001"}) {
            SCOPED_TRACE(solver + x);
            Simulation simulation(folder.scenario(
                bar(materials, x) + dynamics(0.08, solver + "gravity = [0, 0, -9.81]\n")));
            run(simulation);
            EXPECT_EQ(topology::components(simulation.mesh()).count, 2);
            EXPECT_LE(simulation.ledger().mass_error(), 1e-12);
            EXPECT_TRUE(simulation.warnings().empty()) << simulation.warnings()[0];
        }
}

TEST(ExactCut, NextToAMeshPlaneLeavesSoundSteps) {
    expect_parted("[[material]]\ndensity = 1000\nyoung = 2e4\npoisson = 0.4\n");
}

TEST(ExactCut, WhereMaterialsMeetLeavesSoundSteps) {
    expect_parted(R"([[material]]
regions = 1
density = 1000
young = 1e7
poisson = 0.4
[[material]]
regions = 2
density = 1000
young = 2e4
poisson = 0.4
)");
}

}  // namespace
}  // namespace incise::runner
