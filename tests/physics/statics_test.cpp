// Equilibria found directly: equal to those that damped motion ends in, whole and cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "incise/base/error.h"
#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::CellKind;
using topology::Mesh;

VertexSet nodes_at(const Mesh& mesh, double x) {
    return VertexSet(nodes_where(mesh, [&](const Vec3& X) { return std::abs(X.x() - x) < 1e-9; }));
}

topology::ChangeSet open_across(Mesh& mesh, double x, double up_to) {
    topology::MeshEdit edit(mesh);
    for (const CellId e : living_elements(mesh))
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            bool is_chosen = mesh.neighbor({e, f}).is_valid();
            for (int p = 0; p < mesh.face_size({e, f}); ++p) {
                const Vec3& X = mesh.rest_position(mesh.face_corner({e, f}, p));
                is_chosen &= std::abs(X.x() - x) < 1e-9 && X.z() > up_to - 1e-9;
            }
            if (is_chosen) edit.open({e, f});
        }
    return edit.commit();
}

/// Held at the left, led at the right, heavy, with pressure and traction on top.
BoundaryConditions loaded(const Mesh& mesh) {
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -2.0};
    Constraint hand = holding("hand", nodes_at(mesh, 0.2));
    hand.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.02, 0.0, 0.01)}});
    hand.angle = TimeCurve<double>({{0.0, 0.0}, {1.0, 0.4}});
    hand.point = {0.2, 0.05, 0.05};
    hand.axis = Vec3::UnitX();
    s.constraints = {holding("clamp", nodes_at(mesh, 0.0)), hand};
    std::vector<FaceId> top;
    for (const FaceId f : topology::boundary_faces(mesh)) {
        bool is_top = true;
        for (int p = 0; p < mesh.face_size(f); ++p)
            is_top &= mesh.rest_position(mesh.face_corner(f, p)).z() > 0.0999;
        if (is_top) top.push_back(f);
    }
    const TimeCurve<double> growing({{0.0, 0.0}, {1.0, 1.0}});
    s.loads = {{"breath", PressureLoad{FaceSet(top), 80.0}, growing},
               {"pull", TractionLoad{FaceSet(top), {0.0, 30.0, 0.0}}, growing}};
    return s;
}

void relax(Model& model, double from, double seconds) {
    const double dt = 0.8 * model.stable_step();
    double time = from;
    while (time < from + seconds) step(model, time, dt);
}

double largest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
    double largest = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, (a[n] - b[n]).norm());
    return largest;
}

TEST(Statics, EndWhereDampedMotionEnds) {
    for (const NamedMaterial& m : materials_of_all_methods()) {
        SCOPED_TRACE(m.name);
        const Mesh mesh = bar(m.kind);
        BoundaryConditions s = loaded(mesh);
        Model still(mesh, m.table, s);
        Statics statics;
        for (int i = 0; i < 4; ++i) {
            statics.step(still, 0.25 * i, 0.25);
            still.compute_forces(0.25 * (i + 1));
        }
        s.damping = 15.0;
        Model moving(mesh, m.table, s);
        relax(moving, 0.0, 5.0);
        EXPECT_LE(largest_distance(still.positions(), moving.positions()),
                  1e-7 * moving.max_displacement());
        for (std::size_t i = 0; i < 2; ++i) {
            const double force = moving.boundary().reactions()[i].force.norm();
            EXPECT_LE(
                (still.boundary().reactions()[i].force - moving.boundary().reactions()[i].force)
                    .norm(),
                1e-6 * force);
            EXPECT_LE(
                (still.boundary().reactions()[i].torque - moving.boundary().reactions()[i].torque)
                    .norm(),
                1e-6 * force);
        }
        EXPECT_EQ(still.energetics().totals().kinetic_energy, 0.0);
        // In equilibrium constraints bear all loads.
        Vec3 all = still.boundary().reactions()[0].force + still.boundary().reactions()[1].force;
        for (const Vec3& f : still.boundary().outer_forces()) all += f;
        EXPECT_LE(all.norm(), 1e-9 * still.boundary().reactions()[0].force.norm());
    }
}

TEST(Statics, EndAlikeWheneverTheBodyIsCut) {
    for (const NamedMaterial& m : materials_of_all_methods()) {
        SCOPED_TRACE(m.name);
        std::vector<std::vector<Vec3>> ends;
        for (const bool is_cut_before : {true, false}) {
            Mesh mesh = bar(m.kind);
            if (is_cut_before) open_across(mesh, 0.1, 0.05);
            Model model(mesh, m.table, loaded(mesh));
            Statics statics;
            statics.step(model, 0.0, 0.5);
            if (!is_cut_before) {
                EXPECT_FALSE(statics.equilibrate(model, 0.5));  // nothing new
                model.apply(model.mesh(), open_across(mesh, 0.1, 0.05));
                EXPECT_TRUE(statics.equilibrate(model, 0.5));
            }
            statics.step(model, 0.5, 0.5);
            ends.emplace_back(model.positions().begin(), model.positions().end());
        }
        EXPECT_LE(largest_distance(ends[0], ends[1]), 1e-9);
    }
}

TEST(Statics, RecordTheWorkThatTheBodyKeeps) {
    const Mesh mesh = bar();
    std::vector<double> errors;
    for (const int num_steps : {4, 8}) {
        BoundaryConditions s = loaded(mesh);
        s.gravity = Vec3::Zero();
        Model model(mesh, table_of_one_law(soft_law), s);
        Statics statics;
        for (int i = 0; i < num_steps; ++i)
            statics.step(model, i / double(num_steps), 1.0 / num_steps);
        const double kept = model.energetics().elastic_energy();
        errors.push_back(std::abs(model.energetics().external_work() - kept) / kept);
        EXPECT_NEAR(model.energetics().dissipated_energy(), 0.0, 1e-9 * kept);
    }
    EXPECT_LT(errors[0], 5e-3);
    EXPECT_NEAR(errors[0] / errors[1], 4.0, 1.0);  // of second order
}

TEST(Statics, RecordWhatACutReleasesAsDissipated) {
    Mesh mesh = bar();
    BoundaryConditions s = loaded(mesh);
    s.gravity = Vec3::Zero();
    s.loads.clear();
    Model model(mesh, table_of_one_law(soft_law), s);
    Statics statics;
    statics.step(model, 0.0, 1.0);
    const double before = model.energetics().elastic_energy(),
                 work = model.energetics().external_work(),
                 dissipated = model.energetics().dissipated_energy();
    model.apply(model.mesh(), open_across(mesh, 0.1, 0.05));
    statics.equilibrate(model, 1.0);
    const double lost = before - model.energetics().elastic_energy();
    EXPECT_GT(lost, 0.05 * before);
    EXPECT_EQ(model.energetics().external_work(), work);  // constraints stand still
    EXPECT_NEAR(model.energetics().dissipated_energy() - dissipated, lost, 0.02 * lost);
}

TEST(Statics, LeaveFreeComponentsAndRefusePushedOnes) {
    Mesh mesh = bar();
    open_across(mesh, 0.1, 0.0);  // all through
    BoundaryConditions s;
    s.constraints = {holding("clamp", nodes_at(mesh, 0.0))};
    {
        Model model(mesh, table_of_one_law(soft_law), s);
        BodyState state = rest_state(mesh);
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
            if (mesh.rest_position(VertexId(n)).x() > 0.1001) state.positions[n].y() += 0.3;
        set_state(model, state);
        Statics statics;
        statics.step(model, 0.0, 1.0);
        // The free half has its shape again, about where it was; the other is as at rest.
        EXPECT_LE(model.energetics().totals().elastic_energy, 1e-12);
        EXPECT_NEAR(model.energetics().totals().centre_of_mass.y(), 0.05 + 0.15, 0.08);
        EXPECT_LE(model.boundary().reactions()[0].force.norm(), 1e-6);
    }
    s.gravity = {0.0, 0.0, -1.0};
    Model model(mesh, table_of_one_law(soft_law), s);
    Statics statics;
    try {
        statics.step(model, 0.0, 1.0);
        FAIL() << "the piece should fall";
    } catch (const PhysicsError& error) {
        EXPECT_NE(std::string(error.what()).find("a piece of 48 elements"), std::string::npos)
            << error.what();
        EXPECT_NE(std::string(error.what()).find("push it with 1 N along"), std::string::npos)
            << error.what();
    }
}

// A piece held at one edge hangs there like a door that nothing turns; led away it comes along.
TEST(Statics, LeadAComponentThatIsHeldInPart) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    Constraint tongs = holding(
        "tongs",
        VertexSet(nodes_where(mesh, [](const Vec3& X) { return X.x() == 0.0 && X.y() == 0.0; })));
    tongs.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.5, -0.3, 0.4)}});
    s.constraints = {tongs};
    Model model(mesh, table_of_one_law(soft_law), s);
    Statics statics;
    for (int i = 0; i < 2; ++i) statics.step(model, 0.5 * i, 0.5);
    EXPECT_LE(model.energetics().totals().elastic_energy, 1e-12);
    EXPECT_LE((model.energetics().totals().centre_of_mass - Vec3(0.6, -0.25, 0.45)).norm(), 1e-6);
}

// Held in z only, on ice: it may slide and turn about z, and nothing makes it do so.
TEST(Statics, FindTheEquilibriumOfBodiesFreeToSlide) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -5.0};
    s.constraints = {
        holding("ice", VertexSet(nodes_where(mesh, [](const Vec3& X) { return X.z() == 0.0; })),
                {false, false, true})};
    Model model(mesh, table_of_one_law(soft_law), s);
    Statics statics;
    statics.step(model, 0.0, 1.0);
    EXPECT_NEAR(model.boundary().reactions()[0].force.z(), 10.0, 1e-8);
    EXPECT_GT(model.max_displacement(), 1e-4);
    s.gravity.x() = 0.1;
    Model sliding(mesh, table_of_one_law(soft_law), s);
    EXPECT_THROW(Statics().step(sliding, 0.0, 1.0), PhysicsError);
}

// Far beyond its buckling load a column is pressed together; tangents are indefinite on the way.
TEST(Statics, FindAStableStateOfABucklingColumn) {
    const Mesh mesh = Mesh::build(topology::box_mesh(CellKind::tetrahedron, Vec3::Zero(),
                                                     {0.4, 0.04, 0.04}, {16, 2, 2}))
                          .mesh;
    BoundaryConditions s;
    Constraint press = holding("press", nodes_at(mesh, 0.4));
    press.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(-0.12, 0, 0)}});
    s.constraints = {holding("base", nodes_at(mesh, 0.0)), press};
    Model model(mesh, table_of_one_law(soft_law), s);
    Statics statics;
    for (int i = 0; i < 5; ++i) statics.step(model, 0.2 * i, 0.2);
    EXPECT_GT(model.energetics().min_volume_ratio(), 0.5);
    double aside = 0.0;
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
        aside = std::max(aside, (model.positions()[n] - mesh.rest_positions()[n]).tail<2>().norm());
    EXPECT_GT(aside, 0.05);
}

TEST(Statics, LeadABodyThatIsHeldAllOver) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    Constraint all = holding("all", VertexSet(nodes_where(mesh, [](const Vec3&) { return true; })));
    all.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.1, 0, 0)}});
    s.constraints = {all};
    Model model(mesh, table_of_one_law(soft_law), s);
    Statics().step(model, 0.0, 1.0);
    EXPECT_NEAR(model.max_displacement(), 0.1, 1e-15);
}

TEST(Statics, SayWhereNoEquilibriumIs) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    s.constraints = {holding("clamp", nodes_at(mesh, 0.0))};
    s.gravity = {std::numeric_limits<double>::infinity(), 0.0, 0.0};
    Model model(mesh, table_of_one_law(soft_law), s);
    Statics statics;
    try {
        statics.step(model, 0.5, 1.0);
        FAIL();
    } catch (const PhysicsError& error) {
        EXPECT_NE(std::string(error.what()).find("no equilibrium found at load time"),
                  std::string::npos)
            << error.what();
    }
}

TEST(LoadTangents, AreTheSymmetricPartOfThePressureDerivative) {
    for (const CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
        const Mesh mesh =
            Mesh::build(topology::box_mesh(kind, Vec3::Zero(), {1, 1, 1}, {1, 1, 1})).mesh;
        const auto table = kind == CellKind::tetrahedron
                               ? table_of_one_law(soft_law)
                               : table_of_one_material(HybridSprings{3e3, 1e4, 1.0});
        BoundaryConditions s;
        s.loads = {{"", PressureLoad{FaceSet({topology::boundary_faces(mesh)[1]}), 100.0}, {}}};
        const Model model(mesh, table, s);
        const std::size_t size = 3 * mesh.node_capacity();
        struct Dense final : TangentSink {
            Eigen::MatrixXd K;
            void add(std::span<const std::uint32_t> nodes, std::span<const double> k) override {
                for (std::size_t j = 0; j < 3 * nodes.size(); ++j)
                    for (std::size_t i = 0; i < 3 * nodes.size(); ++i)
                        K(3 * nodes[i / 3] + i % 3, 3 * nodes[j / 3] + j % 3) +=
                            k[j * 3 * nodes.size() + i];
            }
        } found;
        found.K.setZero(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
        test::Random random(1);
        std::vector<Vec3> x = random_state(mesh, random, 0.1, 0.0).positions;
        model.boundary().visit_tangents(x, 0.0, found);
        Eigen::MatrixXd expected(size, size);
        std::vector<Vec3> up(x.size()), down(x.size());
        for (std::size_t j = 0; j < size; ++j) {
            const double h = 0.1;  // forces are quadratic: central differences are exact
            auto& at = x[j / 3][static_cast<Eigen::Index>(j % 3)];
            at += h;
            model.boundary().outer_forces_at(x, 0.0, model.workers(), up);
            at -= 2 * h;
            model.boundary().outer_forces_at(x, 0.0, model.workers(), down);
            at += h;
            for (std::size_t i = 0; i < size; ++i)
                expected(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                    -(up[i / 3] - down[i / 3])[static_cast<Eigen::Index>(i % 3)] / (2 * h);
        }
        const Eigen::MatrixXd symmetric = 0.5 * (expected + expected.transpose());
        EXPECT_GT(symmetric.norm(), 1.0);
        EXPECT_LE((found.K - symmetric).norm(), 1e-10 * symmetric.norm());
    }
}

}  // namespace
}  // namespace incise::physics
