// How vertices follow the nodes of the physics: positions to them, forces back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/embedding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "incise/topology/mesh_edit.h"
#include "support/exact_plane.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::fragments {
namespace {

using topology::ChangeSet;
using topology::Mesh;

/// The vertices at cells that an edit has changed, as the model names them.
std::vector<VertexId> touched_vertices(const Mesh& material, const ChangeSet& changes) {
    std::vector<VertexId> touched;
    const auto touch = [&](std::span<const VertexId> corners) {
        touched.insert(touched.end(), corners.begin(), corners.end());
    };
    for (const auto* records : {&changes.elements_added, &changes.elements_removed})
        for (const topology::CellRecord& record : *records) {
            touch(record.corners);
            if (record.parent.is_valid()) touch(material.corners(record.parent));
        }
    for (const topology::CellRewiring& rewiring : changes.rewired) {
        touched.push_back(rewiring.from);
        touched.push_back(rewiring.to);
    }
    return touched;
}

/// Returns the nodes that a vertex follows, with their weights.
std::vector<std::pair<NodeId, double>> nodes_of(const Embedding& embedding, VertexId v) {
    std::vector<std::pair<NodeId, double>> nodes;
    embedding.for_each(v, [&](NodeId n, double weight) { nodes.emplace_back(n, weight); });
    return nodes;
}

void expect_as_built_afresh(const Embedding& embedding, const Mesh& material,
                            const FragmentMesh& fragments) {
    const Embedding fresh(material, fragments);
    EXPECT_EQ(embedding.is_trivial(), fresh.is_trivial());
    EXPECT_EQ(embedding.largest_gain(), fresh.largest_gain());
    for (const VertexId v : material.nodes()) {
        EXPECT_FALSE(nodes_of(embedding, v).empty());
        EXPECT_EQ(nodes_of(embedding, v), nodes_of(fresh, v));
    }
}

TEST(Embedding, TakesForcesBackByTheWeightsOfThePositions) {
    for (const auto* family : test::tetrahedral_families()) {
        if (family->data.num_cells() <= 2) continue;
        for (int seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE(testing::Message() << family->name << ", seed " << seed);
            test::Random random(static_cast<std::uint64_t>(seed));
            Mesh material = Mesh::build(family->data).mesh;
            FragmentMesh fragments(material);
            Embedding embedding(material, fragments);
            EXPECT_TRUE(embedding.is_trivial());
            std::uint64_t version = 0;
            for (int i = 0; i < 4; ++i) {
                std::vector<CellId> cells;
                for (const CellId cell : material.elements()) cells.push_back(cell);
                Vec3 middle = Vec3::Zero();
                for (const VertexId v : material.corners(cells[random.below(cells.size())]))
                    middle += 0.25 * material.rest_position(v);
                const ChangeSet changes = test::cut_along_plane(
                    material, middle, random.vector(1.0), [](const Vec3&) { return true; });
                if (changes.is_empty()) continue;
                const FragmentChanges done = fragments.apply(material, changes);
                embedding.apply(material, fragments, touched_vertices(material, changes), done);
                expect_as_built_afresh(embedding, material, fragments);

                const auto x = embedding.positions(fragments.rest_positions(), ++version);
                for (const VertexId v : material.nodes())
                    EXPECT_LT((x[v.index()] - material.rest_position(v)).norm(), 1e-12);
                // The power of a force at a point is that of its parts at the nodes.
                std::vector<Vec3> of_nodes(fragments.node_capacity());
                for (Vec3& velocity : of_nodes) velocity = random.vector(1.0);
                const auto velocities = embedding.velocities(of_nodes, version);
                topology::CellPoint at{cells[random.below(cells.size())]};
                if (!material.is_alive(at.cell)) continue;
                double sum = 0.0;
                at.count = 4;
                std::ranges::copy(material.corners(at.cell), at.corners.begin());
                for (std::size_t k = 0; k < 4; ++k) sum += at.weights[k] = random.uniform();
                for (std::size_t k = 0; k < 4; ++k) at.weights[k] /= sum;
                const Vec3 force = random.vector(1.0);
                double power = 0.0, scale = 0.0;
                embedding.for_each(at, [&](NodeId n, double weight) {
                    power += weight * force.dot(of_nodes[n.index()]);
                    scale += std::abs(weight);
                });
                EXPECT_NEAR(power, force.dot(at.position(velocities)), 1e-12 * scale);
            }
        }
    }
}

}  // namespace
}  // namespace incise::fragments
