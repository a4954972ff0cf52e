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

/// Through the whole cube at a slant, or down to its middle, where the mesh has no faces.
const std::string blade_through = R"([[tool]]
kind = "blade"
name = "knife"
edge = [[0, -0.1, 0.05], [0, 0.03, 0.053], [0, 0.2, 0.058]]
path = [{ time = 0.01, at = [-0.05, 0, 0] }, { time = 0.03, at = [0.15, 0, 0.01] }]
)";
const std::string blade_halfway = R"([[tool]]
kind = "blade"
name = "knife"
edge = [[0.047, -0.1, 0], [0.052, 0.2, 0.004]]
path = [{ time = 0.01, at = [0, 0, 0.12] }, { time = 0.03, at = [0, 0, 0.041] }]
)";
const std::string plane_cut = R"([[tool]]
kind = "cut"
time = 0.015
plane = { point = [0.05, 0.045, 0.05], normal = [0.1, 1, 0.3] }
)";
const std::string ball_carver = R"([[tool]]
kind = "carver"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0.02, at = [0.05, 0.05, 0.13] }, { time = 0.03, at = [0.05, 0.05, 0.08] }]
)";
const std::string while_falling = dynamics(0.04, "gravity = [0, 0, -9.81]\ndamping = 5\n");

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

/// The mesh of the cube, of other cells.
const std::string of_bricks =
    "[mesh]\nbox = { size = [0.1, 0.1, 0.1], cells = [3, 3, 3], element = \"hex\" }\n";
const std::string of_file = "[mesh]\nfile = \"cube.vtu\"\n";

/// Writes a jittered cube of hexahedra, wedges and pyramids.
void write_mixed_cube(const RunFolder& folder) {
    topology::MeshData cube = test::brick_cube(test::Bricks::mixed, 3, 0.1, 5);
    cube.scale(0.1);
    io::write_mesh(folder / "cube.vtu", cube);
}

struct Tools {
    std::string name, text;
    std::string mesh = {};  ///< in place of that of soft_cube
};

std::string scene_of(const Tools& tools) {
    return (tools.mesh.empty() ? soft_cube
                               : tools.mesh + soft_cube.substr(soft_cube.find("[[material]]"))) +
           tools.text;
}

std::ostream& operator<<(std::ostream& out, const Tools& tools) { return out << tools.name; }

class CutFrame : public testing::TestWithParam<Tools> {};

TEST_P(CutFrame, ReadAsAMeshIsTheBodyAtRest) {
    const RunFolder folder;
    write_mixed_cube(folder);
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
    // The order of sums differs with the ids.
    constexpr double rounding = 1e-12;
    EXPECT_NEAR(read.model().structure().rest_stable_step(),
                written.model().structure().rest_stable_step(),
                rounding * written.model().structure().rest_stable_step());
    EXPECT_NEAR(read.model().energetics().totals().mass, written.model().energetics().totals().mass,
                rounding * written.model().energetics().totals().mass);
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
    write_mixed_cube(folder);
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

TEST(FrameOfACutBody, HasTetrahedraInPlaceOfPolyhedra) {
    const RunFolder folder;
    write_mixed_cube(folder);
    Simulation simulation(folder.scenario(scene_of({"", blade_halfway + plane_cut, of_file}) +
                                          while_falling +
                                          "[output]\ncells = \"tetrahedra\"\nphysics = true\n"));
    run(simulation);
    std::vector<scenario::Field> fields = simulation.scenario().output.fields;
    ASSERT_EQ(std::erase(fields, scenario::Field::tetrahedra), 1u);
    const auto polyhedra = build_frame(simulation.model(), 0.04, fields);
    const auto frame = build_frame(simulation.model(), 0.04, simulation.scenario().output.fields);
    EXPECT_EQ(std::ranges::count(frame.mesh.kinds, topology::CellKind::polyhedron), 0);
    EXPECT_GT(std::ranges::count(polyhedra.mesh.kinds, topology::CellKind::polyhedron), 10);
    EXPECT_TRUE(frame.mesh.carriers.is_empty());
    const topology::SourceFaces faces(frame.mesh), faces_before(polyhedra.mesh);
    const auto field = [](const std::vector<io::Field>& all, const std::string& name) {
        return *std::ranges::find(all, name, &io::Field::name);
    };
    const auto ids =
        std::get<std::vector<std::int64_t>>(field(frame.cell_fields, "element_id").values);
    const auto ids_before =
        std::get<std::vector<std::int64_t>>(field(polyhedra.cell_fields, "element_id").values);
    // By element: its volume, the area of its faces on cuts, and its fields.
    const auto sums_of = [&](const io::Frame& of, const topology::SourceFaces& its_faces,
                             const std::vector<std::int64_t>& elements) {
        const auto stress = std::get<std::vector<float>>(field(of.cell_fields, "von_mises").values);
        std::map<std::int64_t, std::array<double, 3>> sums;
        for (std::size_t c = 0; c < of.mesh.num_cells(); ++c) {
            auto& [volume, area, value] = sums[elements[c]];
            volume += its_faces.volume(c);
            value = static_cast<double>(stress[c]);
            for (int f = 0; f < its_faces.num_faces(c); ++f)
                if (of.mesh.is_on_cut(c, f))
                    area += topology::area_vector(its_faces.size({c, f}), [&](int p) {
                                return its_faces.position({c, f}, p);
                            }).norm();
        }
        return sums;
    };
    const auto sums = sums_of(frame, faces, ids),
               sums_before = sums_of(polyhedra, faces_before, ids_before);
    ASSERT_EQ(sums.size(), sums_before.size());
    constexpr double brick = 0.1 * 0.1 * 0.1 / 27.0;  // m3
    double cut_area = 0.0, cut_area_before = 0.0;
    for (const auto& [e, before] : sums_before) {
        EXPECT_NEAR(sums.at(e)[0], before[0], 1e-12 * brick);
        EXPECT_EQ(sums.at(e)[2], before[2]);
        cut_area += sums.at(e)[1];
        cut_area_before += before[1];
    }
    // Bent faces have more area in triangles.
    EXPECT_GT(cut_area_before, 0.0);
    EXPECT_NEAR(cut_area, cut_area_before, 0.02 * cut_area_before);
    for (const char* name : {"mass", "force"}) {
        const auto sum = [&](const io::Frame& of) {
            double total = 0.0;
            std::visit(
                [&](const auto& values) {
                    for (const auto v : values) total += static_cast<double>(v);
                },
                field(of.point_fields, name).values);
            return total;
        };
        EXPECT_EQ(sum(frame), sum(polyhedra)) << name;
    }
    for (const io::Field& of_points : frame.point_fields)
        EXPECT_EQ(of_points.size(),
                  frame.mesh.points.size() * static_cast<std::size_t>(of_points.components));
    io::write_vtu(folder / "frame.vtu", frame);
    EXPECT_EQ(io::read_mesh(folder / "frame.vtu").mesh.num_cells(), frame.mesh.num_cells());
}

TEST(FrameOfACutBody, WithoutPolyhedraIsTheSameInTetrahedra) {
    const RunFolder folder;
    Simulation simulation(folder.scenario(soft_cube + plane_cut + while_falling));
    run(simulation);
    const std::vector<scenario::Field> tetrahedra{scenario::Field::mass,
                                                  scenario::Field::tetrahedra};
    EXPECT_EQ(io::vtu_text(build_frame(simulation.model(), 0.0, tetrahedra)),
              io::vtu_text(build_frame(simulation.model(), 0.0, std::span(tetrahedra).first(1))));
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
    constexpr double rounding = 1e-12;
    EXPECT_NEAR(read.model().structure().rest_stable_step(),
                written.model().structure().rest_stable_step(),
                rounding * written.model().structure().rest_stable_step());
    EXPECT_NEAR(read.model().energetics().totals().mass, written.model().energetics().totals().mass,
                rounding * written.model().energetics().totals().mass);
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
