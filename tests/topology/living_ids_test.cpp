// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/living_ids.h"

#include <gtest/gtest.h>

#include <iterator>
#include <unordered_set>

#include "incise/topology/mesh_edit.h"
#include "support/mesh_families.h"

namespace incise::topology {
namespace {

static_assert(std::forward_iterator<LivingIds<VertexId, Mesh>::Iterator>);

template <class Id>
void expect_living(const Mesh& mesh, LivingIds<Id, Mesh> found, std::size_t capacity,
                   std::size_t count) {
    std::vector<Id> living;
    for (std::size_t i = 0; i < capacity; ++i)
        if (mesh.is_alive(Id(i))) living.emplace_back(i);
    EXPECT_EQ(std::vector<Id>(found.begin(), found.end()), living);
    EXPECT_EQ(living.size(), count);
}

void expect_all_living(const Mesh& mesh) {
    expect_living(mesh, mesh.nodes(), mesh.node_capacity(), mesh.num_nodes());
    expect_living(mesh, mesh.elements(), mesh.element_capacity(), mesh.num_elements());
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
                for (const CellId e : std::vector<CellId>(living.begin(), living.end()))
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
    std::unordered_set<CellId> elements;
    for (std::size_t i = 0; i < 100; ++i) EXPECT_TRUE(elements.insert(CellId(i)).second);
    EXPECT_FALSE(elements.insert(CellId(7)).second);
    EXPECT_TRUE(elements.contains(CellId(99)));
    EXPECT_FALSE(elements.contains(CellId(100)));
}

}  // namespace
}  // namespace incise::topology
