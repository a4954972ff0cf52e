// Warnings of scenarios that can be run, and are hardly meant.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/plausibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "incise/scenario/tissue_catalog.h"
#include "scenario_file.h"

namespace incise::scenario {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A block of 10 cm that rests on its bottom.
const std::string rest_block = R"([mesh]
box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }
[[material]]
density = 1000
young = 5000
poisson = 0.4
[[constraint]]
name = "bottom"
where = { box = { min = [-99, -99, 0], max = [99, 99, 0] } }
fix = "xyz"
[dynamics]
end_time = 1
gravity = [0, 0, -9.81]
)";

std::vector<std::string> warnings_of(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
    const ScenarioReport report = ScenarioFile(text).read(overrides);
    EXPECT_THAT(report.errors, IsEmpty());
    return check_body(report.scenario).warnings;
}

TEST(Plausibility, OfABlockOfTissueIsNotDoubted) {
    EXPECT_THAT(warnings_of(rest_block), IsEmpty());
}

TEST(Plausibility, NamesTheUnitThatMayBeMeant) {
    EXPECT_THAT(warnings_of(rest_block, {"mesh.box.size=[100, 100, 100]", "material[0].young=1e9"}),
                ElementsAre(HasSubstr("scene.toml:2:7: the body is 100 m long; if its coordinates "
                                      "are in millimetres, write scale = 0.001")));
    EXPECT_THAT(warnings_of(rest_block, {"mesh.box.size=[1e-5, 1e-5, 1e-5]"}),
                ElementsAre(HasSubstr("the body is only 1e-05 m long")));
    EXPECT_THAT(warnings_of(rest_block, {"material[0].density=1.06"}),
                ElementsAre(HasSubstr("material 1 has a density of 1.06 kg/m3")));
    EXPECT_THAT(warnings_of(rest_block, {"material[0].young=5", "dynamics.gravity=[0, 0, 0]"}),
                ElementsAre(HasSubstr("a Young's modulus of 5 Pa at rest")));
}

TEST(Plausibility, OfTissuesIsNotDoubted) {
    for (const Tissue& tissue : tissues()) {
        SCOPED_TRACE(tissue.key);
        std::string text = rest_block;
        text.replace(text.find("density"), text.find("[[constraint]]") - text.find("density"),
                     "preset = '" + std::string(tissue.key) + "'\n");
        EXPECT_THAT(warnings_of(text, {"dynamics.gravity=[0, 0, 0]"}), IsEmpty());
    }
}

TEST(Plausibility, AsksWhatHoldsTheBodyAndWhetherItBearsItself) {
    EXPECT_THAT(warnings_of(rest_block.substr(0, rest_block.find("[[constraint]]")) +
                            rest_block.substr(rest_block.find("[dynamics]"))),
                ElementsAre(HasSubstr("nothing holds the body against gravity")));
    EXPECT_THAT(warnings_of(rest_block.substr(0, rest_block.find("[[constraint]]")) +
                            "[[load]]\nwhere = { box = { min = [-99, -99, 0], max = [99, 99, 0] "
                            "} }\npressure = 50\n[dynamics]\nmode = 'static'\nend_time = 1\n"
                            "gravity = [0, 0, -9.81]\n"),
                testing::Contains(HasSubstr("so there is no equilibrium: add a [[constraint]]")));
    EXPECT_THAT(warnings_of(rest_block, {"material[0].young=1000"}),
                ElementsAre(HasSubstr("its own weight may crush it")));
    // Lying flat it bears itself.
    EXPECT_THAT(
        warnings_of(rest_block, {"material[0].young=1000", "mesh.box.size=[0.1, 0.1, 0.02]"}),
        IsEmpty());
}

TEST(Plausibility, AsksForBladesThatMoveAcrossTheirEdge) {
    const auto with_blade = [](const std::string& path) {
        return warnings_of(rest_block +
                           "[[tool]]\nkind = 'blade'\nname = 'knife'\n"
                           "edge = [[0, 0, 0], [0, 0.05, 0], [0, 0.1, 0]]\npath = [" +
                           path + "]\n");
    };
    EXPECT_THAT(with_blade("{ time = 0, at = [0, 0, 0.05] }, { time = 1, at = [0.1, 0, 0.05] }"),
                IsEmpty());
    EXPECT_THAT(
        with_blade("{ time = 0, at = [0.03, -1, 0.05] }, { time = 1, at = [0.03, 1, 0.05] }"),
        ElementsAre(HasSubstr("tool 'knife' moves along its own edge")));
    EXPECT_THAT(
        with_blade("{ time = 0, at = [0.03, 0, 0.05] }, { time = 1, at = [0.03, 0, 0.05] }"),
        ElementsAre(HasSubstr("tool 'knife' does not move")));
    // It ends where it began, turned to the other side: on the way it sweeps half a disk.
    EXPECT_THAT(
        with_blade(
            "{ time = 0, at = [0.03, 0, 0.05] }, "
            "{ time = 1, at = [0.03, 0, 0.05], rotate = { axis = [0, 0, 1], angle = 3.1 } }"),
        IsEmpty());
}

// A body of two tetrahedra that share a face, one of which is flat.
TEST(Plausibility, NamesElementsThatCostTheStep) {
    for (const double height : {0.1, 0.002}) {
        topology::MeshData data;
        data.points = {
            {0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.03, 0.03, -0.1}, {0.03, 0.03, height}};
        data.add_cell(topology::CellKind::tetrahedron, std::vector<std::int64_t>{0, 2, 1, 3}, 0);
        data.add_cell(topology::CellKind::tetrahedron, std::vector<std::int64_t>{0, 1, 2, 4}, 0);
        const topology::Mesh mesh = topology::Mesh::build(data).mesh;
        const physics::Model model(
            mesh, {{{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1500.0, 6000.0}}}},
                   {{0, 0}},
                   {}});
        const auto warning = warning_of_costly_elements(model);
        EXPECT_EQ(warning.has_value(), height < 0.01);
        if (warning) {
            EXPECT_THAT(*warning, HasSubstr("element 1 is so thin or stiff that steps are"));
        }
    }
}

// A run warns of all that a check warns of, in the same words.
TEST(Plausibility, IsDoubtedByARunAsByACheck) {
    const ScenarioFile file(R"([mesh]
file = "thin.vtk"
[[material]]
density = 1
young = 5000
poisson = 0.4
[dynamics]
end_time = 1
gravity = [0, 0, -9.81]
)");
    std::ofstream(file.path().parent_path() / "thin.vtk")
        << "# vtk DataFile Version 3.0\nthin\nASCII\nDATASET UNSTRUCTURED_GRID\n"
           "POINTS 5 double\n0 0 0 0.1 0 0 0 0.1 0 0.03 0.03 -0.1 0.03 0.03 0.002\n"
           "CELLS 2 10\n4 0 2 1 3\n4 0 1 2 4\nCELL_TYPES 2\n10 10\n";
    const Scenario scenario = file.read().scenario;
    const auto of_check = check_body(scenario).warnings;
    EXPECT_THAT(of_check,
                testing::IsSupersetOf({HasSubstr("material 1 has a density of 1 kg/m3"),
                                       HasSubstr("nothing holds the body against gravity"),
                                       HasSubstr("is so thin or stiff that steps are")}));
    Body body = build_body(scenario);
    make_world(scenario, std::move(body.mesh), std::move(body.materials),
               std::move(body.boundary_conditions), body.warnings);
    EXPECT_EQ(body.warnings, of_check);
}

TEST(Plausibility, IsDoubtedBesideErrorsOfMaterials) {
    const ScenarioFile file(rest_block);
    const ScenarioReport report = file.read({"material[0].poisson=0.5", "material[0].density=1.06",
                                             "mesh.box.size=[100, 100, 100]", "constraint=[]"});
    EXPECT_THAT(report.errors, ElementsAre(HasSubstr("0.5 is not allowed")));
    EXPECT_THAT(report.warnings, ElementsAre(HasSubstr("material 1 has a density of 1.06 kg/m3")));
    EXPECT_THAT(check_body(report.scenario).warnings,
                ElementsAre(HasSubstr("the body is 100 m long"),
                            HasSubstr("nothing holds the body against gravity")));
    // Nor does anybody know what a wrong constraint would hold.
    const ScenarioReport wrong = file.read({"constraint[0].fix=xyzz"});
    EXPECT_THAT(wrong.errors, SizeIs(1));
    EXPECT_THAT(check_body(wrong.scenario).warnings, IsEmpty());
    // A density that is an error, or is not given, is no density to doubt.
    EXPECT_THAT(file.read({"material[0].density=-1"}).warnings, IsEmpty());
}

}  // namespace
}  // namespace incise::scenario
