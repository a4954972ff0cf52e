// What a cut remembers of its front, and of where it has been.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/cut_front.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <optional>
#include <set>
#include <utility>

#include "incise/cutting/exact/snap_history.h"
#include "incise/topology/mesh_edit.h"
#include "support/mesh_families.h"

namespace incise::cutting {
namespace {

/// What follows these edits does not look at the mesh.
const topology::Mesh& any_mesh() {
    static const topology::Mesh mesh = topology::Mesh::build(test::jittered_cube(1, 0.0, 1)).mesh;
    return mesh;
}

using test::Random;
using topology::ChangeSet;

VertexId node(std::size_t i) { return VertexId(i); }

/// A record that says so: one node is a copy, the other is between two.
ChangeSet additions(std::initializer_list<std::pair<std::size_t, std::size_t>> copies) {
    ChangeSet changes;
    for (const auto& [id, source] : copies) {
        topology::VertexRecord record;
        record.id = node(id);
        record.sources[0] = {node(source), 1.0};
        record.num_sources = 1;
        changes.nodes_added.push_back(record);
    }
    return changes;
}

TEST(CutFront, KnowsItsNodes) {
    CutFront front;
    EXPECT_TRUE(front.is_empty());
    front.put_on(node(3), true, 0.5, 4);
    front.put_on(node(5), false, 0.5, 6);
    EXPECT_EQ(front.size(), 2u);
    EXPECT_TRUE(front.is_on(node(3)) && front.is_on(node(5)));
    EXPECT_FALSE(front.is_on(node(4)));
    EXPECT_FALSE(front.is_near(node(3)));  // but on it
    EXPECT_TRUE(front.is_near(node(5)));
    EXPECT_FALSE(front.is_near(node(4)));
    // What is on it exactly stays so, with its rank; the reach is the larger one.
    front.put_on(node(3), false, 2.0, 7);
    EXPECT_EQ(front.rank(node(3)), 4u);
    EXPECT_EQ(front.rank(node(5)), 6u);
    EXPECT_EQ(front.rank(node(4)), 0u);
    EXPECT_FALSE(front.is_near(node(3)));
    EXPECT_EQ(front.size(), 2u);
    EXPECT_EQ(front.local_edge_length(node(3)), 2.0);
    EXPECT_EQ(front.local_edge_length(node(5)), 0.5);
    EXPECT_EQ(front.local_edge_length(node(4)), 0.0);
}

TEST(CutFront, TogglesEdgesWhicheverWayTheyAreAskedFor) {
    // Against a plain set of pairs.
    std::set<std::pair<std::size_t, std::size_t>> crossed;
    CutFront front;
    Random random(3);
    for (int i = 0; i < 3000; ++i) {
        const std::size_t a = random.below(12);
        const std::size_t b = (a + 1 + random.below(11)) % 12;
        front.toggle(node(a), node(b));
        const auto pair = std::minmax(a, b);
        if (!crossed.erase(pair)) crossed.insert(pair);
        const std::size_t p = random.below(12), q = random.below(12);
        const bool expected = crossed.contains(std::minmax(p, q));
        ASSERT_EQ(front.is_crossed(node(p), node(q)), expected);
        ASSERT_EQ(front.is_crossed(node(q), node(p)), expected);
    }
}

TEST(CutFront, CopiesAreWhatTheirSourcesAre) {
    CutFront front;
    front.put_on(node(1), true, 1.0, 1);
    front.put_on(node(2), false, 1.0, 2);
    front.toggle(node(1), node(7));
    front.toggle(node(2), node(8));
    front.toggle(node(2), node(7));
    ChangeSet changes = additions({{20, 1}, {21, 2}, {22, 9}});
    topology::VertexRecord between;
    between.id = node(23);
    between.num_sources = 2;
    between.sources = {{{node(1), 0.5}, {node(2), 0.5}}};
    changes.nodes_added.push_back(between);
    front.apply(any_mesh(), changes);

    EXPECT_TRUE(front.is_on(node(20)) && !front.is_near(node(20)));
    EXPECT_TRUE(front.is_on(node(21)) && front.is_near(node(21)));
    EXPECT_EQ(front.rank(node(21)), 2u);
    EXPECT_FALSE(front.is_on(node(22)));
    EXPECT_FALSE(front.is_on(node(23)));  // whoever makes a node says that it is on the cut
    EXPECT_TRUE(front.is_crossed(node(20), node(7)));
    EXPECT_TRUE(front.is_crossed(node(21), node(8)));
    EXPECT_TRUE(front.is_crossed(node(21), node(7)));
    EXPECT_FALSE(front.is_crossed(node(20), node(8)));
    EXPECT_FALSE(front.is_crossed(node(22), node(7)));
    EXPECT_TRUE(front.is_crossed(node(1), node(7)));  // as before

    CutFront empty;
    empty.apply(any_mesh(), changes);
    EXPECT_TRUE(empty.is_empty());
}

/// The node and those that come after it in its ring, in ascending order.
std::vector<VertexId> ring(const CutFront& front, VertexId n) {
    std::vector<VertexId> nodes{n};
    for (VertexId twin = front.next_twin(n); twin != n && nodes.size() < 10;
         twin = front.next_twin(twin))
        nodes.push_back(twin);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

TEST(CutFront, TwinsMakeARing) {
    CutFront front;
    front.put_on(node(1), true, 1.0, 1);
    front.put_on(node(2), true, 1.0, 2);
    front.apply(any_mesh(), additions({{20, 1}, {21, 1}}), true);
    front.apply(any_mesh(), additions({{22, 20}, {23, 9}}), true);
    front.apply(any_mesh(), additions({{24, 1}}));  // by another cut
    const std::vector<VertexId> all{node(1), node(20), node(21), node(22)};
    for (const VertexId n : all) EXPECT_EQ(ring(front, n), all);
    EXPECT_EQ(ring(front, node(2)), std::vector{node(2)});
    EXPECT_EQ(ring(front, node(23)), std::vector{node(23)});  // not on the cut
    EXPECT_EQ(ring(front, node(24)), std::vector{node(24)});

    const auto mesh = topology::Mesh::build(test::jittered_cube(2, 0.0, 1)).mesh;
    EXPECT_TRUE(front.is_on(mesh));
    front.forget(mesh, {node(1), node(22)});
    EXPECT_EQ(ring(front, node(20)), (std::vector{node(20), node(21)}));
    EXPECT_EQ(ring(front, node(21)), (std::vector{node(20), node(21)}));
    EXPECT_TRUE(front.is_on(mesh));
}

TEST(CutFront, ForgetsWhatIsLeftBehind) {
    CutFront front;
    for (const std::size_t n : {1u, 2u, 3u})
        front.put_on(node(n), true, 0.1 * static_cast<double>(n), n);
    front.toggle(node(1), node(7));  // an edge to a node that is not on the cut
    front.toggle(node(1), node(2));  // one to a node that is
    front.toggle(node(3), node(7));
    const auto mesh = topology::Mesh::build(test::jittered_cube(1, 0.0, 1)).mesh;
    front.forget(mesh, front.nodes_unless([](VertexId n) { return n != node(1); }));
    EXPECT_FALSE(front.is_on(node(1)));
    EXPECT_TRUE(front.is_on(node(2)) && front.is_on(node(3)));
    EXPECT_FALSE(front.is_crossed(node(1), node(7)));
    EXPECT_TRUE(front.is_crossed(node(1), node(2)));  // the other end still needs it
    EXPECT_TRUE(front.is_crossed(node(3), node(7)));
    front.forget(mesh, front.nodes_unless([](VertexId) { return false; }));
    EXPECT_TRUE(front.is_empty());
    for (const auto& [a, b] : {std::pair(1, 2), {1, 7}, {3, 7}})
        EXPECT_FALSE(
            front.is_crossed(node(static_cast<std::size_t>(a)), node(static_cast<std::size_t>(b))));
}

/// A tetrahedron of a cube with one corner, `far`, that is not on the cut; the others were made
/// there.
struct CornersOnCut {
    topology::Mesh mesh = topology::Mesh::build(test::jittered_cube(1, 0.0, 1)).mesh;
    topology::MeshEdit edit{mesh};
    CutFront front;
    CellId element{0u};
    VertexId far = mesh.corners(element)[0], near_end = mesh.corners(element)[1];

    CornersOnCut() {
        for (const VertexId n : mesh.corners(element).subspan(1)) front.put_on(n, true, 1.0, 1);
    }

    /// Returns the half that has the end b.
    CellId divide(CellId e, VertexId a, VertexId b, bool is_crossed_from_a) {
        const auto& halves = edit.bisect(e, a, b, 0.5);
        front.put_on(halves.node, true, 1.0, 2);
        if (is_crossed_from_a) front.toggle(a, halves.node);
        front.place_halves(mesh, a, b, halves.node, halves.elements);
        CellId half;
        for (const auto& [kept, added] : halves.elements)
            if (kept == e) half = added;
        EXPECT_GE(mesh.corner_of(half, b), 0);
        return half;
    }
    std::optional<CutFront::Place> place_of(CellId e) const {
        return front.place_of(e, mesh.corners(e).first<4>());
    }
    void expect_place(CellId e, VertexId corner, bool is_crossed) const {
        const auto place = place_of(e);
        ASSERT_TRUE(place);
        EXPECT_EQ(place->corner, corner);
        EXPECT_EQ(place->is_crossed, is_crossed);
    }
};

TEST(CutFront, KnowsTheSideOfElementsOnTheCut) {
    for (const bool is_crossed : {true, false}) {
        SCOPED_TRACE(is_crossed);
        CornersOnCut body;
        body.expect_place(body.element, body.far, false);
        const CellId beyond = body.divide(body.element, body.far, body.near_end, is_crossed);
        body.expect_place(body.element, body.far, false);
        // The middle is on this side of the cut through it if the way to it crosses the cut.
        const VertexId middle = body.mesh.corners(beyond)[0];
        body.expect_place(beyond, middle, !is_crossed);

        // Both halves keep what tells, then one loses it again.
        const VertexId third = body.mesh.corners(beyond)[2];
        const CellId half = body.divide(beyond, body.near_end, third, false);
        for (const CellId e : {beyond, half}) body.expect_place(e, middle, !is_crossed);
        const CellId last = body.divide(half, middle, third, true);
        body.expect_place(half, middle, !is_crossed);
        const VertexId second_middle = body.mesh.corners(last)[0];
        body.expect_place(last, second_middle, !is_crossed);

        body.front.forget(body.mesh, {third});
        body.expect_place(last, third, false);
        body.front.put_on(third, true, 1.0, 3);
        EXPECT_FALSE(body.place_of(last));
        body.expect_place(beyond, middle, !is_crossed);
    }
}

/// Of a cut that passed by the node at this distance along the normal.
CutRecord cut_record(const Vec3& normal, double distance) {
    return {normal, distance * normal, false, 1};
}

TEST(SnapHistory, RecognizesARepeatedCutAlsoAtCopies) {
    SnapHistory snap_history;
    const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
    const VertexId n(std::size_t{3}), copy(std::size_t{7}), other(std::size_t{4});
    snap_history.add(n, cut_record(z, 0.2));
    snap_history.add(n, cut_record(x, -0.1));
    EXPECT_TRUE(snap_history.has(n, cut_record(z, 0.2), 1.0));
    EXPECT_TRUE(snap_history.has(n, cut_record(-z, -0.2), 1.0));  // from the other side
    EXPECT_TRUE(
        snap_history.has(n, {z, Vec3(0.5, 0.3, 0.2), false, 1}, 1.0));  // elsewhere in its plane
    EXPECT_TRUE(snap_history.has(n, cut_record(x, -0.1 + 1e-9), 1.0));
    EXPECT_FALSE(snap_history.has(n, cut_record(z, 0.19), 1.0));
    EXPECT_FALSE(snap_history.has(n, cut_record(z, -0.2), 1.0));
    EXPECT_FALSE(snap_history.has(n, cut_record(Vec3(0.0, 0.01, 1.0).normalized(), 0.2), 1.0));
    EXPECT_FALSE(snap_history.has(other, cut_record(z, 0.2), 1.0));
    topology::ChangeSet changes;
    topology::VertexRecord record{copy, Vec3::Zero(), {}, 1};
    record.sources[0] = {n, 1.0};
    changes.nodes_added.push_back(record);
    snap_history.apply(any_mesh(), changes);
    EXPECT_TRUE(snap_history.has(copy, cut_record(x, -0.1), 1.0));
    EXPECT_FALSE(snap_history.has(copy, cut_record(x, 0.1), 1.0));
}

}  // namespace
}  // namespace incise::cutting
