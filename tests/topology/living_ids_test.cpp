// SPDX-License-Identifier: LGPL-3.0-or-later
#include "topology/living_ids.h"

#include <gtest/gtest.h>

#include <iterator>
#include <unordered_set>

#include "support/mesh_families.h"
#include "topology/mesh_edit.h"

namespace incise::topology {
namespace {

static_assert(std::forward_iterator<LivingIds<NodeId, Mesh>::Iterator>);

void expect_all_living(const Mesh& mesh) {
    std::vector<ElementId> elements;
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
        if (mesh.is_alive(ElementId(i))) elements.emplace_back(i);
    const auto found = mesh.elements();
    EXPECT_EQ(std::vector<ElementId>(found.begin(), found.end()), elements);
    EXPECT_EQ(elements.size(), mesh.num_elements());

    std::vector<NodeId> nodes;
    for (std::size_t i = 0; i < mesh.node_capacity(); ++i)
        if (mesh.is_alive(NodeId(i))) nodes.emplace_back(i);
    const auto found_nodes = mesh.nodes();
    EXPECT_EQ(std::vector<NodeId>(found_nodes.begin(), found_nodes.end()), nodes);
    EXPECT_EQ(nodes.size(), mesh.num_nodes());
}

TEST(LivingIds, AreThoseAliveAfterRemovals) {
    test::Random random(1);
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        Mesh mesh = Mesh::build(family.data).mesh;
        expect_all_living(mesh);
        while (mesh.num_elements() > 0) {
            {
                MeshEdit edit(mesh);
                std::size_t num_removed = 0;
                const auto living = mesh.elements();
                for (const ElementId e : std::vector<ElementId>(living.begin(), living.end()))
                    if (random.below(3) == 0) {
                        edit.remove(e);
                        ++num_removed;
                    }
                if (num_removed == 0) edit.remove(*mesh.elements().begin());
                edit.commit();
            }
            expect_all_living(mesh);
        }
        EXPECT_TRUE(mesh.nodes().begin() == mesh.nodes().end());
    }
}

TEST(Ids, AreKeysOfSets) {
    std::unordered_set<ElementId> elements;
    for (std::size_t i = 0; i < 100; ++i) EXPECT_TRUE(elements.insert(ElementId(i)).second);
    EXPECT_FALSE(elements.insert(ElementId(7)).second);
    EXPECT_TRUE(elements.contains(ElementId(99)));
    EXPECT_FALSE(elements.contains(ElementId(100)));
}

}  // namespace
}  // namespace incise::topology
