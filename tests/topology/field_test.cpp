// Fields have after edits what their rule says, and after the inverse what they had.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/field.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "incise/base/error.h"
#include "incise/topology/boundary_surface.h"
#include "incise/topology/component_count.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/spatial/element_boxes.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

static_assert(Follower<NodeField<VertexId, Vec3>> && Follower<ElementField<CellId, int>> &&
              Follower<BoundarySurface> && Follower<ComponentCount> && Follower<ElementBoxes>);

/// A linear function of the place at rest, which means with weights reproduce.
Vec3 function_of(const Vec3& x) { return Vec3(2.0 * x.x() - x.y(), x.z() + 1.0, x.sum()); }

TEST(NodeField, FollowsEditsAsTheRestPositionsDo) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
            Mesh mesh = Mesh::build(family.data).mesh;
            test::Random random(seed);
            NodeField<VertexId, Vec3> field(mesh, Vec3(Vec3::Zero()));
            for (const VertexId n : mesh.nodes()) field[n] = function_of(mesh.rest_position(n));
            for (int i = 0; i < test::num_cases(10) && mesh.num_elements() > 4; ++i) {
                const std::vector<Vec3> before(field.values().begin(), field.values().end());
                const ChangeSet changes = test::random_edit(mesh, random);
                field.apply(mesh, changes);
                ASSERT_EQ(field.values().size(), mesh.node_capacity());
                for (const VertexId n : mesh.nodes())
                    ASSERT_LE((field[n] - function_of(mesh.rest_position(n))).norm(), 1e-14);
                if (changes.is_empty() || random.below(2) > 0) continue;
                const ChangeSet back = inverse(changes);
                replay(mesh, back);
                field.apply(mesh, back);
                ASSERT_TRUE(std::ranges::equal(field.values(), before));
            }
        }
    }
}

TEST(ElementField, GivesPartsWhatTheWholeHas) {
    Mesh mesh = Mesh::build(test::jittered_cube(3, 0.1, 1)).mesh;
    test::Random random(2);
    ElementField<CellId, int> field(mesh, 0);
    for (const CellId e : mesh.elements()) field[e] = e.value;
    int num_parts = 0;
    for (int i = 0; i < test::num_cases(100); ++i) {
        const ChangeSet changes = test::random_edit(mesh, random);
        field.apply(mesh, changes);
        for (const CellRecord& record : changes.elements_added)
            if (record.parent.is_valid() && mesh.is_alive(record.id)) {
                EXPECT_EQ(field[record.id], field[record.parent]);
                ++num_parts;
            }
        ASSERT_EQ(field.values().size(), mesh.element_capacity());
    }
    EXPECT_GT(num_parts, 10);
}

TEST(Fields, FollowSeveralEditsAfterTheLast) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    NodeField<VertexId, Vec3> at_once(mesh, mesh.rest_positions()), one_by_one = at_once;
    test::Random random(5);
    std::vector<ChangeSet> edits;
    for (int i = 0; i < 10; ++i) {
        edits.push_back(test::random_edit(mesh, random));
        one_by_one.apply(mesh, edits.back());
    }
    for (const ChangeSet& changes : edits) at_once.apply(mesh, changes);
    EXPECT_TRUE(std::ranges::equal(at_once.values(), one_by_one.values()));
}

TEST(Followers, RefuseEditsOutOfTurn) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    NodeField<VertexId, double> nodes(mesh, 1.0);
    ElementField<CellId, double> elements(mesh, 1.0);
    ComponentCount components(mesh);
    BoundarySurface surface(mesh);
    ElementBoxes boxes(mesh, mesh.rest_positions());
    MeshEdit first(mesh);
    first.remove(CellId(3));
    first.commit();
    MeshEdit second(mesh);
    second.remove(CellId(5));
    const ChangeSet changes = second.commit();
    EXPECT_THROW(nodes.apply(mesh, changes), InputError);
    EXPECT_THROW(elements.apply(mesh, changes), InputError);
    EXPECT_THROW(components.apply(mesh, changes), InputError);
    EXPECT_THROW(surface.apply(mesh, changes), InputError);
    EXPECT_THROW(boxes.apply(mesh, changes), InputError);
}

}  // namespace
}  // namespace incise::topology
