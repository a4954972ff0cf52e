// What the verbs make of meshes that are not as they should be: unjoined points, cells that are
// wound the wrong way round, files that only name others.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <sstream>

#include "in_folder.h"

namespace incise {
namespace {

using FaultyMesh = test::InFolder;

/// Tetrahedra of four nodes each: those of the base, then the apexes.
std::string soup(const std::vector<std::string>& cells) {
    std::string nodes, elements;
    std::size_t num_nodes = 0, num_elements = 0;
    for (const auto& cell : cells) {
        std::istringstream points(cell);
        std::string corners;
        for (std::string x, y, z; points >> x >> y >> z;) {
            nodes += std::to_string(++num_nodes) + " " + x + " " + y + " " + z + "\n";
            corners += " " + std::to_string(num_nodes);
        }
        elements += std::to_string(++num_elements) + " 4 2 1 1" + corners + "\n";
    }
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(num_nodes) + "\n" +
           nodes + "$EndNodes\n$Elements\n" + std::to_string(num_elements) + "\n" + elements +
           "$EndElements\n";
}

const std::string first = "0 0 0  1 0 0  0 1 0  0 0 1";
const std::string second = "1 0 0  0 1 0  0 0 1  1 1 1";

const std::string rest_of_scenario = R"(
[[material]]
density = 1060
young = 1600
poisson = 0.45
[dynamics]
end_time = 1
)";

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
}

nlohmann::json parsed(const std::string& text) { return nlohmann::json::parse(text); }

TEST_F(FaultyMesh, WarnsOnceOfPointsNotJoined) {
    write("soup.msh", soup({first, second}));
    write("soup.toml", "[mesh]\nfile = \"soup.msh\"\n" + rest_of_scenario);
    for (const auto* arguments :
         {"info soup.msh", "check soup.msh", "check soup.toml", "run soup.toml --dry-run",
          "convert soup.msh soup.vtu", "cut soup.msh --out cut.vtu --plane 0,0,0.2,0,0,1"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << arguments;
        EXPECT_EQ(count_of(outcome.err,
                           "incise: warning: soup.msh: 3 points are not joined to others at the "
                           "same position, so the cells do not hang together there: point 1 "),
                  1u)
            << arguments << ": " << outcome.err;
    }
    const auto figures = parsed(run("info soup.msh --json").out);
    EXPECT_EQ(figures["components"], 2);
    EXPECT_EQ(figures["warnings"].size(), 1u);
}

TEST_F(FaultyMesh, IsWeldedOnConversion) {
    write("soup.msh", soup({first, second}));
    for (const std::string suffix : {".vtu", ".vtk", ".msh", ".mesh", ".inp"}) {
        const auto outcome = run("convert --weld soup.msh one" + suffix);
        EXPECT_EQ(outcome.status, 0);
        EXPECT_EQ(outcome.err, "");
        EXPECT_EQ(outcome.out, "one" + suffix +
                                   ": 5 points, 2 cells; 3 points were joined to others at the "
                                   "same position\n");
        const auto figures = parsed(run("info --json one" + suffix).out);
        EXPECT_EQ(figures["components"], 1);
        EXPECT_EQ(figures["warnings"].size(), 0u);
    }
    EXPECT_EQ(run("convert --weld one.vtu again.vtu").out,
              "again.vtu: 5 points, 2 cells; no two points are at the same position: none was "
              "joined\n");
}

TEST_F(FaultyMesh, IsWeldedFirstWhereThatIsAskedFor) {
    write("soup.msh", soup({first, second}));
    for (const std::string verb : {"info", "check"}) {
        const auto outcome = run(verb + " --weld soup.msh");
        EXPECT_EQ(outcome.status, 0);
        EXPECT_EQ(outcome.err,
                  "incise: warning: soup.msh: 3 points were joined to others at the same "
                  "position\n");
        EXPECT_NE(outcome.out.find(verb == "info" ? "points           5\n" : "with 5 points, 2 "),
                  std::string::npos)
            << outcome.out;
    }
    EXPECT_EQ(parsed(run("info --weld --json soup.msh").out)["components"], 1);
    write("three.msh", soup({first, second, "1 0 0  0 1 0  0 0 1  2 2 2"}));
    for (const std::string verb : {"info", "check"}) {
        const auto outcome = run(verb + " --weld three.msh");
        EXPECT_EQ(outcome.status, 2);
        EXPECT_NE(outcome.err.find("three.msh: cells 0, 1 and 2 (in the file 1, 2 and 3) all share "
                                   "one face"),
                  std::string::npos)
            << outcome.err;
    }
}

const std::string second_order =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 2\n"
    "5 1 0 0\n6 1 1 0\n7 0 1 0\n8 0 0 1\n9 0 1 1\n10 1 0 1\n$EndNodes\n$Elements\n1\n"
    "1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";

TEST_F(FaultyMesh, IsOfSecondOrderAndRefused) {
    write("tet10.msh", second_order);
    write("tet10.toml", "[mesh]\nfile = \"tet10.msh\"\n" + rest_of_scenario);
    for (const auto* arguments :
         {"info tet10.msh", "check tet10.msh", "check tet10.toml", "run tet10.toml --dry-run",
          "convert tet10.msh a.vtu", "cut tet10.msh --out a.vtu --plane 0,0,0.2,0,0,1"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_NE(outcome.err.find(
                      "tet10.msh:19: element 1: a second-order tetrahedron (Gmsh element type 11) "
                      "cannot be used; export linear elements (tetrahedra, hexahedra, wedges, "
                      "pyramids), or read them by their corners as linear ones with 'incise "
                      "convert --linear IN OUT' or with 'linear = true' in [mesh] of a scenario\n"),
                  std::string::npos)
            << outcome.err;
    }
}

TEST_F(FaultyMesh, IsOfSecondOrderAndReadByItsCorners) {
    write("tet10.msh", second_order);
    write("tet10.toml", "[mesh]\nfile = \"tet10.msh\"\nlinear = true\n" + rest_of_scenario);
    for (const auto* arguments :
         {"info --linear tet10.msh", "check --linear tet10.msh", "check tet10.toml",
          "run tet10.toml --dry-run", "convert --linear tet10.msh a.vtu"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << arguments << outcome.err;
        EXPECT_EQ(outcome.err.find(
                      "incise: warning: tet10.msh: read 1 second-order tetrahedron by the corners "
                      "alone, as linear; 6 nodes that are no corners were left out\n"),
                  0u)
            << outcome.err;
    }
    const auto info = parsed(run("info --json a.vtu").out);
    EXPECT_EQ(info["points"], 4);
    EXPECT_EQ(info["tets"], 1);
    EXPECT_EQ(info["warnings"].size(), 0u);
    write("box.toml", "[mesh]\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }\nlinear = true\n" +
                          rest_of_scenario);
    EXPECT_EQ(
        run("check box.toml").err,
        "incise: warning: box.toml:3:10: 'mesh.linear' has no effect on a box, whose elements "
        "are linear\n");
}

TEST_F(FaultyMesh, IsReportedWhereAGapIsTooWide) {
    write("gap.msh", soup({first, "1.001 0 0  0.001 1 0  0.001 0 1  1 1 1"}));
    for (const auto* arguments : {"check gap.msh", "convert gap.msh gap.vtu",
                                  "convert --weld gap.msh gap.vtu", "check gap.vtu"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << arguments;
        EXPECT_EQ(count_of(outcome.err, "3 points are within 0.01 of the shortest edge of others"),
                  1u)
            << arguments << ": " << outcome.err;
    }
}

TEST_F(FaultyMesh, IsNotWeldedToAnUnsoundOne) {
    write("three.msh", soup({first, second, "1 0 0  0 1 0  0 0 1  2 2 2"}));
    write("three.toml", "[mesh]\nfile = \"three.msh\"\nweld = true\n" + rest_of_scenario);
    for (const auto* arguments :
         {"convert --weld three.msh out.vtu", "check three.toml", "run three.toml --dry-run"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_NE(outcome.err.find("three.msh: cells 0, 1 and 2 (in the file 1, 2 and 3) all share "
                                   "one face"),
                  std::string::npos)
            << outcome.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.vtu"));
}

TEST_F(FaultyMesh, IsNoneThatIsCutByIncise) {
    write("two.msh", soup({first}));
    for (const std::string suffix : {".vtu", ".vtk", ".msh", ".mesh", ".inp"}) {
        const auto cut = "cut two.msh --snap 0 --plane 0,0,0.4,0,0,1 --out cut" + suffix;
        ASSERT_EQ(run(cut).status, 0);
        const auto info = run("info --json cut" + suffix);
        const auto figures = parsed(info.out);
        EXPECT_EQ(figures["components"], 2);
        EXPECT_EQ(figures["warnings"].size(), 0u) << figures["warnings"];
        const std::string err = run("convert cut" + suffix + " copy.msh").err;
        EXPECT_EQ(err.find("position"), std::string::npos) << err;
        EXPECT_EQ(err.empty(), suffix != ".vtu") << err;  // only .vtu has carriers to lose
        EXPECT_EQ(run("info copy.msh").err, "");
        EXPECT_EQ(run("convert --weld cut" + suffix + " healed.vtu").status, 0);
        EXPECT_EQ(parsed(run("info --json healed.vtu").out)["components"], 1);
    }
}

TEST_F(FaultyMesh, IsTurnedWhereAllCellsAreInverted) {
    write("two.msh", soup({"0 0 0  0 1 0  1 0 0  0 0 1", "0 1 0  1 0 0  0 0 1  1 1 1"}));
    const auto outcome = run("info two.msh");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.err.find("two.msh: all 2 cells have negative volume"), std::string::npos);
    EXPECT_NE(outcome.out.find("volume           0.5\n"), std::string::npos) << outcome.out;
    EXPECT_EQ(run("convert --weld two.msh one.vtu").status, 0);
    EXPECT_EQ(run("info one.vtu").err, "");
    write("flat.msh", soup({"0 0 0  0 1 0  1 0 0  0 0 1", "0 1 0  1 0 0  0 0 1  1 1 1",
                            "5 0 0  6 0 0  5 1 0  6 1 0"}));
    const auto flat = run("check flat.msh");
    EXPECT_EQ(flat.status, 2);
    EXPECT_EQ(count_of(flat.err, "\n"), 2u) << flat.err;
    EXPECT_NE(flat.err.find("all cells but 1 without volume have negative volume"),
              std::string::npos)
        << flat.err;
    EXPECT_NE(flat.err.find("flat.msh: cell 2 (tetrahedron, number 3 in the file) has zero volume; "
                            "remove it or remesh\n"),
              std::string::npos)
        << flat.err;
    write("some.msh", soup({first, "0 1 0  1 0 0  0 0 1  1 1 1"}));
    EXPECT_EQ(run("info some.msh").status, 2);
}

/// Cells of Gmsh, each far from the others.
/// @param type  the number of the kind in Gmsh
std::string scattered(int type, const std::vector<std::array<double, 3>>& corners, int num_cells) {
    std::ostringstream nodes, elements;
    std::size_t num_nodes = 0;
    for (int c = 0; c < num_cells; ++c) {
        elements << c + 101 << ' ' << type << " 2 1 1";
        for (const auto& [x, y, z] : corners) {
            nodes << ++num_nodes << ' ' << x + 10.0 * c << ' ' << y << ' ' << z << '\n';
            elements << ' ' << num_nodes;
        }
        elements << '\n';
    }
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(num_nodes) + "\n" +
           nodes.str() + "$EndNodes\n$Elements\n" + std::to_string(num_cells) + "\n" +
           elements.str() + "$EndElements\n";
}

// Each corner of these cells is sound, and their volume is positive.
TEST_F(FaultyMesh, HasCellsTooDistortedForForces) {
    write("hex.msh", scattered(5,
                               {{0, 0, 0},
                                {1, 0, 0},
                                {1, 1, 0},
                                {0, 1, 0},
                                {0, 0, 1},
                                {1.8, 0.8, 0.1},
                                {1, 1, 1},
                                {0, 1, 1}},
                               7));
    write("wedge.msh",
          scattered(6, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 2, 0.9}, {0, 1, 1}}, 1));
    const std::string reason =
        " in the file) is so distorted that a part between its centre and one of its faces has no "
        "volume; move its nodes, or divide it into tetrahedra\n";
    const auto hex = run("check hex.msh");
    EXPECT_EQ(hex.status, 2);
    EXPECT_EQ(count_of(hex.err, reason), 5u) << hex.err;
    EXPECT_NE(hex.err.find("hex.msh: cell 0 (hexahedron, number 101" + reason), std::string::npos)
        << hex.err;
    EXPECT_TRUE(hex.err.ends_with("hex.msh: and 2 more such cells\n")) << hex.err;
    const auto wedge = run("check wedge.msh");
    EXPECT_EQ(wedge.status, 2);
    EXPECT_NE(wedge.err.find("wedge.msh: cell 0 (wedge, number 101" + reason), std::string::npos)
        << wedge.err;
    EXPECT_EQ(run("convert hex.msh hex.vtu").status, 0);  // which needs no forces
}

TEST_F(FaultyMesh, TellsWhichQuadrilateralsAreJoinedToTriangles) {
    // A cube, and tetrahedra on its top.
    const std::string cube =
        "# vtk DataFile Version 3.0\nmixed\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n"
        "0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1  0.5 0.5 2\n";
    write("mixed.vtk", cube +
                           "CELLS 3 19\n8 0 1 2 3 4 5 6 7\n4 4 5 6 8\n4 4 6 7 8\nCELL_TYPES "
                           "3\n12\n10\n10\n");
    const auto outcome = run("check mixed.vtk");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(outcome.err.empty()) << outcome.err;
    const std::string line = "joined 1 quadrilateral of hexahedra to two triangles of tetrahedra\n";
    EXPECT_TRUE(outcome.out.ends_with("mixed.vtk: " + line)) << outcome.out;
    EXPECT_NE(run("info mixed.vtk").out.find("\n" + line), std::string::npos);
    write("mixed.toml", "[mesh]\nfile = \"mixed.vtk\"\n" + rest_of_scenario);
    EXPECT_NE(run("check mixed.toml").out.find("mixed.toml: " + line), std::string::npos);

    write("half.vtk", cube + "CELLS 2 14\n8 0 1 2 3 4 5 6 7\n4 4 5 6 8\nCELL_TYPES 2\n12\n10\n");
    const auto half = run("check half.vtk");
    EXPECT_EQ(half.status, 0) << half.err;
    EXPECT_EQ(count_of(half.err,
                       "half.vtk: the quadrilateral of cell 0 (hexahedron) and the triangle of "
                       "cell 1 (tetrahedron) on it are no common face, so these cells are not "
                       "joined: let two triangles, which share one of its diagonals, cover each "
                       "such quadrilateral\n"),
              1u)
        << half.err;
}

TEST_F(FaultyMesh, IsNoIndexOfFrames) {
    write("beam.pvd",
          "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" "
          "file=\"frames/beam_0.vtu\"/><DataSet timestep=\"1\" file=\"frames/beam_1.vtu\"/>"
          "</Collection></VTKFile>");
    write("beam.vtu.series",
          "{\"file-series-version\": \"1.0\", \"files\": [{\"name\": \"frames/beam_0.vtu\", "
          "\"time\": 0}, {\"name\": \"frames/beam_1.vtu\", \"time\": 1}]}");
    for (const std::string index : {"beam.pvd", "beam.vtu.series"}) {
        write("beam.toml", "[mesh]\nfile = \"" + index + "\"\n" + rest_of_scenario);
        const std::vector<std::string> uses = {"info " + index,
                                               "check " + index,
                                               "check beam.toml",
                                               "run beam.toml",
                                               "convert " + index + " out.vtu",
                                               "cut " + index + " --out o.vtu --plane 0,0,0,1,0,0"};
        for (const auto& arguments : uses) {
            const auto outcome = run(arguments);
            EXPECT_EQ(outcome.status, 2) << arguments;
            EXPECT_NE(outcome.err.find(index + ": holds no mesh itself but names 2 files, from "
                                               "frames/beam_0.vtu to frames/beam_1.vtu; give one "
                                               "of them\n"),
                      std::string::npos)
                << outcome.err;
        }
    }
}

}  // namespace
}  // namespace incise
