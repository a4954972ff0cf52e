// The patch test: where the boundary moves as an affine map says, the inside does too, in one
// stress, whatever the mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>

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

void expect_patch_test_of_every_law(const Mesh& mesh) {
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

TEST(PatchTest, IsPassedByMixturesOfCells) {
    expect_patch_test_of_every_law(
        Mesh::build(test::brick_cube(test::Bricks::mixed, 4, 0.15, 5)).mesh);
}

TEST(PatchTest, IsPassedWhereQuadrilateralsMeetTriangles) {
    expect_patch_test_of_every_law(
        Mesh::build(test::brick_cube(test::Bricks::joined, 3, 0.08, 5)).mesh);
}

bool is_inside(const Vec3& X) { return X.minCoeff() > 1e-9 && X.maxCoeff() < 1.0 - 1e-9; }

/// Expects that no node inside the unit cube has a force in an affine state, neither of the lanes
/// that explicit steps use nor of the kernels.
/// @param tolerance  times the largest force
void expect_no_force_inside(const Mesh& mesh, const MaterialTable& table, const Mat3& F,
                            double tolerance) {
    Model model(mesh, table);
    BodyState state = rest_state(model.fragments());
    for (Vec3& x : state.positions) x = F * x;
    model.set_state(state.positions, state.velocities, 0.0);
    std::vector<Vec3> of_kernels(state.positions.size(), Vec3::Zero());
    model.structure().elements().add_forces({state.positions, model.state().history(), 1.0},
                                            of_kernels);
    double largest = 0.0;
    for (const Vec3& f : model.elastic_forces()) largest = std::max(largest, f.norm());
    ASSERT_GT(largest, 0.0);
    std::size_t num_inside = 0;
    for (const NodeId n : model.fragments().nodes()) {
        if (!is_inside(model.fragments().rest_position(n))) continue;
        ++num_inside;
        EXPECT_LE(model.elastic_forces()[n.index()].norm(), tolerance * largest);
        EXPECT_LE(of_kernels[n.index()].norm(), tolerance * largest);
    }
    EXPECT_GT(num_inside, 0u);
}

TEST(PatchTest, LeavesNoForceInsideMixturesWithAnyDiagonals) {
    for (const double jitter : {0.0, 0.08})
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            SCOPED_TRACE(testing::Message() << "jitter " << jitter << ", seed " << seed);
            const Mesh mesh =
                Mesh::build(test::brick_cube(test::Bricks::joined, 3, jitter, seed)).mesh;
            ASSERT_EQ(components(mesh).count, 1);
            for (const NamedLaw& named : test_laws()) {
                SCOPED_TRACE(named.name);
                MaterialTable table = table_of_one_law(named.law);
                if (has_fibres(named.law))
                    table.fibres.assign(mesh.num_elements(), Vec3(2, -1, 2) / 3.0);
                expect_no_force_inside(mesh, table, stretch_and_shear(), 1e-12);
            }
        }
}

/// The material of region 0 for hexahedra, and the one of divided boxes for all others.
MaterialTable table_of_springs_and_links(const HybridSprings& springs) {
    MaterialTable table = table_of_one_material(springs);
    table.materials.push_back({1000.0, links_of_divided_box(springs)});
    table.of_region[1] = 1;
    return table;
}

// Boxes of hybrid springs that meet triangles have the law of divided boxes from the start. Where
// they are beside other boxes, the two laws agree to first order of strain.
TEST(PatchTest, IsPassedByHybridSpringsBesideTriangles) {
    const HybridSprings springs{3e3, 1e4, std::numeric_limits<double>::infinity()};
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        SCOPED_TRACE(seed);
        topology::MeshData data = test::brick_cube(test::Bricks::joined, 3, 0.0, seed);
        for (std::size_t c = 0; c < data.num_cells(); ++c)
            data.regions[c] = data.kinds[c] == CellKind::hexahedron ? 0 : 1;
        const Mesh mesh = Mesh::build(data).mesh;
        for (const double strain : {1e-3, 1e-5}) {
            const Mat3 F = Mat3::Identity() + strain * (stretch_and_shear() - Mat3::Identity());
            expect_no_force_inside(mesh, table_of_springs_and_links(springs), F, 2.0 * strain);
        }
    }
}

TEST(PatchTest, IsExactForOneLayerOfBoxesBetweenTetrahedra) {
    // Hexahedra in the middle of three layers, each with triangles above and below.
    topology::MeshData data;
    const topology::MeshData hexahedra = topology::box_mesh(CellKind::hexahedron, Vec3::Zero(),
                                                            Vec3::Ones(), {3, 3, 3}),
                             tetrahedra = topology::box_mesh(CellKind::tetrahedron, Vec3::Zero(),
                                                             Vec3::Ones(), {3, 3, 3});
    data.points = hexahedra.points;
    ASSERT_EQ(hexahedra.points, tetrahedra.points);
    const auto is_in_middle = [](const topology::MeshData& of, std::size_t c) {
        double z = 0.0;
        for (const std::int64_t p : of.cell(c)) z += of.points[static_cast<std::size_t>(p)].z();
        return std::abs(z / static_cast<double>(of.cell(c).size()) - 0.5) < 1.0 / 6.0;
    };
    for (std::size_t c = 0; c < hexahedra.num_cells(); ++c)
        if (is_in_middle(hexahedra, c)) data.add_cell(CellKind::hexahedron, hexahedra.cell(c), 0);
    for (std::size_t c = 0; c < tetrahedra.num_cells(); ++c)
        if (!is_in_middle(tetrahedra, c))
            data.add_cell(CellKind::tetrahedron, tetrahedra.cell(c), 1);
    const auto built = Mesh::build(data);
    ASSERT_EQ(components(built.mesh).count, 1);
    for (const double ratio : {1.0, 0.5, std::numeric_limits<double>::infinity()})
        expect_no_force_inside(built.mesh, table_of_springs_and_links({3e3, 1e4, ratio}),
                               stretch_and_shear(), 1e-12);
}

}  // namespace
}  // namespace incise::physics
