// The patch test: where the boundary moves as an affine map says, the inside does too, in one
// stress, whatever the mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/physics/solve/integrator.h"
#include "support/mesh_families.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::CellKind;
using topology::Mesh;

Mat3 stretch_and_shear() {
    Mat3 F;
    F << 1.12, 0.15, -0.06,  //
        0.04, 0.92, 0.11,    //
        -0.05, 0.08, 1.06;
    return F;
}

/// Each node of the boundary of the unit cube is led to where F takes it.
BoundaryConditions affine_boundary(const Mesh& mesh, const Mat3& F) {
    BoundaryConditions s;
    for (const VertexId n : nodes_where(mesh, [](const Vec3& X) {
             return X.minCoeff() < 1e-9 || X.maxCoeff() > 1.0 - 1e-9;
         })) {
        Constraint constraint = holding("node " + std::to_string(n.value), VertexSet({n}));
        const Vec3 u = F * mesh.rest_position(n) - mesh.rest_position(n);
        constraint.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, u}});
        s.constraints.push_back(constraint);
    }
    return s;
}

TEST(PatchTest, OfEveryLawIsPassed) {
    const Mesh mesh = Mesh::build(test::jittered_cube(4, 0.2, 5)).mesh;
    const Mat3 F = stretch_and_shear();
    const BoundaryConditions boundary_conditions = affine_boundary(mesh, F);
    ASSERT_LT(boundary_conditions.constraints.size(), mesh.num_nodes());
    for (const NamedLaw& named : test_laws()) {
        SCOPED_TRACE(named.name);
        MaterialTable table = table_of_one_law(named.law);
        for (Vec3& fibre : table.fibres) fibre = Vec3(2, -1, 2) / 3.0;  // the same everywhere
        Model model(mesh, table, boundary_conditions);
        Statics statics;
        statics.step(model, 0.0, 0.5);
        statics.step(model, 0.5, 0.5);
        for (std::size_t n = 0; n < mesh.num_nodes(); ++n)
            EXPECT_LE((model.positions()[n] - F * mesh.rest_position(VertexId(n))).norm(), 1e-9);
        const Mat3 stress = model.element_result(ElementId(std::size_t{0})).cauchy_stress;
        ASSERT_GT(stress.norm(), 0.0);
        for (const ElementId e : living_elements(model.fragments()))
            EXPECT_LE((model.element_result(e).cauchy_stress - stress).norm(),
                      1e-8 * stress.norm());
    }
}

TEST(PatchTest, IsPassedByMixturesOfCells) {
    const Mesh mesh = Mesh::build(test::brick_cube(test::Bricks::mixed, 4, 0.15, 5)).mesh;
    const Mat3 F = stretch_and_shear();
    const BoundaryConditions boundary_conditions = affine_boundary(mesh, F);
    for (const NamedLaw& named : test_laws()) {
        SCOPED_TRACE(named.name);
        MaterialTable table = table_of_one_law(named.law);
        if (has_fibres(named.law)) table.fibres.assign(mesh.num_elements(), Vec3(2, -1, 2) / 3.0);
        Model model(mesh, table, boundary_conditions);
        Statics statics;
        statics.step(model, 0.0, 0.5);
        statics.step(model, 0.5, 0.5);
        for (std::size_t n = 0; n < mesh.num_nodes(); ++n)
            EXPECT_LE((model.positions()[n] - F * mesh.rest_position(VertexId(n))).norm(), 1e-9);
        const Mat3 stress = model.element_result(ElementId(std::size_t{0})).cauchy_stress;
        for (const ElementId e : living_elements(model.fragments()))
            EXPECT_LE((model.element_result(e).cauchy_stress - stress).norm(),
                      1e-8 * stress.norm());
    }
}

}  // namespace
}  // namespace incise::physics
