// The command as users and scripts meet it: exit statuses, messages, what goes to which stream.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "in_folder.h"

namespace incise {
namespace {

const std::string scenario = R"([mesh]
box = { size = [1, 1, 1], cells = [2, 2, 2] }
[[material]]
density = 1060
young = 1600
poisson = 0.45
[dynamics]
end_time = 1
)";

/// Two tetrahedra that share a face, in regions 3 and 5; the second has `apex`.
std::string mesh(const std::string& apex = "1 1 1") {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
           "5 " +
           apex +
           "\n$EndNodes\n$Elements\n2\n1 4 2 3 1 1 2 3 4\n2 4 2 5 1 2 3 4 5\n"
           "$EndElements\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

using Command = test::InFolder;

TEST_F(Command, PrintsItsVersionAndHelp) {
    EXPECT_EQ(run("--version").out, "incise " INCISE_VERSION "\n");
    const auto help = run("--help");
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    for (const auto* word : {"run", "check", "info", "cut", "convert", "mesh", "materials",
                             "render", "report", "Examples:", "Exit status: 0 done"})
        EXPECT_NE(help.out.find(word), std::string::npos) << word;
    for (const auto* verb :
         {"run", "check", "info", "cut", "convert", "mesh", "materials", "report", "bench"}) {
        const auto of_verb = run(std::string(verb) + " --help");
        EXPECT_EQ(of_verb.status, 0) << verb;
        EXPECT_NE(of_verb.out.find(std::string("Usage: incise ") + verb), std::string::npos);
        EXPECT_NE(of_verb.out.find("Example"), std::string::npos) << verb;
        std::istringstream lines(of_verb.out);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
    }
}

TEST_F(Command, RefusesUsageThatItDoesNotKnow) {
    const auto refused = [&](const std::string& arguments) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        return outcome.err;
    };
    EXPECT_EQ(refused("").find("incise: a verb is missing:"), 0u);
    EXPECT_EQ(refused("inof a.vtu").find("incise: verb 'inof': is not known; did you mean 'info'?"),
              0u);
    EXPECT_NE(refused("bench a.vtu").find("a.vtu"), std::string::npos);
    EXPECT_EQ(refused("info"), "incise: MESH is required\nincise: see incise info --help\n");
    EXPECT_NE(refused("info a.vtu --jsn").find("--jsn"), std::string::npos);
    EXPECT_EQ(refused("--nonsense").substr(0, 8), "incise: ");
}

TEST_F(Command, RefusesEmptyWords) {
    for (const auto* arguments :
         {"bench --json ''", "run ''", "run scene.toml --out ''", "check ''",
          "info a.vtu --region-array ''", "cut a.vtu --out '' --plane 0,0,0,1,0,0",
          "cut a.vtu --out b.vtu --plane ''", "materials ''"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_NE(outcome.err.find(": must not be empty"), std::string::npos) << outcome.err;
    }
}

TEST_F(Command, ReportsBeforeTheWorkWhatCannotBeWritten) {
    write("two.msh", mesh());
    std::filesystem::create_directory(folder_ / "folder.vtu");
    for (const auto* arguments :
         {"bench --json missing/bench.json", "bench --json /proc/version",
          "bench --json folder.vtu", "cut two.msh --out missing/out.vtu --plane 0,0,0.2,0,0,1",
          "cut two.msh --out out.vtu --json missing/cut.json --plane 0,0,0.2,0,0,1",
          "convert no.msh folder.vtu"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 4) << arguments;
        EXPECT_NE(outcome.err.find(": cannot be written: "), std::string::npos) << outcome.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.vtu"));
}

TEST_F(Command, RefusesNumbersOfThreadsThatCannotBe) {
    for (const auto* number : {"0", "-1", "two", "1000000"}) {
        const auto outcome = run(std::string("run scene.toml --threads ") + number);
        EXPECT_EQ(outcome.status, 2) << number;
        EXPECT_NE(outcome.err.find("--threads"), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find(number), std::string::npos) << outcome.err;
    }
}

TEST_F(Command, RefusesARegionArrayThatTheMeshLacks) {
    write("two.msh", mesh());
    ASSERT_EQ(run("convert two.msh two.vtu").status, 0);
    write("scene.toml", "[mesh]\nfile = \"two.vtu\"\nregion_array = \"nope\"\n" +
                            scenario.substr(scenario.find("[[")));
    for (const auto* arguments :
         {"info two.vtu --region-array nope", "convert two.vtu new.vtu --region-array nope",
          "check scene.toml", "run scene.toml --dry-run"}) {
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_NE(
            outcome.err.find("two.vtu: has no cell array 'nope' to take the regions from; its "
                             "cell arrays of whole numbers: 'region'\n"),
            std::string::npos)
            << outcome.err;
    }
}

TEST_F(Command, DescribesAMeshAsJson) {
    write("two.msh", mesh());
    const auto outcome = run("info two.msh --json");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json["points"], 5);
    EXPECT_EQ(json["tets"], 2);
    EXPECT_EQ(json["hexes"], 0);
    EXPECT_EQ(json["wedges"], 0);
    EXPECT_EQ(json["pyramids"], 0);
    EXPECT_EQ(json["components"], 1);
    EXPECT_NEAR(json["volume"].get<double>(), 0.5, 1e-14);  // 1/6 and 2/6
    EXPECT_GT(json["surface_area"].get<double>(), 0.0);
    EXPECT_EQ(json["bounding_box"]["max"], (std::vector{1.0, 1.0, 1.0}));
    EXPECT_EQ(json["regions"], (nlohmann::json{{"3", 1}, {"5", 1}}));
    EXPECT_GT(json["min_altitude"].get<double>(), 0.0);
    EXPECT_GT(json["min_dihedral_deg"].get<double>(), 0.0);
    EXPECT_EQ(json["edge_length"]["min"], 1.0);
    EXPECT_TRUE(json["warnings"].is_array());
}

TEST_F(Command, DescribesAMeshInWords) {
    write("two.msh", mesh());
    const auto outcome = run("info two.msh");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out.find("tetrahedra       2\nregion 3         1 cell\n"), std::string::npos);
}

TEST_F(Command, NamesTheFileOfABrokenMesh) {
    write("flat.msh", mesh("0 0 1"));  // the second has no volume
    for (const auto* verb : {"info ", "check "}) {
        const auto outcome = run(std::string(verb) + "flat.msh");
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.err.substr(0, 18), "incise: flat.msh: ") << verb;
    }
    const auto missing = run("info none.vtu");
    EXPECT_EQ(missing.status, 2);
    EXPECT_EQ(missing.err.substr(0, 17), "incise: none.vtu:");
}

TEST_F(Command, ConvertsThereAndBack) {
    write("two.msh", mesh());
    const auto there = run("convert two.msh two.vtu");
    EXPECT_EQ(there.status, 0);
    EXPECT_EQ(there.out, "two.vtu: 5 points, 2 cells\n");
    const auto info = run("info two.msh --json").out;
    EXPECT_EQ(run("info two.vtu --json").out, info);
    for (const std::string name : {"two.mesh", "two.inp", "two.vtk"}) {
        EXPECT_EQ(run("convert two.vtu " + name).status, 0) << name;
        EXPECT_EQ(run("info " + name + " --json").out, info) << name;
    }
    write("two.node", "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n");
    write("two.ele", "2 4 1\n1 1 2 3 4 3\n2 2 3 4 5 5\n");
    EXPECT_EQ(run("info two.ele --json").out, info);
}

TEST_F(Command, DistinguishesInputFromOutputFailures) {
    write("two.msh", mesh());
    EXPECT_EQ(run("convert two.msh two.doc").status, 2);
    EXPECT_EQ(run("convert none.msh two.vtu").status, 2);
    const auto unwritable = run("convert two.msh no/such/folder/two.vtu");
    EXPECT_EQ(unwritable.status, 4);
    EXPECT_EQ(unwritable.err.substr(0, 31), "incise: no/such/folder/two.vtu:");
}

TEST_F(Command, ChecksEveryFileAndCountsProblems) {
    write("good.toml", scenario);
    write("bad.toml", scenario + "dampin = 2\nsafety = 7\n");
    write("two.msh", mesh());
    const auto good = run("check good.toml two.msh");
    EXPECT_EQ(good.status, 0);
    EXPECT_EQ(good.err, "");
    EXPECT_EQ(good.out,
              "good.toml: OK, scenario of 1 s with 1 material, 0 constraints, 0 loads, 0 tools\n"
              "two.msh: OK, mesh with 5 points, 2 cells, 2 regions\n");
    const auto bad = run("check bad.toml none.msh two.msh");
    EXPECT_EQ(bad.status, 2);
    EXPECT_NE(bad.err.find("incise: bad.toml:9:1: key 'dynamics.dampin': is not known; did you "
                           "mean 'damping'?"),
              std::string::npos);
    EXPECT_NE(bad.err.find("incise: bad.toml:10:10: key 'dynamics.safety': 7 is not allowed"),
              std::string::npos);
    EXPECT_NE(bad.err.find("incise: none.msh: "), std::string::npos);
    EXPECT_EQ(bad.out,
              "bad.toml: 2 problems\nnone.msh: 1 problem\n"
              "two.msh: OK, mesh with 5 points, 2 cells, 2 regions\n");
}

TEST_F(Command, GoesOnCheckingAfterABoxTooLarge) {
    const double pages = static_cast<double>(::sysconf(_SC_PHYS_PAGES));
    if (pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) > 240e9) GTEST_SKIP() << "it is not";
    std::string large = scenario;
    large.replace(large.find("[2, 2, 2]"), 9, "[464, 464, 464], element = \"hex\"");
    write("large.toml", large);
    write("large_and_bad.toml", large + "damping = -1\n");
    write("good.toml", scenario);
    const std::string message =
        ".toml:2:7: key 'mesh.box.cells': makes 99897344 elements: that "
        "takes 469.5 GB of memory, and this machine has ";
    const auto outcome = run("check large.toml good.toml");
    EXPECT_EQ(outcome.status, 5);
    const std::string announced = "large.toml: builds the body of 99897344 elements, to check it\n";
    EXPECT_EQ(outcome.err.find(announced + "incise: large" + message), 0u) << outcome.err;
    EXPECT_EQ(outcome.out,
              "large.toml: too large for this machine\n"
              "good.toml: OK, scenario of 1 s with 1 material, 0 constraints, 0 loads, 0 tools\n");
    const auto refused = run("run large.toml");
    EXPECT_EQ(refused.status, 5);
    EXPECT_EQ(announced + refused.err, outcome.err);
    const auto bad = run("check large_and_bad.toml");
    EXPECT_EQ(bad.status, 2);
    EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), '\n'), 3) << bad.err;
    // What needs no body comes first.
    EXPECT_LT(bad.err.find("'dynamics.damping'"), bad.err.find("builds the body"));
    EXPECT_NE(bad.err.find("incise: large_and_bad" + message), std::string::npos) << bad.err;
}

TEST_F(Command, WarnsOfRegionsThatTheMeshLacks) {
    write("two.msh", mesh());
    write("scene.toml",
          "[mesh]\nfile = \"two.msh\"\n" + scenario.substr(scenario.find("[[")) +
              "[[constraint]]\nwhere = { region = [3, 9] }\nfix = \"x\"\n"
              "[[load]]\nname = \"push\"\nwhere = { region = [4, 5] }\npressure = 1\n");
    const auto outcome = run("check scene.toml");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err,
              "incise: warning: scene.toml:10:9: constraint 'constraint_1' names region 9, which "
              "the mesh does not have (it has 3, 5)\n"
              "incise: warning: scene.toml:14:9: load 'push' names region 4, which the mesh does "
              "not have (it has 3, 5)\n");
}

TEST_F(Command, ChecksScenariosByTheirEnding) {
    write("scene.txt", scenario);
    const auto outcome = run("check scene.txt");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("; if it is a scenario, let its name end in .toml\n"),
              std::string::npos)
        << outcome.err;
}

TEST_F(Command, ReportsAnUnwritableFolderWithAllElse) {
    write("good.toml", scenario);
    write("bad.toml", scenario + "damping = -1\n");
    write("bad_body.toml", scenario + "[[load]]\nwhere = { region = 7 }\npressure = 1\n");
    const std::string message =
        "incise: good.toml/out: cannot be written: not a directory; a file is in the place of a "
        "folder; choose another path\n";
    for (const std::string option : {"", " --dry-run"}) {
        const auto alone = run("run good.toml --quiet --out good.toml/out" + option);
        EXPECT_EQ(alone.status, 4);
        EXPECT_EQ(alone.err, message);
        for (const std::string name : {"bad.toml", "bad_body.toml"}) {
            const auto both = run("run " + name + " --out good.toml/out" + option);
            EXPECT_EQ(both.status, 2);
            EXPECT_EQ(both.err.find("incise: " + name), 0u) << both.err;
            EXPECT_NE(both.err.find("\n" + message), std::string::npos) << both.err;
        }
    }
    // Nothing is made.
    EXPECT_EQ(run("run good.toml --quiet --out new/folder --dry-run").status, 0);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

TEST_F(Command, LocatesARegionArrayThatTheMeshLacks) {
    write("two.msh", mesh());
    ASSERT_EQ(run("convert two.msh two.vtu").status, 0);
    const auto check = [&](const std::string& file) {
        write("scene.toml", "[mesh]\nfile = \"" + file + "\"\nregion_array = \"nope\"\n" +
                                scenario.substr(scenario.find("[[")));
        return run("check scene.toml").err;
    };
    EXPECT_EQ(check("two.vtu").find("incise: scene.toml:3:16: two.vtu: has no cell array 'nope'"),
              0u);
    write("bad.vtu", "<VTKFile");
    EXPECT_EQ(check("bad.vtu").find("incise: scene.toml:2:8: bad.vtu:"), 0u);
}

TEST_F(Command, ChecksTheMeshOfAScenario) {
    write("flat.msh", mesh("0 0 1"));
    write("scene.toml", "[mesh]\nfile = \"flat.msh\"\n" + scenario.substr(scenario.find("[[")));
    const auto outcome = run("check scene.toml");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err.find("incise: scene.toml:2:8: flat.msh: cell 1 "), 0u) << outcome.err;
}

TEST_F(Command, RefusesRunsWithAllErrorsOfChecks) {
    const std::string of_body = scenario + R"(time_step = 5
[[load]]
where = { region = 7 }
pressure = 1
[[tool]]
kind = "cut"
time = 0.01
surface = "scene.toml"
)";
    const std::string of_text = "[[tool]]\nkind = \"cut\"\ntime = 0.01\nsurface = \"none.stl\"\n";
    for (const auto& text : {of_body, of_body + of_text}) {
        write("scene.toml", text);
        const auto checked = run("check scene.toml");
        EXPECT_EQ(checked.status, 2);
        EXPECT_EQ(std::count(checked.err.begin(), checked.err.end(), '\n'), text == of_body ? 3 : 4)
            << checked.err;
        for (const auto* place : {"9:13", "11:9", "16:11"})
            EXPECT_NE(checked.err.find(std::string("incise: scene.toml:") + place + ": "),
                      std::string::npos)
                << place << " in\n"
                << checked.err;
        const auto refused = run("run scene.toml");
        EXPECT_EQ(refused.status, 2);
        EXPECT_EQ(refused.err, checked.err);
    }
}

TEST_F(Command, ChecksWithEachWarningOfARunOnce) {
    // Two tetrahedra that meet in point 0 alone; point 7 is of none.
    write("pinched.msh",
          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
          "5 -1 0 0\n6 0 -1 0\n7 0 0 -1\n8 2 2 2\n$EndNodes\n$Elements\n3\n1 4 2 3 1 1 2 3 4\n"
          "2 4 2 3 1 1 6 5 7\n3 15 2 1 1 1\n$EndElements\n");
    const auto text = "[mesh]\nfile = \"pinched.msh\"\n" + scenario.substr(scenario.find("[["));
    write("scene.toml", replaced(text, "density = 1060", "density = 1060\nregions = [3, 9]"));

    const auto count = [](const std::string& haystack, const std::string& needle) {
        int found = 0;
        for (auto at = haystack.find(needle); at != std::string::npos;
             at = haystack.find(needle, at + 1))
            ++found;
        return found;
    };
    const std::string warning = "incise: warning: ";
    const auto of_mesh = run("check pinched.msh");
    const auto of_scenario = run("check scene.toml");
    const auto of_run = run("run scene.toml --dry-run --quiet");
    for (const auto* outcome : {&of_mesh, &of_scenario, &of_run}) {
        EXPECT_EQ(outcome->status, 0) << outcome->err;
        for (const auto* told :
             {"joins cells that share no face there", "ignored 1 point element", "point 7"})
            EXPECT_EQ(count(outcome->err, told), 1) << told << " in\n" << outcome->err;
    }
    EXPECT_EQ(count(of_mesh.err, warning + "pinched.msh: "), 3) << of_mesh.err;
    EXPECT_EQ(count(of_mesh.err, warning), 3) << of_mesh.err;
    EXPECT_EQ(count(of_scenario.err, warning + "pinched.msh: "), 3) << of_scenario.err;
    EXPECT_EQ(count(of_scenario.err, warning + "scene.toml:5:11: material 1 names region 9"), 1);
    EXPECT_EQ(count(of_scenario.err, warning), 4) << of_scenario.err;
    EXPECT_EQ(count(of_run.err, warning), 4) << of_run.err;
}

TEST_F(Command, RefusesToRunABadScenario) {
    write("scene.toml", scenario);
    const auto outcome = run("run scene.toml --set dynamics.safety=7 --set material[0].young=-1");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("incise: --set dynamics.safety=7: key 'dynamics.safety'"),
              std::string::npos);
    EXPECT_NE(outcome.err.find("incise: --set material[0].young=-1: key 'material[0].young'"),
              std::string::npos);
    EXPECT_NE(run("run scene.toml --end-time=-1").err.find("'dynamics.end_time': -1"),
              std::string::npos);
    EXPECT_EQ(run("run none.toml").err, "incise: none.toml: there is no such file\n");
}

TEST_F(Command, ListsMaterials) {
    const auto all = run("materials");
    EXPECT_EQ(all.status, 0);
    for (const auto* name : {"saint-venant-kirchhoff", "neo-hookean", "mooney-rivlin",
                             "fung-demiray", "ogden", "mass-spring", "hybmss"})
        EXPECT_NE(all.out.find(name), std::string::npos) << name;
    EXPECT_NE(run("materials mooney-rivlin").out.find("law = \"mooney-rivlin\""),
              std::string::npos);
    const auto json = nlohmann::json::parse(run("materials --json").out);
    std::map<std::string, nlohmann::json> rows;
    for (const auto& row : json["materials"]) rows[row["name"]] = row;
    EXPECT_EQ(rows.size(), json["materials"].size());
    EXPECT_EQ(json["materials"][1]["name"], "neo-hookean");
    EXPECT_EQ(rows["neo-hookean"]["parameter_sets"][0], (std::vector{"young", "poisson"}));
    EXPECT_EQ(rows["neo-hookean"]["kind"], "law");
    EXPECT_EQ(rows["hybmss"]["kind"], "method");
    EXPECT_NE(run("materials hybmss").out.find("method = \"hybmss\""), std::string::npos);
    EXPECT_EQ(run("materials neo-hooke").status, 2);
}

TEST_F(Command, ListsTissues) {
    const auto all = run("materials").out;
    EXPECT_LT(all.find("\nhybmss\n"), all.find("\nliver\n"));
    EXPECT_NE(all.find("\nparturient-abdomen\n    Abdomen of a parturient woman\n    law = "),
              std::string::npos);
    const auto liver = run("materials liver");
    EXPECT_EQ(liver.status, 0);
    for (const auto* text : {"preset = \"liver\"\n",
                             "    law = \"neo-hookean\"\n    density = 1060\n    "
                             "young = 1600\n    poisson = 0.48\n",
                             "\nSource\n", "s40323-015-0049-1", "\nValidity\n", "76 to 225 J/m2"})
        EXPECT_NE(liver.out.find(text), std::string::npos) << text;
    EXPECT_NE(run("materials livr").err.find("did you mean 'liver'?"), std::string::npos);

    const auto one = [&](const std::string& name) {
        const auto json = nlohmann::json::parse(run("materials --json " + name).out);
        EXPECT_EQ(json["materials"].size(), 1u);
        return json["materials"][0];
    };
    const auto fat = one("fat");
    EXPECT_EQ(fat["kind"], "tissue");
    EXPECT_EQ(fat["law"], "neo-hookean");
    EXPECT_EQ(fat["density"], 917.0);
    EXPECT_EQ(fat["parameters"]["shear_modulus"], 530.0);
    EXPECT_EQ(fat["prony"], nlohmann::json::parse(R"([{"alpha": 0.39, "tau": 700.0}])"));
    EXPECT_EQ(fat["toughness"]["max"], 4100.0);
    for (const auto* key : {"title", "source", "density_source", "validity", "assumed"})
        EXPECT_FALSE(fat[key].get<std::string>().empty()) << key;
    EXPECT_EQ(one("brain")["toughness"], nullptr);
    EXPECT_EQ(one("skin")["parameters"]["terms"],
              nlohmann::json::parse(R"([{"mu": 10.0, "alpha": 40.0}])"));
}

TEST_F(Command, HandsRenderingOverWithAllArguments) {
    const auto program = (folder_ / "incise").string();
    std::filesystem::copy_file(INCISE_PROGRAM, program);
    const auto missing = run("render scene.out", program);
    EXPECT_EQ(missing.status, 2);
    EXPECT_NE(missing.err.find("incise-render: cannot be started"), std::string::npos);

    write("incise-render", "#!/bin/sh\nprintf '<%s>' \"$@\"\nexit 4\n");
    std::filesystem::permissions(folder_ / "incise-render", std::filesystem::perms::owner_all);
    const auto handed = run("render 'a b.out' --frame 3 --help --all=x", program);
    EXPECT_EQ(handed.out, "<a b.out><--frame><3><--help><--all=x>");
    EXPECT_EQ(handed.status, 4);
}

}  // namespace
}  // namespace incise
