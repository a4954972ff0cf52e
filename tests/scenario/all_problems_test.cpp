// The promise of `check`: all problems of a scenario at once, each with its location.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>

#include "scenario_file.h"

namespace incise::scenario {
namespace {

using Lines = std::vector<std::string>;

TEST(AllProblems, OfMoreFramesThanADiskHolds) {
    const auto with = [](const std::string& interval) {
        return ScenarioFile(minimal + "[output]\ninterval = " + interval + "\n");
    };
    for (const std::string interval : {"1e-300", "1e-12", "9e-08"}) {
        const auto errors = with(interval).errors();
        ASSERT_EQ(errors.size(), 1u) << interval;
        EXPECT_EQ(errors[0].find("scene.toml:10:12: key 'output.interval': an output interval of " +
                                 interval + " s makes "),
                  0u)
            << errors[0];
        EXPECT_EQ(with(interval).warnings(), Lines{});
    }
    EXPECT_EQ(with("1e-6").errors(), Lines{});
    EXPECT_EQ(with("1e-6").warnings(),
              Lines{"scene.toml:10:12: the output interval of 1e-06 s makes 1e+06 frames"});
    // At the usual interval.
    EXPECT_EQ(ScenarioFile(minimal).errors({"dynamics.end_time=1e9"}),
              Lines{"scene.toml:7:1: key 'dynamics': an output interval of 0.01 s makes 1e+11 "
                    "frames of a run of 1e+09 s, more than the 1e+07 allowed: use a longer one, or "
                    "0 for no frames"});
    // Nothing is said of the usual interval in location of one that cannot be read.
    const ScenarioFile unreadable(minimal + "[output]\ninterval = 'x'\n");
    EXPECT_EQ(
        unreadable.errors({"dynamics.end_time=200000"}),
        Lines{"scene.toml:10:12: key 'output.interval': must be a number, but is the text \"x\""});
    EXPECT_EQ(unreadable.warnings({"dynamics.end_time=0.001"}), Lines{});
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

TEST(AllProblems, OfTheTextHideNoneOfTheBody) {
    EXPECT_EQ(places_of(ScenarioFile(minimal + two_faults).all_errors()), (Lines{"14:9", "12:11"}));
    // Whatever else is at fault, with mesh and selections that are sound.
    for (const std::string other :
         {"titel = 'a'\n", "[output]\ninterval = -1\n", "[[tool]]\nkind = 'knife'\n",
          "[[tool]]\nkind = 'cut'\ntime = 0.01\nsurface = 'missing.stl'\n",
          "[[load]]\nwhere = { region = 0 }\npressure = 'a'\n"}) {
        const bool is_root = other[0] == 't';
        const auto errors =
            ScenarioFile((is_root ? other : "") + minimal + two_faults + (is_root ? "" : other))
                .all_errors();
        EXPECT_EQ(errors.size(), 3u) << other;
    }
}

TEST(AllProblems, OfTheMeshHideNoneOfSurfaces) {
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

TEST(AllProblems, DoNotHideBehindUnknownKeys) {
    const auto places = [](std::string text, const std::string& known, const std::string& given) {
        text.replace(text.find(known), known.size(), given);
        return places_of(ScenarioFile(text + two_faults).all_errors());
    };
    // Misspelt ones mean what they were to mean.
    const std::string scaled = minimal_mesh + "scale = 100\n" + minimal_rest +
                               "time_step = 5\n[[constraint]]\nname = 'far'\n"
                               "where = { box = { min = [90, 90, 90], max = [110, 110, 110] } }\n"
                               "fix = 'x'\n";
    const auto before = places(scaled, "scale", "scale");
    EXPECT_EQ(before.size(), 2u);  // the step of 5 s holds for a body so large
    for (const auto& [known, given, location] :
         {std::array<std::string, 3>{"scale", "scael", "3:1"},
          {"mesh", "msh", "1:2"},
          {"box", "bxo", "2:1"},
          {"material", "materials", "4:3"},
          {"young", "yuong", "6:1"},
          {"dynamics", "dynamic", "8:2"},
          {"end_time", "endtime", "9:1"},
          {"fix =", "fixed =", "14:1"},
          {"[[constraint]]\nname", "[[constraint]]\nnmae", "12:1"}}) {
        auto errors = places(scaled, known, given);
        EXPECT_EQ(std::erase(errors, location), 1u) << given;
        EXPECT_EQ(errors, before) << given;
    }
    // Of others nothing is made.
    for (const std::string line : {"depth = 3", "xyz = 'a'", "e = []"}) {
        auto errors = places(scaled, "scale = 100", "scale = 100\n" + line);
        EXPECT_EQ(std::erase(errors, "4:1"), 1u) << line;
        EXPECT_EQ(errors.size(), before.size()) << line;
    }
}

TEST(AllProblems, OfConstraintsNameTheFirstHolder) {
    const std::string text = minimal + "time_step = 5\n" + R"([[constraint]]
where = { nodes = [3] }
fix = "x"
[[constraint]]
where = { nodes = [3] }
fix = "xy"
move = [{ time = 0, by = [0, 0, 0] }, { time = 1, by = [1, 1, 0] }]
[[constraint]]
where = { nodes = [1, 3] }
fix = "yx"
move = [{ time = 0, by = [0, 0, 0] }, { time = 1, by = [2, 2, 0] }]
[[constraint]]
where = { nodes = [1, 3] }
fix = "z"
)";
    const auto errors = ScenarioFile(text).all_errors();
    ASSERT_EQ(errors.size(), 4u);
    EXPECT_EQ(errors[0],
              "scene.toml:14:9: node 3 is held in x by both 'constraint_1' and 'constraint_2', "
              "with different motion; make their selections disjoint or their motion there equal");
    EXPECT_EQ(errors[1].find("scene.toml:18:9: node 3 is held in x by both 'constraint_1' and "
                             "'constraint_3'"),
              0u);
    EXPECT_EQ(errors[2].find("scene.toml:18:9: node 3 is held in y by both 'constraint_2' and "
                             "'constraint_3'"),
              0u);
    EXPECT_EQ(errors[3].find("scene.toml:9:13: dynamics.time_step of 5 s is above the stable"), 0u);
}

TEST(AllProblems, OfManyConstraintsAreTheFirstFew) {
    const auto errors = [](std::size_t num_constraints) {
        std::string text = minimal;
        for (std::size_t i = 0; i < num_constraints; ++i)
            text += "[[constraint]]\nwhere = { region = 0 }\nmove = [{ time = 0, by = [" +
                    std::to_string(i) + ", 0, 0] }]\n";
        return ScenarioFile(text).all_errors();
    };
    EXPECT_EQ(errors(11).size(), 10u);
    EXPECT_EQ(errors(12).back(),
              "scene.toml:43:9: and 1 more pair of constraints from here on move a node "
              "differently in the same direction; make their selections disjoint or their motion "
              "there equal");
    const auto many = errors(1000);
    ASSERT_EQ(many.size(), 11u);
    EXPECT_EQ(many[9].find("scene.toml:40:9: node 0 is held in x by both 'constraint_1' and "
                           "'constraint_11'"),
              0u)
        << many[9];
    EXPECT_EQ(many[10].find("scene.toml:43:9: and 989 more pairs of constraints "), 0u) << many[10];
}

TEST(AllProblems, OfBoxesOutOfRangeNameTheirKey) {
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

TEST(AllProblems, OfExclusiveKeysHideNoneOfTheirValues) {
    EXPECT_EQ(places_of(ScenarioFile("[mesh]\nfile = 'none.vtu'\nbox = { size = [1, 0, 1], cells = "
                                     "[1, 1, 1.5] }\n" +
                                     minimal_rest)
                            .errors()),
              (Lines{"1:1", "2:8", "3:16", "3:35"}));
    EXPECT_EQ(
        places_of(ScenarioFile(minimal + R"([[tool]]
kind = "carver"
shape = { sphere = { radius = -1 }, box = { size = [1, 0, 1] } }
path = [{ time = 0, at = [0, 0, 0] }]
[[tool]]
kind = "cut"
time = 0
plane = { point = [0, 0, 0], normal = [0, 0, 0] }
surface = "none.stl"
[[load]]
pressure = "a"
traction = [1, 2]
)")
                      .errors()),
        (Lines{"11:9", "11:31", "11:52", "13:1", "16:39", "17:11", "18:1", "19:12", "20:12"}));
}

TEST(AllProblems, OfEdgePointsSayNothingOfTheirNumber) {
    EXPECT_EQ(ScenarioFile(minimal + R"([[tool]]
kind = "blade"
edge = [[0, "a", 0], [0, 1, 0]]
path = [{ time = 0, at = [0, 0, 0] }, { time = 1, at = [0, 0, 1] }]
)")
                  .errors(),
              (Lines{"scene.toml:11:13: key 'tool[0].edge[0][1]': must be a number, but is the "
                     "text \"a\""}));
}

TEST(AllProblems, OfBothFibreKeysAreThoseOfEach) {
    const auto errors = ScenarioFile(minimal_mesh + R"([[material]]
law = "holzapfel-gasser-ogden"
density = 1
c1 = 1
k1 = 1
k2 = 1
bulk_modulus = 1
fibre = [0, 0, 0]
fibre_array = "a"
[dynamics]
end_time = 1
)")
                            .errors();
    EXPECT_EQ(places_of(errors), (Lines{"3:1", "10:9", "11:15"}));
    EXPECT_EQ(errors[0],
              "scene.toml:3:1: key 'material[0]': has fibre, fibre_array, but only one of fibre, "
              "fibre_array is allowed");
}

TEST(AllProblems, OfRegionsAreThoseNamedTwice) {
    const auto errors = [](const std::string& regions) {
        return ScenarioFile(
                   minimal_mesh + "[[material]]\nregions = " + regions +
                   "\npreset = 'fat'\n[dynamics]\nend_time = 1\n[[load]]\nwhere = { region = " +
                   regions + " }\npressure = 1\n")
            .errors();
    };
    EXPECT_EQ(errors("[0, 1]"), Lines{});
    EXPECT_EQ(errors("[0, 0]"),
              (Lines{"scene.toml:4:15: key 'material[0].regions[1]': 0 is there twice",
                     "scene.toml:9:24: key 'load[0].where.region[1]': 0 is there twice"}));
    EXPECT_EQ(places_of(errors("[1, 1, 'a']")), (Lines{"4:15", "4:18", "9:24", "9:27"}));
}

TEST(AllProblems, OfMaterialValuesHideNoneOfTheKeys) {
    const auto errors = [](const std::string& young, const std::string& terms) {
        return ScenarioFile(minimal_mesh + "[[material]]\nlaw = 'ogden'\ndensity = 1\nyoung = " +
                            young + "\nshear_modulus = 1\nterms = " + terms +
                            "\nfibre = [0, 0, 1]\nmethod = 'hybmss'\n[dynamics]\nend_time = 1\n")
            .errors();
    };
    const auto keys = errors("1", "[{ mu = 5, alpha = 2 }]");
    EXPECT_EQ(places_of(keys), (Lines{"3:1", "4:7", "9:9"}));
    const auto all = errors("-1", "[]");
    EXPECT_EQ(places_of(all), (Lines{"3:1", "4:7", "6:9", "8:9", "9:9"}));
    EXPECT_EQ(all[0], keys[0]);
    // Values that depend on the one at fault are not spoken of.
    EXPECT_EQ(places_of(ScenarioFile(minimal_mesh + "[[material]]\ndensity = 1\nlame_mu = 'a'\n"
                                                    "lame_lambda = -3\n[dynamics]\nend_time = 1\n")
                            .errors()),
              Lines{"5:11"});
}

TEST(AllProblems, OfMaterialsUnfitForElementsHaveTheirLine) {
    EXPECT_EQ(places_of(ScenarioFile(minimal + "time_step = 5\n[[material]]\nregions = 0\n"
                                               "method = 'hybmss'\ndensity = 1\nyoung = 1\n"
                                               "poisson = 0.3\n")
                            .all_errors()),
              Lines{"10:1"});
}

/// What `minimal` and the lines after it are told of. The first of them is line 9.
struct Case {
    std::string lines;
    Lines places;
};

void expect_places(const std::vector<Case>& cases) {
    for (const auto& [lines, places] : cases)
        EXPECT_EQ(places_of(ScenarioFile(minimal + lines).all_errors()), places) << lines;
}

TEST(AllProblems, OfAnItemHideNoneOfItsOthers) {
    const std::string no_nodes = "where = { box = { min = [9, 9, 9], max = [9, 9, 9] } }\n";
    const std::string held = "[[constraint]]\n" + no_nodes;
    const std::string loaded = "[[load]]\n" + no_nodes;
    expect_places({
        // Selections of nothing.
        {held + "fix = 'w'\n", {"11:7", "10:9"}},
        {held + "name = 'a b'\nfix = 'x'\n", {"11:8", "10:9"}},
        {held, {"9:1", "10:9"}},
        {held + "move = [{ time = 1, by = [0, 0, 0] }, { time = 0, by = [0, 0, 0] }]\n",
         {"11:48", "10:9"}},
        {loaded + "pressure = 'a'\n", {"11:12", "10:9"}},
        {loaded + "pressure = 1\nfactor = []\n", {"12:10", "10:9"}},
        {loaded, {"9:1"}},  // of what, is not known
        {"[[constraint]]\nwhere = { nodes = -1 }\nfix = 'w'\n", {"10:19", "11:7"}},
        // Constraints of the same node, as far as is known what they prescribe.
        {"[[constraint]]\nwhere = { nodes = 1 }\nfix = 'x'\n[[constraint]]\nname = '?'\nwhere = { "
         "nodes = 1 }\nmove = [{ time = 0, by = [1, 0, 0] }]\n",
         {"13:8", "14:9"}},
        {"[[constraint]]\nwhere = { nodes = 1 }\nfix = 'x'\n[[constraint]]\nname = '?'\nwhere = { "
         "nodes = 1 }\nfix = 'x'\n",
         {"13:8"}},
        {"[[constraint]]\nwhere = { nodes = 1 }\nfix = 'x'\n[[constraint]]\nwhere = { "
         "nodes = 1 }\nmove = [{ time = -1, by = [1, 0, 0] }]\n",
         {"14:18"}},
        {"[[constraint]]\nwhere = { nodes = 1 }\nfix = 'xx'\n[[constraint]]\nwhere = { "
         "nodes = 1 }\nfix = 'x'\n",
         {"11:7"}},
        // Files of surfaces.
        {"[[tool]]\nkind = 'cut'\ntime = -1\nsurface = 'liver.vtu'\n", {"11:8", "12:11"}},
        {"[[tool]]\nkind = 'cut'\ntime = 1\nsurface = 'none.stl'\nscale = 0\n", {"12:11", "13:9"}},
        // The time step.
        {"time_step = 5\ndamping = -1\n", {"10:11", "9:13"}},
        {"time_step = 5\nsafety = 'a'\n", {"10:10", "9:13"}},
        {"time_step = 5\nprecision = 'a'\n", {"10:13", "9:13"}},
        {"time_step = 5\nmode = 'statc'\n", {"10:8"}},
        {"time_step = 5\nintegrator = 1\n", {"10:14"}},
        {"time_step = 1e-300\nprecision = 'a'\n", {"10:13", "9:13"}},
    });
    // Without end there is no number of steps, and without safety none of their length.
    const auto places = [](const std::string& dynamics) {
        const std::string rest = minimal_rest.substr(0, minimal_rest.find("end_time"));
        return places_of(ScenarioFile(minimal_mesh + rest + dynamics).all_errors());
    };
    EXPECT_EQ(places("end_time = -1\ntime_step = 5"), (Lines{"8:12", "9:13"}));
    EXPECT_EQ(places("end_time = 1e12\n[output]\ninterval = 0"), Lines{"8:12"});
    EXPECT_EQ(places("end_time = 1e12\nsafety = 2\n[output]\ninterval = 0"), Lines{"9:10"});
}

TEST(AllProblems, OfToolsOfUnknownKindIncludeTheirKeys) {
    const std::string keys = R"(name = "?"
path = [{ time = -1, at = 0 }]
shape = { sphere = { radius = 0 } }
edge = [[0, 0, 0]]
mode = "tear"
snap = 2
time = -1
plane = { point = 0, normal = [0, 0, 0] }
surface = "none.stl"
scale = 0
)";
    const Lines faults = {"11:8", "12:18", "12:27", "13:31", "14:8",  "15:8",
                          "16:8", "17:8",  "18:19", "18:31", "19:11", "20:9"};
    for (const std::string kind : {"kind = 'knife'", "kind = 3"}) {
        Lines all = {"10:8"};
        all.insert(all.end(), faults.begin(), faults.end());
        expect_places({{"[[tool]]\n" + kind + "\n" + keys, all}});
    }
    // Nothing is said of what only one of a kind must have or must not have.
    expect_places({{"[[tool]]\nkind = 'knife'\n", {"10:8"}},
                   {"[[tool]]\nkind = 'knife'\nsnap = 0.5\nscale = 2\n", {"10:8"}},
                   {"[[tool]]\npath = [{ time = 0, at = [0, 0, 0] }]\n", {"9:1"}}});
}

TEST(AllProblems, OfToolsLeaveTheWarningOfAMiss) {
    const auto num_warnings = [](const std::string& lines) {
        const ScenarioFile file(minimal + "[[tool]]\n" + lines);
        EXPECT_EQ(file.errors().size(), 1u) << lines;
        return check_body(file.read().scenario).warnings.size();
    };
    const std::string far = "path = [{ time = 0, at = [9, 9, 9] }, { time = 1, at = [9, 8, 9] }]\n";
    const std::string ball = "shape = { sphere = { radius = 1 } }\n";
    const std::string plane = "plane = { point = [9, 9, 9], normal = [1, 0, 0] }\n";
    EXPECT_EQ(num_warnings("kind = 'carver'\nname = '?'\n" + ball + far), 1u);
    EXPECT_EQ(num_warnings("kind = 'blade'\nsnap = 3\nedge = [[0, 0, 0], [1, 0, 0]]\n" + far), 1u);
    EXPECT_EQ(num_warnings("kind = 'cut'\nsnap = 3\ntime = 0\n" + plane), 1u);
    // Unless it is not known where it is.
    EXPECT_EQ(num_warnings("kind = 'carver'\nshape = { sphere = { radius = 0 } }\n" + far), 0u);
    EXPECT_EQ(num_warnings("kind = 'carver'\npath = []\n" + ball), 0u);
    EXPECT_EQ(num_warnings("kind = 'blade'\n" + far), 0u);
    EXPECT_EQ(num_warnings("kind = 'cut'\ntime = 0\n"), 0u);
    EXPECT_EQ(num_warnings("kind = 'craver'\n" + ball + far), 0u);
}

TEST(AllProblems, OfHeadingsAndArraysTakenForEachOther) {
    expect_places({
        {"[constraint]\nwhere = { nodes = 99 }\nfix = 'w'\n", {"9:1", "11:7", "10:9"}},
        {"[load]\npresure = 1\n", {"9:1", "10:1"}},
        {"[tool]\nkind = 'blade'\nedge = 1\npath = { time = -1, at = 0 }\n",
         {"9:1", "11:8", "12:8", "12:17", "12:26"}},
        {"[[output]]\ninterval = -1\n", {"9:1", "10:12"}},
        {"[[expect]]\nmas = { max = 'a' }\n", {"9:1", "10:1", "10:15"}},
        {"[expect]\nmass = [{ max = 'a' }]\nvolume = []\ntime = [1]\n",
         {"10:8", "10:17", "11:10", "12:8"}},
    });
    EXPECT_EQ(
        places_of(ScenarioFile(minimal_mesh + "[material]\ndensity = -1\nyoung = 1\npoisson = 0.3\n"
                                              "[[dynamics]]\nend_time = 1\nsafety = -1\n")
                      .all_errors()),
        (Lines{"3:1", "4:11", "7:1", "9:10"}));
}

TEST(AllProblems, OfMisspeltHeadingsBesideTheRightOne) {
    const std::string more = R"([[materials]]
regions = 1
density = -1000
preset = "fat"
[[constraint]]
name = "a"
where = { nodes = 1 }
fix = "x"
[[constraints]]
name = "b"
where = { nodes = 99 }
fix = "x"
[expect]
reaction_b_x = { min = 0 }
)";
    expect_places({{more, {"9:3", "11:11", "17:3", "19:9"}}});
    // Nothing else is joined: the times of one would not ascend from those of the other.
    expect_places(
        {{"[[constraint]]\nwhere = { nodes = 1 }\nmove = [{ time = 1, by = [0, 0, 0] }]\n"
          "moves = [{ time = 0, by = [0, 0, 0] }]\n",
          {"12:1"}}});
}

TEST(AllProblems, AreNotReportedForWronglyGuessedKeys) {
    expect_places({
        {"step = 0.01\n", {"9:1"}},
        {"step = 10\n", {"9:1"}},  // a load step, of what is no statics
        {"step = 0.01\ntime_step = 5\n", {"9:1", "10:13"}},
        {"dampin = -1\n", {"9:1"}},
        {"gravty = 9.81\n", {"9:1"}},
        {"tool = 3\n", {"9:1"}},
        {"[[load]]\npressur = [0, 0, 1]\n", {"10:1"}},
        {"[[constraint]]\nwher = 1\nfix = 'w'\n", {"10:1", "11:7"}},
        {"[outputs]\ninterval = -1\n", {"9:2", "10:12"}},  // but of what is in its table
    });
}

TEST(AllProblems, AreNotReportedThatFollowFromOthers) {
    expect_places({
        {"mode = 'statc'\nsteps = 10\n", {"9:8"}},
        {"mode = 'statc'\nsteps = 0\n", {"9:8", "10:9"}},
        {"mode = 'statc'\nprecision = 'single'\n", {"9:8"}},
        {"integrator = 'implicit-eulr'\n", {"9:14"}},
        {"integrator = 'implicit-euler'\ntime_step = 'a'\n", {"10:13"}},
        {"[[load]]\nwhere = { box = { min = 'a', max = [-1, -1, -1] } }\npressure = 1\n",
         {"10:25"}},
        {"[[load]]\nwhere = { box = { min = [1, 1, 1], max = 'a' } }\npressure = 1\n", {"10:42"}},
        {"[[load]]\npressure = 1\nfactor = [{ time = 0, value = 0 }, { time = 'a', value = 1 }]\n",
         {"11:45"}},
        {"[[load]]\npressure = 1\nfactor = [{ time = 'a', value = 0 }, { time = 0, value = 1 }]\n",
         {"11:20"}},
    });
    EXPECT_EQ(places_of(ScenarioFile("[mesh]\nbox = { size = [1, 1, 1], element = 'hexa', cells = "
                                     "[1000, 1000, 90] }\n" +
                                     minimal_rest)
                            .all_errors()),
              Lines{"2:37"});
}

TEST(AllProblems, OfFibresShowWhateverTheLaw) {
    const auto places = [](const std::string& line) {
        return places_of(ScenarioFile(minimal_mesh + "[[material]]\n" + line +
                                      "\ndensity = 1\nfibre = [0, 0, 0]\nfibre_array = ''\n"
                                      "prony_rule = 'nodal'\n[dynamics]\nend_time = 1\n")
                             .all_errors());
    };
    for (const std::string line : {"preset = 'livr'", "method = 'hml'"})
        EXPECT_EQ(places(line), (Lines{"4:" + std::to_string(line.find('\'') + 1), "6:9", "7:15"}))
            << line;
    EXPECT_EQ(places("law = 'holzapfl'"), (Lines{"4:7", "6:9", "7:15", "8:14"}));
}

TEST(AllProblems, OfExpectedRangesShowUnderUnknownNames) {
    expect_places({{"[expect]\nmas = { min = 2, max = 1 }\nx = 3\ny = {}\n",
                    {"10:1", "10:7", "11:1", "11:5", "12:1", "12:5"}}});
    // What is there already was hardly meant.
    EXPECT_EQ(ScenarioFile(minimal + "[expect]\nmass = { min = 2, mix = 3 }\n").errors(),
              Lines{"scene.toml:10:19: key 'expect.mass.mix': is not known; did you mean 'max'? "
                    "Known here: min, max"});
    // Each quantity is known once.
    const std::string held = "[[constraint]]\nname = 'a'\nwhere = { nodes = 1 }\nfix = 'x'\n";
    const auto errors =
        ScenarioFile(minimal + held + held + "[expect]\nx = { min = 0 }\n").errors();
    ASSERT_EQ(places_of(errors), (Lines{"14:8", "18:1"}));
    EXPECT_EQ(errors[1].find("reaction_a_x"), errors[1].rfind("reaction_a_x"));
}

}  // namespace
}  // namespace incise::scenario
