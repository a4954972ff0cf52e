// Selections of faces that follow edits of cells of any shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/physics/body/cell_set.h"
#include "incise/topology/darts.h"
#include "incise/topology/mesh_edit.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::physics {
namespace {

using test::Bricks;
using test::Random;
using topology::Dart;
using topology::Mesh;
using topology::MeshEdit;

Dart random_dart(const Mesh& mesh, Random& random) {
    std::vector<CellId> cells;
    for (const CellId e : mesh.elements()) cells.push_back(e);
    const CellId e = cells[random.below(cells.size())];
    const FaceId f{e, static_cast<int>(random.below(static_cast<std::size_t>(mesh.num_faces(e))))};
    return {f, static_cast<int>(random.below(static_cast<std::size_t>(mesh.face_size(f))))};
}

/// Divides an edge, a face, or a cell by a path round two faces that meet, or opens a face.
void change(MeshEdit& edit, const Mesh& mesh, Random& random) {
    const Dart d = random_dart(mesh, random);
    switch (random.below(4)) {
        case 0:
            edit.divide_edge(d, random.uniform(0.2, 0.8));
            return;
        case 1:
            if (mesh.face_size(d.face) <= topology::max_corners) edit.divide_face_at_centre(d.face);
            return;
        case 2:
            if (mesh.neighbor(d.face).is_valid()) edit.open(d.face);
            return;
        default:
            break;
    }
    std::vector<VertexId> path;
    for (const Dart start : {d, opposite(mesh, d)})
        for (Dart at = next(mesh, start); at != start; at = next(mesh, at))
            path.push_back(from(mesh, at));
    const bool is_simple = std::set(path.begin(), path.end()).size() == path.size();
    if (is_simple && path.size() > 2 && mesh.num_faces(d.face.cell) > 3)
        edit.divide_cell(d.face.cell, path);
}

std::vector<std::pair<FaceId, CellId>> members_of(const FaceSet& faces) {
    std::vector<std::pair<FaceId, CellId>> members;
    for (const FaceSet::Member& member : faces.members())
        members.emplace_back(member.face, member.left_to);
    return members;
}

double area_of(const FaceSet& faces, const Mesh& mesh) {
    double area = 0.0;
    for (const FaceSet::Member& member : faces.members())
        if (!mesh.neighbor(member.face).is_valid()) area += topology::rest_area(mesh, member.face);
    return area;
}

std::size_t num_bytes_of(const FaceSet& faces) {
    ArchiveWriter ar;
    ar(faces);
    return ar.bytes().size();
}

TEST(FaceSet, FollowsCellsOfAnyShapeAndGoesBackWithoutAHistory) {
    std::size_t num_grown = 0;
    for (const auto bricks :
         {Bricks::hexahedra, Bricks::wedges, Bricks::pyramids, Bricks::mixed, Bricks::joined})
        for (std::uint64_t seed = 0; seed < test::num_cases(20); ++seed) {
            SCOPED_TRACE(testing::Message()
                         << "bricks " << static_cast<int>(bricks) << ", seed " << seed);
            Random random(seed);
            Mesh mesh = Mesh::build(test::brick_cube(bricks, 2, 0.0, 1)).mesh;
            std::vector<FaceId> some;
            for (const FaceId f : topology::boundary_faces(mesh))
                if (random.below(2) == 0) some.push_back(f);
            FaceSet faces(some);
            const double area = area_of(faces, mesh);
            std::vector<std::vector<std::pair<FaceId, CellId>>> before;
            std::vector<topology::ChangeSet> edits;
            for (int i = 0; i < 4; ++i) {
                before.push_back(members_of(faces));
                MeshEdit edit(mesh);
                for (int k = 0; k < 8; ++k) change(edit, mesh, random);
                edits.push_back(edit.commit());
                faces.apply(mesh, edits.back());
                EXPECT_NEAR(area_of(faces, mesh), area, 1e-12 * area);
                num_grown += faces.members().size() > before.back().size();
            }
            std::vector<FaceId> now;
            for (const FaceSet::Member& member : faces.members()) now.push_back(member.face);
            EXPECT_EQ(num_bytes_of(faces), num_bytes_of(FaceSet(now)));
            for (std::size_t i = edits.size(); i-- > 0;) {
                const auto back = inverse(edits[i]);
                replay(mesh, back);
                faces.apply(mesh, back);
                EXPECT_EQ(members_of(faces), before[i]);
            }
        }
    EXPECT_GE(num_grown, test::num_cases(20));
}

}  // namespace
}  // namespace incise::physics
