// Good scenarios: what is read, what is left to its default, overrides, the hash and warnings.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/scenario_reader.h"

#include <gtest/gtest.h>

#include "scenario_file.h"

namespace incise::scenario {
namespace {

using Lines = std::vector<std::string>;

const std::string full = R"(title = "Everything"
[mesh]
file = "liver.vtu"
scale = 0.001
region_array = "tissue"
[[material]]
regions = [2, 1]
method = "heml"
law = "mooney-rivlin"
density = 1047.0
c1 = 2500.0
c2 = 1175.0
bulk_modulus = 1e5
inversion_threshold = 0.3
prony = [{ alpha = 0.3, tau = 0.5 }, { alpha = 0.25, tau = 20 }]
prony_rule = "nodal"
[[material]]
method = "mass-spring"
density = 900
young = 3e3
[dynamics]
end_time = 2.0
time_step = 1e-4
safety = 1.0
damping = 2.0
gravity = [0, 0, -9.81]
[[constraint]]
name = "clamp"
where = { box = { min = [0, 0, 0], max = [1, 1, 0] }, surface = true }
fix = "zx"
[[constraint]]
where = { sphere = { center = [0, 0, 1], radius = 0.5 }, region = 2 }
move = [ { time = 0, by = [0, 0, 0] }, { time = 1, by = [0, 0, -0.02] } ]
rotate = [ { time = 0, angle = 0 }, { time = 1, angle = 0.3 } ]
about = { point = [0, 0, 1], axis = [0, 0, 2] }
[[load]]
where = { half_space = { point = [0, 0, 1], normal = [0, 3, 4] } }
pressure = 100
factor = [ { time = 0, value = 0 }, { time = 0.5, value = 1 } ]
[[load]]
name = "pull"
where = { nodes = [9, 3, 3] }
nodal_force = [1, 2, 3]
[[load]]
traction = [0, 0, 5]
[[load]]
body_force = [0, -1, 0]
[[tool]]
kind = "carver"
shape = { capsule = { from = [0, 0, 0], to = [0, 0, 1], radius = 0.1 } }
path = [ { time = 0.25, at = [1, 2, 3] } ]
[[tool]]
kind = "blade"
name = "knife"
edge = [[-1, 0, 0], [0, 0, 0], [1, 0, 0]]
mode = "separate"
path = [ { time = 0.2, at = [0, 0, 1] },
         { time = 0.8, at = [0, 0, -1], rotate = { axis = [2, 0, 0], angle = 0.2 } } ]
[[tool]]
kind = "carver"
shape = { box = { size = [1, 2, 3] } }
path = [ { time = 0, at = [0, 0, 0] } ]
[output]
interval = 0.5
fields = ["J", "displacement"]
compression = "lz4"
[expect]
mass_error = { max = 1e-12 }
min_J = { min = 0.2, max = 1 }
)";

TEST(ScenarioReader, ReadsEverySection) {
    const ScenarioFile file(full, "everything.toml");
    const auto report = file.read();
    EXPECT_EQ(report.errors, Lines{});
    EXPECT_EQ(report.warnings, Lines{});
    const Scenario& s = report.scenario;
    EXPECT_EQ(s.name, "everything");
    EXPECT_EQ(s.title, "Everything");
    EXPECT_EQ(s.folder, file.path().parent_path());
    EXPECT_EQ(std::get<std::filesystem::path>(s.mesh.source),
              file.path().parent_path() / "liver.vtu");
    EXPECT_EQ(s.mesh.scale, 0.001);
    EXPECT_EQ(s.mesh.region_array, "tissue");

    ASSERT_EQ(s.materials.size(), 2u);
    EXPECT_EQ(s.materials[0].regions, (std::vector{1, 2}));
    EXPECT_EQ(s.materials[0].law, "mooney-rivlin");
    EXPECT_EQ(s.materials[0].density, 1047.0);
    EXPECT_EQ(s.materials[0].parameters[Parameter::c2], 1175.0);
    EXPECT_FALSE(s.materials[0].parameters[Parameter::young].has_value());
    EXPECT_EQ(s.materials[0].inversion_threshold, 0.3);
    EXPECT_EQ(s.materials[0].prony, (std::vector<physics::PronyTerm>{{0.3, 0.5}, {0.25, 20.0}}));
    EXPECT_FALSE(s.materials[1].regions.has_value());
    EXPECT_EQ(s.materials[0].prony_rule, physics::PronyRule::nodal);
    EXPECT_TRUE(s.materials[1].prony.empty());
    EXPECT_EQ(s.materials[1].prony_rule, physics::PronyRule::stress);
    EXPECT_EQ(s.materials[1].method, Method::mass_spring);

    EXPECT_EQ(s.dynamics.end_time, 2.0);
    EXPECT_EQ(s.dynamics.time_step, 1e-4);
    EXPECT_EQ(s.dynamics.safety, 1.0);
    EXPECT_EQ(s.dynamics.damping, 2.0);
    EXPECT_EQ(s.dynamics.gravity, Vec3(0, 0, -9.81));
    EXPECT_EQ(s.output.interval, 0.5);
    EXPECT_EQ(s.output.fields, (std::vector{Field::J, Field::displacement}));
    EXPECT_EQ(s.output.compression, io::Compression::lz4);
    ASSERT_EQ(s.expect.size(), 2u);
    EXPECT_EQ(s.expect[0].quantity, "mass_error");
    EXPECT_FALSE(s.expect[0].min.has_value());
    EXPECT_EQ(s.expect[0].max, 1e-12);
    EXPECT_EQ(s.expect[1].min, 0.2);
}

TEST(ScenarioReader, ReadsConstraintsAndLoads) {
    const auto s = ScenarioFile(full).read().scenario;
    ASSERT_EQ(s.constraints.size(), 2u);
    EXPECT_EQ(s.constraints[0].name, "clamp");
    EXPECT_EQ(s.constraints[0].fixed, (std::array{true, false, true}));
    EXPECT_TRUE(s.constraints[0].where.surface);
    EXPECT_EQ(s.constraints[0].where.box->max, Vec3(1, 1, 0));
    EXPECT_EQ(s.constraints[1].name, "constraint_2");
    EXPECT_EQ(s.constraints[1].where.sphere->radius, 0.5);
    EXPECT_EQ(s.constraints[1].where.regions, std::vector{2});
    ASSERT_EQ(s.constraints[1].move.size(), 2u);
    EXPECT_EQ(s.constraints[1].move[1].value, Vec3(0, 0, -0.02));
    EXPECT_EQ(s.constraints[1].rotate[1].value, 0.3);
    EXPECT_EQ(s.constraints[1].about_point, Vec3(0, 0, 1));
    EXPECT_EQ(s.constraints[1].about_axis, Vec3(0, 0, 1)) << "made a unit vector";

    ASSERT_EQ(s.loads.size(), 4u);
    EXPECT_EQ(s.loads[0].name, "load_1");
    EXPECT_EQ(std::get<Pressure>(s.loads[0].load).pressure, 100.0);
    EXPECT_EQ(s.loads[0].where.half_space->normal, Vec3(0, 0.6, 0.8));
    EXPECT_EQ(s.loads[0].factor[1].time, 0.5);
    EXPECT_EQ(s.loads[0].factor[1].value, 1.0);
    EXPECT_EQ(s.loads[1].name, "pull");
    EXPECT_EQ(s.loads[1].where.nodes, (std::vector<std::int64_t>{3, 9}));
    EXPECT_EQ(std::get<NodalForce>(s.loads[1].load).force, Vec3(1, 2, 3));
    EXPECT_EQ(std::get<Traction>(s.loads[2].load).stress, Vec3(0, 0, 5));
    EXPECT_TRUE(s.loads[2].where.selects_all());
    EXPECT_EQ(std::get<BodyForce>(s.loads[3].load).density, Vec3(0, -1, 0));
}

TEST(ScenarioReader, ReadsTools) {
    const auto s = ScenarioFile(full).read().scenario;
    ASSERT_EQ(s.tools.size(), 3u);
    EXPECT_EQ(s.tools[0].name, "carver_1");
    const auto& capsule =
        std::get<cutting::Capsule>(std::get<cutting::Carver>(s.tools[0].shape).shape);
    EXPECT_EQ(capsule.to, Vec3(0, 0, 1));
    EXPECT_EQ(capsule.radius, 0.1);
    EXPECT_EQ(s.tools[0].path[0].value.position, Vec3(1, 2, 3));
    EXPECT_TRUE(s.tools[0].path[0].value.rotation.isApprox(Eigen::Quaterniond::Identity()));
    EXPECT_EQ(s.tools[1].name, "knife");
    EXPECT_EQ(std::get<cutting::Blade>(s.tools[1].shape).edge.size(), 3u);
    EXPECT_EQ(s.tools[1].path[1].time, 0.8);
    const Eigen::AngleAxisd turn(s.tools[1].path[1].value.rotation);
    EXPECT_EQ(turn.axis(), Vec3(1, 0, 0));
    EXPECT_NEAR(turn.angle(), 0.2, 1e-15);
    EXPECT_EQ(s.tools[2].name, "carver_2");
    EXPECT_EQ(std::get<cutting::Cuboid>(std::get<cutting::Carver>(s.tools[2].shape).shape).size,
              Vec3(1, 2, 3));
}

TEST(ScenarioReader, FillsInWhatTheShortestScenarioLeavesOut) {
    const auto report = ScenarioFile(minimal).read();
    EXPECT_EQ(report.errors, Lines{});
    EXPECT_EQ(report.warnings, Lines{});
    const Scenario& s = report.scenario;
    EXPECT_EQ(s.title, "scene");
    const auto& box = std::get<BoxMeshSpec>(s.mesh.source);
    EXPECT_EQ(box.element, topology::CellKind::tetrahedron);
    EXPECT_EQ(box.cells, (std::array{2, 2, 2}));
    EXPECT_EQ(box.origin, Vec3(0, 0, 0));
    EXPECT_EQ(s.mesh.scale, 1.0);
    EXPECT_EQ(s.mesh.region_array, "region");
    EXPECT_EQ(s.materials[0].method, Method::heml);
    EXPECT_EQ(s.materials[0].law, "neo-hookean");
    EXPECT_EQ(s.materials[0].inversion_threshold, 0.4);
    EXPECT_FALSE(s.dynamics.time_step.has_value());
    EXPECT_EQ(s.dynamics.safety, 0.8);
    EXPECT_EQ(s.dynamics.damping, 0.0);
    EXPECT_EQ(s.dynamics.gravity, Vec3(0, 0, 0));
    EXPECT_EQ(s.output.interval, 0.01);
    EXPECT_EQ(s.output.fields.size(), field_names.size());
    EXPECT_EQ(s.output.compression, io::Compression::zlib);
    EXPECT_TRUE(s.tools.empty() && s.loads.empty() && s.constraints.empty() && s.expect.empty());
}

TEST(ScenarioReader, TakesAutoForTheTimeStep) {
    const auto report = ScenarioFile(minimal + "time_step = \"auto\"\n").read();
    EXPECT_EQ(report.errors, Lines{});
    EXPECT_FALSE(report.scenario.dynamics.time_step.has_value());
}

TEST(ScenarioReader, AppliesOverridesInOrder) {
    const ScenarioFile file(minimal);
    const auto report =
        file.read({"dynamics.end_time=0.2", "material.0.young=2000", "material[0].poisson = 0.3",
                   "material.0.law=neo-hookean", "material[0].law=saint-venant-kirchhoff",
                   "dynamics.gravity=[0, 0, -9.81]", "output.interval=0.1", "mesh.box.cells[2]=5"});
    EXPECT_EQ(report.errors, Lines{});
    const Scenario& s = report.scenario;
    EXPECT_EQ(s.dynamics.end_time, 0.2);
    EXPECT_EQ(s.materials[0].parameters[Parameter::young], 2000.0);
    EXPECT_EQ(s.materials[0].parameters[Parameter::poisson], 0.3);
    EXPECT_EQ(s.materials[0].law, "saint-venant-kirchhoff");
    EXPECT_EQ(s.dynamics.gravity, Vec3(0, 0, -9.81));
    EXPECT_EQ(s.output.interval, 0.1) << "the section was not there";
    EXPECT_EQ(std::get<BoxMeshSpec>(s.mesh.source).cells, (std::array{2, 2, 5}));
}

TEST(ScenarioReader, HashFollowsContentsOnly) {
    const auto hash = [](const std::string& text, const Lines& overrides = {}) {
        return ScenarioFile(text).read(overrides).scenario.hash;
    };
    const auto original = hash(minimal);
    EXPECT_EQ(original.size(), 16u);
    EXPECT_EQ(hash("# a comment\n" + minimal_rest + minimal_mesh), original);
    EXPECT_EQ(hash(minimal, {"dynamics.end_time=1.0"}), original);
    EXPECT_NE(hash(minimal, {"dynamics.end_time=1.5"}), original);
    EXPECT_NE(hash(minimal + "safety = 0.7\n"), original);
}

TEST(ScenarioReader, WarnsOfWhatComesAfterTheEnd) {
    const ScenarioFile file(minimal + R"([[tool]]
kind = "blade"
mode = "separate"
edge = [[0, 0, 0], [1, 0, 0]]
path = [ { time = 2, at = [0, 0, 1] },
         { time = 3, at = [0, 0, 0] } ]
[output]
interval = 5
)");
    EXPECT_EQ(file.errors(), Lines{});
    EXPECT_EQ(file.warnings(),
              (Lines{"scene.toml:13:8: tool 'blade_1' starts at 2 s, after the end at 1 s",
                     "scene.toml:14:19: 'tool[0].path' goes on until 3 s, but the run ends at 1 s",
                     "scene.toml:16:12: the output interval of 5 s is longer than the run of 1 s: "
                     "only the first and last state are written"}));
}

TEST(ScenarioReader, WarnsOfAThresholdWithoutEffect) {
    const auto text = minimal_mesh + R"([[material]]
density = 1
young = 1
poisson = 0
law = "saint-venant-kirchhoff"
inversion_threshold = 0.5
[dynamics]
end_time = 1
)";
    const ScenarioFile file(text);
    EXPECT_EQ(file.errors(), Lines{});
    ASSERT_EQ(file.warnings().size(), 1u);
    EXPECT_NE(file.warnings()[0].find("scene.toml:8:23: 'material[0].inversion_threshold' has no"),
              std::string::npos);
}

TEST(ScenarioReader, WarnsWhereHybridSpringsAreOnShakyGround) {
    const auto warnings = [](double poisson, const std::string& more) {
        const ScenarioFile file(minimal_mesh +
                                "[[material]]\nmethod = \"hybmss\"\ndensity = 1\n"
                                "young = 1\npoisson = " +
                                std::to_string(poisson) + "\n" + more +
                                "\n[dynamics]\nend_time = 1\n");
        EXPECT_EQ(file.errors(), Lines{});
        std::string all;
        for (const auto& warning : file.warnings()) all += warning + "\n";
        return all;
    };
    EXPECT_EQ(warnings(0.25, ""), "");
    EXPECT_EQ(warnings(0.49, "stiffness_ratio = inf"), "");
    EXPECT_EQ(warnings(0.25, "correction_forces = false"), "");
    EXPECT_NE(warnings(0.2, "").find("Poisson's ratio is 0.2; below 1/4 the method hybmss loses"),
              std::string::npos);
    EXPECT_NE(warnings(0.3, "correction_forces = false").find("ratio is 1/4 and not 0.3"),
              std::string::npos);
    EXPECT_EQ(warnings(0.3, "stiffness_ratio = 0.5"), "");
    EXPECT_NE(warnings(0.3, "stiffness_ratio = 0.1").find("is nearly the singular model"),
              std::string::npos);
    EXPECT_NE(warnings(0.3, "face_diagonals = false").find("a model that is singular"),
              std::string::npos);
}

TEST(ScenarioReader, RefusesNamesThatCannotNameRunFiles) {
    EXPECT_EQ(ScenarioFile(minimal + "unknown = 1\n",
                           "sc\xff"
                           "en.toml")
                  .errors()[0],
              "sc\xff"
              "en.toml: 'sc?en' cannot name the files of a run: rename it, in UTF-8 and without "
              "slashes and control characters");
    EXPECT_EQ(ScenarioFile(minimal, "sc\n.toml").errors().size(), 1u);
    EXPECT_EQ(ScenarioFile(minimal, "Münze & Co.toml").errors(), Lines{});
}

TEST(ScenarioReader, KeepsTheEndOfStaticsDespiteIneffectiveKeys) {
    const ScenarioFile file(minimal + "mode = 'static'\nintegrator = 'implicit-euler'\n");
    EXPECT_EQ(file.errors(), std::vector<std::string>{});
    EXPECT_EQ(file.read().scenario.dynamics.end_time, 1.0);
}

}  // namespace
}  // namespace incise::scenario
