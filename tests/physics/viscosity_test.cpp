// Viscosity: relaxation, creep, loss and storage beside the solutions of linear viscoelasticity,
// and what it must keep: turning with the body, and the energy ledger.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "incise/physics/elements/viscous_kernel.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "tests/physics/test_bodies.h"
#include "tests/physics/viscous_work.h"

namespace incise::physics {
namespace {

using topology::Mesh;

/// 1 less the sum of the alphas.
double long_time_share(const Series& series) {
    double share = 1.0;
    for (const PronyTerm& term : series) share -= term.alpha;
    return share;
}

/// What is left of the stress at the time t after a sudden strain.
double relaxation(const Series& series, double t) {
    double g = long_time_share(series);
    for (const PronyTerm& term : series) g += term.alpha * std::exp(-t / term.tau);
    return g;
}

Memory no_memory(const Series& series) {
    return Memory(ViscousKernel::history_size(series.size()), 0.0);
}

/// Calls visit(name, kernel) for HEML with each law and two terms.
template <class Visit>
void for_each_viscous_kernel(Visit visit) {
    for_each_heml_kernel([&](const std::string& name, const auto& elastic) {
        visit(name, WithFibre(ViscousKernel(elastic, two_terms)));
    });
}

/// Volume times modulus over size: what the forces of a strain of one are like.
template <class Kernel>
double force_scale(const Kernel& kernel, const typename Kernel::Element& e) {
    return kernel.stiffness_energy(e) / std::cbrt(e.volume);
}

/// A unit tetrahedron of a law under a strain along x alone, by the total stress along x.
struct StrainedElement {
    ViscousKernel kernel;
    Tetrahedron X{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    ViscousKernel::Element element;
    Memory memory;
    double strain = 0.0;

    explicit StrainedElement(const Series& series)
        : kernel({soft_law, 0.4}, series),
          element(kernel.precompute(X)),
          memory(no_memory(series)) {}

    Tetrahedron at(double strain_along_x) const {
        return deformed(X, Vec3(1.0 + strain_along_x, 1.0, 1.0).asDiagonal());
    }
    /// Returns the energy taken.
    double strain_to(double next, double dt) {
        kernel.begin_step(dt);
        const double energy = kernel.advance(element, at(strain), at(next), memory);
        strain = next;
        return energy;
    }
    /// Over the modulus of strain along x.
    double stress() const {
        const auto f = kernel.forces(element, at(strain), memory);
        return -f[1].x() / kernel.stiffness_energy(element);
    }
};

TEST(SecondPiolaKirchhoff, HasTheForcesOfTheElement) {
    test::Random random(31);
    for_each_viscous_kernel([&](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        for (int i = 0; i < 50; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const auto e = kernel.precompute(X);
            const auto x = deformed(X, random_deformation(random, {0.8, 1.1, 1.3}));
            const auto f = forces_of_stress(kernel.stress(e, x), e, x);
            const auto g = HemlKernel{kernel.law, 0.4}.forces(e, x);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_LE((f[k] - g[k]).norm(), 1e-12 * force_scale(kernel, e));
        }
    });
}

TEST(SecondPiolaKirchhoff, IsFiniteAndContinuousInFlatElements) {
    for_each_viscous_kernel([&](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        const Mat3 C0 = Vec3(1.1, 0.9, 0.0).asDiagonal();
        const auto stress = [&](double J) {
            Mat3 C = C0;
            C(2, 2) = J * J / (1.1 * 0.9);
            const Mat3 twice_E = C - Mat3::Identity();
            const LinkStrain strain{twice_E.trace(), twice_E.squaredNorm(), J};
            return second_piola_kirchhoff(response(kernel.law, strain, 0.4), twice_E, J, 0.4);
        };
        EXPECT_TRUE(stress(0.0).allFinite());
        for (const double J : {-0.4, 0.0, 0.4}) {
            const auto jump = [&](double d) { return (stress(J + d) - stress(J - d)).norm(); };
            EXPECT_LE(jump(1e-9), 0.01 * jump(1e-6) + 1e-12 * stress(J).norm());
        }
    });
}

TEST(Viscosity, RelaxesAfterASuddenStrain) {
    const Mesh mesh = Mesh::build(test::jittered_cube(1, 0.1, 3)).mesh;
    for (const Series& series :
         {Series{{0.6, 0.3}}, two_terms, Series{{0.1, 0.02}, {0.2, 1.0}, {0.5, 8.0}}})
        for (const double dt : {0.01, 0.07, 1.0}) {
            // Nodes so heavy that they do not move.
            Model model(mesh,
                        table_of_one_material(HyperElasticLinks{soft_law, 0.4, series}, 1e30));
            Model elastic(mesh, table_of_one_law(soft_law, 1e30));
            test::Random random(32);
            const BodyState state = random_state(mesh, random, 0.05, 0.0);
            set_state(elastic, state);
            set_state(model, state);
            const ElementId e(0);
            const Mat3 sudden = elastic.element_result(e).cauchy_stress;
            for (int i = 0; i <= 40; ++i) {
                const double g = relaxation(series, i * dt);
                for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
                    EXPECT_LE((model.elastic_forces()[n] - g * elastic.elastic_forces()[n]).norm(),
                              1e-12 * elastic.elastic_forces()[n].norm());
                EXPECT_LE((model.element_result(e).cauchy_stress - g * sudden).norm(),
                          1e-12 * sudden.norm());
                ExplicitStep().move(model, i * dt, dt);
                model.compute_forces((i + 1) * dt);
            }
            // The long-time moduli, of which the elastic energy is.
            for (int i = 0; i < 400; ++i) ExplicitStep().move(model, 0.0, 1.0);
            model.compute_forces(0.0);
            const double share = long_time_share(series);
            EXPECT_LE((model.element_result(e).cauchy_stress - share * sudden).norm(),
                      1e-12 * sudden.norm());
            EXPECT_NEAR(model.energetics().totals().elastic_energy,
                        share * elastic.energetics().totals().elastic_energy,
                        1e-12 * elastic.energetics().totals().elastic_energy);
            EXPECT_EQ(model.stable_step(), elastic.stable_step());
        }
}

// The rule is exact for stress that is linear in time, whatever the step.
TEST(Viscosity, FollowsARampOfStrainExactly) {
    const double rise = 0.6, strain = 1e-7;
    const auto expected = [&](double t) {
        const double risen = std::min(t, rise);
        double stress = long_time_share(two_terms) * risen;
        for (const PronyTerm& term : two_terms)
            stress += term.alpha * term.tau *
                      (std::exp((risen - t) / term.tau) - std::exp(-t / term.tau));
        return stress / rise * strain;
    };
    for (const int steps_of_rise : {1, 3, 50}) {
        StrainedElement element(two_terms);
        const double dt = rise / steps_of_rise;
        for (int i = 1; i <= 4 * steps_of_rise; ++i) {
            element.strain_to(strain * std::min(1.0, static_cast<double>(i) / steps_of_rise), dt);
            EXPECT_NEAR(element.stress() / expected(i * dt), 1.0, 1e-6);
        }
    }
}

TEST(Viscosity, StoresAndLosesWhatTheSeriesSays) {
    const double amplitude = 1e-6;
    const double modulus = soft_law.rest_lambda() + 2.0 * soft_law.rest_mu();
    for (const double omega : {0.1, 1.0, 4.0, 30.0}) {
        SCOPED_TRACE(omega);
        double storage = long_time_share(two_terms), loss = 0.0;
        for (const auto& [alpha, tau] : two_terms) {
            const double x = omega * tau;
            storage += alpha * x * x / (1.0 + x * x);
            loss += alpha * x / (1.0 + x * x);
        }
        const int per_period = 400;
        const double dt = 2.0 * std::numbers::pi / omega / per_period;
        StrainedElement element(two_terms);
        const int num_periods = 10 + static_cast<int>(20.0 * 5.0 * omega / 6.0);
        double in_phase = 0.0, out_of_phase = 0.0, taken = 0.0;
        for (int i = 1; i <= num_periods * per_period; ++i) {
            const double phase = 2.0 * std::numbers::pi * i / per_period;
            const double energy = element.strain_to(amplitude * std::sin(phase), dt);
            if (i <= (num_periods - 1) * per_period) continue;
            in_phase += 2.0 / per_period * element.stress() / amplitude * std::sin(phase);
            out_of_phase += 2.0 / per_period * element.stress() / amplitude * std::cos(phase);
            taken += energy;
        }
        // Stress that is linear in each step instead of harmonic: (omega dt)^2/12 = 2e-5.
        EXPECT_NEAR(in_phase, storage, 1e-4 * storage);
        EXPECT_NEAR(out_of_phase, loss, 1e-4 * storage);
        const double cycle =
            std::numbers::pi * amplitude * amplitude * modulus * element.element.volume;
        EXPECT_NEAR(taken, loss * cycle, 1e-3 * storage * cycle);
    }
}

// Strain e(t) of a body under a sudden load is the inverse Laplace transform of 1 / (s g(s)), where
// g(s) = 1 - sum of alpha + sum of alpha s tau / (1 + s tau), times the load over Young's modulus.
TEST(Viscosity, CreepsUnderASuddenLoad) {
    const Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                     {1, 1, 1}, {1, 1, 1}))
                          .mesh;
    const double young = 5000.0, stress = 1e-4 * young;
    const SaintVenantKirchhoff stvk{0.3 * young / (1.3 * 0.4), young / 2.6};
    const Series series{{0.3, 1.0}, {0.4, 6.0}};
    const auto& [a1, t1] = series[0];
    const auto& [a2, t2] = series[1];
    const double g = long_time_share(series);
    // g(s) = P(s)/Q(s), P = p2 s^2 + p1 s + g, Q = (1 + s t1)(1 + s t2).
    const double p2 = t1 * t2, p1 = (g + a1) * t1 + (g + a2) * t2;
    const auto expected = [&](double t) {
        double e = 1.0 / g;
        for (const double sign : {-1.0, 1.0}) {
            const double s = (-p1 + sign * std::sqrt(p1 * p1 - 4.0 * p2 * g)) / (2.0 * p2);
            e += (1.0 + s * t1) * (1.0 + s * t2) / (s * (2.0 * p2 * s + p1)) * std::exp(s * t);
        }
        return e * stress / young;
    };
    EXPECT_NEAR(expected(0.0), stress / young, 1e-12);
    EXPECT_NEAR(expected(1e3), stress / young / g, 1e-12);

    BoundaryConditions s;
    s.damping = 2e4;  // of vibrations, whose frequency is about as much; its drag on creep is small
    for (int c = 0; c < 3; ++c)
        s.constraints.push_back(holding(
            "plane", VertexSet(nodes_where(mesh, [c](const Vec3& x) { return x[c] == 0.0; })),
            {c == 0, c == 1, c == 2}));
    std::vector<FaceId> loaded;
    for (const auto f : topology::boundary_faces(mesh)) {
        bool is_on_end = true;
        for (int p = 0; p < 3; ++p)
            is_on_end &= mesh.rest_position(mesh.face_corner(f, p)).x() == 1;
        if (is_on_end) loaded.push_back(f);
    }
    s.loads.push_back({"pull", TractionLoad{loaded, {stress, 0.0, 0.0}}, {}});
    Model model(mesh, table_of_one_material(HyperElasticLinks{stvk, 0.4, series}, 5e-5), s);
    const VertexId end =
        nodes_where(mesh, [](const Vec3& x) { return x == Vec3(1, 1, 1); }).front();
    double time = 0.0, next_check = 0.1;
    const double dt = 0.7 * model.stable_step();
    while (time < 8.0) {
        step(model, time, dt);
        if (time < next_check) continue;
        next_check += 0.5;
        EXPECT_NEAR((model.positions()[end.index()].x() - 1.0) / expected(time), 1.0, 1e-3) << time;
    }
}

// A body that is turned in between has the same stresses, turned, and the same memory.
TEST(Viscosity, TurnsWithTheBody) {
    test::Random random(33);
    const Mat3 quarter = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()).matrix();
    for_each_viscous_kernel([&](const std::string& name, auto kernel) {
        SCOPED_TRACE(name);
        kernel.begin_step(0.1);
        for (int i = 0; i < 20; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const auto e = kernel.precompute(X);
            std::vector<Tetrahedron> states{X};
            for (int k = 0; k < 4; ++k)
                states.push_back(deformed(X, random_deformation(random, {0.85, 1.1, 1.2})));
            states.push_back(states.back());  // held: it relaxes
            const Mat3 Q = i == 0 ? quarter : random_rotation(random);
            Memory memory = no_memory(two_terms), turned_memory = memory;
            Tetrahedron before = X;
            for (std::size_t k = 1; k < states.size(); ++k) {
                const Tetrahedron turned = k < 3 ? states[k] : deformed(states[k], Q);
                const double energy = kernel.advance(e, states[k - 1], states[k], memory);
                const double same = kernel.advance(e, before, turned, turned_memory);
                EXPECT_NEAR(energy, same, 1e-12 * kernel.stiffness_energy(e));
                before = turned;
                const auto f = kernel.forces(e, states[k], memory);
                const auto g = kernel.forces(e, turned, turned_memory);
                for (std::size_t n = 0; n < 4; ++n)
                    EXPECT_LE(((k < 3 ? Mat3(Mat3::Identity()) : Q) * f[n] - g[n]).norm(),
                              1e-12 * force_scale(kernel, e));
            }
        }
    });
}

// What advance() returns is the work done on the element less the growth of its energy, also on
// the way through a flat state and back.
TEST(Viscosity, DissipatesTheWorkMissingFromItsEnergy) {
    for_each_viscous_kernel([&](const std::string& name, auto kernel) {
        SCOPED_TRACE(name);
        const auto error = [&](int num_steps) {
            return missing_work(kernel, no_memory(two_terms), num_steps);
        };
        const double coarse = error(200), fine = error(400);
        EXPECT_LE(coarse, 1e-3);
        EXPECT_LE(fine, 0.5 * coarse + 1e-12);
    });
}

TEST(Viscosity, KeepsTheEnergyLedgerOfFreeVibration) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    BodyState start = rest_state(mesh);
    Mat3 G;
    G << 0.2, 0.1, 0.0, -0.1, -0.25, 0.15, 0.1, 0.0, 0.1;
    for (std::size_t n = 0; n < start.positions.size(); ++n)
        start.velocities[n] = G * (start.positions[n] - Vec3::Constant(0.5));
    const auto ledger_error = [&](int num_steps) {
        Model model(mesh, table_of_one_material(HyperElasticLinks{soft_law, 0.4, two_terms}));
        set_state(model, start);
        const Totals initial = model.energetics().totals();
        double time = 0.0, largest = 0.0;
        const double dt = 3.0 / num_steps;
        EXPECT_LT(dt, 0.5 * model.stable_step());
        for (int i = 0; i < num_steps; ++i) {
            step(model, time, dt);
            const Totals now = model.energetics().totals();
            largest = std::max(
                largest, std::abs(now.kinetic_energy + now.elastic_energy +
                                  model.energetics().dissipated_energy() - initial.kinetic_energy));
        }
        const Totals end = model.energetics().totals();
        double scale = 0.0;
        for (std::size_t n = 0; n < start.velocities.size(); ++n)
            scale += model.masses()[n] * start.velocities[n].norm();
        EXPECT_LE((end.momentum - initial.momentum).norm(), 1e-12 * scale);
        EXPECT_LE((end.angular_momentum - initial.angular_momentum).norm(), 1e-12 * scale);
        EXPECT_GT(model.energetics().dissipated_energy(), 0.5 * initial.kinetic_energy);
        EXPECT_LT(model.energetics().dissipated_energy(), initial.kinetic_energy);
        return largest / initial.kinetic_energy;
    };
    const double coarse = ledger_error(500), middle = ledger_error(1000), fine = ledger_error(2000);
    // Velocities half a step off, as without viscosity: first order.
    EXPECT_LE(coarse, 0.05);
    EXPECT_NEAR(coarse / middle, 2.0, 0.2);
    EXPECT_NEAR(middle / fine, 2.0, 0.2);
}

TEST(Viscosity, OfNoShareChangesNoBit) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    Model elastic(mesh, table_of_one_law(soft_law));
    Model none(mesh, table_of_one_material(HyperElasticLinks{soft_law, 0.4, {}}));
    Model zero(mesh, table_of_one_material(HyperElasticLinks{soft_law, 0.4, {{0.0, 0.1}}}));
    EXPECT_TRUE(none.state().history().is_empty());
    EXPECT_TRUE(none.state().history().values().empty());
    EXPECT_FALSE(zero.state().history().is_empty());
    test::Random random(35);
    const BodyState state = random_state(mesh, random, 0.03, 0.5);
    const double dt = 0.5 * elastic.stable_step();
    for (Model* model : {&elastic, &none, &zero}) {
        set_state(*model, state);
        double time = 0.0;
        for (int i = 0; i < 100; ++i) step(*model, time, dt);
    }
    EXPECT_EQ(state_of(none), state_of(elastic));
    EXPECT_EQ(state_of(zero), state_of(elastic));
    EXPECT_EQ(zero.energetics().totals().elastic_energy,
              elastic.energetics().totals().elastic_energy);
    EXPECT_EQ(zero.energetics().dissipated_energy(), 0.0);
}

TEST(Viscosity, ForcesAreAFunctionOfPositionsAndHistory) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    const auto table = table_of_one_material(HyperElasticLinks{soft_law, 0.4, two_terms});
    Model model(mesh, table);
    test::Random random(36);
    set_state(model, random_state(mesh, random, 0.03, 0.5));
    double time = 0.0;
    for (int i = 0; i < 10; ++i) step(model, time, 0.3 * model.stable_step());
    model.compute_forces(time);
    const std::vector<Vec3> forces(model.elastic_forces().begin(), model.elastic_forces().end());
    model.compute_forces(time);
    EXPECT_TRUE(std::ranges::equal(model.elastic_forces(), forces));
    set_state(model, state_of(model));  // no change of strain
    EXPECT_TRUE(std::ranges::equal(model.elastic_forces(), forces));
    Model other(mesh, table);
    set_state(other, state_of(model));
    other.state().change().history.set_values(model.state().history().values());
    other.compute_forces(time);
    EXPECT_TRUE(std::ranges::equal(other.elastic_forces(), forces));
}

}  // namespace
}  // namespace incise::physics
