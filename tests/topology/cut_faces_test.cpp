// Faces on cuts: all faces of the boundary but those of the first surface, after any edits, in the
// surface that follows them, and in a body that is saved or written and read again.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "incise/base/archive.h"
#include "incise/topology/boundary_surface.h"
#include "incise/topology/mesh_archive.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/mesh_repair.h"
#include "support/exact_plane.h"
#include "support/first_surface.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

const std::vector<FaceId> no_faces;

/// Returns what is wrong with the marks of a surface that has followed the edits.
std::vector<FaceId> faults(const BoundarySurface& surface, const Mesh& mesh) {
    std::vector<FaceId> faults;
    for (std::size_t t = 0; t < surface.triangles().size(); ++t)
        if ((surface.is_cut()[t] != 0) != mesh.is_on_cut(surface.faces()[t]))
            faults.push_back(surface.faces()[t]);
    return faults;
}

Mesh saved_and_restored(const Mesh& mesh) {
    ArchiveWriter out;
    save(mesh, out);
    ArchiveReader in(out.bytes());
    return load_mesh(in);
}

/// Returns which faces are on cuts, by row of the elements in ascending order.
std::vector<std::vector<bool>> marks(const Mesh& mesh) {
    std::vector<std::vector<bool>> marks;
    for (const CellId e : mesh.elements()) {
        marks.emplace_back();
        for (int f = 0; f < mesh.num_faces(e); ++f) marks.back().push_back(mesh.is_on_cut({e, f}));
    }
    return marks;
}

/// Returns the marks of the mesh that a file of it gives, in the order of the file.
std::vector<std::vector<bool>> marks_in_file(const MeshData& data) {
    const Mesh read = Mesh::build(data).mesh;
    std::vector<std::vector<bool>> marks(data.num_cells());
    for (const CellId e : read.elements())
        for (int f = 0; f < read.num_faces(e); ++f)
            marks[static_cast<std::size_t>(read.label(e))].push_back(read.is_on_cut({e, f}));
    return marks;
}

TEST(CutFaces, AreThoseThatAreNotOfTheFirstSurface) {
    std::size_t num_read = 0;
    for (const auto& family : test::mesh_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE(testing::Message() << family.name << ", seed " << seed);
            test::Random random(seed);
            Mesh mesh = Mesh::build(family.data).mesh;
            test::FirstSurface first(mesh);
            BoundarySurface surface(mesh);
            const auto follow = [&](const ChangeSet& changes) {
                first.apply(changes);
                surface.apply(mesh, changes);
                ASSERT_EQ(first.faults(mesh), no_faces);
                ASSERT_EQ(faults(surface, mesh), no_faces);
            };
            ASSERT_EQ(first.faults(mesh), no_faces);
            for (int i = 0; i < 6 && mesh.num_elements() > 4; ++i) {
                const auto before = marks(mesh);
                const ChangeSet changes = test::random_edit(mesh, random);
                follow(changes);
                if (changes.is_empty()) continue;
                const auto after = marks(mesh);
                replay(mesh, inverse(changes));
                follow(inverse(changes));
                ASSERT_EQ(marks(mesh), before);
                replay(mesh, changes);
                follow(changes);
                ASSERT_EQ(marks(mesh), after);
                if (i % 3 != 2) continue;
                ASSERT_EQ(marks(saved_and_restored(mesh)), after);
                // A face that is open while both its sides have the same nodes is closed in a file.
                const MeshData data = to_mesh_data(mesh, mesh.rest_positions());
                if (!data.faces.empty()) continue;  // no mesh begins with polyhedra
                if (boundary_faces(Mesh::build(data).mesh).size() != boundary_faces(mesh).size())
                    continue;
                ASSERT_EQ(marks_in_file(data), after);
                ++num_read;
            }
        }
    if (!test::is_sanitized) {  // there are too few cases then
        EXPECT_GT(num_read, 0u);
    }
}

TEST(CutFaces, AreThoseOfPlanesThatCrossEachOther) {
    for (const test::MeshFamily* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        test::Random random(1);
        Mesh mesh = Mesh::build(family->data).mesh;
        test::FirstSurface first(mesh);
        BoundarySurface surface(mesh);
        for (int i = 0; i < 4; ++i) {
            const ChangeSet changes =
                test::cut_along_plane(mesh, {0.5 + 0.1 * i, 0.4, 0.5}, random.vector(1.0));
            first.apply(changes);
            surface.apply(mesh, changes);
            EXPECT_EQ(first.faults(mesh), no_faces);
            EXPECT_EQ(faults(surface, mesh), no_faces);
        }
    }
}

TEST(CutFaces, StayMarkedInAMirroredBody) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        Mesh mesh = Mesh::build(family.data).mesh;
        if (mesh.num_elements() < 3) continue;
        MeshEdit edit(mesh);
        edit.remove(CellId(mesh.element_capacity() / 2));
        edit.commit();
        MeshData data = to_mesh_data(mesh, mesh.rest_positions());
        const auto area = [](const MeshData& of) {
            const Mesh read = Mesh::build(of).mesh;
            double sum = 0.0;
            for (const FaceId face : boundary_faces(read))
                sum += read.is_on_cut(face) ? rest_area(read, face) : 0.0;
            return sum;
        };
        const double before = area(data);
        EXPECT_GT(before, 0.0);
        for (Vec3& x : data.points) x.x() = -x.x();
        EXPECT_EQ(turn_inverted_cells(data).num_cells, data.num_cells());
        EXPECT_NEAR(area(data), before, 1e-12 * before);
    }
}

TEST(CutFaces, ThatAreNoneAreRefused) {
    MeshData data = test::jittered_cube(1, 0.0, 1);
    data.cut_faces.assign(data.num_cells(), 15);
    EXPECT_TRUE(check(data).errors.empty());
    for (const std::int32_t faces : {16, -1}) {
        data.cut_faces[2] = faces;
        ASSERT_EQ(check(data).errors.size(), 1u);
        EXPECT_NE(check(data).errors.front().find("cell 2 (tetrahedron) has the cut_faces"),
                  std::string::npos);
    }
    data.cut_faces.pop_back();
    EXPECT_EQ(check(data).errors.size(), 1u);
}

}  // namespace
}  // namespace incise::topology
