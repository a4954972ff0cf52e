// The promise of `check`: all problems of a scenario at once, each with its place.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "scenario_file.h"

namespace incise::sim {
namespace {

using Lines = std::vector<std::string>;

TEST(AllProblems, OfMoreFramesThanADiskHolds) {
    const auto with = [](const std::string& interval) {
        return ScenarioFile(minimal + "[output]\ninterval = " + interval + "\n");
    };
    for (const std::string interval : {"1e-300", "1e-12", "9e-08"}) {
        const auto errors = with(interval).errors();
        ASSERT_EQ(errors.size(), 1u) << interval;
        EXPECT_EQ(errors[0].find("scene.toml:10:12: key 'output.interval': an interval of " +
                                 interval + " s makes "),
                  0u)
            << errors[0];
        EXPECT_EQ(with(interval).warnings(), Lines{});
    }
    EXPECT_EQ(with("1e-6").errors(), Lines{});
    EXPECT_EQ(with("1e-6").warnings(),
              Lines{"scene.toml:10:12: the output interval of 1e-06 s makes 1e+06 frames"});
    EXPECT_EQ(ScenarioFile(minimal).errors({"dynamics.end_time=1e9"}).size(), 1u)
        << "at the usual interval";
}

const std::string two_faults = R"([[tool]]
kind = "cut"
time = 0.01
surface = "liver.vtu"
[[constraint]]
where = { nodes = [1, 99] }
fix = "x"
)";

/// "LINE:COLUMN" of each.
Lines places_of(const Lines& errors) {
    Lines places;
    const std::string file = "scene.toml:";
    for (const auto& error : errors)
        places.push_back(error.substr(file.size(), error.find(": ") - file.size()));
    return places;
}

TEST(AllProblems, OfTheTextDoNotHideThoseOfTheBody) {
    EXPECT_EQ(places_of(ScenarioFile(minimal + two_faults).all_errors()), (Lines{"14:9", "12:11"}));
    // Whatever else is at fault, with mesh and selections that are sound.
    for (const std::string other :
         {"titel = 'a'\n", "[output]\ninterval = -1\n", "[[tool]]\nkind = 'knife'\n",
          "[[tool]]\nkind = 'cut'\ntime = 0.01\nsurface = 'missing.stl'\n",
          "[[load]]\nwhere = { region = 7 }\npressure = 'a'\n"}) {
        const bool is_root = other[0] == 't';
        const auto errors =
            ScenarioFile((is_root ? other : "") + minimal + two_faults + (is_root ? "" : other))
                .all_errors();
        EXPECT_EQ(errors.size(), 3u) << other;
    }
}

TEST(AllProblems, OfTheMeshDoNotHideThoseOfSurfaces) {
    const auto errors =
        ScenarioFile("[mesh]\nfile = 'liver.vtu'\n" + minimal_rest + two_faults).all_errors();
    EXPECT_EQ(places_of(errors), (Lines{"2:8", "12:11"}));
    EXPECT_EQ(errors[0].find("scene.toml:2:8: liver.vtu: "), 0u) << errors[0];
    // What is made of a part at fault is left alone.
    EXPECT_EQ(places_of(ScenarioFile(minimal + "time_step = 5\n" + two_faults + R"([[material]]
regions = 5
preset = "livr"
)")
                            .all_errors()),
              (Lines{"19:10", "15:9", "13:11"}));
    EXPECT_EQ(places_of(ScenarioFile(minimal + "time_step = 5\nmode = 1\n").all_errors()),
              Lines{"10:8"});
}

TEST(AllProblems, OfSupportsAreAllPairsAndHideNoStep) {
    const std::string text = minimal + "time_step = 5\n" + R"([[constraint]]
where = { nodes = [3] }
fix = "x"
[[constraint]]
where = { nodes = [3] }
fix = "xy"
[[constraint]]
where = { nodes = [1, 3] }
fix = "yx"
[[constraint]]
where = { nodes = [1, 3] }
fix = "z"
)";
    const auto errors = ScenarioFile(text).all_errors();
    ASSERT_EQ(errors.size(), 4u);
    EXPECT_EQ(errors[0],
              "scene.toml:14:9: node 3 is held in x by both 'constraint_1' and 'constraint_2'; "
              "make their selections disjoint");
    EXPECT_EQ(errors[1].find("scene.toml:17:9: node 3 is held in x by both 'constraint_1' and "
                             "'constraint_3'"),
              0u);
    EXPECT_EQ(errors[2].find("scene.toml:17:9: node 3 is held in x by both 'constraint_2' and "
                             "'constraint_3'"),
              0u);
    EXPECT_EQ(errors[3].find("scene.toml:9:13: dynamics.time_step of 5 s is above the stable"), 0u);
}

TEST(AllProblems, OfABoxTooFarOrOfAnotherSizeThanNumbersHaveNameItsKey) {
    const auto error = [](const std::string& mesh) {
        const auto errors = ScenarioFile("[mesh]\n" + mesh + "\n" + minimal_rest).all_errors();
        return errors.size() == 1 ? errors[0] : std::to_string(errors.size()) + " errors";
    };
    const std::string box = "box = { size = [1, 1, 1], cells = [1, 2, 2]";
    EXPECT_EQ(error(box + ", origin = [1e20, 0, 0] }"),
              "scene.toml:2:7: key 'mesh.box': its bricks of [1, 0.5, 0.5] are lost to rounding so "
              "far from [0, 0, 0]: bring 'origin', now [1e+20, 0, 0], nearer to it, or make the "
              "bricks larger");
    EXPECT_EQ(error(box + " }\nscale = 1e308"),
              "scene.toml:3:9: key 'mesh.scale': 1e+308 makes the mesh too large to compute with, "
              "which without it is sound: use a smaller one");
    EXPECT_EQ(error(box + " }\nscale = 1e-308"),
              "scene.toml:3:9: key 'mesh.scale': 1e-308 makes the mesh too small to compute with, "
              "which without it is sound: use a larger one");
    EXPECT_EQ(error("box = { size = [1e-200, 1e-200, 1], cells = [1, 1, 1] }"),
              "scene.toml:2:7: key 'mesh.box': its bricks of [1e-200, 1e-200, 1] have a volume too "
              "small to compute with: use smaller units of length");
}

TEST(AllProblems, OfAMaterialThatDoesNotSuitItsElementsHaveItsPlace) {
    EXPECT_EQ(places_of(ScenarioFile(minimal + "time_step = 5\n[[material]]\nregions = 0\n"
                                               "method = 'hybmss'\ndensity = 1\nyoung = 1\n"
                                               "poisson = 0.3\n")
                            .all_errors()),
              Lines{"10:1"});
}

}  // namespace
}  // namespace incise::sim
