// Steps of bodies that are held, moved and loaded in every way have the same bits on any number of
// threads, and after edits those of a body built anew.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "incise/physics/solve/solved_step.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::CellKind;
using topology::Mesh;

constexpr double side = 0.1;

/// Of more ranges of nodes, and of more blocks, than one thread works on alone.
Mesh cube(CellKind kind) {
    return Mesh::build(topology::box_mesh(kind, Vec3::Zero(), {side, side, side}, {13, 13, 13}))
        .mesh;
}

template <class Predicate>
std::vector<FaceId> faces_where(const Mesh& mesh, Predicate is_inside) {
    std::vector<FaceId> faces = topology::boundary_faces(mesh);
    std::erase_if(faces, [&](FaceId f) {
        for (int p = 0; p < mesh.face_size(f); ++p)
            if (!is_inside(mesh.rest_position(mesh.face_corner(f, p)))) return true;
        return false;
    });
    return faces;
}

VertexSet nodes_at_height(const Mesh& mesh, double z) {
    return VertexSet(nodes_where(mesh, [&](const Vec3& X) { return X.z() == z; }));
}

BoundaryConditions held_moved_and_loaded(const Mesh& mesh) {
    BoundaryConditions s;
    s.gravity = {0.3, -0.2, -9.81};
    s.damping = 2.0;
    s.constraints.push_back(holding("floor", nodes_at_height(mesh, 0.0)));
    Constraint lid = holding("lid", nodes_at_height(mesh, side), {true, false, true});
    lid.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.1, 0.2, -0.3)}});
    lid.angle = TimeCurve<double>({{0.0, 0.0}, {1.0, 0.5}});
    lid.point = {0.05, 0.05, side};
    s.constraints.push_back(lid);
    const TimeCurve<double> growing({{0.0, 0.5}, {1.0, 2.0}});
    s.loads.push_back(
        {"hooks", NodalLoad{nodes_at_height(mesh, side), {1e-3, 2e-3, -1e-3}, {}}, growing});
    s.loads.push_back(
        {"wind",
         TractionLoad{faces_where(mesh, [](const Vec3& X) { return X.x() == 0.0; }), {20, 10, 5}},
         {}});
    s.loads.push_back(
        {"gas",
         PressureLoad{
             faces_where(mesh, [](const Vec3& X) { return X.x() == side || X.y() == side; }), 30.0},
         growing});
    s.loads.push_back({"field", BodyLoad{living_elements(mesh), {100, -200, 50}}, {}});
    return s;
}

MaterialTable viscous_or_hybrid(CellKind kind) {
    if (kind == CellKind::hexahedron) return table_of_one_material(HybridSprings{3e3, 1e4, 1.0});
    return table_of_one_material(HyperElasticLinks{soft_law, 0.4, {{0.3, 0.05}, {0.2, 0.2}}});
}

/// What some steps lead to.
struct Outcome {
    BodyState state;
    std::vector<Vec3> outer_forces, reactions, moments;
    double work, dissipated;
    bool operator==(const Outcome&) const = default;
};

Outcome outcome_of_steps(Model& model) {
    const double dt = 0.3 * model.stable_step();
    double time = 0.0;
    for (int i = 0; i < 5; ++i) step(model, time, dt);
    Outcome outcome{
        state_of(model),
        {model.boundary().outer_forces().begin(), model.boundary().outer_forces().end()},
        {},
        {},
        model.energetics().external_work(),
        model.energetics().dissipated_energy()};
    for (std::size_t i = 0; i < model.boundary().constraints().size(); ++i) {
        outcome.reactions.push_back(model.boundary().reactions()[i].force);
        outcome.moments.push_back(model.boundary().reactions()[i].torque);
    }
    return outcome;
}

void expect_equal(const Outcome& a, const Outcome& b) {
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.outer_forces, b.outer_forces);
    EXPECT_EQ(a.reactions, b.reactions);
    EXPECT_EQ(a.moments, b.moments);
    EXPECT_EQ(a.work, b.work);
    EXPECT_EQ(a.dissipated, b.dissipated);
}

TEST(WholeStep, HasTheSameBitsForAnyThreadCount) {
    for (const CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
        SCOPED_TRACE(topology::traits(kind).name);
        const Mesh mesh = cube(kind);
        ASSERT_GE(num_node_ranges(mesh.node_capacity()), 5u);
        const auto outcome_on = [&](int num_threads) {
            Model model(mesh, viscous_or_hybrid(kind), held_moved_and_loaded(mesh));
            model.set_num_threads(num_threads);
            return outcome_of_steps(model);
        };
        const Outcome alone = outcome_on(1);
        for (const Vec3& reaction : alone.reactions) EXPECT_GT(reaction.norm(), 0.0);
        for (const int num_threads : {2, 3, 16}) {
            SCOPED_TRACE(num_threads);
            expect_equal(outcome_on(num_threads), alone);
        }
    }
}

TEST(WholeStep, OfAnEditedBodyEqualsAFreshOne) {
    for (const CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
        SCOPED_TRACE(topology::traits(kind).name);
        Mesh mesh = cube(kind);
        Model edited(mesh, viscous_or_hybrid(kind), held_moved_and_loaded(mesh));
        topology::MeshEdit edit(mesh);
        for (std::size_t e = 5; e < mesh.element_capacity(); e += 97) edit.remove(CellId(e));
        const auto changes = edit.commit();
        ASSERT_TRUE(changes.nodes_added.empty());  // else copies would share forces
        edited.apply(edited.mesh(), changes);
        edited.set_num_threads(2);
        Model built(mesh, viscous_or_hybrid(kind), held_moved_and_loaded(mesh));
        expect_equal(outcome_of_steps(edited), outcome_of_steps(built));
    }
}

// Implicit steps and statics ask for them at positions of their own.
TEST(WholeStep, HasLoadsOfEditedBodiesBeforeTheirForces) {
    Mesh mesh = bar();
    Model edited(mesh, table_of_one_law(soft_law), held_moved_and_loaded(mesh));
    topology::MeshEdit edit(mesh);
    edit.remove(CellId(0));
    edited.apply(edited.mesh(), edit.commit());
    begin_solved_step(edited);
    const Model built(mesh, table_of_one_law(soft_law), held_moved_and_loaded(mesh));
    std::vector<Vec3> of_edited(mesh.node_capacity()), of_built(mesh.node_capacity());
    edited.boundary().outer_forces_at(edited.positions(), 0.2, edited.workers(), of_edited);
    built.boundary().outer_forces_at(built.positions(), 0.2, built.workers(), of_built);
    EXPECT_EQ(of_edited, of_built);
}

}  // namespace
}  // namespace incise::physics
