// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/viscous_kernel.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace incise::physics {

namespace {

/// A symmetric tensor by its components 11, 22, 33, 12, 23, 31.
using SymmetricTensor = Eigen::Matrix<double, 6, 1>;

Mat3 matrix_of(const SymmetricTensor& t) {
    Mat3 matrix;
    matrix << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
    return matrix;
}
SymmetricTensor symmetric_tensor(const Mat3& matrix) {
    SymmetricTensor t;
    t << matrix(0, 0), matrix(1, 1), matrix(2, 2), matrix(0, 1), matrix(1, 2), matrix(2, 0);
    return t;
}

Eigen::Map<SymmetricTensor> tensor(std::span<double> memory, std::size_t i) {
    return Eigen::Map<SymmetricTensor>(memory.data() + 6 * i);
}
Eigen::Map<const SymmetricTensor> tensor(std::span<const double> memory, std::size_t i) {
    return Eigen::Map<const SymmetricTensor>(memory.data() + 6 * i);
}

SymmetricTensor sum_of_terms(std::span<const double> memory, std::size_t num_terms) {
    SymmetricTensor sum = SymmetricTensor::Zero();
    for (std::size_t i = 0; i < num_terms; ++i) sum += tensor(memory, i + 1);
    return sum;
}

/// Work done against the mean of two states of an element's forces, joules.
double work_against(const std::array<Vec3, 4>& f, const std::array<Vec3, 4>& g,
                    const std::array<Vec3, 4>& before, const std::array<Vec3, 4>& x) {
    double work = 0.0;
    for (std::size_t k = 0; k < 4; ++k) work -= 0.5 * (f[k] + g[k]).dot(x[k] - before[k]);
    return work;
}

}  // namespace

Mat3 change_of_right_cauchy_green(const Vec6& dl, const Mat3& inverse_edges) {
    Mat3 D;
    D(0, 0) = dl[0];
    D(1, 1) = dl[1];
    D(2, 2) = dl[2];
    D(0, 1) = D(1, 0) = 0.5 * (dl[0] + dl[1] - dl[3]);
    D(1, 2) = D(2, 1) = 0.5 * (dl[1] + dl[2] - dl[4]);
    D(2, 0) = D(0, 2) = 0.5 * (dl[2] + dl[0] - dl[5]);
    return inverse_edges.transpose() * D * inverse_edges;
}

Mat3 second_piola_kirchhoff(const LawResponse<double>& r, const Mat3& C_minus_1, double J,
                            double J0) {
    Mat3 S = 4.0 * r.w_b * C_minus_1;
    S.diagonal().array() += 2.0 * r.w_a;
    if (r.w_J == 0.0) return S;
    const Mat3 C = Mat3::Identity() + C_minus_1;
    const double factor = r.w_J * J / std::max(J * J, J0 * J0);
    Mat3 cofactor;
    for (int k = 0; k < 3; ++k) {
        const int m = (k + 1) % 3, n = (k + 2) % 3;
        cofactor(k, k) = C(m, m) * C(n, n) - C(m, n) * C(m, n);
        cofactor(m, n) = cofactor(n, m) = C(k, m) * C(k, n) - C(k, k) * C(m, n);
    }
    return S + factor * cofactor;
}

std::array<Vec3, 4> forces_of_stress(const Mat3& S, double volume, const Mat3& inverse_edges,
                                     const std::array<Vec3, 4>& x) {
    const Mat3 t = volume * (inverse_edges * S * inverse_edges.transpose());
    const Vec3 v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
    const Vec3 f1 = -(t(0, 0) * v1 + t(1, 0) * v2 + t(2, 0) * v3);
    const Vec3 f2 = -(t(0, 1) * v1 + t(1, 1) * v2 + t(2, 1) * v3);
    const Vec3 f3 = -(t(0, 2) * v1 + t(1, 2) * v2 + t(2, 2) * v3);
    return {-(f1 + f2 + f3), f1, f2, f3};
}

PronyStep prony_step(const PronyTerm& term, double dt) {
    const double x = dt / term.tau;
    return {std::exp(-x), x == 0.0 ? term.alpha : term.alpha * (-std::expm1(-x) / x)};
}

ViscousKernel::ViscousKernel(const HemlKernel& elastic, std::vector<PronyTerm> prony)
    : HemlKernel(elastic), terms(std::move(prony)), steps(terms.size()) {
    for (const PronyTerm& term : terms) long_time_share -= term.alpha;
}

ViscousKernel::Element ViscousKernel::precompute(const Corners& X, const Vec3& fibre) const {
    return {HemlKernel::precompute(X, fibre), edge_matrix(X).inverse()};
}

double ViscousKernel::energy(const Element& e, const Corners& x) const {
    return long_time_share * HemlKernel::energy(e, x);
}

std::array<Vec3, 4> ViscousKernel::forces_of_memory(const Element& e, const Corners& x,
                                                    std::span<const double> memory) const {
    const SymmetricTensor relaxed =
        sum_of_terms(memory, terms.size()) - (1.0 - long_time_share) * tensor(memory, 0);
    return forces_of_stress(matrix_of(relaxed), e.volume, e.inverse_edges, x);
}

std::array<Vec3, 4> ViscousKernel::forces(const Element& e, const Corners& x,
                                          std::span<const double> memory) const {
    Corners f = HemlKernel::forces(e, x);
    const Corners rest = forces_of_memory(e, x, memory);
    for (std::size_t k = 0; k < 4; ++k) f[k] += rest[k];
    return f;
}

Mat3 ViscousKernel::stress(const Element& e, const Corners& x) const {
    // The invariants come from C itself, which is needed anyway: this spares reading Mtr.
    const Mat3 C_minus_1 =
        change_of_right_cauchy_green(squared_links(x) - e.rest_links, e.inverse_edges);
    const LinkStrain<double> strain{C_minus_1.trace(), C_minus_1.squaredNorm(), volume_ratio(e, x),
                                    e.fibre.dot(C_minus_1 * e.fibre)};
    const LawResponse<double> r = response(law, strain, inversion_threshold);
    return second_piola_kirchhoff(r, C_minus_1, strain.J, inversion_threshold) +
           2.0 * r.w_f * e.fibre * e.fibre.transpose();
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
    const Mat3 twice_E =
        change_of_right_cauchy_green(squared_links(x) - e.rest_links, e.inverse_edges);
    return end.share * HemlKernel::energy(e, x) +
           0.5 * e.volume * end.stress.cwiseProduct(twice_E).sum();
}

std::array<Vec3, 4> ViscousKernel::forces(const Element& e, const Corners& x,
                                          const EndOfStep& end) const {
    const Corners elastic = HemlKernel::forces(e, x);
    Corners f = forces_of_stress(end.stress, e.volume, e.inverse_edges, x);
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
        // The stress remembered is not all of the law's: work and energy as they are.
        const Corners f = forces(e, before, memory);
        follow();
        return work_against(f, forces(e, x, memory), before, x) -
               (energy(e, x) - energy(e, before));
    }
    SymmetricTensor twice_mean = sum_of_terms(memory, terms.size());
    follow();
    twice_mean += sum_of_terms(memory, terms.size());
    const Mat3 twice_dE =
        change_of_right_cauchy_green(squared_links(x) - squared_links(before), e.inverse_edges);
    return 0.25 * e.volume * matrix_of(twice_mean).cwiseProduct(twice_dE).sum();
}

}  // namespace incise::physics
