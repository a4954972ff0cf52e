// Frames in tetrahedra: read again they are the body, in one piece where it is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cut_scenes.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/runner/frame_builder.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/source_faces.h"
#include "run_folder.h"
#include "support/mesh_families.h"

namespace incise::runner {
namespace {

using test::Bricks;
using topology::Mesh;

struct Body {
    std::string name;
    Bricks bricks;
};
std::ostream& operator<<(std::ostream& out, const Body& body) { return out << body.name; }

class FrameInTetrahedra : public testing::TestWithParam<Body> {};

TEST_P(FrameInTetrahedra, ReadAgainHangsTogetherAsTheBody) {
    const std::vector<scenario::Field> as_it_is{}, tetrahedra{scenario::Field::tetrahedra};
    const std::string two_cuts = blade_through + plane_cut;
    int num_read = 0;
    for (const auto& [name, tools] :
         {std::pair("through", blade_through), std::pair("halfway", blade_halfway),
          std::pair("plane", plane_cut), std::pair("two cuts", two_cuts)})
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
            const RunFolder folder;
            write_cube(folder, GetParam().bricks, seed);
            Simulation simulation(folder.scenario(scene_of({"", tools, of_file}) + while_falling));
            run(simulation);
            io::write_vtu(folder / "body.vtu", build_frame(simulation.model(), 0.04, as_it_is));
            io::write_vtu(folder / "frame.vtu", build_frame(simulation.model(), 0.04, tetrahedra));
            const io::MeshFile body = io::read_mesh(folder / "body.vtu"),
                               frame = io::read_mesh(folder / "frame.vtu");
            ASSERT_GT(std::ranges::count(body.mesh.kinds, topology::CellKind::polyhedron), 5);
            EXPECT_EQ(frame.warnings, std::vector<std::string>());
            // Where two cuts meet, cut faces of a cell can lie on each other: see
            // TetrahedralDivision.OfABodyCutSeveralTimesIsTheBody.
            const auto errors = topology::check(frame.mesh).errors;
            const bool are_folds = std::ranges::all_of(errors, [](const std::string& error) {
                return error.find("negative volume") != std::string::npos;
            });
            if (!errors.empty() && are_folds && tools == two_cuts) continue;
            ASSERT_EQ(errors, std::vector<std::string>());
            ++num_read;
            const auto built = Mesh::build(frame.mesh);
            EXPECT_EQ(built.warnings, std::vector<std::string>());
            EXPECT_EQ(built.mesh.num_nodes(), frame.mesh.points.size());  // none is pinched
            EXPECT_EQ(topology::components(built.mesh).count,
                      topology::components(simulation.mesh()).count);
            const auto metrics = topology::measure(frame.mesh),
                       of_body = topology::measure(body.mesh);
            EXPECT_NEAR(metrics.volume, of_body.volume, 1e-12 * of_body.volume);
            EXPECT_NEAR(metrics.surface_area, of_body.surface_area, 1e-10 * of_body.surface_area);
            if (testing::Test::HasFailure()) return;
        }
    EXPECT_GE(num_read, 6);  // all that were cut once
}

INSTANTIATE_TEST_SUITE_P(Bodies, FrameInTetrahedra,
                         testing::Values(Body{"Hexahedra", Bricks::hexahedra},
                                         Body{"Wedges", Bricks::wedges},
                                         Body{"Pyramids", Bricks::pyramids},
                                         Body{"Mixed", Bricks::mixed},
                                         Body{"Joined", Bricks::joined}),
                         [](const auto& body) { return body.param.name; });

// Also before the first cut, so that all frames of a run have the same kind of cells.
TEST(FrameOfAnUncutBody, IsInTetrahedra) {
    const RunFolder folder;
    const Simulation simulation(folder.scenario(scene_of({"", "", of_bricks}) + while_falling));
    const std::vector<scenario::Field> tetrahedra{scenario::Field::tetrahedra};
    const auto frame = build_frame(simulation.model(), 0.0, tetrahedra);
    EXPECT_EQ(frame.mesh.num_cells(), 24u * 27);
    EXPECT_EQ(std::ranges::count(frame.mesh.kinds, topology::CellKind::tetrahedron), 24 * 27);
}

// The points inside move with the corners.
TEST(FrameOfTetrahedra, IsThatOfTheDeformedBody) {
    const RunFolder folder;
    Simulation simulation(folder.scenario(scene_of({"", plane_cut, of_bricks}) + while_falling));
    run(simulation);
    const std::vector<scenario::Field> as_it_is{}, tetrahedra{scenario::Field::tetrahedra};
    const auto volume_of = [](const io::Frame& frame) {
        const topology::SourceFaces faces(frame.mesh);
        double volume = 0.0;
        for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c) volume += faces.volume(c);
        return volume;
    };
    const double at_rest = 1e-3;
    const double volume = volume_of(build_frame(simulation.model(), 0.04, as_it_is));
    EXPECT_GT(std::abs(volume - at_rest), 1e-9 * at_rest);
    EXPECT_NEAR(volume_of(build_frame(simulation.model(), 0.04, tetrahedra)), volume,
                1e-12 * at_rest);
}

TEST(FrameOfTetrahedra, HasTheValuesOfItsCells) {
    const RunFolder folder;
    write_cube(folder);
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

TEST(FrameOfTetrahedra, OfTetrahedraStaysAsItIs) {
    const RunFolder folder;
    Simulation simulation(folder.scenario(soft_cube + plane_cut + while_falling));
    run(simulation);
    const std::vector<scenario::Field> tetrahedra{scenario::Field::mass,
                                                  scenario::Field::tetrahedra};
    EXPECT_EQ(io::vtu_text(build_frame(simulation.model(), 0.0, tetrahedra)),
              io::vtu_text(build_frame(simulation.model(), 0.0, std::span(tetrahedra).first(1))));
}

}  // namespace
}  // namespace incise::runner
