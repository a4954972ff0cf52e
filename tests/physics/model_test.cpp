// A body at rest, its masses and totals, what it refuses, and how it fails.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "incise/base/archive.h"
#include "incise/base/error.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/physics/solve/solved_step.h"
#include "incise/topology/box_mesh.h"
#include "tests/physics/model_snapshot.h"

namespace incise::physics {
namespace {

using topology::CellKind;
using topology::Mesh;

std::string message_of(const auto& action) {
    try {
        action();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "nothing was thrown";
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Model, StartsAtRestWithoutForces) {
    const auto table = table_of_all_materials();
    for (const auto* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        const Mesh mesh = Mesh::build(with_regions(family->data, table.materials.size())).mesh;
        const Model model(mesh, table);
        EXPECT_EQ(state_of(model), rest_state(mesh));
        for (const Vec3& f : model.elastic_forces()) EXPECT_LE(f.norm(), 1e-9);  // of some kPa
        const Totals totals = model.energetics().totals();
        EXPECT_EQ(totals.elastic_energy, 0.0);
        EXPECT_EQ(totals.kinetic_energy, 0.0);
        EXPECT_EQ(model.energetics().min_volume_ratio(), 1.0);
    }
}

TEST(LumpedMass, GivesEachCornerAQuarterOfAnElement) {
    const auto table = table_of_all_materials();
    for (const auto* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        const Mesh mesh = Mesh::build(with_regions(family->data, table.materials.size())).mesh;
        const Model model(mesh, table);
        std::vector<double> masses(mesh.node_capacity(), 0.0);
        double mass = 0.0, volume = 0.0;
        for (const CellId e : living_elements(mesh)) {
            std::array<Vec3, 4> X;
            for (std::size_t k = 0; k < 4; ++k) X[k] = mesh.rest_position(mesh.corners(e)[k]);
            const double element_volume = topology::tetrahedron_volume(X[0], X[1], X[2], X[3]);
            const double density =
                table.materials[static_cast<std::size_t>(mesh.region(e))].density;
            volume += element_volume;
            mass += density * element_volume;
            for (const VertexId n : mesh.corners(e))
                masses[n.index()] += 0.25 * density * element_volume;
        }
        for (std::size_t n = 0; n < masses.size(); ++n)
            EXPECT_NEAR(model.masses()[n], masses[n], 1e-14 * mass);
        EXPECT_NEAR(model.energetics().totals().mass, mass, 1e-14 * mass);
        EXPECT_NEAR(model.energetics().totals().rest_volume, volume, 1e-14 * volume);
    }
}

TEST(Model, SumsTheForcesOfItsElements) {
    const auto table = table_of_all_materials();
    const Mesh mesh =
        Mesh::build(with_regions(test::jittered_cube(3, 0.2, 2), table.materials.size())).mesh;
    Model model(mesh, table);
    test::Random random(4);
    const BodyState state = random_state(mesh, random, 0.02, 0.0);
    set_state(model, state);
    // Forces of the whole body are minus the gradient of its energy. Its third derivative jumps
    // where fibres become slack: steps as short as round-off lets them be.
    const double h = 1e-5;
    double largest = 0.0;
    for (const Vec3& f : model.elastic_forces()) largest = std::max(largest, f.norm());
    const std::vector<Vec3> forces(model.elastic_forces().begin(), model.elastic_forces().end());
    for (std::size_t n = 0; n < mesh.node_capacity(); n += 5)
        for (int c = 0; c < 3; ++c) {
            const auto energy = [&](double d) {
                BodyState moved = state;
                moved.positions[n][c] += d;
                set_state(model, moved);
                return model.energetics().totals().elastic_energy;
            };
            const double slope =
                (8.0 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12.0 * h);
            EXPECT_NEAR(forces[n][c], -slope, 1e-8 * largest);
        }
}

// Its forces are in floats, what is asked of it now and then is not.
TEST(Model, HasTheEnergyOfDoublesInSinglePrecision) {
    auto table = table_of_all_materials();
    ASSERT_TRUE(std::holds_alternative<MassSprings>(table.materials.back().method));
    table.materials.pop_back();  // which has no forces in floats
    const Mesh mesh =
        Mesh::build(with_regions(test::jittered_cube(3, 0.2, 2), table.materials.size())).mesh;
    Model in_doubles(mesh, table);
    table.precision = Precision::single_precision;
    Model in_floats(mesh, table);
    test::Random random(4);
    const BodyState state = random_state(mesh, random, 0.02, 0.0);
    set_state(in_doubles, state);
    set_state(in_floats, state);
    EXPECT_NE(in_floats.elastic_forces()[0], in_doubles.elastic_forces()[0]);
    EXPECT_EQ(in_floats.energetics().elastic_energy(), in_doubles.energetics().elastic_energy());
    EXPECT_EQ(in_floats.energetics().min_volume_ratio(),
              in_doubles.energetics().min_volume_ratio());
}

// Blocks keep energies, ranges of nodes their sums while nothing moves, and forces may be computed
// ahead; edits_test.cpp has those of edited bodies.
TEST(Model, HasTotalsAndForcesOfItsPresentState) {
    const topology::MeshData cube = test::jittered_cube(3, 0.2, 2);
    const auto table = table_for(cube);
    const Mesh mesh = Mesh::build(with_regions(cube, table.materials.size())).mesh;
    Model model(mesh, table);
    test::Random random(4);
    const BodyState start = random_state(mesh, random, 0.02, 1.0);
    Totals last = model.energetics().totals();
    const auto compute_ahead = [&] {
        model.state().change().history.set_values(
            model.state().history().values());  // nothing is known any more
        model.compute_totals_and_forces();
    };
    const auto expect_present = [&](const char* what) {
        SCOPED_TRACE(what);
        Model fresh(mesh, table);
        set_state(fresh, state_of(model));
        fresh.state().change().history.set_values(model.state().history().values());
        fresh.compute_forces(0.0);
        model.compute_forces(0.0);
        EXPECT_TRUE(std::ranges::equal(model.elastic_forces(), fresh.elastic_forces()));
        compute_ahead();
        model.compute_forces(0.0);
        EXPECT_TRUE(std::ranges::equal(model.elastic_forces(), fresh.elastic_forces()));
        EXPECT_EQ(figures_of(model.energetics().totals()), figures_of(fresh.energetics().totals()));
        EXPECT_NE(model.energetics().totals().elastic_energy, last.elastic_energy);
        EXPECT_NE(model.energetics().totals().kinetic_energy, last.kinetic_energy);
        last = model.energetics().totals();
        compute_ahead();  // in vain: the state is another next
    };
    set_state(model, start);
    expect_present("set");
    ArchiveWriter archive;
    model.save(archive);
    const auto saved_figures = figures_of(model.energetics().totals());
    const std::vector<Vec3> saved_forces(model.elastic_forces().begin(),
                                         model.elastic_forces().end());
    ExplicitStep().move(model, 0.0, 0.1 * model.stable_step());
    expect_present("integrated");
    BodyState next = state_of(model);
    for (Vec3& x : next.positions) x += random.vector(0.001);
    for (Vec3& v : next.velocities) v += random.vector(0.1);
    const std::vector<Vec3> reactions(next.positions.size(), Vec3::Zero());
    take_solved_step(model, next.positions, next.velocities, reactions, 1e-4);
    expect_present("step taken");
    ArchiveReader reader(archive.bytes());
    const Model restored(mesh, table, reader, 0.0);
    EXPECT_EQ(figures_of(restored.energetics().totals()), saved_figures);
    EXPECT_TRUE(std::ranges::equal(restored.elastic_forces(), saved_forces));
}

TEST(Model, ReportsTotalsOfARigidMotion) {
    const Mesh mesh =
        Mesh::build(topology::box_mesh(CellKind::tetrahedron, {1, 2, 3}, {2, 2, 2}, {2, 2, 2}))
            .mesh;
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -10.0};
    Model model(mesh, table_of_one_law(NeoHookean{1e3, 1e3}, 500.0), s);
    BodyState state = rest_state(mesh);
    const Vec3 velocity(1.0, 2.0, -1.0);
    for (Vec3& v : state.velocities) v = velocity;
    set_state(model, state);
    const Totals totals = model.energetics().totals();
    const double mass = 500.0 * 8.0;
    const Vec3 centre(2.0, 3.0, 4.0);
    EXPECT_NEAR(totals.mass, mass, 1e-12 * mass);
    EXPECT_NEAR(totals.kinetic_energy, 0.5 * mass * 6.0, 1e-12 * mass);
    EXPECT_NEAR(totals.gravity_energy, mass * 10.0 * 4.0, 1e-11 * mass);
    EXPECT_LE((totals.momentum - mass * velocity).norm(), 1e-12 * mass);
    // By symmetry the lumped masses have the centre of the box for theirs.
    EXPECT_LE((totals.angular_momentum - centre.cross(mass * velocity)).norm(), 1e-11 * mass);
}

TEST(Model, HasTheEnergyOfTheGravityThatItHasNow) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    Model model(mesh, table_of_one_law(soft_law));
    EXPECT_EQ(model.energetics().totals().gravity_energy, 0.0);
    model.boundary().set_gravity({0.0, 0.0, -10.0});
    const Totals totals = model.energetics().totals();
    EXPECT_NEAR(totals.gravity_energy, 10.0 * totals.mass * totals.centre_of_mass.z(),
                1e-12 * totals.mass);
    EXPECT_NE(totals.gravity_energy, 0.0);
}

TEST(Model, RefusesARegionWithoutMaterial) {
    auto data = test::jittered_cube(2, 0.0, 1);
    data.regions[17] = 42;
    const Mesh mesh = Mesh::build(data).mesh;
    const auto table = table_of_one_law(NeoHookean{1e3, 1e3});
    EXPECT_THROW(Model(mesh, table), InputError);
    const std::string text = message_of([&] { Model(mesh, table); });
    EXPECT_TRUE(has(text, "element 17")) << text;
    EXPECT_TRUE(has(text, "region 42")) << text;
}

TEST(Model, RefusesCellsThatItsMethodDoesNotTake) {
    for (const char* name : {"hexahedra", "mixed"})
        for (const auto& family : test::mesh_families()) {
            if (family.name != name) continue;
            auto data = family.data;
            std::fill(data.regions.begin(), data.regions.end(), 0);
            const Mesh mesh = Mesh::build(data).mesh;
            EXPECT_NO_THROW(Model(mesh, table_of_one_law(soft_law)));
            const std::vector<PronyTerm> prony{{0.3, 0.05}};
            for (const auto& table : {table_of_one_material(MassSprings{8e3}),
                                      table_of_one_material(HyperElasticLinks{soft_law, 0.4, prony,
                                                                              PronyRule::nodal})}) {
                const std::string text = message_of([&] { Model(mesh, table); });
                EXPECT_TRUE(has(text, "element ") && has(text, "needs tetrahedra")) << text;
            }
        }
}

TEST(Model, RefusesMassSpringsInSinglePrecision) {
    MaterialTable table = table_of_one_material(MassSprings{1e4});
    table.precision = Precision::single_precision;
    const Mesh mesh = bar();
    EXPECT_TRUE(has(message_of([&] { Model(mesh, table); }),
                    "mass springs have no forces in single precision"));
}

TEST(Model, NamesAnElementOfANonFiniteState) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    Model model(mesh, table_of_one_law(NeoHookean{1e3, 1e3}));
    BodyState state = rest_state(mesh);
    state.velocities[3].y() = std::numeric_limits<double>::quiet_NaN();
    set_state(model, state);
    EXPECT_THROW(ExplicitStep().move(model, 0.0, 1e-3), PhysicsError);
    set_state(model, state);
    const std::string text = message_of([&] { ExplicitStep().move(model, 0.0, 1e-3); });
    EXPECT_TRUE(has(text, "no longer at a finite place")) << text;
    EXPECT_TRUE(
        has(text, "element " + std::to_string(mesh.label(mesh.incident_element(VertexId(3))))))
        << text;
    EXPECT_TRUE(has(text, "node " + std::to_string(mesh.label(VertexId(3))))) << text;
}

TEST(Model, GivesTheSameBitsEachTime) {
    const auto table = table_of_all_materials();
    const Mesh mesh =
        Mesh::build(with_regions(test::jittered_cube(3, 0.2, 2), table.materials.size())).mesh;
    const auto run = [&] {
        Model model(mesh, table);
        test::Random random(4);
        set_state(model, random_state(mesh, random, 0.0, 0.5));
        double time = 0.0;
        for (int i = 0; i < 100; ++i) step(model, time, 0.5 * model.stable_step());
        return state_of(model);
    };
    EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace incise::physics
