// SPDX-License-Identifier: LGPL-3.0-or-later
#include "topology/change_check.h"

#include <gtest/gtest.h>

#include <functional>

#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "topology/error.h"
#include "topology/mesh_edit.h"

namespace incise::topology {
namespace {

std::string refusal_of(const ChangeSet& changes, const Mesh& mesh) {
    try {
        require_fit(changes, mesh);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ChangeCheck, LetsEveryEditPassThatTheMeshHasMade) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        test::Random random(8);
        Mesh mesh = Mesh::build(family.data).mesh;
        for (int i = 0; i < test::num_cases(100); ++i) {
            if (mesh.num_elements() == 0) mesh = Mesh::build(family.data).mesh;
            const ChangeSet changes = test::random_edit(mesh, random);
            if (changes.is_empty()) continue;
            replay(mesh, inverse(changes));
            ASSERT_EQ(refusal_of(changes, mesh), "") << i;
            replay(mesh, changes);
        }
    }
}

TEST(ChangeCheck, RefusesForgedRecords) {
    struct Forgery {
        const char* why;
        std::function<void(ChangeSet&)> make;
    };
    // One edit that has something of everything but merged nodes.
    Mesh mesh = Mesh::build(test::jittered_cube(3, 0.1, 1)).mesh;
    ChangeSet good;
    {
        MeshEdit edit(mesh);
        edit.remove(ElementId(100));
        for (std::size_t i = 0; i < test::num_cases(100); ++i)  // a node at least comes apart
            for (int f = 0; f < 4; ++f)
                if (i % 7 == 0 && mesh.neighbor({ElementId(i), f}).is_valid())
                    edit.open({ElementId(i), f});
        const auto corners = mesh.corners(ElementId(1));
        const NodeId a = corners[0], b = corners[1];
        edit.bisect(ElementId(1), a, b, 0.5);
        good = edit.commit();
    }
    replay(mesh, inverse(good));
    ASSERT_EQ(refusal_of(good, mesh), "");
    ASSERT_FALSE(good.rewired.empty());

    const NodeId nowhere(good.node_capacity_after);
    const ElementId no_element(good.element_capacity_after);
    for (const auto& [why, make] : std::vector<Forgery>{
             {"out of turn", [](auto& c) { c.epoch_before += 1; }},
             {"other numbers", [](auto& c) { c.node_capacity_after += 1'000'000'000; }},
             {"other numbers", [](auto& c) { c.elements_added.clear(); }},
             {"out of turn", [&](auto& c) { c.nodes_added[0].id = nowhere; }},
             {"not finite", [](auto& c) { c.nodes_added[0].rest_position.x() = 0.0 / 0.0; }},
             {"sources", [](auto& c) { c.nodes_added[0].num_sources = 5; }},
             {"without a source", [](auto& c) { c.nodes_added[0].num_sources = 0; }},
             {"which is not there", [&](auto& c) { c.nodes_added[0].sources[0].node = nowhere; }},
             {"before its source",
              [](auto& c) { c.nodes_added[0].sources[0].node = c.nodes_added[0].id; }},
             {"which is not there", [&](auto& c) { c.elements_removed[0].id = no_element; }},
             {"as another one", [](auto& c) { c.elements_removed[0].id = ElementId(99); }},
             {"as another one", [](auto& c) { c.elements_removed[0].region += 1; }},
             {"which is not there",
              [](auto& c) { c.elements_removed.push_back(c.elements_removed[0]); }},
             {"while it is joined", [](auto& c) { c.faces_opened.clear(); }},
             {"not joined so", [](auto& c) { c.faces_opened[0].a.face = 77; }},
             {"not joined so", [](auto& c) { c.faces_opened[0].b.element = ElementId(); }},
             {"twice", [](auto& c) { c.faces_opened.push_back(c.faces_opened[0]); }},
             {"out of turn", [](auto& c) { c.elements_added[0].parent = ElementId(); }},
             {"unlike the one",
              [](auto& c) { c.elements_added[0].kind = static_cast<CellKind>(200); }},
             {"unlike the one", [](auto& c) { c.elements_added[0].corners.pop_back(); }},
             {"which is not there", [&](auto& c) { c.elements_added[0].corners[2] = nowhere; }},
             {"which is not there", [&](auto& c) { c.rewired[0].element = no_element; }},
             {"that it has not", [](auto& c) { c.rewired[0].corner = -1; }},
             {"that it has not", [](auto& c) { c.rewired[0].from = c.rewired[0].to; }},
             {"which is not there", [&](auto& c) { c.rewired[0].to = nowhere; }},
             {"different nodes", [](auto& c) { c.rewired.clear(); }},
             {"which is not there", [&](auto& c) { c.faces_closed[0].a.element = no_element; }},
             {"has not", [](auto& c) { c.faces_closed[0].b.face = 4; }},
             {"joined already",
              [](auto& c) { c.faces_closed.push_back(c.faces_closed.front()); }}}) {
        ChangeSet forged = good;
        make(forged);
        const std::string refusal = refusal_of(forged, mesh);
        EXPECT_NE(refusal.find(why), std::string::npos) << why << ": " << refusal;
    }
}

}  // namespace
}  // namespace incise::topology
