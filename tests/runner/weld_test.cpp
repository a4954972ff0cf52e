// Scenarios whose mesh file has points that are not joined: what is told, and what 'mesh.weld'
// does. SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/io/vtk/vtu_writer.h"
#include "incise/runner/frame_builder.h"
#include "incise/scenario/body.h"
#include "incise/sim/selection.h"
#include "incise/topology/box_mesh.h"
#include "run_folder.h"
#include "support/mesh_families.h"

namespace incise::runner {
namespace {

using Lines = std::vector<std::string>;

const std::string file_mesh = "[mesh]\nfile = \"body.vtu\"\n";
const std::string rest = R"([[material]]
density = 1000
young = 1000
poisson = 0.4
[[constraint]]
where = { nodes = [0, 5, 17] }
fix = "xyz"
)" + dynamics(0.1);

/// A soup of a cube of 8 bricks, which have a region each.
io::Frame soup(topology::CellKind kind = topology::CellKind::tetrahedron) {
    io::Frame frame;
    frame.mesh =
        test::soup_of(topology::box_mesh(kind, Vec3::Zero(), Vec3::Constant(0.1), {2, 2, 2}));
    const std::size_t cells_of_brick = frame.mesh.num_cells() / 8;
    for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c)
        frame.mesh.regions[c] = static_cast<int>(c / cells_of_brick);
    return frame;
}

/// The warnings without the folder in front.
Lines warnings_of(const RunFolder& folder, const Scenario& scenario) {
    Lines warnings = build_body(scenario).warnings;
    for (auto& warning : warnings) {
        const std::string path = (folder / "").string();
        if (warning.starts_with(path)) warning.erase(0, path.size());
    }
    return warnings;
}

TEST(UnweldedBody, IsReportedAndFallsApart) {
    const RunFolder folder;
    io::write_vtu(folder / "body.vtu", soup());
    const Scenario scenario = folder.scenario(file_mesh + rest);
    const auto warnings = warnings_of(folder, scenario);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].starts_with(
        "body.vtu: 165 points are not joined to others at the same position"))
        << warnings[0];
    EXPECT_EQ(topology::components(build_body(scenario).mesh).count, 48);
}

TEST(UnweldedBody, IsNotReportedWhereItIsMeant) {
    const RunFolder folder;
    io::write_vtu(folder / "body.vtu", soup());
    const Scenario scenario = folder.scenario(file_mesh + "weld = false\n" + rest);
    EXPECT_EQ(warnings_of(folder, scenario), Lines{});
    EXPECT_EQ(topology::components(build_body(scenario).mesh).count, 48);
}

TEST(WeldedBody, IsOneWhateverTheScale) {
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron})
        for (const char* scale : {"1", "0.001", "300"}) {
            SCOPED_TRACE(scale);
            const RunFolder folder;
            io::write_vtu(folder / "body.vtu", soup(kind));
            const MeshSpec spec =
                folder.scenario(file_mesh + "weld = true\nscale = " + scale + "\n" + rest).mesh;
            const SourceMesh source = build_mesh(spec, {});
            EXPECT_EQ(source.mesh.num_nodes(), 27u);
            EXPECT_EQ(topology::components(source.mesh).count, 1);
            const std::size_t num_joined = source.mesh.num_source_points() - 27;
            EXPECT_EQ(source.warnings,
                      Lines{(folder / "body.vtu").string() + ": " + std::to_string(num_joined) +
                            " points were joined to others at the same position"});
        }
}

TEST(WeldedBody, AnswersToTheLabelsOfAllItsPoints) {
    const RunFolder folder;
    const io::Frame frame = soup();
    io::write_vtu(folder / "body.vtu", frame);
    const auto mesh = build_body(folder.scenario(file_mesh + "weld = true\n" + rest)).mesh;
    for (std::size_t p = 0; p < frame.mesh.points.size(); ++p) {
        Selection where;
        where.nodes = {static_cast<std::int64_t>(p)};
        const auto nodes = select_nodes(mesh, where);
        ASSERT_EQ(nodes.size(), 1u);
        EXPECT_EQ(mesh.rest_position(nodes[0]), frame.mesh.points[p]);
        EXPECT_LE(mesh.label(nodes[0]), static_cast<std::int64_t>(p));
    }
}

TEST(WeldedBody, KeepsRegionsAndFibresOfItsCells) {
    const RunFolder folder;
    io::Frame frame = soup();
    std::vector<double> fibres;
    for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c)
        fibres.insert(fibres.end(), {1.0, static_cast<double>(c), 0.0});
    frame.cell_fields.push_back({"fibre", 3, fibres});
    io::write_vtu(folder / "body.vtu", frame);
    const Simulation simulation(folder.scenario(file_mesh + R"(weld = true
[[material]]
law = "holzapfel-gasser-ogden"
density = 1000
shear_modulus = 400
bulk_modulus = 2000
k1 = 1000
k2 = 0.5
fibre_array = "fibre"
)" + dynamics(0.1)));
    const auto& mesh = simulation.mesh();
    ASSERT_EQ(mesh.num_elements(), frame.mesh.num_cells());
    for (std::size_t i = 0; i < mesh.num_elements(); ++i) {
        const CellId e(i);
        const auto c = static_cast<std::size_t>(mesh.label(e));
        EXPECT_EQ(mesh.region(e), frame.mesh.regions[c]);
        EXPECT_LE(
            (simulation.model().structure().fibres()[i] - Vec3(fibres.data() + 3 * c).normalized())
                .norm(),
            1e-15);
    }
}

TEST(WeldedBody, IsReportedWhereNothingIsToJoin) {
    const RunFolder folder;
    io::Frame frame;
    frame.mesh =
        topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {2, 2, 2});
    io::write_vtu(folder / "body.vtu", frame);
    EXPECT_EQ(warnings_of(folder, folder.scenario(file_mesh + "weld = true\n" + rest)),
              Lines{"body.vtu: no two points are at the same position: none was joined"});
}

TEST(FramesOfACut, AreWeldedOnlyWhereThatIsWished) {
    const RunFolder folder;
    const std::string cut = R"([[tool]]
kind = "cut"
time = 0.05
plane = { point = [0, 0.047, 0.05], normal = [0.1, 1, 0.1] }
)";
    Simulation simulation(folder.scenario(soft_cube + cut + dynamics(0.1)));
    run(simulation);
    io::write_vtu(folder / "body.vtu", build_frame(simulation.model(), 0.0, {}));
    const std::string loose = rest.substr(0, rest.find("[[constraint]]")) + dynamics(0.1);
    const Scenario cut_body = folder.scenario(file_mesh + loose);
    EXPECT_EQ(warnings_of(folder, cut_body), Lines{});
    EXPECT_EQ(topology::components(build_body(cut_body).mesh).count, 2);
    const Scenario healed = folder.scenario(file_mesh + "weld = true\n" + loose);
    EXPECT_EQ(topology::components(build_body(healed).mesh).count, 1);
}

TEST(WeldKey, IsTrueOrFalseAndOfFiles) {
    const RunFolder folder;
    io::write_vtu(folder / "body.vtu", soup());
    const std::string location = (folder / "scene.toml").string() + ":3:8: ";
    EXPECT_EQ(folder.report(file_mesh + "weld = 1\n" + rest).errors,
              Lines{location + "key 'mesh.weld': must be true or false, but is the number 1"});
    EXPECT_EQ(folder.report(file_mesh + "wled = true\n" + rest).errors,
              Lines{(folder / "scene.toml").string() +
                    ":3:1: key 'mesh.wled': is not known; did you mean 'weld'? Known here: file, "
                    "box, scale, region_array, weld, linear"});
    EXPECT_EQ(
        folder.report("[mesh]\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }\nweld = true\n" + rest)
            .warnings,
        Lines{location + "'mesh.weld' has no effect on a box, whose elements are joined"});
}

}  // namespace
}  // namespace incise::runner
