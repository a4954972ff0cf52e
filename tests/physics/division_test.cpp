// A body whose elements are divided: state, motion, constraints and loads go on to the parts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <functional>

#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/balance.h"
#include "tests/physics/descent.h"
#include "tests/physics/model_snapshot.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::ChangeSet;
using topology::Mesh;
using topology::MeshEdit;

struct Edge {
    CellId element;
    VertexId a, b;
};

Edge random_edge(const Mesh& mesh, test::Random& random) {
    const auto elements = living_elements(mesh);
    const CellId e = elements[random.below(elements.size())];
    const std::size_t a = random.below(4), b = (a + 1 + random.below(3)) % 4;
    return {e, mesh.corners(e)[a], mesh.corners(e)[b]};
}

ChangeSet bisect(Mesh& mesh, const Edge& edge, double t) {
    MeshEdit edit(mesh);
    edit.bisect(edge.element, edge.a, edge.b, t);
    return edit.commit();
}

/// The edge of an element with the two nodes that are where `is_end` says.
template <class Predicate>
Edge edge_where(const Mesh& mesh, Predicate is_edge) {
    for (const CellId e : living_elements(mesh))
        for (const VertexId a : mesh.corners(e))
            for (const VertexId b : mesh.corners(e))
                if (a != b && is_edge(mesh.rest_position(a), mesh.rest_position(b)))
                    return {e, a, b};
    ADD_FAILURE() << "no such edge";
    return {};
}

void open_all_inner_faces(Mesh& mesh, MeshEdit& edit) {
    for (const CellId e : living_elements(mesh))
        for (int f = 0; f < 4; ++f)
            if (mesh.neighbor({e, f}).is_valid()) edit.open({e, f});
}

Mesh cube() { return Mesh::build(test::jittered_cube(2, 0.2, 3)).mesh; }

Mesh one_tetrahedron() { return Mesh::build(test::mesh_families().front().data).mesh; }

/// Outer forces by node on the resting body, from one step.
std::vector<Vec3> loads_at_rest(Model& model) {
    set_state(model, rest_state(model.fragments()));
    const double dt = 1e-4;
    ExplicitStep().move(model, 0.0, dt);
    std::vector<Vec3> forces;
    for (std::size_t n = 0; n < model.masses().size(); ++n)
        forces.push_back(model.masses()[n] / dt * model.velocities()[n]);
    return forces;
}

Vec3 sum_of(const std::vector<Vec3>& vectors) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& v : vectors) sum += v;
    return sum;
}

TEST(Bisection, ChangesNoBitOfTheBody) {
    for (const auto* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        const auto table = table_of_all_materials();
        const auto data = with_regions(family->data, table.materials.size());
        test::Random random(11);
        for (int i = 0; i < 10; ++i) {
            Mesh mesh = Mesh::build(data).mesh;
            BoundaryConditions s;
            s.gravity = {1.0, -2.0, 3.0};
            Model model(mesh, table, s);
            set_state(model, random_state(mesh, random, 0.02, 1.0));
            const ModelSnapshot before(model, 0.0);
            const BodyEdit first =
                follow(model, bisect(mesh, random_edge(mesh, random), random.uniform(0.05, 0.95)));
            const BodyEdit second =
                follow(model, bisect(mesh, random_edge(mesh, random), random.uniform(0.05, 0.95)));
            expect_equal(ModelSnapshot(model, 0.0), before);
            // The new node is where it was made.
            const auto& born = first.material.nodes_added.front();
            Vec3 x = Vec3::Zero();
            for (std::size_t k = 0; k < 2; ++k)
                x += born.sources[k].weight * model.mesh_positions()[born.sources[k].node.index()];
            EXPECT_LE((model.mesh_positions()[born.id.index()] - x).norm(), 1e-14);
            take_back(mesh, model, second);
            take_back(mesh, model, first);
            expect_equal(ModelSnapshot(model, 0.0), before);
        }
    }
}

// All the pieces of a face bear what it bore, and what was inside never bears anything.
TEST(Bisection, KeepsForceAndMomentOfTractionAndPressure) {
    const Vec3 traction(3.0, -2.0, 5.0);
    const double pressure = 7.0;
    for (const bool is_pressure : {false, true}) {
        Mesh mesh = cube();
        std::vector<FaceId> loaded;  // two sides that meet in an edge
        for (const FaceId f : topology::boundary_faces(mesh))
            for (const int c : {0, 2}) {
                bool is_on_side = true;
                for (int p = 0; p < 3; ++p)
                    is_on_side &= mesh.rest_position(mesh.face_corner(f, p))[c] == 1.0;
                if (is_on_side) loaded.push_back(f);
            }
        ASSERT_EQ(loaded.size(), 16u);
        BoundaryConditions s;
        if (is_pressure)
            s.loads.push_back({"gas", PressureLoad{loaded, pressure}, {}});
        else
            s.loads.push_back({"wind", TractionLoad{loaded, traction}, {}});
        // So soft that elastic forces, whose sum is nothing but round-off, do not show.
        // Without light fragments: these move with another one, and their faces with them.
        Model model(mesh, fragments::FragmentMesh(mesh, 0.0),
                    table_of_one_law(NeoHookean{1e-3, 1e-3}), s);
        test::Random random(13);
        BodyState state = random_state(mesh, random, 0.05, 0.0);
        const auto force_and_moment = [&] {
            set_state(model, state);
            Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
            const double dt = 1e-4;
            ExplicitStep().move(model, 0.0, dt);
            for (std::size_t n = 0; n < state.positions.size(); ++n) {
                const Vec3 f = model.masses()[n] / dt * model.velocities()[n];
                force += f;
                moment += state.positions[n].cross(f);
            }
            return std::pair{force, moment};
        };
        const auto [force, moment] = force_and_moment();
        if (!is_pressure) {
            EXPECT_LE((force - 2.0 * traction).norm(), 1e-13);
        }
        for (int i = 0; i < 60; ++i) {
            set_state(model, state);
            MeshEdit edit(mesh);
            for (std::size_t k = random.below(4) + 1; k > 0; --k) {
                const Edge edge = random_edge(mesh, random);
                edit.bisect(edge.element, edge.a, edge.b, random.uniform(0.3, 0.7));
                if (random.below(3) == 0)
                    for (int f = 0; f < 4; ++f)
                        if (mesh.neighbor({edge.element, f}).is_valid())
                            edit.open({edge.element, f});
            }
            model.apply(model.mesh(), edit.commit());
            state = state_of(model);
            for (Vec3& v : state.velocities) v.setZero();
            const auto [force_now, moment_now] = force_and_moment();
            EXPECT_LE((force_now - force).norm(), 1e-12 * force.norm());
            EXPECT_LE((moment_now - moment).norm(), 1e-12 * moment.norm());
        }
    }
}

/// A tetrahedron with one face under traction and a body force, and what it is to bear.
struct LoadedTetrahedron {
    Mesh mesh = one_tetrahedron();
    Descent descent;
    Model model;

    explicit LoadedTetrahedron(int loaded_face)
        : descent(mesh, {{}, {}, {{CellId(0), loaded_face}}, {CellId(0)}}),
          model(mesh, table_of_one_law(soft_law), boundary_conditions()) {}

    void apply(const ChangeSet& changes) {
        model.apply(model.mesh(), changes);
        descent.follow(changes);
        expect_loads_of_a_fresh_model();
    }
    void expect_loads_of_a_fresh_model() {
        Model fresh(mesh, model.fragments(), table_of_one_law(soft_law), boundary_conditions());
        EXPECT_EQ(loads_at_rest(model), loads_at_rest(fresh));
    }
    BoundaryConditions boundary_conditions() const {
        const Selections now = descent.now(mesh);
        BoundaryConditions s;
        s.loads = {{"traction", TractionLoad{now.loaded_faces, {3.0, -2.0, 5.0}}, {}},
                   {"pressure", PressureLoad{now.loaded_faces, 7.0}, {}},
                   {"body force", BodyLoad{now.loaded_elements, {0.0, 1.0, 0.0}}, {}}};
        return s;
    }
};

// A face may go to the added element as a whole; the one that the kept element then has under its
// number lies inside, and does not come to bear the load when a cut opens it.
TEST(Bisection, DoesNotLoadAFaceThatItMade) {
    for (int loaded_face = 0; loaded_face < 4; ++loaded_face)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j) {
                if (i == j) continue;
                for (const bool is_opened_at_once : {true, false}) {
                    SCOPED_TRACE(testing::Message() << "face " << loaded_face << ", edge " << i
                                                    << " to " << j << is_opened_at_once);
                    LoadedTetrahedron body(loaded_face);
                    const auto corners = body.mesh.corners(CellId(0));
                    const Edge edge{CellId(0), corners[i], corners[j]};
                    // Ids that are given out again are not mistaken for those they were before.
                    const Edge other{CellId(0), corners[j], corners[(i + 1) % 4]};
                    if (other.a != other.b) {
                        take_back(body.mesh, body.model,
                                  follow(body.model, bisect(body.mesh, other, 0.5)));
                        body.expect_loads_of_a_fresh_model();
                    }
                    MeshEdit edit(body.mesh);
                    edit.bisect(edge.element, edge.a, edge.b, 0.25);
                    if (is_opened_at_once) open_all_inner_faces(body.mesh, edit);
                    body.apply(edit.commit());
                    if (is_opened_at_once) continue;
                    MeshEdit opening(body.mesh);
                    open_all_inner_faces(body.mesh, opening);
                    body.apply(opening.commit());
                }
            }
}

TEST(Bisection, CarriesLoadsThroughDivisionsOfParts) {
    test::Random random(14);
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE(i);
        LoadedTetrahedron body(i % 4);
        for (int k = 0; k < 3; ++k) {
            MeshEdit edit(body.mesh);
            for (int d = 0; d < 3; ++d) {
                const Edge edge = random_edge(body.mesh, random);
                edit.bisect(edge.element, edge.a, edge.b, random.uniform(0.3, 0.7));
                // Removed at once: its parts remain.
                if (edge.element == CellId(0) && random.below(8) == 0) edit.remove(edge.element);
            }
            if (k > 0) open_all_inner_faces(body.mesh, edit);
            body.apply(edit.commit());
        }
    }
}

// One edit that joins two faces again and divides an edge of them, before or after: who was merged
// must not hide whose parts the pieces are.
TEST(Bisection, AndJoiningTogetherKeepLoadsAndState) {
    for (const bool is_divided_first : {false, true}) {
        Mesh mesh = Mesh::build(test::mesh_families()[1].data).mesh;  // two by a face
        const FaceId shared = [&] {
            for (int f = 0;; ++f)
                if (mesh.neighbor({CellId(0), f}).is_valid()) return FaceId{CellId(0), f};
        }();
        const FaceId other = mesh.neighbor(shared);
        MeshEdit opening(mesh);
        opening.open(shared);
        opening.commit();
        const Vec3 traction(3.0, -2.0, 5.0);
        std::vector<FaceId> loaded = topology::boundary_faces(mesh);
        std::erase(loaded, shared);
        std::erase(loaded, other);
        BoundaryConditions s;
        s.loads = {{"wind", TractionLoad{loaded, traction}, {}}};
        Model model(mesh, table_of_one_law(soft_law), s);
        const Vec3 force = sum_of(loads_at_rest(model));
        const BodyState state = rest_state(mesh);
        set_state(model, state);

        MeshEdit edit(mesh);
        const auto divide = [&](FaceId f, int from, int to) {
            return edit.bisect(f.cell, mesh.face_corner(f, from), mesh.face_corner(f, to), 0.5)
                .node;
        };
        const auto position_in = [&](FaceId f, const Vec3& X) {
            int p = 0;
            while (mesh.rest_position(mesh.face_corner(f, p)) != X) ++p;
            return p;
        };
        const Vec3 a = mesh.rest_position(mesh.face_corner(shared, 0)),
                   b = mesh.rest_position(mesh.face_corner(shared, 1));
        if (is_divided_first) {
            divide(shared, 0, 1);
            divide(other, position_in(other, a), position_in(other, b));
        }
        edit.close(shared, other);
        if (!is_divided_first) divide(shared, 0, 1);
        const ChangeSet changes = edit.commit();
        const BodyEdit done = follow(model, changes);
        for (const VertexId n : mesh.nodes())
            EXPECT_LE((model.mesh_positions()[n.index()] - mesh.rest_position(n)).norm(), 1e-15);
        EXPECT_LE((sum_of(loads_at_rest(model)) - force).norm(), 1e-13 * force.norm());
        set_state(model, rest_state(model.fragments()));
        take_back(mesh, model, done);
        EXPECT_EQ(state_of(model), state);
        EXPECT_LE((sum_of(loads_at_rest(model)) - force).norm(), 1e-13 * force.norm());
    }
}

TEST(Bisection, AddsNoForceToALoadOnNodes) {
    Mesh mesh = cube();
    const auto is_loaded = [](const Vec3& X) { return X.z() == 1.0; };
    const auto loaded = nodes_where(mesh, is_loaded);
    const Vec3 force(1.0, -2.0, 0.5);
    BoundaryConditions s;
    s.loads.push_back({"hooks", NodalLoad{VertexSet(loaded), force, {}}, {}});
    Model model(mesh, table_of_one_law(soft_law), s);
    const std::vector<Vec3> before = loads_at_rest(model);
    const Vec3 total = static_cast<double>(loaded.size()) * force;
    ASSERT_LE((sum_of(before) - total).norm(), 1e-12);

    const BodyEdit divided = follow(
        model, bisect(mesh,
                      edge_where(mesh, [&](const Vec3& a,
                                           const Vec3& b) { return is_loaded(a) && is_loaded(b); }),
                      0.3));
    EXPECT_EQ(loads_at_rest(model), before);
    // Nor do copies add to the whole.
    MeshEdit edit(mesh);
    open_all_inner_faces(mesh, edit);
    const BodyEdit opened = follow(model, edit.commit());
    EXPECT_LE((sum_of(loads_at_rest(model)) - total).norm(), 1e-12);
    take_back(mesh, model, opened);
    take_back(mesh, model, divided);
    EXPECT_EQ(loads_at_rest(model), before);
}

TEST(Bisection, HoldsOnlyNodesAddedBetweenHeldOnes) {
    const auto left = [](const Vec3& X) { return X.x() == 0.0; };
    const auto right = [](const Vec3& X) { return X.x() == 1.0; };
    const auto middle = [&](const Vec3& X) { return !left(X) && !right(X); };
    struct Case {
        std::function<bool(const Vec3&)> a, b;
        bool is_held;
    };
    for (const Case& c : {Case{left, left, true}, Case{right, right, true},
                          Case{left, middle, false}, Case{middle, right, false}}) {
        Mesh mesh = cube();
        BoundaryConditions s;
        s.gravity = {0.0, 0.0, -9.81};
        s.constraints = {holding("left", VertexSet(nodes_where(mesh, left))),
                         holding("right", VertexSet(nodes_where(mesh, right)))};
        Model model(mesh, table_of_one_law(soft_law), s);
        const ChangeSet changes = bisect(
            mesh, edge_where(mesh, [&](const Vec3& a, const Vec3& b) { return c.a(a) && c.b(b); }),
            0.5);
        model.apply(model.mesh(), changes);
        MeshEdit edit(mesh);
        open_all_inner_faces(mesh, edit);  // copies are held as what they are copies of
        const ChangeSet opened = edit.commit();
        model.apply(model.mesh(), opened);
        double time = 0.0;
        step(model, time, 1e-3);
        const VertexId born = changes.nodes_added.front().id;
        std::vector<VertexId> copies{born};
        for (const auto& record : opened.nodes_added)
            if (record.sources[0].node == born) copies.push_back(record.id);
        ASSERT_GT(copies.size(), 1u);
        for (const VertexId n : copies)
            EXPECT_EQ(model.mesh_velocities()[n.index()].z() == 0.0, c.is_held);
    }
}

TEST(Constraints, IndexedEditByEditEqualFreshOnes) {
    for (const auto* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        Mesh mesh = Mesh::build(family->data).mesh;
        const auto all = nodes_where(mesh, [](const Vec3&) { return true; });
        test::Random random(15);
        std::vector<Constraint> constraints(3);
        for (std::size_t i = 0; i < 3; ++i) {
            std::vector<VertexId> some;
            for (const VertexId n : all)
                if (random.below(2) == 0) some.push_back(n);
            constraints[i] = holding("support " + std::to_string(i), VertexSet(some));
            for (std::size_t c = 0; c < 3; ++c) constraints[i].components[c] = c == i;
        }
        BoundaryConditions s;
        s.constraints = constraints;
        Model model(mesh, table_of_one_law(soft_law), s);
        const auto expect_equal_to_fresh_ones = [&](const ChangeSet& changes) {
            for (Constraint& constraint : constraints) constraint.nodes.apply(mesh, changes);
            const Constraints fresh({mesh, model.fragments(), model.structure().elements(),
                                     model.masses(), model.positions()},
                                    constraints);
            for (std::size_t n = 0; n < model.fragments().node_capacity(); ++n) {
                const auto *a = model.boundary().constraints().of_node(n), *b = fresh.of_node(n);
                ASSERT_EQ(a == nullptr, b == nullptr) << n;
                ASSERT_TRUE(!a || *a == *b) << n;
            }
        };
        for (int i = 0; i < 200 && mesh.num_elements() > 0; ++i) {
            const BodyEdit done = follow(model, test::random_edit(mesh, random));
            expect_equal_to_fresh_ones(done.material);
            if (random.below(3) > 0) continue;
            take_back(mesh, model, done);
            expect_equal_to_fresh_ones(inverse(done.material));
        }
    }
}

}  // namespace
}  // namespace incise::physics
