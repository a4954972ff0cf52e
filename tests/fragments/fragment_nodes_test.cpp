// Nodes of fragments over many edits: which fragments share them, and where they are.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "incise/fragments/fragment_mesh.h"
#include "incise/fragments/validate.h"
#include "incise/topology/mesh_edit.h"
#include "support/exact_plane.h"
#include "support/fragment_shape.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::fragments {
namespace {

using namespace topology;

std::vector<CellId> living_cells(const Mesh& material) {
    std::vector<CellId> cells;
    for (const CellId e : material.elements()) cells.push_back(e);
    return cells;
}

Vec3 centre(const Mesh& material, CellId cell) {
    Vec3 sum = Vec3::Zero();
    for (const VertexId n : material.corners(cell)) sum += material.rest_position(n);
    return sum / 4.0;
}

/// Removes some cells side by side.
ChangeSet remove_some(Mesh& material, test::Random& random) {
    const auto cells = living_cells(material);
    std::vector<CellId> pending{cells[random.below(cells.size())]};
    MeshEdit edit(material);
    for (int i = 0; i < 6 && !pending.empty(); ++i) {
        const CellId e = pending.back();
        pending.pop_back();
        if (!material.is_alive(e) || material.num_elements() < 3) continue;
        for (int f = 0; f < material.num_faces(e); ++f)
            if (material.neighbor({e, f}).is_valid())
                pending.push_back(material.neighbor({e, f}).cell);
        edit.remove(e);
    }
    return edit.commit();
}

/// Opens faces between cells on two sides of a plane: those near a point, or some.
ChangeSet open_some(Mesh& material, test::Random& random) {
    const auto cells = living_cells(material);
    const Vec3 point = centre(material, cells[random.below(cells.size())]),
               normal = random.vector(1.0);
    const double size = random.uniform();
    const bool is_near = random.below(2) == 0;
    const auto is_ahead = [&](CellId e) { return (centre(material, e) - point).dot(normal) > 0.0; };
    MeshEdit edit(material);
    for (const FaceId f : test::inner_faces(material)) {
        if (is_ahead(f.cell) == is_ahead(material.neighbor(f).cell)) continue;
        const Vec3& x = material.rest_position(material.face_corner(f, 0));
        if (is_near ? (x - point).norm() < size : random.uniform() < 0.3 * size) edit.open(f);
    }
    return edit.commit();
}

/// A random edit that joins nothing.
ChangeSet part_some(Mesh& material, test::Random& random) {
    constexpr std::size_t most_cells = 2000;
    const std::size_t kind = random.below(4);
    if (kind == 0) return remove_some(material, random);
    if (kind == 3 || material.num_elements() > most_cells) return open_some(material, random);
    const auto cells = living_cells(material);
    const Vec3 point = centre(material, cells[random.below(cells.size())]),
               end = centre(material, cells[random.below(cells.size())]),
               ahead = random.vector(1.0), normal = random.vector(1.0);
    return test::cut_along_plane(material, point, normal, [&](const Vec3& x) {
        return kind == 1 || ahead.dot(x - end) < 0.0;
    });
}

struct Body {
    std::string family;
    std::uint64_t seed = 0;
    double light_share = default_light_share;
};

/// Bodies of more than a few cells, and rare ones in which nodes across a cut were once merged, or
/// material moved to another fragment of its own carrier.
std::vector<Body> bodies() {
    std::vector<Body> all{{"cube", 6}, {"cube", 11}, {"ball", 21}, {"cube", 11, 0.5}};
    for (const auto* family : test::tetrahedral_families())
        if (family->data.num_cells() > 2)
            for (int seed = 0; seed < test::num_cases(5); ++seed)
                all.push_back({family->name, static_cast<std::uint64_t>(seed)});
    return all;
}

using Visit =
    std::function<void(Mesh& material, const FragmentMesh& before, const FragmentMesh& now,
                       const ChangeSet& changes, const FragmentChanges& done)>;

/// Goes through random edits of a body. Calls visit() after each.
/// @return the material and its fragments after all
std::pair<Mesh, FragmentMesh> edit(const Body& body, const Visit& visit) {
    const auto& families = test::mesh_families();
    const auto family = std::ranges::find(families, body.family, &test::MeshFamily::name);
    test::Random random(body.seed);
    Mesh material = Mesh::build(family->data).mesh;
    FragmentMesh fragments(material, body.light_share);
    for (int i = 0; i < 30 && material.num_elements() > 2; ++i) {
        const ChangeSet changes = part_some(material, random);
        if (changes.is_empty()) continue;
        const FragmentMesh before = fragments;
        const FragmentChanges done = fragments.apply(material, changes);
        visit(material, before, fragments, changes, done);
    }
    return {std::move(material), std::move(fragments)};
}

std::string describe(const Body& body) {
    return body.family + ", seed " + std::to_string(body.seed) + ", light share " +
           std::to_string(body.light_share);
}

/// Appends an edit, so that the result has the effect of all.
void append(ChangeSet& all, const ChangeSet& next) {
    if (all.is_empty()) {
        all = next;
        return;
    }
    all.epoch_after = next.epoch_after;
    all.element_capacity_after = next.element_capacity_after;
    all.node_capacity_after = next.node_capacity_after;
    const auto add = [](auto& list, const auto& more) {
        list.insert(list.end(), more.begin(), more.end());
    };
    add(all.elements_added, next.elements_added);
    add(all.elements_removed, next.elements_removed);
    add(all.faces_opened, next.faces_opened);
    add(all.faces_closed, next.faces_closed);
}

/// Drops the cells that were added and removed again. What they came from takes their place.
void drop_passing(ChangeSet& all) {
    std::map<CellId, CellId> parents;
    for (const CellRecord& record : all.elements_added) parents[record.id] = record.parent;
    std::map<CellId, CellId> passing;
    for (const CellRecord& record : all.elements_removed)
        if (parents.contains(record.id)) passing[record.id] = parents.at(record.id);
    const auto is_passing = [&](const CellRecord& r) { return passing.contains(r.id); };
    std::erase_if(all.elements_added, is_passing);
    std::erase_if(all.elements_removed, is_passing);
    const auto replace = [&](CellId& cell) {
        while (passing.contains(cell)) cell = passing.at(cell);
    };
    for (CellRecord& record : all.elements_added) replace(record.parent);
    for (auto* pairs : {&all.faces_opened, &all.faces_closed})
        for (FacePair& pair : *pairs) {
            replace(pair.a.cell);
            replace(pair.b.cell);
        }
}

TEST(FragmentNodes, AreNotMergedWhereNothingJoins) {
    for (const Body& body : bodies()) {
        SCOPED_TRACE(describe(body));
        edit(body, [](const Mesh&, const FragmentMesh&, const FragmentMesh&, const ChangeSet&,
                      const FragmentChanges& done) {
            for (const NodeRecord& record : done.mesh.nodes_removed)
                EXPECT_EQ(record.num_sources, 0) << "node " << record.id.value;
        });
    }
}

TEST(FragmentNodes, AreThoseOfASingleEdit) {
    for (const Body& body : bodies()) {
        SCOPED_TRACE(describe(body));
        ChangeSet all;
        const auto [material, fragments] =
            edit(body, [&](const Mesh& now, const FragmentMesh&, const FragmentMesh& after,
                           const ChangeSet& changes, const FragmentChanges&) {
                append(all, changes);
                EXPECT_EQ(validate(after, now), std::vector<std::string>());
            });
        drop_passing(all);
        const auto& families = test::mesh_families();
        const auto family = std::ranges::find(families, body.family, &test::MeshFamily::name);
        FragmentMesh at_once(Mesh::build(family->data).mesh, body.light_share);
        at_once.apply(material, all);
        EXPECT_EQ(validate(at_once, material), std::vector<std::string>());
        EXPECT_TRUE(test::shape_of(fragments) == test::shape_of(at_once));
    }
}

// Nodes are anywhere: only material that joins another fragment or parts from it may move.
TEST(FragmentNodes, LetNoMaterialJump) {
    int num_around = 0;
    for (const Body& body : bodies()) {
        SCOPED_TRACE(describe(body));
        test::Random random(body.seed);
        std::vector<Vec3> x;
        const auto corners_of = [&](const FragmentMesh& fragments, ElementId e) {
            std::vector<Vec3> corners;
            for (const NodeId n : fragments.corners(e)) corners.push_back(x[n.index()]);
            return corners;
        };
        edit(body, [&](const Mesh& material, const FragmentMesh& before, const FragmentMesh& now,
                       const ChangeSet& changes, const FragmentChanges& done) {
            while (x.size() < before.node_capacity()) x.push_back(random.vector(1.0));
            x.resize(now.node_capacity());
            for (const NodeRecord& record : done.mesh.nodes_removed)
                if (record.num_sources == 1)  // merged
                    x[record.sources[0].node.index()] += x[record.id.index()];
            for (const NodeRecord& record : done.mesh.nodes_added) {
                x[record.id.index()] = Vec3::Zero();
                for (std::size_t k = 0; k < static_cast<std::size_t>(record.num_sources); ++k)
                    x[record.id.index()] +=
                        record.sources[k].weight * x[record.sources[k].node.index()];
            }
            std::map<CellId, CellId> ancestors;
            for (const CellRecord& record : changes.elements_added) {
                const auto known = ancestors.find(record.parent);
                ancestors[record.id] = known == ancestors.end() ? record.parent : known->second;
            }
            for (const CellId cell : material.elements()) {
                const auto record =
                    std::ranges::lower_bound(done.cells, cell, {}, &CarriedCell::cell);
                if (record != done.cells.end() && record->cell == cell &&
                    (record->is_joined || record->is_released))
                    continue;
                const auto ancestor = ancestors.find(cell);
                const ElementId from =
                    before.fragment_of_cell(ancestor == ancestors.end() ? cell : ancestor->second);
                EXPECT_EQ(corners_of(before, from), corners_of(now, now.fragment_of_cell(cell)))
                    << "element " << cell.value;
            }
            for (const CellId cell : material.elements())
                num_around += now.is_carried_around(cell) ? 1 : 0;
        });
    }
    EXPECT_GT(num_around, 100);
}

TEST(FragmentNodes, AreTheSameAfterUndoAndReplay) {
    for (const Body& body : bodies()) {
        SCOPED_TRACE(describe(body));
        edit(body, [](Mesh& material, const FragmentMesh& before, const FragmentMesh& now,
                      const ChangeSet& changes, const FragmentChanges& done) {
            FragmentMesh fragments = now;
            replay(material, inverse(changes));
            fragments.go_back(material, inverse(done));
            EXPECT_TRUE(fragments == before);
            replay(material, changes);
            EXPECT_TRUE(fragments.apply(material, changes) == done);
            EXPECT_TRUE(fragments == now);
        });
    }
}

}  // namespace
}  // namespace incise::fragments
