// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/nodal_viscous_kernel.h"

#include <Eigen/LU>
#include <utility>

namespace incise::physics {

namespace {

Eigen::Map<Mat3> first_stress(std::span<double> memory, std::size_t i) {
    return Eigen::Map<Mat3>(memory.data() + 9 * i);
}
Eigen::Map<const Mat3> first_stress(std::span<const double> memory, std::size_t i) {
    return Eigen::Map<const Mat3>(memory.data() + 9 * i);
}

Mat3 sum_of_relaxing(std::span<const double> memory, std::size_t num_terms) {
    Mat3 sum = Mat3::Zero();
    for (std::size_t i = 0; i < num_terms; ++i) sum += first_stress(memory, i + 1);
    return sum;
}

}  // namespace

NodalPronyStep nodal_prony_step(const PronyTerm& term, double dt) {
    if (std::isinf(dt)) return {0.0, term.alpha};
    return {term.tau / (dt + term.tau), dt * term.alpha / (dt + term.tau)};
}

NodalViscousKernel::NodalViscousKernel(const HemlKernel& elastic, std::vector<PronyTerm> prony)
    : HemlKernel(elastic), terms(std::move(prony)), steps(terms.size()) {
    for (const PronyTerm& term : terms) long_time_share -= term.alpha;
}

NodalViscousKernel::Element NodalViscousKernel::precompute(const Corners& X,
                                                           const Vec3& fibre) const {
    const Mat3 V = edge_matrix(X);
    return {HemlKernel::precompute(X, fibre), V, V.inverse()};
}

double NodalViscousKernel::energy(const Element& e, const Corners& x) const {
    return long_time_share * HemlKernel::energy(e, x);
}

std::array<Vec3, 4> NodalViscousKernel::forces_of_memory(const Element& e, const Corners&,
                                                         std::span<const double> memory) const {
    const Mat3 relaxed =
        e.volume * (sum_of_relaxing(memory, terms.size()) * e.inverse_edges.transpose());
    return {-relaxed.rowwise().sum(), relaxed.col(0), relaxed.col(1), relaxed.col(2)};
}

std::array<Vec3, 4> NodalViscousKernel::forces(const Element& e, const Corners& x,
                                               std::span<const double> memory) const {
    Corners f = HemlKernel::forces(e, x);
    const Corners rest = forces_of_memory(e, x, memory);
    for (std::size_t k = 0; k < 4; ++k) f[k] += rest[k];
    return f;
}

NodalViscousKernel::EndOfStep NodalViscousKernel::end_of_step(std::span<const double> memory,
                                                              double dt) const {
    EndOfStep end{1.0, Mat3::Zero()};
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const NodalPronyStep rule = nodal_prony_step(terms[i], dt);
        end.share -= rule.gain;
        end.stress -= rule.decay * first_stress(memory, i + 1);
    }
    return end;
}

double NodalViscousKernel::potential(const Element& e, const Corners& x,
                                     const EndOfStep& end) const {
    return end.share * HemlKernel::energy(e, x) +
           e.volume * end.stress.cwiseProduct(edge_matrix(x) * e.inverse_edges).sum();
}

std::array<Vec3, 4> NodalViscousKernel::forces(const Element& e, const Corners& x,
                                               const EndOfStep& end) const {
    const Mat3 held = e.volume * (end.stress * e.inverse_edges.transpose());
    Corners f = HemlKernel::forces(e, x);
    for (Vec3& force : f) force *= end.share;
    for (std::size_t k = 1; k < 4; ++k) {
        const Vec3 part = held.col(static_cast<int>(k) - 1);
        f[k] -= part;
        f[0] += part;
    }
    return f;
}

void NodalViscousKernel::begin_step(double dt) {
    for (std::size_t i = 0; i < terms.size(); ++i) steps[i] = nodal_prony_step(terms[i], dt);
}

double NodalViscousKernel::advance(const Element& e, const Corners& before, const Corners& x,
                                   std::span<double> memory) const {
    const auto relaxing_stress = [&]() -> Mat3 {
        return (1.0 - long_time_share) * first_stress(memory, 0) -
               sum_of_relaxing(memory, terms.size());
    };
    Mat3 twice_mean = relaxing_stress();
    // P = -sum of f_k X_k^T / Vol: as f_k = -Vol P grad N_k and sum of grad N_k X_k^T = 1.
    const Corners f = HemlKernel::forces(e, x);
    Mat3 forces;
    forces << f[1], f[2], f[3];
    const Mat3 P = -1.0 / e.volume * (forces * e.edges.transpose());
    for (std::size_t i = 0; i < terms.size(); ++i) {
        auto gamma = first_stress(memory, i + 1);
        gamma = steps[i].decay * gamma + steps[i].gain * P;
    }
    first_stress(memory, 0) = P;
    twice_mean += relaxing_stress();
    const Mat3 dF = (edge_matrix(x) - edge_matrix(before)) * e.inverse_edges;
    return 0.5 * e.volume * twice_mean.cwiseProduct(dF).sum();
}

}  // namespace incise::physics
