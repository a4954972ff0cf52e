// Bad tools of scenarios: every problem is found, at its location, in words that help.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "scenario_file.h"

namespace incise::scenario {
namespace {

TEST(ToolErrors, OfPathsAndKinds) {
    const std::string grasper =
        "[[tool]]\nkind = \"grasper\"\nshape = { sphere = { radius = 0.1 } }\nclose = 0.1\n";
    EXPECT_EQ(error_of(grasper + "path = [{ time = 0, at = [0, 0, 0] }]\n"),
              "scene.toml:13:8: key 'tool[0].path': must have at least 2 times: a grasper is there "
              "from the first to the last");
    EXPECT_EQ(
        error_of(grasper + "open = 3\npath = [{ time = 0, at = [0, 0, 0] }, { time = 1, at = "
                           "[0, 0, 1] }]\n"),
        "scene.toml:13:8: key 'tool[0].open': 3 is not allowed: must be within the path, from "
        "0 to 1 s");
    EXPECT_EQ(
        error_of("[[obstacle]]\nshape = { half_space = { point = [0, 0, 0], normal = [0, 0, 1] "
                 "} }\n[contact]\nenabled = false\n"),
        "scene.toml:9:1: key 'obstacle[0]': an obstacle touches tissue, but [contact] has "
        "enabled = false");
    EXPECT_EQ(error_of("[[tool]]\nsnap = 0.1\n"),
              "scene.toml:9:1: key 'tool[0].kind': is missing: must be one of blade, carver, cut, "
              "probe, grasper, suture, scissors");
    const std::string path = "path = [{ time = 0, at = [0, 0, 0] }]\n";
    EXPECT_EQ(error_of("[[tool]]\nkind = \"carver\"\nedge = [[0, 0, 0]]\nshape = {}\n" + path),
              "scene.toml:11:8: key 'tool[0].edge': belongs to a blade: leave it out | "
              "scene.toml:12:9: key 'tool[0].shape': must have exactly one of sphere, capsule, "
              "box");
    EXPECT_EQ(error_of("[[tool]]\nkind = \"carver\"\nshape = { sphere = { radius = 0 } }\n" + path),
              "scene.toml:11:31: key 'tool[0].shape.sphere.radius': 0 is not allowed: must be "
              "above 0");
    EXPECT_EQ(error_of("[[tool]]\nkind = \"blade\"\nmode = \"separate\"\n"
                       "edge = [[0, 0, 1], [0, 0, 1]]\n" +
                       path),
              "scene.toml:12:8: key 'tool[0].edge': points 0 and 1 (from 0) are the same: leave "
              "one out | scene.toml:13:8: key 'tool[0].path': must have at least 2 times: a blade "
              "cuts where it moves");
    const std::string blade =
        "[[tool]]\nkind = \"blade\"\nedge = [[0, 0, 0], [1, 0, 0]]\n"
        "path = [{ time = 0, at = [0, 0, 0] }, { time = 1, at = [0, 0, 1] }]\n";
    EXPECT_EQ(error_of(blade), "");
    EXPECT_EQ(error_of(blade + "mode = \"slit\"\n"),
              "scene.toml:13:8: key 'tool[0].mode': 'slit': is not known; did you mean 'split'? "
              "Known here: split, separate");
    EXPECT_EQ(error_of(blade + "snap = 1.5\n"),
              "scene.toml:13:8: key 'tool[0].snap': 1.5 is not allowed: must be at least 0 and "
              "at most 0.5");
    EXPECT_EQ(error_of(blade + "mode = \"separate\"\nsnap = 0.1\n"),
              "scene.toml:14:8: key 'tool[0].snap': belongs to mode = \"split\": leave it out");
    EXPECT_EQ(error_of(blade + "time = 1\n"),
              "scene.toml:13:8: key 'tool[0].time': belongs to a cut or a suture: leave it out");
}

TEST(ToolErrors, OfTheForceOfCutting) {
    const std::string blade =
        "[[tool]]\nkind = \"blade\"\nedge = [[0, 0, 0], [1, 0, 0]]\n"
        "path = [{ time = 0, at = [0, 0, 0] }, { time = 1, at = [0, 0, 1] }]\n";
    EXPECT_EQ(error_of(blade + "toughness = 160\ncutting_force = \"report\"\n"), "");
    EXPECT_EQ(error_of(blade + "toughness = 0\n"),
              "scene.toml:13:13: key 'tool[0].toughness': 0 is not allowed: must be above 0");
    EXPECT_EQ(error_of(blade + "cutting_force = \"apply\"\n"),
              "scene.toml:9:1: key 'tool[0].toughness': is missing: energy to open an area, J/m2, "
              "as in toughness = 160");
    EXPECT_EQ(error_of(blade + "toughness = 1\n[contact]\nenabled = false\n"),
              "scene.toml:13:13: key 'tool[0].toughness': gives a force of cutting, which needs "
              "contact, but [contact] has enabled = false");
    EXPECT_EQ(error_of("[[tool]]\nkind = \"cut\"\ntime = 0\nplane = { point = [0, 0, 0], normal "
                       "= [0, 0, 1] }\ntoughness = 1\n"),
              "scene.toml:13:13: key 'tool[0].toughness': belongs to a blade: leave it out");
    EXPECT_EQ(
        error_of(blade + "toughness = 1\nmode = \"separate\"\n"),
        "scene.toml:13:13: key 'tool[0].toughness': belongs to mode = \"split\": leave it out");
    // Elements of 0.5 m of 1,600 Pa bear up to 1,200 J/m2.
    const auto too_tough =
        ScenarioFile(minimal + blade + "toughness = 1300\ncutting_force = \"apply\"\n")
            .all_errors();
    ASSERT_EQ(too_tough.size(), 1u);
    EXPECT_EQ(too_tough[0],
              "scene.toml:9:1: tool 'blade_1': a toughness of 1300 J/m2 cannot be applied: up to "
              "1200 J/m2 the softest material bears it at elements of 0.5 m; use larger elements, "
              "a lower toughness, or report the force");
}

TEST(ToolErrors, OfTheSurfaceOfAProbe) {
    const std::string probe =
        "[[obstacle]]\nshape = { surface = { file = \"liver.vtu\", scale = 0 } }\n";
    EXPECT_EQ(error_of(probe),
              "scene.toml:10:51: key 'obstacle[0].shape.surface.scale': 0 is not allowed: must be "
              "above 0");
    EXPECT_NE(error_of("[[obstacle]]\nshape = { surface = { file = \"none.stl\" } }\n")
                  .find("there is no file"),
              std::string::npos);
    EXPECT_EQ(error_of("[[obstacle]]\nshape = { surface = {} }\n"),
              "scene.toml:10:21: key 'obstacle[0].shape.surface.file': is missing: a closed "
              "surface, as in file = \"probe.stl\"");
    const support::TemporaryFolder folder;
    const auto file = folder / "open.off";
    std::ofstream(file) << "OFF\n3 1 0\n0 0 2\n1 0 2\n0 1 2\n3 0 1 2\n";
    const auto errors = ScenarioFile(minimal + "[[obstacle]]\nshape = { surface = { file = \"" +
                                     file.string() + "\" } }\n")
                            .all_errors();
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0], "scene.toml:10:30: " + file.string() +
                             ": its surface is open: it ends at [0.5, 0, 2]; close it, as a probe "
                             "is solid");
}

TEST(ToolErrors, OfSutures) {
    const std::string suture = "[[tool]]\nkind = \"suture\"\nstiffness = 200\n";
    const std::string points = "points = [[0.2, 0.2, 1.1], [0.8, 0.2, 1.0]]\n";
    EXPECT_EQ(error_of(suture + points + "time = 0.1\n"), "");
    EXPECT_EQ(error_of("[[tool]]\nkind = \"suture\"\n"),
              "scene.toml:9:1: key 'tool[0].points': is missing: a line of points at rest, as in "
              "points = [[0, 0, 0], [0.01, 0, 0]] | scene.toml:9:1: key 'tool[0].stiffness': is "
              "missing: of the thread, N/m, as in stiffness = 200 | scene.toml:9:1: key "
              "'tool[0].time': is missing: when it is tied, seconds, as in time = 0.5");
    EXPECT_EQ(error_of(suture + "points = [[0, 0, 0]]\ntime = 0\n"),
              "scene.toml:12:10: key 'tool[0].points': must have at least 2 points");
    EXPECT_EQ(error_of(suture + points + "time = 0\ntighten = { over = -1 }\n"),
              "scene.toml:14:11: key 'tool[0].tighten.length': is missing: to which the thread is "
              "drawn, m, as in length = 0.001 | scene.toml:14:20: key 'tool[0].tighten.over': -1 "
              "is not allowed: must be above 0");
    EXPECT_EQ(error_of(suture + "points = [[0, 0, 0], [0, 0, 0]]\ntime = 0\n"),
              "scene.toml:12:10: key 'tool[0].points': points 0 and 1 (from 0) are the same: leave "
              "one out");
    EXPECT_EQ(
        ScenarioFile(minimal + suture + points + "time = 1\n").warnings(),
        std::vector<std::string>{"scene.toml:13:8: tool 'suture_1' is tied at the end of the run"});
    EXPECT_EQ(ScenarioFile(minimal + suture + points +
                           "time = 0.9\ntighten = { over = 0.2, length = 0 }\n")
                  .warnings(),
              std::vector<std::string>{
                  "scene.toml:14:11: tool 'suture_1' is drawn until 1.1 s, after the end at 1 s"});
    EXPECT_EQ(
        error_of(suture + points + "time = 0\npath = []\n"),
        "scene.toml:14:8: key 'tool[0].path': a suture has none: its points are in the tissue; "
        "leave it out");
    EXPECT_EQ(error_of(suture + points + "time = 0\n[contact]\nenabled = false\n"),
              "scene.toml:10:8: key 'tool[0].kind': 'suture' touches tissue, but [contact] has "
              "enabled = false");
    const auto far =
        ScenarioFile(minimal + suture + points + "time = 0\nreach = 0.05\n").all_errors();
    ASSERT_EQ(far.size(), 1u);
    EXPECT_EQ(far[0],
              "scene.toml:9:1: tool 'suture_1': point 0 (from 0), [0.2, 0.2, 1.1], is farther than "
              "its reach, 0.05 m, from the body at rest; check its coordinates and units");
}

TEST(ToolErrors, OfScissorsThatHaveNoTime) {
    const std::string scissors =
        "[[tool]]\nkind = 'scissors'\nlength = 2\n"
        "path = [{ time = 0, at = [0, 0, 0] }, { time = 0.5, at = [0, 0, 0] }]\n";
    const auto warnings_of = [&](const std::string& more) {
        return ScenarioFile(minimal + scissors + more).warnings();
    };
    EXPECT_TRUE(warnings_of("close = 0.1\n").empty());
    EXPECT_TRUE(warnings_of("close = 0.1\nopen = 0.3\n").empty());
    for (const std::string more :
         {"close = 0.4\n", "close = 0.1\nopen = 0.2\n", "close = 0.2\nclosing_time = 0.6\n"}) {
        const auto warnings = warnings_of(more);
        ASSERT_EQ(warnings.size(), 1u) << more;
        EXPECT_NE(warnings[0].find("closes by 50 % only"), std::string::npos) << warnings[0];
    }
}

TEST(ToolErrors, OfScissors) {
    const std::string scissors = "[[tool]]\nkind = \"scissors\"\n";
    const std::string path =
        "path = [{ time = 0.1, at = [0, 0, 0] }, { time = 0.9, at = [0, 0, 0] }]\n";
    EXPECT_EQ(error_of(scissors +
                       "length = 2\nclose = 0.2\nopen = 0.5\nangle = 1\n"
                       "closing_time = 0.1\nsnap = 0\n" +
                       path),
              "");
    EXPECT_EQ(error_of(scissors + path),
              "scene.toml:9:1: key 'tool[0].length': is missing: from the pivot to the tips, m, as "
              "in length = 0.02 | scene.toml:9:1: key 'tool[0].close': is missing: when they begin "
              "to close, seconds, as in close = 0.2");
    EXPECT_EQ(
        error_of(scissors + "length = 0\nangle = 2.5\nclosing_time = 0\nclose = 1\n" + path),
        "scene.toml:11:10: key 'tool[0].length': 0 is not allowed: must be above 0 | "
        "scene.toml:12:9: key 'tool[0].angle': 2.5 is not allowed: must be at least 0.01 and "
        "below 2.5 | scene.toml:13:16: key 'tool[0].closing_time': 0 is not allowed: must be above "
        "0 | scene.toml:14:9: key 'tool[0].close': 1 is not allowed: must be within the path, "
        "from 0.1 to 0.9 s");
    EXPECT_EQ(
        error_of(scissors + "length = 1\nclose = 0.2\npath = [{ time = 0, at = [0, 0, 0] }]\n"),
        "scene.toml:13:8: key 'tool[0].path': must have at least 2 times: scissors are there "
        "from the first to the last");
    EXPECT_EQ(
        error_of("[[tool]]\nkind = \"blade\"\nedge = [[0, 0, 0], [0, 0, 1]]\nangle = 1\n"
                 "close = 0.5\n" +
                 path),
        "scene.toml:12:9: key 'tool[0].angle': belongs to scissors: leave it out | "
        "scene.toml:13:9: key 'tool[0].close': belongs to a grasper or scissors: leave it out");
}

TEST(ToolErrors, OfCuts) {
    const std::string cut = "[[tool]]\nkind = \"cut\"\n";
    EXPECT_EQ(error_of(cut),
              "scene.toml:9:1: key 'tool[0]': must have exactly one of plane, surface | "
              "scene.toml:9:1: key 'tool[0].time': is missing: when it cuts, seconds, as in time = "
              "0.5");
    EXPECT_EQ(error_of(cut + "time = -1\nplane = { point = [0, 0, 0], normal = [0, 0, 0] }\n"),
              "scene.toml:11:8: key 'tool[0].time': -1 is not allowed: must be at least 0 | "
              "scene.toml:12:39: key 'tool[0].plane.normal': is not allowed: a direction must have "
              "a length above 0");
    // What lies along no plane or along two surfaces is not compared with the body.
    for (const char* along :
         {"", "surface = 'none.stl'\nplane = { point = [9, 9, 9], normal = [1, 0, 0] }\n"}) {
        const auto report = ScenarioFile(minimal + cut + "time = 0\n" + along).read();
        EXPECT_NE(report.errors.at(0).find("plane, surface"), std::string::npos)
            << report.errors[0];
        EXPECT_TRUE(report.scenario.tools.at(0).path.empty());
    }
    EXPECT_NE(error_of(cut + "time = 1\nsurface = \"none.stl\"\n").find("there is no file"),
              std::string::npos);
    EXPECT_EQ(error_of(cut + "time = 1\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n"
                             "path = []\nedge = [[0, 0, 0], [1, 0, 0]]\nscale = 2\n"),
              "scene.toml:13:8: key 'tool[0].path': belongs to a blade: leave it out | "
              "scene.toml:14:8: key 'tool[0].edge': belongs to a blade: leave it out | "
              "scene.toml:15:9: key 'tool[0].scale': is for surfaces: leave it out");
}

TEST(ToolErrors, OfAKindHideNoSurface) {
    for (const std::string kind : {"", "kind = 'cat'\n"}) {
        const auto errors =
            ScenarioFile(minimal + "[[tool]]\n" + kind + "time = 0.1\nsurface = 'liver.vtu'\n")
                .all_errors();
        ASSERT_EQ(errors.size(), 2u) << kind;
        EXPECT_NE(errors[0].find("key 'tool[0].kind': "), std::string::npos) << errors[0];
        EXPECT_NE(errors[1].find(": liver.vtu: "), std::string::npos) << errors[1];
    }
    // It is read as a blade and as a cut; the surface is sound.
    const support::TemporaryFolder folder;
    const auto file = folder / "triangle.off";
    std::ofstream(file) << "OFF\n3 1 0\n0 0 0.5\n1 0 0.5\n0 1 0.5\n3 0 1 2\n";
    const auto errors = ScenarioFile(minimal +
                                     "[[tool]]\nkind = 'cat'\nedge = [[0, 0, 0], [1, 0, 0]]\n"
                                     "surface = '" +
                                     file.string() + "'\n")
                            .all_errors();
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_NE(errors[0].find("key 'tool[0].kind': "), std::string::npos) << errors[0];
    EXPECT_EQ(ScenarioFile(minimal + "[[tool]]\nsnap = 0.9\ntoughness = -1\n").all_errors().size(),
              3u);
}

}  // namespace
}  // namespace incise::scenario
