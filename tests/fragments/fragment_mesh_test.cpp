// Fragments of carriers: what they carry, how they are connected, and how they follow edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/fragment_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "incise/base/archive.h"
#include "incise/base/disjoint_set.h"
#include "incise/base/error.h"
#include "incise/fragments/part_volumes.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh_edit.h"
#include "support/exact_plane.h"
#include "support/fragment_shape.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::fragments {
namespace {

using namespace topology;

double volume_of(const Mesh& mesh, CellId e) {
    if (mesh.is_polyhedron(e)) return topology::rest_volume(mesh, e);
    std::vector<Vec3> x;
    for (const VertexId n : mesh.corners(e)) x.push_back(mesh.rest_position(n));
    return signed_volume(mesh.kind(e), x);
}

double volume_of(const Mesh& mesh) {
    double sum = 0.0;
    for (const CellId e : mesh.elements()) sum += volume_of(mesh, e);
    return sum;
}

int num_components(const FragmentMesh& fragments) {
    DisjointSet connected(fragments.node_capacity());
    for (const ElementId e : fragments.elements())
        for (const NodeId n : fragments.corners(e))
            connected.join(fragments.corners(e)[0].value, n.value);
    std::set<std::int32_t> found;
    for (const NodeId n : fragments.nodes()) found.insert(connected.find(n.value));
    return static_cast<int>(found.size());
}

/// Reports what does not hold of any fragment mesh of a material.
void expect_sound(const FragmentMesh& fragments, const Mesh& material) {
    double volume = 0.0;
    std::size_t num_elements = 0, num_nodes = 0;
    std::vector<ElementId> star;
    std::set<NodeId> used;
    for (const ElementId e : fragments.elements()) {
        ++num_elements;
        volume += fragments.volume_share(e) * fragments.carrier_volume(e);
        EXPECT_GT(fragments.volume_share(e), 0.0);
        EXPECT_FALSE(fragments.cells_of(e).empty());
        for (const CellId cell : fragments.cells_of(e)) {
            ASSERT_TRUE(material.is_alive(cell));
            EXPECT_EQ(fragments.fragment_of_cell(cell), e);
            EXPECT_EQ(material.region(cell), fragments.region(e));
        }
        std::vector<Vec3> x;
        for (const NodeId n : fragments.corners(e)) {
            ASSERT_TRUE(n.is_valid());
            EXPECT_TRUE(fragments.is_alive(n));
            used.insert(n);
            x.push_back(fragments.rest_position(n));
            fragments.star(n, star);
            EXPECT_TRUE(std::ranges::binary_search(star, e));
        }
        const auto volumes = part_volumes(fragments.kind(e), x, fragments.diagonals(e));
        const double carrier_volume = fragments.diagonals(e).is_none()
                                          ? signed_volume(fragments.kind(e), x)
                                          : std::accumulate(volumes.begin(), volumes.end(), 0.0);
        EXPECT_EQ(carrier_volume, fragments.carrier_volume(e));
    }
    for (const NodeId n : fragments.nodes()) {
        ++num_nodes;
        EXPECT_TRUE(used.contains(n));
    }
    EXPECT_EQ(num_elements, fragments.num_elements());
    EXPECT_EQ(num_nodes, fragments.num_nodes());
    for (const CellId cell : material.elements()) {
        const ElementId e = fragments.fragment_of_cell(cell);
        EXPECT_EQ(std::ranges::count(fragments.cells_of(e), cell), 1);
    }
    EXPECT_NEAR(volume, volume_of(material), 1e-12 * volume_of(material));
    for (const VertexId n : material.nodes()) {
        const EmbeddedPoint at = fragments.embedded(material, n);
        Vec3 x = Vec3::Zero();
        double sum = 0.0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k) {
            EXPECT_TRUE(fragments.is_alive(at.nodes[k]));
            x += at.weights[k] * fragments.rest_position(at.nodes[k]);
            sum += at.weights[k];
        }
        EXPECT_NEAR(sum, 1.0, 1e-12);
        EXPECT_LT((x - material.rest_position(n)).norm(), 1e-12);
    }
}

/// One edit with the effect of several.
ChangeSet joined(const std::vector<ChangeSet>& edits) {
    ChangeSet all = edits.front();
    for (std::size_t i = 1; i < edits.size(); ++i) {
        const ChangeSet& next = edits[i];
        all.epoch_after = next.epoch_after;
        all.element_capacity_after = next.element_capacity_after;
        all.node_capacity_after = next.node_capacity_after;
        const auto append = [](auto& list, const auto& more) {
            list.insert(list.end(), more.begin(), more.end());
        };
        append(all.elements_added, next.elements_added);
        append(all.elements_removed, next.elements_removed);
        append(all.faces_opened, next.faces_opened);
        append(all.faces_closed, next.faces_closed);
    }
    return all;
}

Vec3 random_point(const Mesh& mesh, test::Random& random) {
    std::vector<CellId> elements;
    for (const CellId e : mesh.elements()) elements.push_back(e);
    Vec3 sum = Vec3::Zero();
    const auto corners = mesh.corners(elements[random.below(elements.size())]);
    for (const VertexId n : corners) sum += mesh.rest_position(n);
    return sum / static_cast<double>(corners.size());
}

/// Returns the numbers of records, so that those of the material compare with those of the physics.
std::string numbers_of(const auto& records) {
    ArchiveWriter ar;
    ar(records);
    return ar.take();
}

TEST(FragmentMesh, IsTheMeshItselfWithoutDivisions) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            test::Random random(seed);
            Mesh material = Mesh::build(family.data).mesh;
            FragmentMesh fragments(material);
            for (int i = 0; i < 6 && material.num_elements() > 1; ++i) {
                MeshEdit edit(material);
                std::vector<FaceId> faces = test::inner_faces(material);
                for (int k = 0; k < 8 && !faces.empty(); ++k) {
                    const FaceId f = faces[random.below(faces.size())];
                    if (material.neighbor(f).is_valid()) edit.open(f);
                }
                std::vector<CellId> elements;
                for (const CellId e : material.elements()) elements.push_back(e);
                if (i % 2 == 1) edit.remove(elements[random.below(elements.size())]);
                const ChangeSet changes = edit.commit();
                const FragmentChanges done = fragments.apply(material, changes);
                EXPECT_EQ(numbers_of(done.mesh.nodes_added), numbers_of(changes.nodes_added));
                // A cell with divided faces has more corners in the material, in another order.
                if (family.name != "joined") {
                    EXPECT_EQ(numbers_of(done.mesh.rewired), numbers_of(changes.rewired));
                    EXPECT_EQ(numbers_of(done.mesh.elements_removed),
                              numbers_of(changes.elements_removed));
                }
                EXPECT_TRUE(done.shares.empty());
            }
            ASSERT_EQ(fragments.node_capacity(), material.node_capacity());
            for (const CellId e : material.elements()) {
                const auto fragment = with_number_of<ElementId>(e);
                const auto whole = material.whole_cell(e);
                ASSERT_TRUE(whole);
                EXPECT_TRUE(std::ranges::equal(fragments.corners(fragment), whole->corners(), {},
                                               &NodeId::value, &VertexId::value));
                EXPECT_EQ(fragments.volume_share(fragment), 1.0);
            }
            for (std::size_t i = 0; i < material.node_capacity(); ++i)
                EXPECT_EQ(fragments.is_alive(NodeId(i)), material.is_alive(VertexId(i)));
            expect_sound(fragments, material);
        }
    }
}

TEST(FragmentMesh, FollowsPlanesAsIfBuiltInOneEdit) {
    int num_light = 0, num_fragments = 0;
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            for (const double light_share : {0.0, default_light_share}) {
                test::Random random(seed);
                Mesh material = Mesh::build(family->data).mesh;
                FragmentMesh fragments(material, light_share), at_once(material, light_share);
                std::vector<ChangeSet> edits;
                for (int i = 0; i < 3; ++i) {
                    edits.push_back(test::cut_along_plane(material, random_point(material, random),
                                                          random.vector(1.0)));
                    if (edits.back().is_empty()) {
                        edits.pop_back();
                        continue;
                    }
                    fragments.apply(material, edits.back());
                    expect_sound(fragments, material);
                    EXPECT_EQ(num_components(fragments), components(material).count);
                }
                if (edits.empty()) continue;
                at_once.apply(material, joined(edits));
                expect_sound(at_once, material);
                EXPECT_TRUE(test::shape_of(fragments) == test::shape_of(at_once));
                num_fragments += static_cast<int>(fragments.num_elements());
                for (const CellId cell : material.elements())
                    num_light += fragments.is_at_home(cell) ? 0 : 1;
            }
        }
    EXPECT_GT(num_fragments, 1000);
    EXPECT_GT(num_light, 100);
}

TEST(FragmentMesh, FollowsAnyEdits) {
    for (const auto& family : test::mesh_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh material = Mesh::build(family.data).mesh;
            FragmentMesh fragments(material);
            for (int i = 0; i < 8; ++i) {
                fragments.apply(material, test::random_edit(material, random));
                expect_sound(fragments, material);
            }
        }
}

TEST(FragmentMesh, UndoesEditsWithTheirIds) {
    for (const auto& family : test::mesh_families()) {
        const bool is_divisible = std::ranges::all_of(
            family.data.kinds, [](CellKind kind) { return kind == CellKind::tetrahedron; });
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh material = Mesh::build(family.data).mesh;
            FragmentMesh fragments(material);
            std::vector<FragmentMesh> before;
            std::vector<std::pair<ChangeSet, FragmentChanges>> done;
            for (int i = 0; i < 5; ++i) {
                before.push_back(fragments);
                const ChangeSet changes =
                    i % 2 == 0 || !is_divisible
                        ? test::random_edit(material, random)
                        : test::cut_along_plane(material, {0.4, 0.3, 0.5}, random.vector(1.0));
                done.emplace_back(changes, fragments.apply(material, changes));
            }
            for (; !done.empty(); done.pop_back(), before.pop_back()) {
                if (done.back().first.is_empty()) continue;
                const FragmentChanges& undone = done.back().second;
                if (done.size() > 1 && !done[done.size() - 2].first.is_empty()) {
                    EXPECT_THROW(fragments.go_back(material, inverse(done[done.size() - 2].second)),
                                 InputError);
                }
                replay(material, inverse(done.back().first));
                fragments.go_back(material, inverse(undone));
                EXPECT_TRUE(fragments == before.back());
                expect_sound(fragments, material);
                // Done again, it has the same effect.
                replay(material, done.back().first);
                EXPECT_TRUE(fragments.apply(material, done.back().first) == undone);
                replay(material, inverse(done.back().first));
                fragments.go_back(material, inverse(undone));
            }
        }
    }
}

TEST(FragmentMesh, KeepsCarriersThatAreCutInPart) {
    Mesh material = Mesh::build(test::jittered_cube(4, 0.1, 3)).mesh;
    FragmentMesh fragments(material);
    const FragmentMesh before = fragments;
    // Divided, but nothing opened: nothing changes for the physics.
    FragmentChanges done =
        fragments.apply(material, test::cut_along_plane(material, {0.51, 0.5, 0.5}, {1, 0.1, 0.2},
                                                        [](const Vec3&) { return false; }));
    EXPECT_TRUE(done.mesh.nodes_added.empty());
    EXPECT_TRUE(done.mesh.elements_added.empty());
    EXPECT_TRUE(done.mesh.rewired.empty());
    EXPECT_TRUE(done.shares.empty());
    EXPECT_FALSE(done.cells.empty());
    for (const ElementId e : fragments.elements()) EXPECT_EQ(fragments.volume_share(e), 1.0);
    expect_sound(fragments, material);
    // Opened on one half: carriers at the end of the cut stay whole.
    Mesh half = Mesh::build(test::jittered_cube(4, 0.1, 3)).mesh;
    FragmentMesh of_half(half);
    of_half.apply(half, test::cut_along_plane(half, {0.51, 0.5, 0.5}, {1, 0.1, 0.2},
                                              [](const Vec3& x) { return x.y() < 0.5; }));
    expect_sound(of_half, half);
    EXPECT_GT(of_half.num_elements(), before.num_elements());
    EXPECT_EQ(num_components(of_half), 1);
}

}  // namespace
}  // namespace incise::fragments
