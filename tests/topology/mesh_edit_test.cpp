// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_edit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "incise/base/error.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

using test::MeshSnapshot;
const std::vector<std::string> no_violations;

// Tetrahedra too are covered here; their masses and forces in physics/edits_test.cpp.
TEST(MeshEdit, LeavesAValidMeshAndUndoesExactly) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        test::Random random(11);
        Mesh mesh = Mesh::build(family.data).mesh;
        for (int i = 0; i < test::num_cases(150); ++i) {
            SCOPED_TRACE(i);
            if (mesh.num_elements() == 0) mesh = Mesh::build(family.data).mesh;
            const MeshSnapshot before(mesh);
            const ChangeSet changes = test::random_edit(mesh, random);
            ASSERT_EQ(validate(mesh), no_violations);
            const MeshSnapshot after(mesh);
            replay(mesh, inverse(changes));
            ASSERT_EQ(validate(mesh), no_violations);
            ASSERT_EQ(MeshSnapshot(mesh), before);
            replay(mesh, changes);
            ASSERT_EQ(MeshSnapshot(mesh), after);
        }
    }
}

TEST(MeshEdit, WithoutCommitLeavesNoTrace) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        Mesh mesh = Mesh::build(family.data).mesh;
        const MeshSnapshot before(mesh);
        {
            MeshEdit edit(mesh);
            for (int f = 0; f < mesh.num_faces(CellId(0)); ++f)
                if (mesh.neighbor({CellId(0), f}).is_valid()) edit.open({CellId(0), f});
            edit.remove(CellId(0));
        }
        EXPECT_EQ(MeshSnapshot(mesh), before);
        EXPECT_EQ(validate(mesh), no_violations);
    }
}

TEST(MeshEdit, WithoutCommitGivesMergedNodesBack) {
    Mesh mesh = Mesh::build(test::mesh_families()[1].data).mesh;
    {
        MeshEdit edit(mesh);
        edit.open(test::inner_faces(mesh).front());
        edit.commit();
    }
    const MeshSnapshot before(mesh);
    for (const std::size_t removed : {0u, 1u}) {
        {
            const FacePair pair = test::open_pairs(mesh).front();
            MeshEdit edit(mesh);
            edit.close(pair.a, pair.b);
            edit.remove(CellId(removed));
        }
        EXPECT_EQ(MeshSnapshot(mesh), before);
        EXPECT_EQ(validate(mesh), no_violations);
    }
}

TEST(MeshEdit, OpeningAPlaneCopiesItsNodesOnce) {
    constexpr int n = 6;
    for (const CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron})
        for (const bool is_full : {true, false}) {
            Mesh mesh = Mesh::build(box_mesh(kind, {0, 0, 0}, {n, n, n}, {n, n, n})).mesh;
            MeshEdit edit(mesh);
            for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
                for (int f = 0; f < mesh.num_faces(CellId(i)); ++f) {
                    const FaceId face{CellId(i), f};
                    bool is_chosen = mesh.neighbor(face).is_valid();
                    for (int p = 0; p < mesh.face_size(face); ++p) {
                        const Vec3& x = mesh.rest_position(mesh.face_corner(face, p));
                        is_chosen = is_chosen && x.x() == n / 2 && (is_full || x.y() <= n / 2);
                    }
                    if (is_chosen) edit.open(face);
                }
            const ChangeSet changes = edit.commit();
            // The front of a partial cut stays joined: its nodes are not copied.
            EXPECT_EQ(changes.nodes_added.size(),
                      static_cast<std::size_t>(is_full ? (n + 1) * (n + 1) : n / 2 * (n + 1)));
            EXPECT_EQ(components(mesh).count, is_full ? 2 : 1);
            for (const VertexRecord& record : changes.nodes_added) {
                ASSERT_EQ(record.num_sources, 1);
                EXPECT_EQ(record.sources[0].weight, 1.0);
                EXPECT_EQ(record.rest_position, mesh.rest_position(record.sources[0].node));
            }
        }
}

TEST(MeshEdit, OpeningOneFaceCopiesNoNode) {
    Mesh mesh = Mesh::build(test::jittered_cube(3, 0.1, 1)).mesh;
    for (std::size_t i = 0; i < mesh.num_elements(); ++i)
        for (int f = 0; f < 4; ++f) {
            const FaceId face{CellId(i), f};
            if (!mesh.neighbor(face).is_valid()) continue;
            bool is_inside = true;
            for (int p = 0; p < 3; ++p) {
                const Vec3& x = mesh.rest_position(mesh.face_corner(face, p));
                is_inside = is_inside && x.minCoeff() > 0.0 && x.maxCoeff() < 1.0;
            }
            if (!is_inside) continue;
            MeshEdit edit(mesh);
            edit.open(face);
            const ChangeSet changes = edit.commit();
            EXPECT_TRUE(changes.nodes_added.empty());
            EXPECT_EQ(changes.faces_opened.size(), 1u);
            replay(mesh, inverse(changes));
        }
}

TEST(MeshEdit, RemovingAHingeAddsANode) {
    // Three tetrahedra in a row: without the middle one, the outer two share nothing by a face.
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1.5}, {1.5, 0.2, 1.5}};
    for (const auto& tet : {std::vector<std::int64_t>{0, 1, 2, 3}, {3, 1, 2, 4}, {3, 1, 4, 5}})
        data.add_cell(CellKind::tetrahedron, tet);
    Mesh mesh = Mesh::build(data).mesh;
    const auto middle = [&] {
        for (std::size_t i = 0; i < 3; ++i)
            if (mesh.label(CellId(i)) == 1) return CellId(i);
        return CellId();
    }();
    MeshEdit edit(mesh);
    edit.remove(middle);
    const ChangeSet changes = edit.commit();
    EXPECT_EQ(changes.nodes_added.size(), 2u);  // points 1 and 3 were common to the outer two
    EXPECT_EQ(mesh.num_nodes(), 8u);
    EXPECT_EQ(components(mesh).count, 2);
    EXPECT_EQ(validate(mesh), no_violations);
}

TEST(MeshEdit, ClosingWhatWasOpenedRestoresTheNodes) {
    Mesh mesh = Mesh::build(test::jittered_cube(3, 0.1, 1)).mesh;
    const std::size_t num_nodes = mesh.num_nodes();
    ChangeSet opened;
    {
        MeshEdit edit(mesh);
        for (std::size_t i = 0; i < mesh.num_elements(); ++i)
            for (int f = 0; f < 4; ++f)
                if (mesh.neighbor({CellId(i), f}).is_valid()) edit.open({CellId(i), f});
        opened = edit.commit();
    }
    EXPECT_EQ(mesh.num_nodes(), 4 * mesh.num_elements());
    MeshEdit edit(mesh);
    for (const FacePair& pair : opened.faces_opened) edit.close(pair.a, pair.b);
    const ChangeSet closed = edit.commit();
    EXPECT_EQ(mesh.num_nodes(), num_nodes);
    EXPECT_EQ(validate(mesh), no_violations);
    for (const VertexRecord& record : closed.nodes_removed) {
        ASSERT_EQ(record.num_sources, 1);
        EXPECT_TRUE(mesh.is_alive(record.sources[0].node));
        EXPECT_LT(record.sources[0].node, record.id);
    }
}

TEST(MeshEdit, RefusesWhatCannotBeDone) {
    Mesh mesh = Mesh::build(test::mesh_families()[1].data).mesh;
    MeshEdit edit(mesh);
    EXPECT_THROW(edit.remove(CellId(7)), InputError);
    EXPECT_THROW(edit.remove(CellId()), InputError);
    const auto outer = boundary_faces(mesh);
    EXPECT_THROW(edit.open(outer[0]), InputError);
    EXPECT_THROW(edit.close(outer[0], outer[4]), InputError);
    EXPECT_THROW(edit.close(outer[0], outer[0]), InputError);
    edit.remove(CellId(0));
    EXPECT_THROW(edit.remove(CellId(0)), InputError);
}

TEST(MeshEdit, RefusesToDivideOrJoinWhatCannotBe) {
    Mesh mesh = Mesh::build(box_mesh(CellKind::tetrahedron, {0, 0, 0}, {1, 1, 1}, {1, 1, 1})).mesh;
    const MeshSnapshot before(mesh);
    const auto message_of = [](const auto& action) {
        try {
            action();
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("nothing was refused");
    };
    const auto expect_end = [&](const auto& action, const char* end) {
        const std::string message = message_of(action);
        EXPECT_TRUE(message.ends_with(end)) << message;
    };
    {
        MeshEdit edit(mesh);
        const CellId e(0);
        const VertexId a = mesh.corners(e)[0], b = mesh.corners(e)[1];
        const std::string edge = "edit: the edge between nodes " + std::to_string(a.value) +
                                 " and " + std::to_string(b.value) +
                                 " of element 0 cannot be divided: ";
        for (const double t : {0.0, 1.0, -0.5, std::nan("")})
            EXPECT_EQ(message_of([&] { edit.bisect(e, a, b, t); }),
                      edge + "the place " + std::to_string(t) + " is not between 0 and 1");
        expect_end([&] { edit.bisect(e, a, a, 0.5); }, "the element has no such edge");
        const CellId part = edit.bisect(e, a, b, 0.5).elements.front().added;
        EXPECT_EQ(message_of([&] { edit.remove(part); }),
                  "edit: element " + std::to_string(part.value) +
                      " was made in this edit and cannot be removed in it: commit first");
        FaceId inner;
        for (int f = 0; f < 4; ++f)
            if (mesh.neighbor({CellId(1), f}).is_valid()) inner = {CellId(1), f};
        FaceId outer = boundary_faces(mesh).back();
        for (const FaceId f : boundary_faces(mesh))
            if (f.cell == CellId(2)) outer = f;
        expect_end([&] { edit.close(inner, outer); }, "one of them is joined already");
    }
    EXPECT_EQ(MeshSnapshot(mesh), before);  // given up, it leaves no trace
}

TEST(MeshEdit, ReplayRefusesAnEditOutOfTurn) {
    Mesh mesh = Mesh::build(test::mesh_families()[3].data).mesh;
    MeshEdit edit(mesh);
    edit.remove(CellId(0));
    const ChangeSet changes = edit.commit();
    EXPECT_THROW(replay(mesh, changes), InputError);
    replay(mesh, inverse(changes));
    EXPECT_THROW(replay(mesh, inverse(changes)), InputError);
}

TEST(MeshEdit, AnEmptyEditKeepsTheEpoch) {
    Mesh mesh = Mesh::build(test::mesh_families()[3].data).mesh;
    MeshEdit edit(mesh);
    EXPECT_TRUE(edit.commit().is_empty());
    EXPECT_EQ(mesh.epoch(), 0u);
}

}  // namespace
}  // namespace incise::topology
