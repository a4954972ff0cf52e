// Fibres in scenarios: where their directions come from, what is refused, and how frames carry
// them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/runner/frame_builder.h"
#include "incise/topology/box_mesh.h"
#include "run_folder.h"

namespace incise::runner {
namespace {

const std::string fibred_material = R"([[material]]
law = "holzapfel-gasser-ogden"
density = 1000
shear_modulus = 400
bulk_modulus = 2000
k1 = 1000
k2 = 0.5
)";

/// Held at its bottom and pulled up at its top.
const std::string pulled = R"([[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[constraint]]
name = "ceiling"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.1, by = [0, 0, 0.02] }]
[dynamics]
end_time = 0.15
damping = 20
)";

const std::string box_of_tissue = "[mesh]\nbox = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }\n";
const std::string body_file = "[mesh]\nfile = \"body.vtu\"\n";

/// The box with vectors of the cells in an array of the name.
io::Frame frame_with_vectors(const std::string& name) {
    io::Frame frame;
    frame.mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                    Vec3::Constant(0.1), {2, 2, 2});
    std::vector<double> vectors;
    for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c) {
        const Vec3 v(0.5, std::sin(static_cast<double>(c)), 2.0);
        vectors.insert(vectors.end(), {v.x(), v.y(), v.z()});
    }
    frame.cell_fields.push_back({name, 3, std::move(vectors)});
    return frame;
}
std::vector<double>& vectors_of(io::Frame& frame) {
    return std::get<std::vector<double>>(frame.cell_fields[0].values);
}

TEST(FibredBody, IsStifferAlongItsFibresThanAcross) {
    const RunFolder folder;
    const auto reaction = [&](const std::string& direction) {
        Simulation simulation(folder.scenario(box_of_tissue + fibred_material +
                                              "fibre = " + direction + "\n" + pulled));
        run(simulation);
        return simulation.model().boundary().reactions()[1].force.z();
    };
    const double along = reaction("[0, 0, 3]"), across = reaction("[1, 0, 0]");
    EXPECT_GT(across, 0.0);
    EXPECT_GT(along, 2.0 * across);
}

/// The warnings of a run up to the first one, or to its end.
std::vector<std::string> first_warnings(const Scenario& scenario) {
    Simulation simulation(scenario);
    simulation.start();
    for (int rest = 5; rest > 0 && !simulation.is_finished();) {
        simulation.step();
        if (!simulation.warnings().empty()) --rest;  // it is told once
    }
    return simulation.warnings();
}

TEST(FibredBody, WarnsOnceWhereItStiffensMuch) {
    const RunFolder folder;
    const std::string drawn =
        "[[constraint]]\nname = \"floor\"\n"
        "where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }\nfix = \"xyz\"\n"
        "[[constraint]]\nname = \"ceiling\"\n"
        "where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }\n"
        "move = [{ time = 0, by = [0, 0, 0] }, { time = 1, by = [0, 0, 0.1] }]\n"
        "[dynamics]\nend_time = 1\ndamping = 20\nsafety = 0.2\n";
    const std::string material = fibred_material + "fibre = [0, 0, 1]\n", k2 = "k2 = 0.5";
    for (const std::string element : {"tet", "hex"}) {
        SCOPED_TRACE(element);
        std::string box = box_of_tissue;
        box.insert(box.find(" }"), ", element = \"" + element + "\"");
        EXPECT_EQ(first_warnings(folder.scenario(box + material + pulled)),
                  std::vector<std::string>{});
        std::string stiffer = material;
        stiffer.replace(stiffer.find(k2), k2.size(), "k2 = 5");
        const auto warnings = first_warnings(folder.scenario(box + stiffer + drawn));
        ASSERT_EQ(warnings.size(), 1u);
        for (const auto* part :
             {"at t = 0.", " s, strain has made tissue so stiff that the stable step fell from ",
              " s at rest to ", "; most strained is element ", ", of region 0, with a volume ratio",
              "; let tools, obstacles and constraints press it less far"})
            EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
    }
}

TEST(FibredBody, CarriesDirectionsFromTheMeshToFrames) {
    const RunFolder folder;
    io::Frame frame = frame_with_vectors("collagen");
    io::write_vtu(folder / "body.vtu", frame);
    const std::string cut = R"([[tool]]
kind = "cut"
time = 0.05
plane = { point = [0, 0.047, 0.05], normal = [0.1, 1, 0.1] }
)";
    const Scenario scenario = folder.scenario(body_file + fibred_material +
                                              "fibre_array = \"collagen\"\n" + pulled + cut);
    Simulation simulation(scenario);
    const topology::Mesh& mesh = simulation.mesh();
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
        const auto c = static_cast<std::size_t>(mesh.label(CellId(i)));
        const Vec3 given(vectors_of(frame).data() + 3 * c);
        EXPECT_LE((simulation.model().structure().fibres()[i] - given.normalized()).norm(), 1e-15);
    }
    run(simulation);
    EXPECT_EQ(topology::components(mesh).count, 2);
    EXPECT_LE(simulation.ledger().energy_error(), 0.05);

    // A frame is a mesh with the same fibres.
    io::write_vtu(folder / "body.vtu", build_frame(simulation.model(), 0.0, {}));
    Simulation again(
        folder.scenario(body_file + fibred_material + "fibre_array = \"fibre\"\n" + pulled));
    std::map<std::vector<double>, Vec3> expected;  // by location
    const auto location = [](const topology::Mesh& m, CellId e) {
        std::vector<double> corners;
        for (const auto n : m.corners(e))
            for (const double x : m.rest_position(n)) corners.push_back(x);
        return corners;
    };
    const auto& fragments = simulation.model().fragments();
    for (const CellId e : mesh.elements())
        expected[location(mesh, e)] =
            simulation.model().structure().fibres()[fragments.fragment_of_cell(e).index()];
    ASSERT_EQ(again.mesh().num_elements(), mesh.num_elements());
    const auto& read = again.model().fragments();
    for (const CellId e : again.mesh().elements())
        EXPECT_EQ(again.model().structure().fibres()[read.fragment_of_cell(e).index()],
                  expected.at(location(again.mesh(), e)));
}

TEST(FibredBody, LeavesFramesOfOthersAlone) {
    Simulation simulation(scenario_of(soft_cube + dynamics(0.1)));
    EXPECT_TRUE(simulation.model().structure().fibres().empty());
    for (const auto& field : build_frame(simulation.model(), 0.0, {}).cell_fields)
        EXPECT_NE(field.name, "fibre");
}

TEST(FibredBody, RefusesVectorsWithoutDirectionForFibres) {
    const RunFolder folder;
    const auto refusal = [&](const io::Frame& frame, const std::string& materials) {
        io::write_vtu(folder / "body.vtu", frame);
        try {
            Simulation simulation(folder.scenario(body_file + materials + pulled));
        } catch (const InputError& error) {
            std::string text = error.what();
            return text.replace(0, text.find("body.vtu"), "");
        }
        return std::string("accepted");
    };
    const std::string one = fibred_material + "fibre_array = \"fibre\"\n";
    io::Frame frame = frame_with_vectors("fibre");
    EXPECT_EQ(refusal(frame, one), "accepted");
    for (std::size_t k = 0; k < 3; ++k) vectors_of(frame)[3 * 7 + k] = 0.0;
    EXPECT_EQ(refusal(frame, one),
              "body.vtu: element 7, of region 0, has [0, 0, 0] in the cell array 'fibre', which is "
              "no direction of fibres: its material needs one in each element; correct the array, "
              "or give the region a law without fibres");
    // Vectors of other regions are of no body_totals.
    frame.mesh.regions[7] = 3;
    const std::string two =
        one + "regions = 0\n[[material]]\ndensity = 1000\nyoung = 1000\npoisson = 0.4\n";
    EXPECT_EQ(refusal(frame, two), "accepted");
    vectors_of(frame)[3 * 4 + 1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal(frame, two).find("element 4, of region 0, has [0.5, nan, 2]"),
              std::string::npos);
    frame.cell_fields[0].name = "fibres";
    EXPECT_EQ(refusal(frame, two),
              "body.vtu: has no cell array 'fibre' of three components; its cell arrays of three "
              "components: 'fibres'");
}

}  // namespace
}  // namespace incise::runner
