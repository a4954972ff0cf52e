// Which ways constraints leave to a piece, however thin it is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/free_components.h"

#include <gtest/gtest.h>

#include "incise/physics/solve/integrator.h"
#include "tests/physics/test_bodies.h"
#include "tests/physics/thin_tetrahedra.h"

namespace incise::physics {
namespace {

using topology::Mesh;

Constraint hold(std::vector<std::size_t> nodes,
                std::array<bool, 3> components = {true, true, true}) {
    Constraint constraint;
    constraint.name = "hold";
    std::vector<VertexId> ids;
    for (const std::size_t n : nodes) ids.emplace_back(n);
    constraint.nodes = VertexSet(ids);
    constraint.components = components;
    return constraint;
}

std::vector<FreeComponent> free_components_of(const Mesh& mesh, const Constraint& constraint) {
    const fragments::FragmentMesh fragments(mesh);
    const ElementStore elements(fragments, mesh, table_of_one_law(soft_law));
    return find_free_components(
        fragments, mesh.rest_positions(),
        Constraints({mesh, fragments, elements, {}, mesh.rest_positions()}, {constraint}));
}

TEST(FreeComponents, AreNoneWhereAllNodesAreHeld) {
    for_each_thin_tetrahedron([](const Tetrahedron& X, double) {
        const Mesh mesh = mesh_of(X);
        EXPECT_TRUE(free_components_of(mesh, hold({0, 1, 2, 3})).empty());
        EXPECT_TRUE(free_components_of(mesh, hold({1, 2, 3})).empty());
    });
}

TEST(FreeComponents, TurnAboutAnEdgeThatIsHeld) {
    for_each_thin_tetrahedron([](const Tetrahedron& X, double) {
        const Mesh mesh = mesh_of(X);
        const auto pieces = free_components_of(mesh, hold({0, 1}));
        ASSERT_EQ(pieces.size(), 1u);
        EXPECT_EQ(pieces[0].modes.cols(), 1);
        EXPECT_EQ(pieces[0].pins.size(), 1u);
    });
}

TEST(FreeComponents, MoveInAllWaysWhereNothingHoldsThem) {
    for_each_thin_tetrahedron([](const Tetrahedron& X, double) {
        const Mesh mesh = mesh_of(X);
        const fragments::FragmentMesh fragments(mesh);
        const ElementStore elements(fragments, mesh, table_of_one_law(soft_law));
        const auto pieces = find_free_components(
            fragments, mesh.rest_positions(),
            Constraints({mesh, fragments, elements, {}, mesh.rest_positions()}, {}));
        ASSERT_EQ(pieces.size(), 1u);
        EXPECT_EQ(pieces[0].pins.size(), 6u);
    });
}

TEST(FreeComponents, ThatAreThinEndInEquilibrium) {
    for_each_thin_tetrahedron([](const Tetrahedron& X, double) {
        const Mesh mesh = mesh_of(X);
        BoundaryConditions s;
        s.gravity = {0.0, 0.0, -9.81};
        s.constraints = {hold({0, 1, 2, 3})};
        Model model(mesh, table_of_one_law(soft_law), s);
        EXPECT_NO_THROW(Statics().step(model, 0.0, 1.0));
    });
}

}  // namespace
}  // namespace incise::physics
