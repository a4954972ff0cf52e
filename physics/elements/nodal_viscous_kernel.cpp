// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/nodal_viscous_kernel.h"

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

double NodalViscousKernel::energy(const Element& e, const Corners& x) const {
    return long_time_share * HemlKernel::energy(e, x);
}

std::array<Vec3, 4> NodalViscousKernel::forces_of_memory(const Element& e, const Corners&,
                                                         std::span<const double> memory) const {
    return forces_of_first_stress(e, -sum_of_relaxing(memory, terms.size()));
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
           e.volume * end.stress.cwiseProduct(displacement_gradient(e, x)).sum();
}

std::array<Vec3, 4> NodalViscousKernel::forces(const Element& e, const Corners& x,
                                               const EndOfStep& end) const {
    return forces_of_first_stress(e, end.share * first_piola_kirchhoff(e, x) + end.stress);
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
    const Mat3 P = first_piola_kirchhoff(e, x);
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
