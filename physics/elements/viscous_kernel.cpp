// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/viscous_kernel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/physics/elements/symmetric_tensor.h"

namespace incise::physics {

namespace {

SymmetricTensor sum_of_terms(std::span<const double> memory, std::size_t num_terms) {
    SymmetricTensor sum = SymmetricTensor::Zero();
    for (std::size_t i = 0; i < num_terms; ++i) sum += tensor(memory, i + 1);
    return sum;
}

/// Returns the work done against the mean of the forces f and g on a motion from `before` to x, J.
double work_against(const std::array<Vec3, 4>& f, const std::array<Vec3, 4>& g,
                    const std::array<Vec3, 4>& before, const std::array<Vec3, 4>& x) {
    double work = 0.0;
    for (std::size_t k = 0; k < 4; ++k) work -= 0.5 * (f[k] + g[k]).dot(x[k] - before[k]);
    return work;
}

}  // namespace

Mat3 second_piola_kirchhoff(const LawResponse<double>& r, const Mat3& twice_strain, double J,
                            double J0, const Vec3& fibre) {
    Mat3 S = second_stress_without_volume(r, twice_strain, fibre);
    if (r.w_J == 0.0) return S;
    const Mat3 C = Mat3::Identity() + twice_strain;
    return S + r.w_J * J / std::max(J * J, J0 * J0) * cofactors(C);
}

std::array<Vec3, 4> forces_of_stress(const Mat3& S, const LinkElement& e,
                                     const std::array<Vec3, 4>& x) {
    return forces_of_first_stress(e, (Mat3::Identity() + displacement_gradient(e, x)) * S);
}

PronyStep prony_step(const PronyTerm& term, double dt) {
    const double x = dt / term.tau;
    return {std::exp(-x), x == 0.0 ? term.alpha : term.alpha * (-std::expm1(-x) / x)};
}

ViscousKernel::ViscousKernel(const HemlKernel& elastic, std::vector<PronyTerm> prony)
    : HemlKernel(elastic), terms(std::move(prony)), steps(terms.size()) {
    for (const PronyTerm& term : terms) long_time_share -= term.alpha;
}

double ViscousKernel::energy(const Element& e, const Corners& x) const {
    return long_time_share * HemlKernel::energy(e, x);
}

std::array<Vec3, 4> ViscousKernel::forces_of_memory(const Element& e, const Corners& x,
                                                    std::span<const double> memory) const {
    const SymmetricTensor relaxed =
        sum_of_terms(memory, terms.size()) - (1.0 - long_time_share) * tensor(memory, 0);
    return forces_of_stress(matrix_of(relaxed), e, x);
}

std::array<Vec3, 4> ViscousKernel::forces(const Element& e, const Corners& x,
                                          std::span<const double> memory) const {
    Corners f = HemlKernel::forces(e, x);
    const Corners rest = forces_of_memory(e, x, memory);
    for (std::size_t k = 0; k < 4; ++k) f[k] += rest[k];
    return f;
}

Mat3 ViscousKernel::stress(const Element& e, const Corners& x) const {
    const Deformation d = deformation(e, x);
    const LawResponse<double> r = response(law, d.strain, inversion_threshold);
    return second_piola_kirchhoff(r, d.twice_strain, d.strain.J, inversion_threshold, e.fibre);
}

ViscousKernel::EndOfStep ViscousKernel::end_of_step(std::span<const double> memory,
                                                    double dt) const {
    double share = long_time_share;
    SymmetricTensor stress = SymmetricTensor::Zero();
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const PronyStep rule = prony_step(terms[i], dt);
        share += rule.gain;
        stress += rule.decay * tensor(memory, i + 1) - rule.gain * tensor(memory, 0);
    }
    return {share, matrix_of(stress)};
}

double ViscousKernel::potential(const Element& e, const Corners& x, const EndOfStep& end) const {
    return end.share * HemlKernel::energy(e, x) +
           0.5 * e.volume * end.stress.cwiseProduct(deformation(e, x).twice_strain).sum();
}

std::array<Vec3, 4> ViscousKernel::forces(const Element& e, const Corners& x,
                                          const EndOfStep& end) const {
    const Corners elastic = HemlKernel::forces(e, x);
    Corners f = forces_of_stress(end.stress, e, x);
    for (std::size_t k = 0; k < 4; ++k) f[k] += end.share * elastic[k];
    return f;
}

void ViscousKernel::begin_step(double dt) {
    for (std::size_t i = 0; i < terms.size(); ++i) steps[i] = prony_step(terms[i], dt);
}

double ViscousKernel::advance(const Element& e, const Corners& before, const Corners& x,
                              std::span<double> memory) const {
    const auto follow = [&] {
        const SymmetricTensor S = symmetric_tensor(stress(e, x));
        for (std::size_t i = 0; i < terms.size(); ++i) {
            auto H = tensor(memory, i + 1);
            H = steps[i].decay * H + steps[i].gain * (S - tensor(memory, 0));
        }
        tensor(memory, 0) = S;
    };
    if (std::min(volume_ratio(e, before), volume_ratio(e, x)) < inversion_threshold) {
        // Below the threshold, the stored stress is not the full stress of the law. The work is
        // therefore computed from the forces, and the energy from the law.
        const Corners f = forces(e, before, memory);
        follow();
        return work_against(f, forces(e, x, memory), before, x) -
               (energy(e, x) - energy(e, before));
    }
    SymmetricTensor twice_mean = sum_of_terms(memory, terms.size());
    follow();
    twice_mean += sum_of_terms(memory, terms.size());
    const Mat3 F = Mat3::Identity() + displacement_gradient(e, before),
               dF = (edge_matrix(x) - edge_matrix(before)) * e.inverse_edges;
    const Mat3 twice_dE = dF.transpose() * F + F.transpose() * dF + dF.transpose() * dF;
    return 0.25 * e.volume * matrix_of(twice_mean).cwiseProduct(twice_dE).sum();
}

}  // namespace incise::physics
