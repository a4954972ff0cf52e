// What free and driven motion keeps: momenta, energy within the integrator's order, the ledger.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::Mesh;

// Long runs that stay well within the range where each law is a material; speeds give as much
// kinetic as elastic energy.
BodyState swinging_state(const Mesh& mesh) {
    test::Random random(12);
    BodyState state = rest_state(mesh);
    Mat3 F = Mat3::Identity(), G = Mat3::Zero();
    for (int c = 0; c < 3; ++c) {
        F.col(c) += random.vector(0.15);
        G.col(c) += random.vector(0.3);
    }
    for (std::size_t n = 0; n < state.positions.size(); ++n) {
        state.velocities[n] = G * state.positions[n] + Vec3(0.3, -0.2, 0.1);
        state.positions[n] = F * state.positions[n];
    }
    return state;
}

/// The energies of a run, each a different way to meet positions and velocities, which semi-
/// implicit Euler knows half a step apart.
struct EnergyRecord {
    std::vector<double> staggered;  ///< W(x_n) + 1/2 sum m v_n . v_{n+1}
    std::vector<double> raw;        ///< W(x_n) + T(v_n)
    std::vector<double> mean;       ///< W(x_n) + T((v_n + v_{n+1})/2)
};

EnergyRecord run(Model& model, double dt, int num_steps) {
    EnergyRecord record;
    double time = 0.0;
    std::vector<Vec3> before;
    for (int i = 0; i < num_steps; ++i) {
        const double W = model.totals().elastic_energy;
        before.assign(model.velocities().begin(), model.velocities().end());
        step(model, time, dt);
        double staggered = 0.0, raw = 0.0, mean = 0.0;
        for (std::size_t n = 0; n < before.size(); ++n) {
            const double m = model.masses()[n];
            const Vec3 &v = before[n], &w = model.velocities()[n];
            staggered += 0.5 * m * v.dot(w);
            raw += 0.5 * m * v.squaredNorm();
            mean += 0.125 * m * (v + w).squaredNorm();
        }
        record.staggered.push_back(W + staggered);
        record.raw.push_back(W + raw);
        record.mean.push_back(W + mean);
    }
    return record;
}

double swing(std::span<const double> energies) {
    const auto [low, high] = std::minmax_element(energies.begin(), energies.end());
    return *high - *low;
}
double average(std::span<const double> energies) {
    double sum = 0.0;
    for (const double e : energies) sum += e;
    return sum / static_cast<double>(energies.size());
}

struct FreeRun {
    const char* name;
    Law law;
    int num_steps;
};

TEST(FreeMotion, KeepsMomentaAndDoesNotDriftInEnergy) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    for (const FreeRun& free : {FreeRun{"neo-Hookean", NeoHookean{1923.0, 5769.0}, 100'000},
                                FreeRun{"Mooney-Rivlin", MooneyRivlin{1346.0, 577.0, 3462.0}, 20'000},
                                FreeRun{"Saint Venant-Kirchhoff", SaintVenantKirchhoff{5769.0, 3846.0},
                                        20'000}}) {
        SCOPED_TRACE(free.name);
        Model model(mesh, table_of_one_law(free.law));
        set_state(model, swinging_state(mesh));
        const Totals start = model.totals();
        double momentum_scale = 0.0, angular_scale = 0.0;
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
            const double p = model.masses()[n] * model.velocities()[n].norm();
            momentum_scale += p;
            angular_scale += p * model.positions()[n].norm();
        }
        const EnergyRecord record = run(model, 0.5 * model.stable_step(), free.num_steps);
        const Totals end = model.totals();
        // Round-off of each step, adding up as a random walk does.
        const double round_off = 1e-15 * std::sqrt(free.num_steps);
        EXPECT_LE((end.momentum - start.momentum).norm(), round_off * momentum_scale);
        EXPECT_LE((end.angular_momentum - start.angular_momentum).norm(),
                  20 * round_off * angular_scale);

        const std::span<const double> energies = record.staggered;
        const auto first = energies.first(energies.size() / 2), second = energies.last(first.size());
        const double energy = average(energies);
        EXPECT_LE(swing(energies), 3e-3 * energy);
        EXPECT_LE(std::abs(average(second) - average(first)), 0.1 * swing(energies));
        EXPECT_LE(swing(second), 1.5 * swing(first));
        RecordProperty(std::string(free.name).substr(0, 4), std::to_string(swing(energies) / energy));
    }
}

TEST(FreeMotion, MeetsTheOrderOfTheIntegrator) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    Model model(mesh, table_of_one_law(NeoHookean{1923.0, 5769.0}));
    const double dt = 0.25 * model.stable_step();
    const auto swings = [&](double step_size, int num_steps) {
        set_state(model, swinging_state(mesh));
        const EnergyRecord record = run(model, step_size, num_steps);
        return std::array{swing(record.raw), swing(record.mean), swing(record.staggered)};
    };
    const auto coarse = swings(dt, 2000), fine = swings(0.5 * dt, 4000);
    EXPECT_NEAR(coarse[0] / fine[0], 2.0, 0.2);  // velocities half a step off: first order
    EXPECT_NEAR(coarse[1] / fine[1], 4.0, 0.5);  // centred: second order
    EXPECT_LT(coarse[2], 0.2 * coarse[0]);
}

TEST(FreeMotion, TakesFromGravityWhatItsEnergyLoses) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    Surroundings s;
    s.gravity = {1.0, -2.0, -9.81};
    Model model(mesh, table_of_one_law(NeoHookean{1923.0, 5769.0}), s);
    set_state(model, swinging_state(mesh));
    const double start = model.totals().gravity_energy;
    const Vec3 momentum = model.totals().momentum;
    double time = 0.0;
    const double dt = 0.5 * model.stable_step();
    double path = 0.0;  // of work, up and down
    for (int i = 0; i < 2000; ++i) {
        const double before = model.external_work();
        step(model, time, dt);
        path += std::abs(model.external_work() - before);
    }
    EXPECT_NEAR(model.external_work(), start - model.totals().gravity_energy, 1e-13 * path);
    EXPECT_EQ(model.dissipated_energy(), 0.0);
    const Totals end = model.totals();
    EXPECT_LE((end.momentum - momentum - end.mass * time * s.gravity).norm(),
              1e-12 * end.mass * time * s.gravity.norm());
}

// Everything at once: gravity, a moving support, loads, damping. Energy gained is work done less
// what damping took, up to an error of first order in the step.
TEST(DrivenMotion, KeepsTheEnergyLedger) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    const auto ledger_error = [&](double share_of_stable_step) {
        Surroundings s;
        s.gravity = {0.0, 0.5, -2.0};
        s.damping = 1.5;
        Support support = holding(
            "hand", NodeSet(nodes_where(mesh, [](const Vec3& x) { return x.z() == 0; })));
        // Smooth from rest: the kinks of linear keys have an error of their own.
        std::vector<std::pair<double, Vec3>> keys;
        for (int i = 0; i <= 2000; ++i) {
            const double t = 1e-3 * i;
            keys.emplace_back(t, 0.1 * std::pow(std::sin(t), 2) * Vec3(1.0, 0.0, 2.0));
        }
        support.displacement = TimeCurve<Vec3>(keys);
        s.supports.push_back(support);
        s.loads.push_back({"gas", PressureLoad{topology::boundary_faces(mesh), 200.0}, {}});
        Model model(mesh, table_of_one_law(NeoHookean{1923.0, 5769.0}), s);
        double time = 0.0;
        const double dt = share_of_stable_step * model.stable_step();
        const int num_steps = static_cast<int>(std::round(2.0 / dt));
        for (int i = 0; i < num_steps; ++i) step(model, time, dt);
        const Totals end = model.totals();
        EXPECT_GT(model.dissipated_energy(), 0.0);
        return (end.kinetic_energy + end.elastic_energy - model.external_work() +
                model.dissipated_energy()) /
               (std::abs(model.external_work()) + model.dissipated_energy());
    };
    const double coarse = ledger_error(0.2), middle = ledger_error(0.1), fine = ledger_error(0.05);
    EXPECT_LE(std::abs(coarse), 0.05);
    EXPECT_NEAR(coarse / middle, 2.0, 0.4);
    EXPECT_NEAR(middle / fine, 2.0, 0.2);
}

TEST(DampedMotion, LosesMomentumAtItsRate) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    Surroundings s;
    s.damping = 3.0;
    Model model(mesh, table_of_one_law(NeoHookean{1923.0, 5769.0}), s);
    set_state(model, swinging_state(mesh));
    const Vec3 start = model.totals().momentum;
    double time = 0.0;
    const double dt = 0.5 * model.stable_step();
    for (int i = 0; i < 100; ++i) step(model, time, dt);
    // Implicitly damped: each step divides by 1 + c dt.
    const Vec3 expected = start * std::pow(1.0 + s.damping * dt, -100);
    EXPECT_LE((model.totals().momentum - expected).norm(), 1e-12 * start.norm());
}

}  // namespace
}  // namespace incise::physics
