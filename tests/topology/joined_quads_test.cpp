// Quadrilaterals that meet two triangles: what is joined, what is not, and that the body stays
// whole and exact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/joined_quads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_archive.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/mesh_repair.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

using test::Bricks;
using test::Random;
using Row = std::vector<std::int64_t>;

/// A cube, and tetrahedra on its top that share its diagonal from point 4 to point 6.
MeshData cube_and_tetrahedra(const std::vector<Row>& tetrahedra) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},    {0, 0, 1},
                   {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.4, 0.5, 2}};
    data.add_cell(CellKind::hexahedron, Row{0, 1, 2, 3, 4, 5, 6, 7});
    for (const Row& corners : tetrahedra) data.add_cell(CellKind::tetrahedron, corners);
    return data;
}

double volume_of(const Mesh& mesh) {
    double sum = 0.0;
    for (const CellId e : mesh.elements()) sum += rest_volume(mesh, e);
    return sum;
}

void for_each_body(auto check) {
    for (const double jitter : {0.0, 0.2})
        for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
            SCOPED_TRACE(testing::Message() << "jitter " << jitter << ", seed " << seed);
            check(test::brick_cube(Bricks::joined, 3, jitter, seed), seed);
        }
}

TEST(JoinedQuads, MakeOneBodyOfAllCells) {
    std::size_t num_divided = 0;
    for_each_body([&](const MeshData& data, std::uint64_t) {
        const auto [mesh, warnings, joins] = Mesh::build(data);
        EXPECT_EQ(warnings, std::vector<std::string>{});
        EXPECT_EQ(validate(mesh), std::vector<std::string>{});
        EXPECT_EQ(components(mesh).count, 1);
        EXPECT_NEAR(volume_of(mesh), 1.0, 1e-14);
        EXPECT_NEAR(measure(data).volume, 1.0, 1e-14);
        EXPECT_NEAR(measure(data).surface_area, 6.0, 1e-13);
        double area = 0.0;
        for (const FaceId f : boundary_faces(mesh)) area += rest_area(mesh, f);
        EXPECT_NEAR(area, 6.0, 1e-13);
        for (const CellId e : mesh.elements()) num_divided += mesh.is_polyhedron(e) ? 1 : 0;
        EXPECT_FALSE(joins.empty());
    });
    EXPECT_GT(num_divided, static_cast<std::size_t>(test::num_cases(100)));
}

// The kinds and the order of corners are those of the source, and cells of other kinds are as they
// were.
TEST(JoinedQuads, LeaveCellsKnownAsThoseOfTheSource) {
    for_each_body([](const MeshData& data, std::uint64_t) {
        const Mesh mesh = Mesh::build(data).mesh;
        for (const CellId e : mesh.elements()) {
            const auto c = static_cast<std::size_t>(mesh.label(e));
            const auto whole = mesh.whole_cell(e);
            ASSERT_TRUE(whole);
            EXPECT_EQ(whole->kind, data.kinds[c]);
            EXPECT_EQ(mesh.is_polyhedron(e), !whole->diagonals.is_none());
            ASSERT_EQ(whole->corners().size(), data.cell(c).size());
            for (std::size_t k = 0; k < data.cell(c).size(); ++k)
                EXPECT_EQ(mesh.label(whole->corners()[k]), data.cell(c)[k]);
        }
        const MeshData written = to_mesh_data(mesh, mesh.rest_positions());
        EXPECT_TRUE(written.faces.empty());
        EXPECT_EQ(written.kinds.size(), data.kinds.size());
        const Mesh again = Mesh::build(written).mesh;
        EXPECT_EQ(components(again).count, 1);
        EXPECT_NEAR(volume_of(again), 1.0, 1e-14);
        EXPECT_EQ(boundary_faces(again).size(), boundary_faces(mesh).size());
    });
}

TEST(JoinedQuads, ComeBackFromAnArchive) {
    for_each_body([](const MeshData& data, std::uint64_t seed) {
        Mesh mesh = Mesh::build(data).mesh;
        Random random(seed);
        for (int i = 0; i < 2; ++i) test::random_edit(mesh, random);
        ArchiveWriter writer;
        save(mesh, writer);
        ArchiveReader reader(writer.bytes());
        const Mesh read = load_mesh(reader);
        EXPECT_TRUE(test::MeshSnapshot(read) == test::MeshSnapshot(mesh));
        for (const CellId e : mesh.elements()) {
            const auto one = mesh.whole_cell(e), other = read.whole_cell(e);
            ASSERT_EQ(one.has_value(), other.has_value());
            if (!one) continue;
            EXPECT_EQ(one->diagonals, other->diagonals);
            EXPECT_EQ(one->at, other->at);
        }
    });
}

TEST(JoinedQuads, StayValidUnderEditsThatAreTakenBack) {
    for_each_body([](const MeshData& data, std::uint64_t seed) {
        Mesh mesh = Mesh::build(data).mesh;
        const test::MeshSnapshot before(mesh);
        Random random(seed);
        std::vector<ChangeSet> edits;
        for (int i = 0; i < 8 && mesh.num_elements() > 1; ++i) {
            ChangeSet changes = test::random_edit(mesh, random);
            ASSERT_EQ(validate(mesh), std::vector<std::string>{});
            if (!changes.is_empty()) edits.push_back(std::move(changes));
            // What is written can be read, also where an edit has opened one triangle of two.
            const MeshData written = to_mesh_data(mesh, mesh.rest_positions());
            if (written.faces.empty()) {
                EXPECT_TRUE(check(written).errors.empty());
            }
        }
        const test::MeshSnapshot after(mesh);
        for (std::size_t i = edits.size(); i-- > 0;) replay(mesh, inverse(edits[i]));
        EXPECT_TRUE(test::MeshSnapshot(mesh) == before);
        for (const ChangeSet& edit : edits) replay(mesh, edit);
        EXPECT_TRUE(test::MeshSnapshot(mesh) == after);
    });
}

// A cell keeps its kind in files while both triangles are joined, or none is.
TEST(JoinedQuads, AreWrittenAsPolyhedraWhereOneTriangleIsGone) {
    MeshData data = cube_and_tetrahedra({{4, 5, 6, 8}, {4, 6, 7, 8}});
    Mesh mesh = Mesh::build(data).mesh;
    const auto is_polyhedron_in_file = [&] {
        return !to_mesh_data(mesh, mesh.rest_positions()).faces.empty();
    };
    EXPECT_FALSE(is_polyhedron_in_file());
    for (const bool is_one_gone : {true, false}) {
        CellId tetrahedron;
        for (const CellId e : mesh.elements())
            if (mesh.kind(e) == CellKind::tetrahedron) tetrahedron = e;
        MeshEdit edit(mesh);
        edit.remove(tetrahedron);
        edit.commit();
        EXPECT_EQ(is_polyhedron_in_file(), is_one_gone);
    }
    const MeshData alone = to_mesh_data(mesh, mesh.rest_positions());
    ASSERT_EQ(alone.num_cells(), 1u);
    EXPECT_EQ(alone.kinds[0], CellKind::hexahedron);
    EXPECT_EQ(alone.cut_faces, std::vector<std::int32_t>{1 << 5});
}

std::size_t num_joined(const MeshData& data) { return check(data).joined_quads.size(); }

TEST(JoinedQuads, NeedBothTrianglesOnOneDiagonal) {
    EXPECT_EQ(num_joined(cube_and_tetrahedra({{4, 5, 6, 8}, {4, 6, 7, 8}})), 1u);
    EXPECT_EQ(num_joined(cube_and_tetrahedra({{4, 5, 7, 8}, {5, 6, 7, 8}})), 1u);
    EXPECT_EQ(num_joined(cube_and_tetrahedra({{4, 5, 6, 8}})), 0u);
    EXPECT_EQ(num_joined(cube_and_tetrahedra({{4, 5, 6, 8}, {5, 6, 7, 8}})), 0u);
    // On both diagonals, so that they overlap.
    MeshData both = cube_and_tetrahedra({{4, 5, 6, 8}, {4, 6, 7, 8}, {4, 5, 7, 9}, {5, 6, 7, 9}});
    both.points.emplace_back(0.5, 0.5, 3);
    EXPECT_EQ(num_joined(both), 0u);
    // On the side of the cube itself.
    MeshData inside = cube_and_tetrahedra({{4, 6, 5, 9}, {4, 7, 6, 9}});
    inside.points.emplace_back(0.5, 0.5, 0.5);
    ASSERT_TRUE(check(inside).errors.empty());
    EXPECT_EQ(num_joined(inside), 0u);
}

// A tetrahedron has both triangles where it fills up a warped quadrilateral.
TEST(JoinedQuads, CanMeetOneTetrahedronTwice) {
    MeshData data = cube_and_tetrahedra({{4, 5, 6, 7}});
    data.points.resize(8);
    for (const std::size_t p : {4, 6}) data.points[p].z() = 0.9;
    for (const std::size_t p : {5, 7}) data.points[p].z() = 1.1;
    EXPECT_EQ(num_joined(data), 1u);
    const Mesh mesh = Mesh::build(data).mesh;
    EXPECT_EQ(validate(mesh), std::vector<std::string>{});
    EXPECT_EQ(components(mesh).count, 1);
    EXPECT_NEAR(volume_of(mesh), 3.1 / 3.0, 1e-15);
    EXPECT_NEAR(measure(data).volume, 3.1 / 3.0, 1e-15);
}

TEST(JoinedQuads, AreReportedByKindsAndRegions) {
    MeshData data = cube_and_tetrahedra({{4, 5, 6, 8}, {4, 6, 7, 8}});
    const auto report = [&] { return report_of_joins(data, check(data).joined_quads); };
    EXPECT_EQ(report(), std::vector<std::string>{"joined 1 quadrilateral of hexahedra to two "
                                                 "triangles of tetrahedra"});
    data.regions = {1, 2, 3};
    EXPECT_EQ(report(), std::vector<std::string>{"joined 1 quadrilateral of hexahedra to two "
                                                 "triangles of tetrahedra, region 1 to 2 and 3"});
    MeshData grid = box_mesh(CellKind::hexahedron, {0, 0, 0}, {1, 1, 1}, {8, 8, 1});
    const MeshData top = box_mesh(CellKind::tetrahedron, {0, 0, 1}, {1, 1, 1}, {8, 8, 1});
    const auto offset = std::ssize(grid.points);
    grid.points.insert(grid.points.end(), top.points.begin(), top.points.end());
    for (std::size_t c = 0; c < top.num_cells(); ++c) {
        Row corners(top.cell(c).begin(), top.cell(c).end());
        for (std::int64_t& p : corners) p += offset;
        grid.add_cell(CellKind::tetrahedron, corners);
    }
    weld(grid);
    const auto built = Mesh::build(grid);
    EXPECT_EQ(built.joins, std::vector<std::string>{"joined 64 quadrilaterals of hexahedra to two "
                                                    "triangles of tetrahedra each"});
    EXPECT_EQ(built.warnings, std::vector<std::string>{});
    EXPECT_EQ(components(built.mesh).count, 1);
}

TEST(JoinedQuads, AreWarnedOfWhereTheyCannotBeJoined) {
    const auto built = Mesh::build(cube_and_tetrahedra({{4, 5, 6, 8}}));
    EXPECT_TRUE(built.joins.empty());
    EXPECT_EQ(components(built.mesh).count, 2);
    EXPECT_EQ(built.warnings.back(),
              "the quadrilateral of cell 0 (hexahedron) and the triangle of cell 1 (tetrahedron) "
              "on it are no common face, so these cells are not joined: let two triangles, which "
              "share one of its diagonals, cover each such quadrilateral");
}

}  // namespace
}  // namespace incise::topology
