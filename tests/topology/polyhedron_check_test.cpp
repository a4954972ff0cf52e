// Polyhedra of the source: what a mesh makes of them, and which are refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/mesh_repair.h"
#include "incise/topology/source_faces.h"
#include "incise/topology/validate.h"
#include "support/cut_bricks.h"

namespace incise::topology {
namespace {

using testing::HasSubstr;

const std::vector<std::string> no_faults;

TEST(Polyhedra, OfTheSourceBecomeCells) {
    const MeshData data = test::cut_bricks();
    const BuiltMesh built = Mesh::build(data);
    EXPECT_EQ(built.warnings, no_faults);
    const Mesh& mesh = built.mesh;
    EXPECT_EQ(validate(mesh), no_faults);
    EXPECT_EQ(components(mesh).count, 1);
    double volume = 0.0;
    for (const CellId e : mesh.elements()) {
        EXPECT_TRUE(mesh.is_polyhedron(e));
        EXPECT_EQ(mesh.region(e), 4);
        EXPECT_EQ(rest_volume(mesh, e), SourceFaces(data).volume(e.index()));
        volume += rest_volume(mesh, e);
    }
    EXPECT_DOUBLE_EQ(volume, 2.0);
    EXPECT_EQ(mesh.num_nodes(), 18u);
    // The halves hang together through the other brick alone.
    EXPECT_FALSE(mesh.neighbor({CellId(0), 5}).is_valid());
    EXPECT_TRUE(mesh.is_on_cut({CellId(0), 5}));
    EXPECT_EQ(mesh.neighbor({CellId(0), 1}), (FaceId{CellId(2), 0}));
    EXPECT_EQ(mesh.neighbor({CellId(1), 1}), (FaceId{CellId(2), 1}));
    const MeshData again = to_mesh_data(mesh, mesh.rest_positions());
    EXPECT_EQ(again.faces, data.faces);
    EXPECT_EQ(again.corners, data.corners);
    EXPECT_EQ(again.cut_faces, data.cut_faces);
}

TEST(Polyhedra, HaveTheMeasuresOfTheirShape) {
    const MeshMetrics metrics = measure(test::cut_bricks());
    EXPECT_EQ(metrics.num_of_kind[static_cast<std::size_t>(CellKind::polyhedron)], 3u);
    EXPECT_DOUBLE_EQ(metrics.volume, 2.0);
    EXPECT_DOUBLE_EQ(metrics.surface_area, 12.0);  // 10 outside, and the cut twice
    EXPECT_DOUBLE_EQ(metrics.min_edge_length, 0.5);
    EXPECT_DOUBLE_EQ(metrics.max_edge_length, 1.0);
    EXPECT_DOUBLE_EQ(metrics.min_altitude, 1.5);  // three times 1/2, over 1
}

TEST(Polyhedra, StayOpenWhereBothSidesHaveTheSamePoints) {
    MeshData data = test::cut_bricks();
    for (auto* list : {&data.faces, &data.corners})
        for (std::int64_t& p : *list)
            if (p == 14 || p == 15) p -= 2;  // the corners at x = 0, too
    ASSERT_EQ(check(data).errors, no_faults);
    EXPECT_FALSE(Mesh::build(data).mesh.neighbor({CellId(0), 5}).is_valid());
    data.set_on_cut(1, 4, false);
    EXPECT_EQ(Mesh::build(data).mesh.neighbor({CellId(0), 5}), (FaceId{CellId(1), 4}));
}

TEST(Polyhedra, AreClosedByWelding) {
    MeshData data = test::cut_bricks();
    EXPECT_EQ(weld(data), 2u);
    ASSERT_EQ(check(data).errors, no_faults);
    const Mesh mesh = Mesh::build(data).mesh;
    EXPECT_EQ(mesh.neighbor({CellId(0), 5}), (FaceId{CellId(1), 4}));
    EXPECT_EQ(validate(mesh), no_faults);
    drop_welded_points(data);
    EXPECT_EQ(data.points.size(), 16u);
    EXPECT_EQ(check(data).errors, no_faults);
}

TEST(Polyhedra, OfAMirroredBodyAreTurned) {
    const MeshData sound = test::cut_bricks();
    MeshData data = sound;
    for (Vec3& x : data.points) x.x() = -x.x();
    for (CarrierCorners& corners : data.carriers.corners)
        for (Vec3& x : corners) x.x() = -x.x();
    EXPECT_EQ(turn_inverted_cells(data).num_cells, 3u);
    EXPECT_EQ(check(data).errors, no_faults);
    EXPECT_EQ(data.cut_faces, sound.cut_faces);
    EXPECT_EQ(Mesh::build(data).mesh.neighbor({CellId(1), 1}), (FaceId{CellId(2), 1}));
}

TEST(Polyhedra, HaveABitForEachFaceOnACut) {
    // A prism of 40 sides, of which all faces are on cuts, in a brick.
    constexpr int num_sides = 40;
    MeshData data;
    std::vector<std::int64_t> faces{0}, top, bottom;
    for (int k = 0; k < num_sides; ++k) {
        const double angle = 2.0 * 3.141592653589793 * k / num_sides;
        for (const double z : {0.0, 1.0})
            data.points.emplace_back(std::cos(angle), std::sin(angle), z);
        bottom.push_back(2 * (num_sides - 1 - k));
        top.push_back(2 * k + 1);
    }
    for (int k = 0; k < num_sides; ++k) {
        const int next = (k + 1) % num_sides;
        test::add_face(faces, {2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
    }
    test::add_face(faces, bottom);
    test::add_face(faces, top);
    data.add_polyhedron(faces);
    data.carriers.of_cell = {0};
    std::vector<Vec3> brick;
    for (const double z : {0.0, 1.0})
        for (const auto& [x, y] : {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0),
                                   std::pair(-1.0, 1.0)})
            brick.emplace_back(x, y, z);
    data.carriers.corners.emplace_back(CellKind::hexahedron, brick);
    for (const int f : {0, 30, 31, 41}) data.set_on_cut(0, f);
    ASSERT_EQ(data.further_cut_faces.size(), 1u);
    ASSERT_EQ(check(data).errors, no_faults);
    const Mesh mesh = Mesh::build(data).mesh;
    for (int f = 0; f < num_sides + 2; ++f)
        EXPECT_EQ(mesh.is_on_cut({CellId(0), f}), f == 0 || f == 30 || f == 31 || f == 41) << f;
    const MeshData again = to_mesh_data(mesh, mesh.rest_positions());
    EXPECT_EQ(again.cut_faces, data.cut_faces);
    EXPECT_EQ(again.further_cut_faces, data.further_cut_faces);

    data.further_cut_faces[0][0] |= 1 << 11;  // face 42
    EXPECT_THAT(check(data).errors.front(), HasSubstr("has the cut_faces_31 "));
    data.further_cut_faces[0].clear();
    EXPECT_THAT(check(data).errors.front(), HasSubstr("further_cut_faces has 0 entries"));
}

TEST(Polyhedra, ThatAreNoneAreRefused) {
    const MeshData sound = test::cut_bricks();
    ASSERT_EQ(check(sound).errors, no_faults);
    const auto expect_fault = [&](const std::string& text, auto forge) {
        SCOPED_TRACE(text);
        MeshData forged = sound;
        forge(forged);
        const auto errors = check(forged).errors;
        ASSERT_FALSE(errors.empty());
        EXPECT_THAT(errors.front(), HasSubstr(text));
        EXPECT_THROW(Mesh::build(forged), InputError);
    };
    // The first cell: 6 faces, each 4 and four points. Face f begins at 1 + 5 * f.
    const auto face = [](int f) { return static_cast<std::ptrdiff_t>(1 + 5 * f); };
    expect_fault("cell 0 (polyhedron) and 2 more without a carrier: forces need",
                 [](MeshData& m) { m.carriers = {}; });
    expect_fault("cell 1 (polyhedron) without a carrier",
                 [](MeshData& m) { m.carriers.of_cell[1] = Carriers::whole; });
    expect_fault("cell 0 (polyhedron) has no list of faces", [](MeshData& m) { m.faces.clear(); });
    expect_fault("cell 0 (polyhedron) has 3 faces", [](MeshData& m) { m.faces[0] = 3; });
    expect_fault("cell 0 (polyhedron) has a face 0 of 2 corners",
                 [](MeshData& m) { m.faces[1] = 2; });
    expect_fault("cell 0 (polyhedron) has a face 0 of 1000 corners",
                 [](MeshData& m) { m.faces[1] = 1000; });
    expect_fault("cell 2 (polyhedron) lacks its face 6 of 7",
                 [](MeshData& m) { m.faces.resize(m.faces.size() - 5); });
    expect_fault("the faces of polyhedra are", [](MeshData& m) { m.faces.push_back(0); });
    expect_fault("cell 0 (polyhedron) has other corners than its faces",
                 [](MeshData& m) { m.corners[0] = 8; });
    expect_fault("node index 99 is out of range", [&](MeshData& m) {
        std::replace(m.corners.begin(), m.corners.end(), std::int64_t{0}, std::int64_t{99});
        std::replace(m.faces.begin() + 1, m.faces.begin() + face(6), std::int64_t{0},
                     std::int64_t{99});
    });
    expect_fault("that meets point", [&](MeshData& m) {
        m.faces[static_cast<std::size_t>(face(0) + 2)] =
            m.faces[static_cast<std::size_t>(face(0) + 1)];
    });
    expect_fault("in the same direction", [&](MeshData& m) {
        std::reverse(m.faces.begin() + face(2) + 1, m.faces.begin() + face(3));
    });
    expect_fault("is not closed: only its face", [&](MeshData& m) {
        m.faces.erase(m.faces.begin() + face(2), m.faces.begin() + face(3));
        m.faces[0] = 5;
        m.cut_faces.clear();
    });
    expect_fault("has 2 sets of faces that do not hang together", [](MeshData& m) {
        // Both halves as one cell.
        MeshData both;
        both.points = m.points;
        std::vector<std::int64_t> faces(m.faces.begin(), m.faces.begin() + 31);
        faces.insert(faces.end(), m.faces.begin() + 32, m.faces.begin() + 62);
        faces[0] = 12;
        for (std::size_t at = 31; at < faces.size(); ++at)
            if ((at - 31) % 5 != 0 && (faces[at] == 16 || faces[at] == 17))
                faces[at] = faces[at] == 16 ? 2 : 5;  // which the lower half has not
        both.add_polyhedron(faces);
        both.carriers = m.carriers;
        both.carriers.of_cell = {0};
        m = both;
    });
    expect_fault("cell 0 (polyhedron) touches itself at point", [](MeshData& m) {
        // Two opposite corners of a box are one point.
        MeshData one;
        one.points = m.points;
        std::vector<std::int64_t> faces(m.faces.begin(), m.faces.begin() + 31);
        std::replace(faces.begin() + 1, faces.end(), std::int64_t{17}, std::int64_t{0});
        one.add_polyhedron(faces);
        one.carriers = m.carriers;
        one.carriers.of_cell = {0};
        m = one;
    });
    expect_fault("which must be positive: its faces run the wrong way round", [&](MeshData& m) {
        m.carriers.of_cell = {0};
        m.kinds = {CellKind::polyhedron};
        m.offsets = {0, m.offsets[1]};
        m.corners.resize(m.offsets[1]);
        m.regions.resize(1);
        m.cut_faces.clear();
        m.faces.resize(static_cast<std::size_t>(face(6)));
        for (int f = 0; f < 6; ++f)
            std::reverse(m.faces.begin() + face(f) + 1, m.faces.begin() + face(f + 1));
    });
    expect_fault("that is not plane", [](MeshData& m) {
        for (const std::size_t p : {12u, 17u}) m.points[p].z() = 0.05;
        for (const std::size_t p : {13u, 16u}) m.points[p].z() = 0.95;
    });
    expect_fault("is not inside its carrier", [](MeshData& m) { m.points[12].x() = -0.1; });
    expect_fault("have more volume than the carrier", [](MeshData& m) {
        // The lower half a second time, with points of its own.
        std::vector<std::int64_t> faces(m.faces.begin(), m.faces.begin() + 31);
        const auto first = std::ssize(m.points);
        for (int p = 0; p < first; ++p) m.points.push_back(m.points[static_cast<std::size_t>(p)]);
        for (std::size_t at = 1; at < faces.size(); ++at)
            if (at % 5 != 1) faces[at] += first;
        m.add_polyhedron(faces, 4);
        m.carriers.of_cell.push_back(0);
    });
    expect_fault("has the carrier 0, a hexahedron: only polyhedra can be parts", [](MeshData& m) {
        m.add_cell(CellKind::tetrahedron, std::array<std::int64_t, 4>{0, 1, 3, 6}, 4);
        m.carriers.of_cell.push_back(0);
    });
}

TEST(Polyhedra, OfATorusAreRefused) {
    // A ring of four prisms with a triangle as their section: closed, in one piece, but no ball.
    MeshData data;
    for (int k = 0; k < 4; ++k) {
        const Vec3 out(k == 0 ? 1.0 : k == 2 ? -1.0 : 0.0, k == 1 ? 1.0 : k == 3 ? -1.0 : 0.0, 0.0);
        data.points.insert(data.points.end(), {2.0 * out, 3.0 * out, 2.5 * out + Vec3(0, 0, 1)});
    }
    std::vector<std::int64_t> faces{0};
    for (int k = 0; k < 4; ++k) {
        const int a = 3 * k, b = 3 * ((k + 1) % 4);
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            test::add_face(faces, {a + j, b + j, b + i, a + i});
        }
    }
    data.add_polyhedron(faces);
    data.carriers = test::cut_bricks().carriers;
    data.carriers.of_cell = {0};
    EXPECT_THAT(check(data).errors.front(), HasSubstr("is no ball: it has 12 corners, 24 edges"));
}

}  // namespace
}  // namespace incise::topology
