// incise cut as users and scripts meet it: what it writes and tells, and what it refuses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "in_folder.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/topology/box_mesh.h"

namespace incise {
namespace {

using nlohmann::json;
using topology::CellKind;

/// A closed box with corners at 0.2 and 0.8, of twelve triangles.
const std::string inner_box =
    "v .2 .2 .2\nv .8 .2 .2\nv .8 .8 .2\nv .2 .8 .2\nv .2 .2 .8\nv .8 .2 .8\nv .8 .8 .8\n"
    "v .2 .8 .8\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// Unit cubes of 4 x 4 x 4 bricks: box.vtu of tetrahedra, bricks.vtu of hexahedra.
class Cut : public test::InFolder {
  protected:
    void SetUp() override {
        for (const auto& [name, kind] :
             {std::pair("box.vtu", CellKind::tetrahedron), {"bricks.vtu", CellKind::hexahedron}})
            io::write_mesh(folder_ / name,
                           topology::box_mesh(kind, Vec3::Zero(), Vec3::Ones(), {4, 4, 4}));
        write("inner.obj", inner_box);
    }

    json cut(const std::string& arguments, const std::string& mesh = "box.vtu") {
        const auto outcome = run("cut " + mesh + " --out out.vtu --json - " + arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return json::parse(outcome.out);
    }
};

std::vector<double> volumes(const json& report) {
    std::vector<double> volumes;
    for (const auto& piece : report["pieces"]) volumes.push_back(piece["volume"]);
    return volumes;
}

void expect_volumes(const json& report, const std::vector<double>& expected, double tolerance) {
    const auto found = volumes(report);
    ASSERT_EQ(found.size(), expected.size()) << report["pieces"];
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], tolerance);
}

TEST_F(Cut, PartsABoxExactlyWithoutSnap) {
    const auto report = cut("--plane 0.3,0,0,1,0,0 --snap 0");
    expect_volumes(report, {0.7, 0.3}, 1e-14);
    EXPECT_EQ(report["mode"], "split");
    EXPECT_EQ(report["snap"], 0.0);
    EXPECT_EQ(report["elements"]["before"], 384);
    EXPECT_EQ(report["nodes"]["before"], 125);
    EXPECT_EQ(report["crossed"], 96);  // a layer
    EXPECT_EQ(report["snapped"], 0);
    EXPECT_EQ(report["elements"]["after"], 384 + report["elements_added"].get<int>());
    EXPECT_EQ(report["nodes"]["after"], 125 + report["nodes_added"].get<int>());
    EXPECT_EQ(report["growth"], report["elements_added"].get<double>() / 96);
    int in_pieces = 0;
    for (const auto& piece : report["pieces"]) in_pieces += piece["elements"].get<int>();
    EXPECT_EQ(report["elements"]["after"], in_pieces);
    EXPECT_NEAR(report["cut_area"].get<double>(), 1.0, 1e-14);
    EXPECT_LT(report["surface_distance"]["max"].get<double>(), 1e-15);
    EXPECT_LT(report["volume_error"].get<double>(), 1e-15);
    EXPECT_GT(report["microseconds_per_crossed_element"].get<double>(), 0.0);
}

TEST_F(Cut, ReportsAllInJson) {
    const auto report = cut("--plane 0.3,0,0,1,0,0 --remove-sphere 0,0,0,0.2");
    for (const auto* key : {"mode",
                            "snap",
                            "pieces",
                            "elements",
                            "nodes",
                            "volume",
                            "crossed",
                            "snapped",
                            "elements_added",
                            "elements_removed",
                            "nodes_added",
                            "nodes_duplicated",
                            "faces_opened",
                            "cut_area",
                            "volume_removed",
                            "surface_distance",
                            "volume_error",
                            "growth",
                            "min_dihedral_deg",
                            "min_altitude",
                            "mean_edge_length",
                            "stable_step_ratio",
                            "microseconds_per_crossed_element",
                            "tools",
                            "warnings"})
        EXPECT_TRUE(report.contains(key) && !report[key].is_null()) << key;
    for (const auto* key : {"min_dihedral_deg", "min_altitude", "mean_edge_length"})
        EXPECT_DOUBLE_EQ(report[key]["ratio"],
                         report[key]["after"].get<double>() / report[key]["before"].get<double>());
    EXPECT_NEAR(report["min_dihedral_deg"]["before"].get<double>(), 45.0, 1e-12);  // Kuhn's
    EXPECT_GE(report["stable_step_ratio"].get<double>(), 0.5);
    EXPECT_DOUBLE_EQ(report["surface_distance"]["relative"],
                     report["surface_distance"]["max"].get<double>() /
                         report["mean_edge_length"]["before"].get<double>());
    ASSERT_EQ(report["tools"].size(), 2u);
    for (const auto* key : {"crossed", "snapped", "elements_added", "elements_removed",
                            "nodes_added", "nodes_duplicated", "faces_opened"})
        EXPECT_EQ(report[key],
                  report["tools"][0][key].get<int>() + report["tools"][1][key].get<int>())
            << key;
    EXPECT_EQ(report["tools"][0]["tool"], "--plane");
    EXPECT_EQ(report["tools"][0]["value"], "0.3,0,0,1,0,0");
    EXPECT_EQ(report["tools"][0]["pieces"], 2);
    EXPECT_TRUE(report["tools"][1]["surface_distance"]["max"].is_null());
}

TEST_F(Cut, WritesAMeshThatReadsBackInComponents) {
    for (const auto* out : {"out.vtu", "out.vtk", "out.msh"}) {
        ASSERT_EQ(run("cut box.vtu --plane 0.3,0,0,1,0.2,0.1 --json report.json --out " +
                      std::string(out))
                      .status,
                  0);
        const auto report = json::parse(support::read_text(folder_ / "report.json"));
        const auto info = json::parse(run("info --json " + std::string(out)).out);
        EXPECT_EQ(info["components"], 2) << out;
        EXPECT_EQ(info["tets"], report["elements"]["after"]) << out;
        EXPECT_EQ(info["points"], report["nodes"]["after"]) << out;
        EXPECT_EQ(info["warnings"], json::array()) << out;
        EXPECT_NEAR(info["volume"].get<double>(), 1.0, 1e-14) << out;
        EXPECT_EQ(info["bounding_box"]["max"], (std::vector{1.0, 1.0, 1.0})) << out;  // at rest
    }
}

TEST_F(Cut, GoesOnFromAMeshThatItWrote) {
    const std::string first = " --plane 0.31,0.5,0.5,1,0.2,0.1",
                      second = " --plane 0.5,0.4,0.5,0.1,1,0.3",
                      third = " --remove-sphere 0.3,0.4,0.5,0.2";
    for (const std::string snap : {"", " --snap 0"}) {
        const auto at_once = cut(first + second + third + snap);
        const std::string written = support::read_text(folder_ / "out.vtu");
        const auto info = json::parse(run("info --json out.vtu").out);
        cut(first + snap);
        std::filesystem::rename(folder_ / "out.vtu", folder_ / "first.vtu");
        cut(second + snap, "first.vtu");
        std::filesystem::rename(folder_ / "out.vtu", folder_ / "second.vtu");
        const auto report = cut(third + snap, "second.vtu");
        for (const char* key : {"pieces", "ghost_nodes", "smallest_share"})
            EXPECT_EQ(report[key], at_once[key]) << key;
        for (const char* key : {"elements", "nodes", "volume", "fragments"})
            EXPECT_EQ(report[key]["after"], at_once[key]["after"]) << key;
        EXPECT_EQ(info["fragments"], at_once["fragments"]["after"]);
        EXPECT_EQ(info["ghost_nodes"], at_once["ghost_nodes"]);
        EXPECT_EQ(info["smallest_share"], at_once["smallest_share"]);
        EXPECT_EQ(support::read_text(folder_ / "out.vtu"), written);
    }
    EXPECT_FALSE(json::parse(run("info --json box.vtu").out).contains("fragments"));
    // Another format has no place for carriers, and says so.
    const auto outcome = run("convert first.vtu first.msh");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.err.find("first.msh: the format has no place for the carriers"),
              std::string::npos)
        << outcome.err;
    run("convert first.vtu copy.vtu");
    EXPECT_EQ(support::read_text(folder_ / "copy.vtu"), support::read_text(folder_ / "first.vtu"));
}

TEST_F(Cut, GivesTheSameBitsAgain) {
    const std::string arguments =
        "cut box.vtu --plane 0.3,0,0,1,0.2,0.1 --surface inner.obj --out ";
    ASSERT_EQ(run(arguments + "a.vtu").status, 0);
    ASSERT_EQ(run(arguments + "b.vtu").status, 0);
    EXPECT_EQ(support::read_text(folder_ / "a.vtu"), support::read_text(folder_ / "b.vtu"));
}

TEST_F(Cut, ReportsInATable) {
    const auto outcome = run("cut box.vtu --out out.vtu --plane 0.3,0,0,1,0,0 --snap 0");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    for (const auto* line : {"--plane 0.3,0,0,1,0,0\n    96 crossed, ",
                             "mode              split\npieces            2\n",
                             "  piece 1         volume 0.7, elements ", "elements          384 to ",
                             "elements crossed  96\n", "cut area          1\n"})
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << " in\n" << outcome.out;

    const auto to_file = run("cut box.vtu --out out.vtu --plane 0.3,0,0,1,0,0 --json report.json");
    EXPECT_EQ(to_file.out + to_file.err, "");
    EXPECT_TRUE(json::accept(support::read_text(folder_ / "report.json")));
}

TEST_F(Cut, AppliesToolsInTheOrderGiven) {
    const std::string plane = "--plane 0,0,0.8,0,0,1 ", top = "--remove-box -1,-1,0.5,2,2,2 ";
    const auto plane_first = cut(plane + top);
    EXPECT_EQ(plane_first["tools"][0]["pieces"], 2);
    EXPECT_EQ(plane_first["tools"][1]["pieces"], 1);
    EXPECT_NEAR(plane_first["volume_removed"].get<double>(), 0.5, 1e-14);
    EXPECT_GT(plane_first["crossed"], 0);
    EXPECT_EQ(plane_first["warnings"], json::array());

    const auto top_first = cut(top + plane);
    EXPECT_EQ(top_first["tools"][0]["tool"], "--remove-box");
    EXPECT_EQ(top_first["crossed"], 0);
    EXPECT_EQ(top_first["warnings"].size(), 1u);

    // Options of one kind do not come together.
    const auto mixed = cut("--plane 0.3,0,0,1,0,0 " + top + "--plane 0.6,0,0,1,0,0 " +
                           "--remove-sphere 0,0,0,0.2 --plane=-.1,0.4,0,0,-1,0");
    std::vector<std::string> order;
    for (const auto& tool : mixed["tools"]) order.push_back(tool["tool"]);
    EXPECT_EQ(order, (std::vector<std::string>{"--plane", "--remove-box", "--plane",
                                               "--remove-sphere", "--plane"}));
    EXPECT_EQ(mixed["pieces"].size(), 6u);
}

TEST_F(Cut, FreesTheInsideOfAClosedSurface) {
    const auto report = cut("--surface inner.obj --snap 0");
    // Only where faces of the surface meet is it followed within an element.
    expect_volumes(report, {1.0 - 0.216, 0.216}, 0.02);
    EXPECT_EQ(report["tools"][0]["pieces"], 2);
    EXPECT_LT(report["surface_distance"]["nodes"].get<double>(), 1e-7);
    // There its faces are off the surface, though their nodes are on it.
    EXPECT_GT(report["surface_distance"]["relative"].get<double>(), 1e-3);
    EXPECT_LT(report["surface_distance"]["relative"].get<double>(), 0.5);
}

TEST_F(Cut, WarnsOfSurfacesThatMeetThemselves) {
    write("fold.obj", "v 0 0 .5\nv 1 0 .5\nv 0 1 .5\nv 1 1 .5\nf 1 2 3\nf 1 2 4\n");
    const auto outcome = run("cut box.vtu --surface fold.obj --out out.vtu");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.err.find("warning: fold.obj: triangles lie upon each other, one near"),
              std::string::npos)
        << outcome.err;
}

TEST_F(Cut, FollowsABladeThroughItsPoses) {
    const auto through =
        cut("--snap 0 --sweep ' 0.3,-1,2; 0.3,0.5,2; 0.3,2,2 | 0.3,-1,0.6;0.3,0.5,0.7;0.3,2,0.6 |"
            "0.3,-1,-1; 0.3,0.5,-1; 0.3,2,-1 '");
    expect_volumes(through, {0.7, 0.3}, 1e-12);
    EXPECT_NEAR(through["cut_area"].get<double>(), 1.0, 1e-12);
    EXPECT_LT(through["surface_distance"]["max"].get<double>(), 1e-12);

    const auto half = cut("--snap 0 --sweep '0.3,-1,2;0.3,2,2 | 0.3,-1,0.4;0.3,2,0.4'");
    expect_volumes(half, {1.0}, 1e-12);
    EXPECT_GT(half["cut_area"].get<double>(), 0.3);  // within an element of 0.6
    EXPECT_LT(half["cut_area"].get<double>(), 0.9);
    EXPECT_GT(half["nodes_duplicated"], 0);
}

TEST_F(Cut, RemovesWhatShapesCover) {
    const auto box = cut("--remove-box -1,-1,-1,0.5,2,2");
    EXPECT_EQ(box["elements_removed"], 192);
    EXPECT_NEAR(box["volume_removed"].get<double>(), 0.5, 1e-14);
    EXPECT_LT(box["volume_error"].get<double>(), 1e-15);
    expect_volumes(box, {0.5}, 1e-14);
    EXPECT_TRUE(box["growth"].is_null());
    EXPECT_TRUE(box["microseconds_per_crossed_element"].is_null());

    EXPECT_NEAR(cut("--remove-sphere 0.5,0.5,0.5,0.4")["volume_removed"].get<double>(), 0.268,
                0.03);
    // Of it one half ball is inside.
    EXPECT_NEAR(cut("--remove-capsule 0.5,0.5,1,0.5,0.5,3,0.4")["volume_removed"].get<double>(),
                0.134, 0.03);
    // A ball, as a capsule without length.
    EXPECT_EQ(cut("--remove-capsule 0.5,0.5,0.5,0.5,0.5,0.5,0.4")["elements_removed"],
              cut("--remove-sphere 0.5,0.5,0.5,0.4")["elements_removed"]);
}

TEST_F(Cut, SeparatesHexahedraAlongTheirFaces) {
    const auto plane = cut("--mode separate --plane 0.55,0,0,1,0,0", "bricks.vtu");
    EXPECT_EQ(plane["mode"], "separate");
    EXPECT_TRUE(plane["snap"].is_null());
    EXPECT_EQ(plane["volume"]["after"], 1.0);
    expect_volumes(plane, {0.5, 0.5}, 1e-15);
    EXPECT_EQ(plane["crossed"], 32);
    EXPECT_EQ(plane["faces_opened"], 16);
    EXPECT_EQ(plane["nodes_duplicated"], 25);
    EXPECT_EQ(plane["cut_area"], 1.0);
    EXPECT_EQ(plane["growth"], 0.0);
    EXPECT_NEAR(plane["surface_distance"]["max"].get<double>(), 0.05, 1e-15);
    EXPECT_NEAR(plane["surface_distance"]["relative"].get<double>(), 0.2, 1e-15);
    EXPECT_NEAR(plane["stable_step_ratio"].get<double>(), 1.0, 1e-12);
    EXPECT_TRUE(plane["microseconds_per_crossed_element"].is_null());

    const auto surface = cut("--mode separate --surface inner.obj", "bricks.vtu");
    expect_volumes(surface, {0.875, 0.125}, 1e-15);  // the inner bricks
    EXPECT_NEAR(surface["surface_distance"]["max"].get<double>(), 0.05 * std::sqrt(3.0), 0.037);

    const auto sweep =
        cut("--mode separate --sweep '0.55,-1,2;0.55,2,2 | 0.55,-1,-1;0.55,2,-1'", "bricks.vtu");
    expect_volumes(sweep, {0.5, 0.5}, 1e-15);
    EXPECT_NEAR(sweep["surface_distance"]["max"].get<double>(), 0.05, 1e-15);
}

TEST_F(Cut, SeparatesTetrahedraIfAsked) {
    const auto report = cut("--mode separate --plane 0.55,0,0,1,0,0");
    EXPECT_EQ(report["elements"]["after"], 384);
    EXPECT_EQ(report["elements_added"], 0);
    EXPECT_EQ(report["pieces"].size(), 2u);
    EXPECT_GT(report["surface_distance"]["max"].get<double>(), 0.0);
}

TEST_F(Cut, CutsNothingTwice) {
    const auto report = cut("--plane 0.5,0,0,1,0,0 --plane 0.5,0,0,-2,0,0");
    expect_volumes(report, {0.5, 0.5}, 1e-15);
    EXPECT_EQ(report["elements_added"], 0);  // the plane runs through nodes
    EXPECT_EQ(report["tools"][1]["faces_opened"], 0);
    EXPECT_EQ(report["tools"][1]["nodes_added"], 0);
    EXPECT_EQ(report["warnings"].size(), 1u);
}

TEST_F(Cut, WarnsOfToolsThatMiss) {
    for (const auto* tool :
         {"--plane 5,0,0,1,0,0", "--sweep '5,0,0;5,1,0|5,0,1;5,1,1'", "--remove-sphere 5,0,0,1"}) {
        const auto outcome = run("cut box.vtu --out out.vtu " + std::string(tool));
        EXPECT_EQ(outcome.status, 0) << tool;
        EXPECT_EQ(outcome.err.find("incise: warning: box.vtu: --"), 0u) << outcome.err;
        EXPECT_NE(outcome.err.find("the body reached from 0 0 0 to 1 1 1 before the first tool"),
                  std::string::npos)
            << outcome.err;
    }
    EXPECT_EQ(json::parse(run("info out.vtu --json").out)["points"], 125);
}

struct Refusal {
    const char *arguments, *message;
};

TEST_F(Cut, RefusesWhatItCannotUnderstand) {
    for (const auto& [arguments, message] : std::initializer_list<Refusal>{
             {"",
              "no tool is given; use one or more of --plane, --surface, --sweep, "
              "--remove-sphere, --remove-box, --remove-capsule"},
             {"--plane 0,0,0,1", "--plane: '0,0,0,1' has 4 numbers; it needs 6: px,py,pz,nx,ny,nz"},
             {"--plane ''", "--plane: must not be empty"},
             {"--plane 0,0,0,1,0,x",
              "--plane: 'x' in '0,0,0,1,0,x' is no number; it needs 6: px,py,pz,nx,ny,nz"},
             {"--plane 0,0,0,1,,0",
              "--plane: '' in '0,0,0,1,,0' is no number; it needs 6: px,py,pz,nx,ny,nz"},
             {"--plane 0,0,nan,1,0,0", "--plane: 'nan' in '0,0,nan,1,0,0' is not allowed"},
             {"--plane 0,0,inf,1,0,0", "--plane: 'inf' in '0,0,inf,1,0,0' is not allowed"},
             {"--plane 0,0,0,-0,0,0", "--plane: '0,0,0,-0,0,0' has a normal of zero length"},
             {"--remove-sphere 0,0,0,0", "--remove-sphere: '0,0,0,0' has a radius of 0"},
             {"--remove-sphere 0,0,1", "--remove-sphere: '0,0,1' has 3 numbers; it needs 4"},
             {"--remove-capsule 0,0,0,1,0,0,-2",
              "--remove-capsule: '0,0,0,1,0,0,-2' has a radius of -2; it must be above 0"},
             {"--remove-box 0,0,0,1,-1,1", "--remove-box: '0,0,0,1,-1,1': y0 must be below y1"},
             {"--remove-box 0,0,0,1,1,0", "--remove-box: '0,0,0,1,1,0': z0 must be below z1"},
             {"--sweep '0,0,0;1,0,0'",
              "--sweep: '0,0,0;1,0,0' has 1 pose; a sweep needs at least "
              "2, with | between"},
             {"--sweep '0,0,0|1,0,0'",
              "--sweep: pose 1, '0,0,0', has 1 point; an edge needs at "
              "least 2, with ; between"},
             {"--sweep '0,0,0;1,0,0|0,0,1;1,0,1;2,0,1'",
              "--sweep: pose 2 has 3 points and pose 1 has 2; all poses need the same number"},
             {"--sweep '0,0,0;1,0,0|0,0,1;1,0'",
              "--sweep: pose 2, point 2: '1,0' has 2 numbers; it needs 3: x,y,z"},
             {"--surface none.stl", "none.stl: "},
             {"--surface box.vtu", "box.vtu: "},
             {"--mode spit --plane 0,0,0,1,0,0",
              "--mode: 'spit' is not known; did you mean "
              "'split'?"},
             {"--snap 1.5 --plane 0,0,0,1,0,0",
              "--snap: '1.5' is not allowed; it must be a number "
              "from 0 to 0.5"},
             {"--snap nan --plane 0,0,0,1,0,0", "--snap: 'nan' is not allowed"},
             {"--json out.vtu --plane 0,0,0,1,0,0", "--json: out.vtu is the mesh"},
             {"--json ./box.vtu --plane 0,0,0,1,0,0", "--json: box.vtu is the mesh"},
             {"--json ./cut.stl --surface cut.stl", "--json: cut.stl is the surface"},
             {"--remove-sphere 0,0,0,9",
              "box.vtu: --remove-sphere 0,0,0,9: removes the last "
              "element: nothing is left of the body"},
             {"--region-array nope --plane 0,0,0,1,0,0", "box.vtu: has no cell array 'nope'"}}) {
        const auto outcome = run("cut box.vtu --out out.vtu " + std::string(arguments));
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_EQ(outcome.err.find("incise: " + std::string(message)), 0u) << arguments << "\n"
                                                                           << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out.vtu")) << arguments;
    }
    const auto without_out = run("cut box.vtu --plane 0,0,0,1,0,0");
    EXPECT_EQ(without_out.status, 2);
    EXPECT_EQ(without_out.err, "incise: --out is required\nincise: see incise cut --help\n");
    EXPECT_EQ(run("cut none.vtu --out out.vtu --plane 0,0,0,1,0,0").err.find("incise: none.vtu:"),
              0u);
    EXPECT_NE(run("cut box.vtu --out out.doc --plane 0,0,0,1,0,0").err.find(".vtu"),
              std::string::npos);
}

TEST_F(Cut, DividesHexahedraExactly) {
    const auto plane = cut("--plane 0.55,0,0,1,0,0", "bricks.vtu");
    EXPECT_EQ(plane["mode"], "split");
    expect_volumes(plane, {0.55, 0.45}, 1e-13);
    EXPECT_EQ(plane["crossed"], 16);
    EXPECT_EQ(plane["elements_added"], 16);
    EXPECT_EQ(plane["growth"], 1.0);
    EXPECT_NEAR(plane["cut_area"].get<double>(), 1.0, 1e-13);
    EXPECT_LE(plane["surface_distance"]["max"].get<double>(), 1e-13);

    const auto oblique =
        cut("--plane 0.5,0.5,0.5,1,0.3,0.2 --plane 0.5,0.5,0.5,-0.2,1,0.4", "bricks.vtu");
    EXPECT_EQ(oblique["pieces"].size(), 4u);
    EXPECT_NEAR(oblique["volume"]["after"].get<double>(), 1.0, 1e-13);

    const auto outcome = run("cut bricks.vtu --out out.msh --plane 0.55,0,0,1,0,0");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("has no polyhedra, and cell "), std::string::npos) << outcome.err;
}

TEST_F(Cut, BecomesTetrahedraForFormatsWithoutPolyhedra) {
    cut("--plane 0.55,0.5,0.5,1,0.2,0.1", "bricks.vtu");
    const auto body = json::parse(run("info --json out.vtu").out);
    for (const std::string suffix : {".msh", ".inp", ".usda"}) {
        SCOPED_TRACE(suffix);
        const auto refused = run("convert out.vtu parts" + suffix);
        EXPECT_EQ(refused.status, 2);
        EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
        EXPECT_NE(refused.err.find("--cells tetrahedra"), std::string::npos) << refused.err;
        const auto outcome = run("convert out.vtu parts" + suffix + " --cells tetrahedra");
        EXPECT_EQ(outcome.status, 0);
        EXPECT_EQ(outcome.err, "");
        const auto parts = json::parse(run("info --json parts" + suffix).out);
        EXPECT_EQ(parts["components"], 2);
        EXPECT_EQ(parts["warnings"], json::array());
        EXPECT_EQ(parts["hexes"], 0);
        for (const char* key : {"volume", "surface_area"})
            EXPECT_NEAR(parts[key].get<double>(), body[key].get<double>(), 1e-12) << key;
    }
    EXPECT_EQ(run("convert out.vtu copy.vtu --cells polyhedra").status, 0);
    EXPECT_EQ(support::read_text(folder_ / "copy.vtu"), support::read_text(folder_ / "out.vtu"));
    const auto unknown = run("convert out.vtu copy.vtu --cells bricks");
    EXPECT_EQ(unknown.status, 2);
    EXPECT_NE(unknown.err.find("--cells: 'bricks' "), std::string::npos) << unknown.err;
}

TEST_F(Cut, GoesOnWithHexahedraThatItHasCut) {
    cut("--plane 0.55,0,0,1,0,0", "bricks.vtu");
    std::filesystem::rename(folder_ / "out.vtu", folder_ / "once.vtu");
    const auto info = json::parse(run("info --json once.vtu").out);
    EXPECT_EQ(info["hexes"], 48);
    EXPECT_EQ(info["polyhedra"], 32);
    EXPECT_EQ(info["polyhedra_are_parts_of"],
              (json{{"tets", 0}, {"hexes", 16}, {"wedges", 0}, {"pyramids", 0}}));
    EXPECT_EQ(info["components"], 2);
    EXPECT_EQ(info["fragments"], 80);
    EXPECT_NEAR(info["volume"].get<double>(), 1.0, 1e-13);
    EXPECT_NE(run("info once.vtu").out.find("polyhedra        32, parts of 16 hexahedra\n"),
              std::string::npos);
    EXPECT_EQ(run("check once.vtu").out.find("once.vtu: OK, mesh with "), 0u);

    const std::string oblique = "--plane 0.5,0.5,0.5,-0.2,1,0.4";
    const auto twice = cut(oblique, "once.vtu");
    EXPECT_EQ(twice["pieces"].size(), 4u);
    std::filesystem::rename(folder_ / "out.vtu", folder_ / "twice.vtu");
    cut("--plane 0.55,0,0,1,0,0 " + oblique, "bricks.vtu");
    EXPECT_EQ(support::read_text(folder_ / "twice.vtu"), support::read_text(folder_ / "out.vtu"));
    EXPECT_EQ(cut("--plane 0.55,0,0,1,0,0", "once.vtu")["crossed"], 0);

    EXPECT_EQ(run("convert once.vtu copy.vtu").err, "");
    EXPECT_EQ(support::read_text(folder_ / "copy.vtu"), support::read_text(folder_ / "once.vtu"));
    const auto for_viewers = run("convert once.vtu copy.vtk");
    EXPECT_EQ(for_viewers.status, 0);
    EXPECT_NE(for_viewers.err.find("polyhedra have no forces"), std::string::npos);
    const auto refused = run("check copy.vtk");
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("copy.vtk: cell 32 (polyhedron) and 31 more without a carrier"),
              std::string::npos)
        << refused.err;
}

TEST_F(Cut, ReportsOutputFailures) {
    for (const auto* arguments : {"--out no/such/out.vtu", "--out out.vtu --json no/such/a.json"}) {
        const auto outcome = run("cut box.vtu --plane 0.3,0,0,1,0,0 " + std::string(arguments));
        EXPECT_EQ(outcome.status, 4) << arguments;
        EXPECT_EQ(outcome.err.find("incise: no/such/"), 0u) << outcome.err;
    }
}

TEST_F(Cut, ExplainsItselfInItsHelp) {
    const auto help = run("cut --help").out;
    for (const auto* words :
         {"px,py,pz,nx,ny,nz", "x0,y0,z0,x1,y1,z1,r", "applied in the order given",
          "opens existing faces", "stable_step_ratio is geometric", "Examples:"})
        EXPECT_NE(help.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace incise
