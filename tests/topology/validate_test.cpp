// What is wrong with a mesh is found: edits that somebody made up are replayed, which no check has
// seen, and break it each in its own way.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/validate.h"

#include <gtest/gtest.h>

#include "incise/topology/mesh_edit.h"

namespace incise::topology {
namespace {

/// Two tetrahedra that share a face, and one by itself.
Mesh three_tetrahedra() {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1},
                   {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};
    data.add_cell(CellKind::tetrahedron, std::array<std::int64_t, 4>{0, 1, 2, 3});
    data.add_cell(CellKind::tetrahedron, std::array<std::int64_t, 4>{0, 2, 1, 4});
    data.add_cell(CellKind::tetrahedron, std::array<std::int64_t, 4>{5, 6, 7, 8});
    return Mesh::build(data).mesh;
}

ChangeSet edit_of(const Mesh& mesh) {
    ChangeSet changes;
    changes.epoch_before = changes.epoch_after = mesh.epoch();
    changes.node_capacity_before = changes.node_capacity_after = mesh.node_capacity();
    changes.element_capacity_before = changes.element_capacity_after = mesh.element_capacity();
    return changes;
}

VertexId node_at(const Mesh& mesh, const Vec3& X) {
    for (std::size_t i = 0; i < mesh.node_capacity(); ++i)
        if (mesh.rest_position(VertexId(i)) == X) return VertexId(i);
    throw std::logic_error("no such node");
}

/// The element with a corner at a place that only it has.
CellId element_at(const Mesh& mesh, const Vec3& X) {
    return mesh.incident_element(node_at(mesh, X));
}

CellRewiring rewiring(const Mesh& mesh, CellId e, VertexId from, VertexId to) {
    return {e, mesh.corner_of(e, from), from, to};
}

void expect_fault(const Mesh& mesh, const std::string& fault) {
    std::string all;
    for (const std::string& found : validate(mesh)) all += found + "\n";
    EXPECT_NE(all.find(fault), std::string::npos) << "not among these: " << fault << "\n" << all;
}

TEST(Validate, FindsNothingInASoundMesh) {
    EXPECT_EQ(validate(three_tetrahedra()), std::vector<std::string>{});
}

TEST(Validate, FindsANodeThatAnElementHasTwice) {
    Mesh mesh = three_tetrahedra();
    const CellId e = element_at(mesh, {6, 0, 0});
    ChangeSet changes = edit_of(mesh);
    changes.rewired = {rewiring(mesh, e, node_at(mesh, {6, 0, 0}), node_at(mesh, {5, 1, 0}))};
    replay(mesh, changes);
    expect_fault(mesh, "twice");
    expect_fault(mesh, "element " + std::to_string(e.value) + " has no positive volume at rest");
}

TEST(Validate, FindsNeighboursWithOtherCornersOnTheirFace) {
    Mesh mesh = three_tetrahedra();
    const CellId e = element_at(mesh, {0, 0, 1});
    ChangeSet changes = edit_of(mesh);
    changes.rewired = {rewiring(mesh, e, node_at(mesh, {1, 0, 0}), node_at(mesh, {6, 0, 0}))};
    replay(mesh, changes);
    expect_fault(mesh, "disagree on their face");
}

TEST(Validate, FindsANodeOfDisconnectedElements) {
    Mesh mesh = three_tetrahedra();
    const CellId e = element_at(mesh, {6, 0, 0});
    const VertexId shared = node_at(mesh, {1, 0, 0});
    ChangeSet changes = edit_of(mesh);
    changes.rewired = {rewiring(mesh, e, node_at(mesh, {6, 0, 0}), shared)};
    replay(mesh, changes);
    expect_fault(mesh, "the elements of node " + std::to_string(shared.value) +
                           " do not hang together through faces at it");
}

TEST(Validate, FindsADeadNodeThatAnElementHas) {
    Mesh mesh = three_tetrahedra();
    const VertexId n = node_at(mesh, {6, 0, 0});
    const std::string number = std::to_string(n.value);
    ChangeSet changes = edit_of(mesh);
    changes.nodes_removed = {{n, {6, 0, 0}, {}, 0}};
    replay(mesh, changes);
    expect_fault(mesh, " has the dead node " + number);
    expect_fault(mesh, "the dead node " + number + " has elements");
}

TEST(Validate, FindsACellTurnedInsideOutAndAWrongCount) {
    Mesh mesh = three_tetrahedra();
    const VertexId n = node_at(mesh, {6, 0, 0});
    ChangeSet changes = edit_of(mesh);
    changes.nodes_added = {{n, {4, 0, 0}, {}, 0}};  // there already
    replay(mesh, changes);
    expect_fault(mesh, "has no positive volume at rest");
    expect_fault(mesh, "there are 9 nodes, counted as 10");
}

}  // namespace
}  // namespace incise::topology
