// Bad scenarios: every problem is found, at its location, in words that help.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/scenario/diagnostics.h"
#include "scenario_file.h"

namespace incise::scenario {
namespace {

using Lines = std::vector<std::string>;

/// The errors of a scenario with these lines for the material, in one line.
std::string material_error(const std::string& lines) {
    const auto errors = ScenarioFile("[[material]]\n" + lines +
                                     "\n[mesh]\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }\n"
                                     "[dynamics]\nend_time = 1\n")
                            .errors();
    std::string all;
    for (const auto& error : errors) all += (all.empty() ? "" : " | ") + error;
    return all;
}

TEST(ScenarioErrors, AreAllFoundAtOnceInFileOrder) {
    const ScenarioFile file(R"(titel = "x"
[mesh]
file = "kidney.vtu"
scale = -1
[[material]]
density = "heavy"
young = 1600
poisson = 0.6
[dynamics]
gravity = [0, 0]
safety = 1.5
seed = 1
[[constraint]]
where = { nodes = [-1], spere = { center = [0, 0, 0], radius = 1 } }
fix = "xxy"
)");
    EXPECT_EQ(
        file.errors(),
        (Lines{"scene.toml:1:1: key 'titel': is not known; did you mean 'title'? Known here: "
               "title, mesh, material, dynamics, contact, constraint, load, tool, obstacle, "
               "output, expect",
               "scene.toml:3:8: key 'mesh.file': there is no file kidney.vtu (paths are relative "
               "to the scenario's folder)",
               "scene.toml:4:9: key 'mesh.scale': -1 is not allowed: must be above 0",
               "scene.toml:6:11: key 'material[0].density': must be a number, but is the text "
               "\"heavy\"",
               "scene.toml:8:11: key 'material[0].poisson': 0.6 is not allowed: must be above -1 "
               "and below 0.5",
               "scene.toml:9:1: key 'dynamics.end_time': is missing: simulated seconds, as in "
               "end_time = 1.0",
               "scene.toml:10:11: key 'dynamics.gravity': must be an array of 3 numbers, as in "
               "[0, 0, 1], but is an array of 2",
               "scene.toml:11:10: key 'dynamics.safety': 1.5 is not allowed: must be above 0 and "
               "at most 1",
               "scene.toml:12:1: key 'dynamics.seed': is not known; did you mean 'mode'? Known "
               "here: mode, integrator, end_time, time_step, steps, safety, damping, gravity, "
               "precision",
               "scene.toml:14:20: key 'constraint[0].where.nodes[0]': -1 is not allowed: must be "
               "at least 0",
               "scene.toml:14:25: key 'constraint[0].where.spere': is not known; did you mean "
               "'sphere'? Known here: box, sphere, half_space, nodes, region, surface",
               "scene.toml:15:7: key 'constraint[0].fix': 'xxy' is not allowed: any of the "
               "letters x, y and z, each at most once, as in fix = \"xyz\""}));
}

TEST(ScenarioErrors, OfSyntaxHaveLineAndColumn) {
    const auto errors = ScenarioFile("[mesh]\nfile = \"liver.vtu\n").errors();
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].substr(0, 13), "scene.toml:2:");
}

// Tables within tables, of which the TOML library has no limit for those of dotted keys.
TEST(ScenarioErrors, OfKeysThatWouldOverrunTheStack) {
    std::string key;
    for (int i = 0; i < 100'000; ++i) key += "a.";
    const std::string text =
        ": a key of more than 16 parts; no key of a scenario has more than six";
    EXPECT_EQ(ScenarioFile("title = 'a'\n" + key + "a = 1\n").errors(),
              Lines{"scene.toml:2:1" + text});
    EXPECT_EQ(ScenarioFile("[" + key + "a]\n").errors(), Lines{"scene.toml:1:1" + text});
    EXPECT_EQ(ScenarioFile(minimal).errors({key + "a=1"}), Lines{"--set " + key + "a=1" + text});
    EXPECT_EQ(ScenarioFile("title = \"\"\"\\\"\"\"\"\"\"\n" + key + "a = 1\n").errors(),
              Lines{"scene.toml:2:1" + text});
    // Text is no key.
    const std::string dots(1000, '.');
    for (const std::string& title :
         {"\"" + dots + "\"", "'" + dots + "'", "\"\"\"\n" + dots + "\n\"\"\"", "'a' # " + dots})
        EXPECT_EQ(ScenarioFile("title = " + title + "\n" + minimal).errors(), Lines{});
}

TEST(ScenarioErrors, OfAnEmptyFileNameWhatIsMissing) {
    const auto errors = ScenarioFile("").errors();
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0],
              "scene.toml: key 'mesh': is missing: add a section [mesh] with file = "
              "\"...\" or box = { ... }");
    EXPECT_EQ(errors[1],
              "scene.toml: key 'material': is missing: add a section [[material]] with "
              "density, young and poisson");
    EXPECT_EQ(errors[2],
              "scene.toml: key 'dynamics': is missing: add a section [dynamics] with an end_time");
}

TEST(ScenarioErrors, OfTheFileItself) {
    const support::TemporaryFolder folder;
    EXPECT_EQ(read_scenario(folder / "none.toml").errors,
              Lines{(folder / "none.toml").string() + ": there is no such file"});
    EXPECT_EQ(read_scenario(folder.path()).errors,
              Lines{folder.path().string() + ": is a folder, not a scenario file"});
    const Lines too_long{
        "/dev/zero: is too long for a scenario (at most 16 MiB); name the scenario, not a mesh"};
    EXPECT_EQ(read_scenario("/dev/zero").errors, too_long);
}

TEST(ScenarioErrors, OfAMeshInPlaceOfAScenario) {
    const support::TemporaryFolder folder;
    for (const char* text :
         {"<?xml version=\"1.0\"?>\n<VTKFile a.b.c>", "\n# vtk DataFile Version 3.0\n",
          "$MeshFormat\n", "MeshVersionFormatted 2\n", "*NODE\n1, 0.0, 0.0, 0.0\n"}) {
        SCOPED_TRACE(text);
        const auto file = folder / "liver.vtu";
        std::ofstream(file) << text;
        EXPECT_EQ(read_scenario(file).errors,
                  Lines{file.string() +
                        ": is a mesh, not a scenario; a scenario is a text file that names its "
                        "mesh: [mesh] file = \"liver.vtu\""});
    }
}

TEST(ScenarioErrors, OfTheMesh) {
    const auto error = [](const std::string& mesh) {
        return ScenarioFile("[mesh]\n" + mesh + "\n" + minimal_rest).errors();
    };
    EXPECT_EQ(error("scale = 2"),
              Lines{"scene.toml:1:1: key 'mesh': must have exactly one of file, box"});
    EXPECT_EQ(error("file = \"liver.vtu\"\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }"),
              Lines{"scene.toml:1:1: key 'mesh': has file, box, but only one of file, box is "
                    "allowed"});
    EXPECT_EQ(error("file = \".\""),
              Lines{"scene.toml:2:8: key 'mesh.file': . is a folder, not a mesh file"});
    EXPECT_EQ(error("box = { size = [1, 0, 1], cells = [1, 1.5, 1], element = \"quad\" }"),
              (Lines{"scene.toml:2:16: key 'mesh.box.size': is not allowed: all three lengths must "
                     "be above 0",
                     "scene.toml:2:35: key 'mesh.box.cells': is not allowed: must be three whole "
                     "numbers, each at least 1",
                     "scene.toml:2:58: key 'mesh.box.element': 'quad': is not known; did you mean "
                     "'tet'? Known here: tet, hex"}));
    EXPECT_EQ(error("box = { size = [1, 1, 1], cells = [1000, 1000, 1000] }"),
              Lines{"scene.toml:2:35: key 'mesh.box.cells': makes 6e+09 elements, more than the "
                    "1e+08 allowed: lower the numbers"});
}

TEST(ScenarioErrors, OfNumbersThatAreNotFinite) {
    EXPECT_EQ(error_of("damping = inf\n"),
              "scene.toml:9:11: key 'dynamics.damping': inf is not allowed: must be finite, at "
              "least 0");
    EXPECT_EQ(error_of("gravity = [0, nan, 0]\n"),
              "scene.toml:9:15: key 'dynamics.gravity[1]': nan is not allowed: must be a finite "
              "number");
}

TEST(ScenarioErrors, OfMaterials) {
    std::string all_laws;
    for (const auto& law : laws())
        all_laws += (all_laws.empty() ? "" : ", ") + std::string(law.key);
    EXPECT_EQ(material_error("density = 1\nyoung = 1"),
              "scene.toml:1:1: key 'material[0]': neo-hookean takes young + poisson, or "
              "shear_modulus + bulk_modulus, or lame_lambda + lame_mu, or c1 + bulk_modulus, or "
              "c1 + lame_lambda; given: young");
    EXPECT_EQ(material_error("density = 1\nyoung = 1\npoisson = 0.3\nlaw = \"neohook\""),
              "scene.toml:5:7: key 'material[0].law': 'neohook': is not known; did you mean "
              "'neo-hookean'? Known here: " +
                  all_laws);
    EXPECT_EQ(material_error("density = 1\nyoung = 1\npoisson = 0.3\nmethod = \"mass-spring\""),
              "scene.toml:4:11: key 'material[0].poisson': is not used by the mass-spring method, "
              "whose springs take young and density only and fix Poisson's ratio near 1/4: leave "
              "it out");
    EXPECT_EQ(material_error("density = 1\nyoung = 1\npoisson = 0.3\nregions = [1, 2]\n"
                             "[[material]]\nyoung = 1\npoisson = 0.3\ndensity = 1\nregions = 2\n"
                             "[[material]]\nyoung = 1\npoisson = 0.3\ndensity = 1\n"
                             "[[material]]\nyoung = 1\npoisson = 0.3\ndensity = 1\n"),
              "scene.toml:10:11: key 'material[1].regions': region 2 belongs to another material "
              "already | scene.toml:15:1: key 'material[3]': has no regions, like another material "
              "before it: only one material can take all that is left");
}

TEST(ScenarioErrors, SayWhatALawWithFibresNeeds) {
    const std::string ground = "density = 1\nshear_modulus = 1\nbulk_modulus = 9\n";
    const std::string law = ground + "law = \"holzapfel-gasser-ogden\"\nk1 = 5\nk2 = 2\n";
    EXPECT_EQ(material_error(law + "fibre = [1, 1, 0]"), "");
    EXPECT_EQ(material_error(law + "fibre = [1, 1, 0]\ndispersion = 0.333333"), "");
    EXPECT_EQ(material_error(law + "fibre = [1, 1, 0]\ndispersion = 0.4"),
              "scene.toml:9:14: key 'material[0].dispersion': 0.4 is not allowed: must be at least "
              "0 and at most 0.3333333333333333");
    EXPECT_EQ(
        material_error(law),
        "scene.toml:1:1: key 'material[0]': holzapfel-gasser-ogden needs the direction of its "
        "fibres: give fibre = [x, y, z], or fibre_array = \"NAME\", a cell array of the mesh "
        "file");
    EXPECT_EQ(material_error(law + "fibre = [0, 0, 0]"),
              "scene.toml:8:9: key 'material[0].fibre': is not allowed: a direction must have a "
              "length above 0");
    EXPECT_EQ(
        material_error(law + "fibre_array = \"a\""),
        "scene.toml:8:15: key 'material[0].fibre_array': needs a mesh file, and the mesh is a "
        "box: use fibre = [x, y, z]");
    EXPECT_EQ(material_error(ground + "fibre = [1, 0, 0]"),
              "scene.toml:5:9: key 'material[0].fibre': is a key of laws with fibres, as "
              "holzapfel-gasser-ogden, not of neo-hookean: leave it out");
    EXPECT_EQ(
        material_error(ground + "law = \"holzapfel-gasser-ogden\"\nk1 = 5\nfibre = [1, 0, 0]"),
        "scene.toml:1:1: key 'material[0]': holzapfel-gasser-ogden takes young + poisson + k1 + "
        "k2, or shear_modulus + bulk_modulus + k1 + k2, or lame_lambda + lame_mu + k1 + k2, "
        "or c1 + bulk_modulus + k1 + k2; dispersion may be added; given: shear_modulus + "
        "bulk_modulus + k1");
    const std::string in_file = ScenarioFile(
                                    "[mesh]\nfile = \"liver.vtu\"\n[dynamics]\n"
                                    "end_time = 1\n[[material]]\n" +
                                    law + "fibre_array = \"\"\n")
                                    .errors()
                                    .at(0);
    EXPECT_EQ(
        in_file,
        "scene.toml:12:15: key 'material[0].fibre_array': is empty: name a cell array of the mesh "
        "file");
}

TEST(ScenarioErrors, OfHybridSprings) {
    const std::string good = "method = \"hybmss\"\ndensity = 1\nyoung = 1\npoisson = 0.3\n";
    EXPECT_EQ(material_error(good), "");
    EXPECT_EQ(material_error(good + "stiffness_ratio = inf"), "");
    EXPECT_EQ(material_error(good + "stiffness_ratio = 0"),
              "scene.toml:6:19: key 'material[0].stiffness_ratio': 0 is not allowed: must be above "
              "0, or inf");
    EXPECT_EQ(material_error(good + "stiffness_ratio = nan"),
              "scene.toml:6:19: key 'material[0].stiffness_ratio': nan is not allowed: must be "
              "above 0, or inf");
    EXPECT_EQ(material_error(good + "stiffness_ratio = 1\nface_diagonals = false"),
              "scene.toml:6:19: key 'material[0].stiffness_ratio': has no meaning without face "
              "diagonals: leave it out");
    EXPECT_EQ(material_error(good + "law = \"neo-hookean\""),
              "scene.toml:6:7: key 'material[0].law': is a key of the method heml, not of hybmss: "
              "leave it out");
    EXPECT_EQ(material_error("density = 1\nyoung = 1\npoisson = 0.3\nface_diagonals = true"),
              "scene.toml:5:18: key 'material[0].face_diagonals': is a key of the method hybmss, "
              "not of heml: leave it out");
    EXPECT_EQ(material_error("method = \"hybmss\"\ndensity = 1\nyoung = 1\nc1 = 0.3\n"),
              "scene.toml:1:1: key 'material[0]': hybmss takes young + poisson, or shear_modulus + "
              "bulk_modulus, or lame_lambda + lame_mu; given: young + c1");
}

TEST(ScenarioErrors, OfTheTermsOfOgdensLaw) {
    const std::string ogden = "law = \"ogden\"\ndensity = 1\nbulk_modulus = 9\n";
    EXPECT_EQ(material_error(ogden + "terms = [{ mu = 1, alpha = 2 }, { mu = -0.5, alpha = -1 }]"),
              "");
    EXPECT_EQ(material_error(ogden + "terms = []"),
              "scene.toml:5:9: key 'material[0].terms': is empty: give at least one, as in [{ mu = "
              "500, alpha = 4 }]");
    EXPECT_EQ(material_error(ogden + "terms = [{ mu = 1, alpha = 0 }]"),
              "scene.toml:5:28: key 'material[0].terms[0].alpha': 0 is not allowed: a power of 0 "
              "is no strain");
    EXPECT_EQ(material_error(ogden + "terms = [{ mu = 1 }]"),
              "scene.toml:5:10: key 'material[0].terms[0].alpha': is missing: the power of the "
              "stretches, as in alpha = 4");
    EXPECT_EQ(
        material_error(ogden + "terms = [{ mu = -1, alpha = 2 }]"),
        "scene.toml:1:1: key 'material[0]': ogden: the shear modulus is -1, but must be above "
        "0: the mu of all terms add up to it");
    EXPECT_EQ(material_error(ogden),
              "scene.toml:1:1: key 'material[0]': ogden takes bulk_modulus + terms, or poisson + "
              "terms, or lame_lambda + terms; given: bulk_modulus");
}

TEST(ScenarioErrors, OfViscosity) {
    const std::string good = "density = 1\nyoung = 1\npoisson = 0.3\n";
    EXPECT_EQ(material_error(good + "prony = [{ alpha = 0.3, tau = 0.5 }]"), "");
    EXPECT_EQ(material_error(good + "prony = []"),
              "scene.toml:5:9: key 'material[0].prony': is empty: give at least one term, as in "
              "[{ alpha = 0.3, tau = 0.5 }], or leave it out");
    EXPECT_EQ(material_error(good + "prony = { alpha = 0.3, tau = 0.5 }"),
              "scene.toml:5:9: key 'material[0].prony': must be an array of tables, as in "
              "[{ ... }, { ... }], but is a table");
    EXPECT_EQ(material_error(good + "prony = [{ alpha = 0, tau = 0 }, { alpha = 1, tau = 1 }]"),
              "scene.toml:5:20: key 'material[0].prony[0].alpha': 0 is not allowed: must be above "
              "0 and below 1 | scene.toml:5:29: key 'material[0].prony[0].tau': 0 is not allowed: "
              "must be above 0 | scene.toml:5:44: key 'material[0].prony[1].alpha': 1 is not "
              "allowed: must be above 0 and below 1");
    EXPECT_EQ(material_error(good + "prony = [{ tua = 1, alpha = 0.1 }, { tau = inf }]"),
              "scene.toml:5:12: key 'material[0].prony[0].tua': "
              "is not known; did you mean 'tau'? Known here: alpha, tau | scene.toml:5:36: key "
              "'material[0].prony[1].alpha': is missing: the share of the stress that relaxes, as "
              "in alpha = 0.3 | scene.toml:5:44: key 'material[0].prony[1].tau': inf is not "
              "allowed: must be finite, above 0");
    EXPECT_EQ(material_error(good + "prony = [{ alpha = 0.5, tau = 1 }, { alpha = 0.5, tau = 2 }]"),
              "scene.toml:5:9: key 'material[0].prony': has shares alpha that add up to 1: their "
              "sum must be below 1, or no stress would last");
    for (const std::string rule : {"stress", "nodal"}) {
        const std::string line = "prony_rule = \"" + rule + "\"\n";
        EXPECT_EQ(material_error(good + line + "prony = [{ alpha = 0.3, tau = 0.5 }]"), "");
        EXPECT_EQ(material_error("preset = \"fat\"\n" + line), "");
        EXPECT_EQ(
            material_error(good + line),
            "scene.toml:5:14: key 'material[0].prony_rule': has no meaning without viscosity: "
            "give prony = [{ alpha = 0.3, tau = 0.5 }], or leave it out");
    }
    EXPECT_EQ(material_error(good + "prony = [{ alpha = 0.3, tau = 0.5 }]\nprony_rule = \"node\""),
              "scene.toml:6:14: key 'material[0].prony_rule': 'node': is not known; did you mean "
              "'nodal'? Known here: stress, nodal");
    EXPECT_NE(material_error("method = \"mass-spring\"\ndensity = 1\nyoung = 1\nprony_rule = "
                             "\"nodal\"")
                  .find("key 'material[0].prony_rule': is a key of the method heml, not of "
                        "mass-spring: leave it out"),
              std::string::npos);
    for (const std::string method : {"mass-spring", "hybmss"})
        EXPECT_NE(material_error("density = 1\nyoung = 1\nprony = [{ alpha = 0.3, tau = 0.5 }]\n"
                                 "method = \"" +
                                 method + "\"")
                      .find("scene.toml:4:9: key 'material[0].prony': is a key of the method heml, "
                            "not of " +
                            method + ": leave it out"),
                  std::string::npos);
}

TEST(ScenarioErrors, OfConstraints) {
    const auto error = [](const std::string& lines) {
        return error_of("[[constraint]]\nwhere = { surface = true }\n" + lines);
    };
    EXPECT_EQ(error(""),
              "scene.toml:9:1: key 'constraint[0]': holds nothing: give fix = \"xyz\", "
              "or move, or rotate");
    EXPECT_EQ(error("rotate = [{ time = 0, angle = 0 }]\n"),
              "scene.toml:9:1: key 'constraint[0].about': is missing: the axis of rotate, as in "
              "about = { point = [0, 0, 0], axis = [0, 0, 1] }");
    EXPECT_EQ(error("fix = \"x\"\nabout = { point = [0, 0, 0], axis = [0, 0, 0] }\n"),
              "scene.toml:12:9: key 'constraint[0].about': belongs to rotate, which is not there | "
              "scene.toml:12:37: key 'constraint[0].about.axis': is not allowed: a direction must "
              "have a length above 0");
    EXPECT_EQ(error("move = [{ time = 0.5, by = [0, 0, 0] }, { time = 0.5, by = [0, 0, 1] }]\n"),
              "scene.toml:11:50: key 'constraint[0].move[1].time': 0.5 is not allowed: must be "
              "above 0.5, the time before it");
    EXPECT_EQ(error("move = []\n"),
              "scene.toml:11:8: key 'constraint[0].move': is empty: give at least one time");
    EXPECT_EQ(error("fix = \"\"\n"),
              "scene.toml:11:7: key 'constraint[0].fix': '' is not allowed: any of the letters x, "
              "y and z, each at most once, as in fix = \"xyz\"");
    EXPECT_EQ(error("fix = \"x\"\nname = \"left side\"\n"),
              "scene.toml:12:8: key 'constraint[0].name': 'left side' is not allowed: use letters, "
              "digits, _ and -");
    EXPECT_EQ(error("fix = \"x\"\nname = \"a\"\n[[constraint]]\nname = \"a\"\nfix = \"y\"\n"
                    "where = {}\n"),
              "scene.toml:14:8: key 'constraint[1].name': 'a' is taken already: names must differ "
              "| scene.toml:16:9: key 'constraint[1].where': is empty: give at least one of box, "
              "sphere, half_space, nodes, region, surface");
}

TEST(ScenarioErrors, OfLoads) {
    EXPECT_EQ(error_of("[[load]]\n"),
              "scene.toml:9:1: key 'load[0]': must have exactly one of "
              "nodal_force, traction, pressure, body_force");
    EXPECT_EQ(error_of("[[load]]\npressure = 1\ntraction = [0, 0, 1]\n"),
              "scene.toml:9:1: key 'load[0]': has traction, pressure, but only one of "
              "nodal_force, traction, pressure, body_force is allowed");
    EXPECT_EQ(error_of("[[load]]\npressure = [0, 0, 1]\n"),
              "scene.toml:10:12: key 'load[0].pressure': must be a number, but is an array of 3");
    EXPECT_EQ(error_of("[[load]]\npressure = 1\nfactor = [{ time = -1, value = 0 }]\n"),
              "scene.toml:11:20: key 'load[0].factor[0].time': -1 is not allowed: must be at least "
              "0");
    EXPECT_EQ(error_of("[load]\npressure = 1\n"),
              "scene.toml:9:1: key 'load': must be an array of tables, as in [[load]], but is a "
              "table");
}

TEST(ScenarioErrors, OfOutputAndExpect) {
    EXPECT_EQ(error_of("[output]\nfields = [\"mass\", \"strain\", \"mass\"]\n"
                       "compression = \"zip\"\n"),
              "scene.toml:10:19: key 'output.fields[1]': 'strain': is not known; did you mean "
              "'stress'? Known here: displacement, velocity, mass, force, stress, von_mises, J, "
              "energy_density | scene.toml:10:29: key 'output.fields[2]': 'mass' is there twice | "
              "scene.toml:11:15: key 'output.compression': 'zip': is not known; did you mean "
              "'zlib'? Known here: none, lz4, zlib, lzma");
    EXPECT_EQ(error_of("[expect]\nmass = { max = 1, mn = 0 }\nnodes = {}\n"
                       "volume = { min = 2, max = 1 }\nmin_J = 3\n"),
              "scene.toml:10:19: key 'expect.mass.mn': is not known; did you mean 'min'? Known "
              "here: min, max | scene.toml:11:9: key 'expect.nodes': must have min, max or both, "
              "as in { max = 1e-9 } | scene.toml:12:10: key 'expect.volume': min 2 is above max 1 "
              "| scene.toml:13:9: key 'expect.min_J': must be a table, but is the number 3");
}

TEST(ScenarioErrors, OfExpectedQuantitiesNameTheNearest) {
    const std::string floor =
        "[[constraint]]\nname = \"floor\"\nfix = \"xyz\"\nwhere = { surface = true }\n";
    const std::string known =
        "Known here: time, step, nodes, elements, components, mass, volume, kinetic_energy, "
        "elastic_energy, external_work, dissipated_energy, momentum_x, momentum_y, momentum_z, "
        "angular_momentum_x, angular_momentum_y, angular_momentum_z, min_J, time_step, "
        "stable_step, contacts, max_penetration, contact_dissipation, fracture_energy, ";
    const std::string more =
        "gravity_energy, edits, elements_removed, elements_split, elements_added, faces_opened, "
        "cut_area, mass_removed, mass_error, energy_error, volume_change, max_displacement";
    EXPECT_EQ(error_of("[expect]\nreaction_floor_z = { min = 0 }\n"),
              "scene.toml:10:1: key 'expect.reaction_floor_z': is not known; did you mean "
              "'elastic_energy'? " +
                  known + more);
    EXPECT_EQ(error_of(floor + "[expect]\nreaction_floor_z = { min = 0 }\n"), "");
    EXPECT_EQ(error_of("[output]\ninterval = -1\n" + floor +
                       "[expect]\ntime = { max = \"x\" }\nreaction_flor_z = { min = 0 }\n"
                       "mas = { min = 0 }\n"),
              "scene.toml:10:12: key 'output.interval': -1 is not allowed: must be at least 0 | "
              "scene.toml:16:16: key 'expect.time.max': must be a number, but is the text \"x\" | "
              "scene.toml:17:1: key 'expect.reaction_flor_z': is not known; did you mean "
              "'reaction_floor_z'? " +
                  known +
                  "reaction_floor_x, reaction_floor_y, reaction_floor_z, torque_floor_x, "
                  "torque_floor_y, torque_floor_z, " +
                  more +
                  " | scene.toml:18:1: key 'expect.mas': is not known; did you mean 'mass'? " +
                  known +
                  "reaction_floor_x, reaction_floor_y, reaction_floor_z, torque_floor_x, "
                  "torque_floor_y, torque_floor_z, " +
                  more);
}

// For each kind of fault, what is wrong comes before what the parser says.
TEST(ScenarioErrors, ExplainFaultsOfSyntaxInWords) {
    const std::vector<std::pair<std::string, std::string>> faults = {
        {"title = A kidney\n", "1:9: that is no value: a text needs quotes"},
        {"title = table\n", "1:10: that is no value: a text needs quotes"},
        {"title = false_start\"\n", "that is no value: a text needs quotes"},
        {"title = info\"\n", "that is no value: a text needs quotes"},
        {"title = nanny\"\n", "that is no value: a text needs quotes"},
        {"title = \"kidney\n", "the text has no closing quote on its line"},
        {"title = \"C:\\users\"\n", "a backslash in a text begins a special character"},
        {"title = \"C:\\data\"\n", "a backslash in a text begins a special character"},
        {"gravity = [0, 0 -9]\n", "the values of a list need commas between them"},
        {"mesh = { file = \"a\" scale = 1 }\n", "entries in { } are of the form key = value"},
        {"damping = 10,5\n", "a number has a point, not a comma"},
        {"end_time 1\n", "a key needs an equals sign"},
        {"[mesh\n", "a section needs both brackets"},
        {"[mesh]\n[mesh]\n", "the name is there twice"},
        {"end_time = .5\n", "a number has digits before and after its point"}};
    for (const auto& [text, words] : faults) {
        const auto errors = ScenarioFile(text).errors();
        ASSERT_EQ(errors.size(), 1u) << text;
        EXPECT_NE(errors[0].find(words), std::string::npos) << errors[0];
    }
    const auto binary = ScenarioFile(std::string("a\0b", 3)).errors();
    ASSERT_EQ(binary.size(), 1u);
    EXPECT_NE(binary[0].find("is no text, and a scenario is a text file"), std::string::npos);
}

TEST(ScenarioErrors, TellWhichFieldsAreThereAnyway) {
    const auto errors = ScenarioFile(minimal + "[output]\nfields = [\"contact_force\"]\n").errors();
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_NE(errors[0].find("'contact_force': need not be asked for: it is there wherever"),
              std::string::npos)
        << errors[0];
}

TEST(ScenarioErrors, KnowWhatPeopleCallThings) {
    const std::string_view kinds[] = {"carver", "blade", "cut", "probe", "grasper", "suture"};
    EXPECT_EQ(nearest("scalpel", kinds), "blade");
    EXPECT_EQ(nearest("stitch", kinds), "suture");
    EXPECT_EQ(nearest("forceps", kinds), "grasper");
    EXPECT_EQ(nearest("blaed", kinds), "blade");
    const std::string_view verbs[] = {"cut", "run", "render"};
    EXPECT_EQ(nearest("simulate", verbs), "run");
    EXPECT_NE(nearest("scalpel", verbs), "blade");  // which is none of these
}

}  // namespace
}  // namespace incise::scenario
