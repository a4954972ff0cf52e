// Frames of bodies that were cut, read as meshes: the same fragments, steps and further cuts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <ostream>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "cut_scenes.h"
#include "incise/base/error.h"
#include "incise/fragments/validate.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/runner/frame_builder.h"
#include "incise/scenario/body.h"
#include "incise/topology/geometry.h"
#include "incise/topology/source_faces.h"
#include "run_folder.h"
#include "support/fragment_shape.h"
#include "support/mesh_families.h"

namespace incise::runner {
namespace {

using fragments::FragmentMesh;
using topology::Mesh;

const std::vector<scenario::Field> some_fields{scenario::Field::displacement, scenario::Field::mass,
                                               scenario::Field::stress};

std::string from_file(const std::string& text) {
    const auto end = text.find("[[material]]");
    return "[mesh]\nfile = \"frame.vtu\"\n" + text.substr(end);
}

/// Returns the fragments with the cells named by their rows in a file.
test::FragmentShape shape_in_file(const Mesh& mesh, const FragmentMesh& fragments) {
    std::vector<std::int64_t> row(mesh.element_capacity(), -1);
    std::int64_t next = 0;
    for (const CellId e : mesh.elements()) row[e.index()] = next++;
    return test::shape_of(fragments, [&](CellId e) { return row[e.index()]; });
}

/// Expects it of a body that was read from the frame of another.
void expect_same_step_and_mass(const Simulation& read, const Simulation& written) {
    constexpr double rounding = 1e-12;  // the order of sums differs with the ids
    const double step = written.model().structure().rest_stable_step(),
                 mass = written.model().energetics().totals().mass;
    EXPECT_NEAR(read.model().structure().rest_stable_step(), step, rounding * step);
    EXPECT_NEAR(read.model().energetics().totals().mass, mass, rounding * mass);
}

class CutFrame : public testing::TestWithParam<Tools> {};

TEST_P(CutFrame, ReadAsAMeshIsTheBodyAtRest) {
    const RunFolder folder;
    write_cube(folder);
    Simulation written(folder.scenario(scene_of(GetParam()) + while_falling));
    run(written);
    ASSERT_GT(written.edits().size(), 0u);
    const auto frame = build_frame(written.model(), written.time(), some_fields);
    ASSERT_FALSE(frame.mesh.carriers.is_empty());
    io::write_vtu(folder / "frame.vtu", frame);

    const Scenario scenario = folder.scenario(from_file(soft_cube) + dynamics(0.02));
    const Body body = build_body(scenario);
    EXPECT_EQ(body.warnings, std::vector<std::string>{});
    const FragmentMesh& before = written.model().fragments();
    Simulation read(scenario);
    const FragmentMesh& after = read.model().fragments();
    EXPECT_EQ(fragments::validate(after, read.mesh()), std::vector<std::string>{});
    EXPECT_TRUE(shape_in_file(read.mesh(), after) == shape_in_file(written.mesh(), before));
    EXPECT_EQ(after.num_nodes(), before.num_nodes());
    expect_same_step_and_mass(read, written);
    for (const ElementId e : after.elements())
        for (const NodeId n : after.corners(e))
            EXPECT_EQ(read.model().positions()[n.index()], after.rest_position(n));
    EXPECT_LT(read.model().energetics().totals().elastic_energy, 1e-20);
    const auto volume_of = [](const Mesh& mesh) {
        double volume = 0.0;
        for (const CellId e : mesh.elements()) volume += topology::rest_volume(mesh, e);
        return volume;
    };
    EXPECT_EQ(volume_of(read.mesh()), volume_of(written.mesh()));
    run(read);
    EXPECT_EQ(read.warnings(), std::vector<std::string>{});

    // The frame of the body that was read is the frame that was written.
    const auto again = build_frame(read.model(), 0.0, some_fields);
    EXPECT_TRUE(again.mesh.carriers == frame.mesh.carriers);
    EXPECT_EQ(again.mesh.cut_faces, frame.mesh.cut_faces);
    EXPECT_TRUE(std::ranges::any_of(frame.mesh.cut_faces, [](int faces) { return faces != 0; }));
}

TEST_P(CutFrame, IsScaledWithItsCarriers) {
    const RunFolder folder;
    write_cube(folder);
    Simulation written(folder.scenario(scene_of(GetParam()) + while_falling));
    run(written);
    io::write_vtu(folder / "frame.vtu", build_frame(written.model(), written.time(), {}));
    std::string text = from_file(soft_cube);
    text.insert(text.find("[[material]]"), "scale = 3.7\n");
    const Simulation read(folder.scenario(text + dynamics(0.02)));
    EXPECT_EQ(read.model().fragments().num_elements(), written.model().fragments().num_elements());
}

INSTANTIATE_TEST_SUITE_P(
    Tools, CutFrame,
    testing::Values(Tools{"BladeThrough", blade_through}, Tools{"BladeHalfway", blade_halfway},
                    Tools{"Plane", plane_cut}, Tools{"TwoCuts", blade_halfway + plane_cut},
                    Tools{"TwoCutsAndACarver", blade_through + plane_cut + ball_carver},
                    Tools{"BladeThroughHexahedra", blade_through, of_bricks},
                    Tools{"BladeHalfwayInHexahedra", blade_halfway, of_bricks},
                    Tools{"PlaneThroughMixed", plane_cut, of_file},
                    Tools{"TwoCutsAndACarverOfMixed", blade_through + plane_cut + ball_carver,
                          of_file}),
    [](const auto& tools) { return tools.param.name; });

TEST(FrameOfACutBody, GivesFragmentsTheirFibres) {
    const RunFolder folder;
    const std::string material = R"([[material]]
law = "holzapfel-gasser-ogden"
density = 1000
shear_modulus = 400
bulk_modulus = 2000
k1 = 1000
k2 = 0.5
)";
    const std::string box = "[mesh]\nbox = { size = [0.1, 0.1, 0.1], cells = [3, 3, 3] }\n";
    Simulation written(folder.scenario(box + material + "fibre = [0.6, 0, 0.8]\n" + plane_cut +
                                       blade_through + dynamics(0.04)));
    run(written);
    io::write_vtu(folder / "frame.vtu", build_frame(written.model(), written.time(), {}));
    Simulation read(
        folder.scenario(from_file(box + material) + "fibre_array = \"fibre\"\n" + dynamics(0.04)));
    const FragmentMesh& fragments = read.model().fragments();
    ASSERT_GT(fragments.element_capacity(), read.mesh().element_capacity());
    for (const ElementId e : fragments.elements())
        EXPECT_EQ(read.model().structure().fibres()[e.index()], Vec3(0.6, 0.0, 0.8));
}

TEST(FrameOfACutBody, HasTheMomentumOfItsPhysics) {
    const RunFolder folder;
    const Simulation uncut(folder.scenario(soft_cube + while_falling));
    EXPECT_TRUE(build_frame(uncut.model(), 0.0, uncut.scenario().output.fields).field_data.empty());
    Simulation simulation(
        folder.scenario(soft_cube + plane_cut + while_falling + "[output]\nphysics = true\n"));
    run(simulation);
    const auto frame = build_frame(simulation.model(), 0.04, simulation.scenario().output.fields);
    EXPECT_EQ(std::ranges::count(frame.point_fields, "velocity", &io::Field::name), 1);
    const auto values = [&](const std::string& name) {
        const auto found = std::ranges::find(frame.field_data, name, &io::Field::name);
        return std::get<std::vector<double>>(found->values);
    };
    Vec3 momentum = Vec3::Zero();
    const auto mass = values("physics_mass"), velocity = values("physics_velocity");
    for (std::size_t n = 0; n < mass.size(); ++n) momentum += mass[n] * Vec3(&velocity[3 * n]);
    const Vec3 expected = simulation.ledger().body_totals().totals.momentum;
    EXPECT_LT((momentum - expected).norm(), 1e-12 * expected.norm());
    io::write_vtu(folder / "frame.vtu", frame);
    EXPECT_EQ(io::read_mesh(folder / "frame.vtu").mesh.num_cells(), frame.mesh.num_cells());
}

TEST(FrameOfACutBody, OfABodyWithoutDivisionsHasNoCarriers) {
    const RunFolder folder;
    Simulation simulation(folder.scenario(soft_cube + two_tools + dynamics(0.16)));
    run(simulation);
    EXPECT_GT(simulation.edits().size(), 1u);
    EXPECT_TRUE(build_frame(simulation.model(), 0.0, {}).mesh.carriers.is_empty());
}

// Quadrilaterals that meet triangles are divided in the mesh, and whole in files.
TEST(FrameOfABody, HasTheCellsOfTheSourceThatReadingJoinsAgain) {
    const RunFolder folder;
    topology::MeshData data = test::brick_cube(test::Bricks::joined, 2, 0.1, 3);
    data.scale(0.1);
    io::Frame source;
    source.mesh = data;
    io::write_vtu(folder / "frame.vtu", source);
    const std::string text = from_file(soft_cube);
    Simulation written(folder.scenario(text + while_falling));
    run(written);
    ASSERT_EQ(topology::components(written.mesh()).count, 1);
    const auto frame = build_frame(written.model(), written.time(), some_fields);
    EXPECT_TRUE(frame.mesh.faces.empty());
    for (std::size_t kind = 0; kind < topology::num_cell_kinds; ++kind)
        EXPECT_EQ(std::ranges::count(frame.mesh.kinds, static_cast<topology::CellKind>(kind)),
                  std::ranges::count(data.kinds, static_cast<topology::CellKind>(kind)));
    io::write_vtu(folder / "frame.vtu", frame);
    const Simulation read(folder.scenario(text + while_falling));
    EXPECT_EQ(topology::components(read.mesh()).count, 1);
    expect_same_step_and_mass(read, written);
}

TEST(FrameOfACutBody, ForgedIsRefusedWithTheFileAndARemedy) {
    const RunFolder folder;
    Simulation written(folder.scenario(soft_cube + plane_cut + while_falling));
    run(written);
    auto frame = build_frame(written.model(), written.time(), {});
    frame.mesh.carriers.of_cell[3] = 1000;
    io::write_vtu(folder / "frame.vtu", frame);
    try {
        build_body(folder.scenario(from_file(soft_cube) + dynamics(0.02)));
        FAIL();
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("frame.vtu: cell 3"), std::string::npos) << text;
        EXPECT_NE(text.find("1000"), std::string::npos) << text;
        EXPECT_NE(text.find("leave out its cell array 'carrier'"), std::string::npos) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace incise::runner
