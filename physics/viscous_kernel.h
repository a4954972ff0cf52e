// Hyper-elastic mass links with memory: a Prony series on the second Piola-Kirchhoff stress.
// Source: HEML 2015, section 3.5; on stress instead of nodal forces, and with the exact rule
// instead of eq. (20): docs/theory.md, Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "physics/heml_kernel.h"
#include "physics/material.h"

namespace incise::physics {

/// A symmetric tensor by its components 11, 22, 33, 12, 23, 31.
using SymmetricTensor = Eigen::Matrix<double, 6, 1>;

inline Mat3 matrix_of(const SymmetricTensor& t) {
    Mat3 matrix;
    matrix << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
    return matrix;
}
inline SymmetricTensor symmetric_tensor(const Mat3& matrix) {
    SymmetricTensor t;
    t << matrix(0, 0), matrix(1, 1), matrix(2, 2), matrix(0, 1), matrix(1, 2), matrix(2, 0);
    return t;
}

/// Change of C for changes `dl` (m2) of the six squared links: V^-T D V^-1, (A.3) to (A.5). C - 1
/// itself for their changes since rest, and exactly zero there.
/// @param inverse_edges V^-1, V with the rest edges 01, 02, 03 as columns
inline Mat3 change_of_right_cauchy_green(const Vec6& dl, const Mat3& inverse_edges) {
    Mat3 D;
    D(0, 0) = dl[0];
    D(1, 1) = dl[1];
    D(2, 2) = dl[2];
    D(0, 1) = D(1, 0) = 0.5 * (dl[0] + dl[1] - dl[3]);
    D(1, 2) = D(2, 1) = 0.5 * (dl[1] + dl[2] - dl[4]);
    D(2, 0) = D(0, 2) = 0.5 * (dl[2] + dl[0] - dl[5]);
    return inverse_edges.transpose() * D * inverse_edges;
}

/// S = dw/dE = 2 w_a 1 + 4 w_b (C - 1) + w_J J C^-1, pascals, frame of rest. The last term has no
/// limit for J -> 0: it is w_J cof(C) / J. For |J| below J0, where the laws with ln J are extended
/// anyway, it is taken as w_J cof(C) J / J0^2, which is finite for flat elements.
inline Mat3 second_piola_kirchhoff(const LawResponse<double>& r, const Mat3& C_minus_1, double J,
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

/// Nodal forces of a stress S (Pa) in the frame of rest, f_i = -Vol F S grad N_i, newtons.
/// @param inverse_edges as above; its rows are the gradients of N_1 to N_3
inline std::array<Vec3, 4> forces_of_stress(const Mat3& S, double volume, const Mat3& inverse_edges,
                                            const std::array<Vec3, 4>& x) {
    const Mat3 t = volume * (inverse_edges * S * inverse_edges.transpose());
    const Vec3 v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
    const Vec3 f1 = -(t(0, 0) * v1 + t(1, 0) * v2 + t(2, 0) * v3);
    const Vec3 f2 = -(t(0, 1) * v1 + t(1, 1) * v2 + t(2, 1) * v3);
    const Vec3 f3 = -(t(0, 2) * v1 + t(1, 2) * v2 + t(2, 2) * v3);
    return {-(f1 + f2 + f3), f1, f2, f3};
}

/// What a term of a Prony series does in one step: H' = decay H + gain (S' - S).
struct PronyStep {
    double decay, gain;
};

/// The exact rule for a stress that is linear in time during the step; for dt = 0 its limit, an
/// instantaneous change.
inline PronyStep prony_step(const PronyTerm& term, double dt) {
    const double x = dt / term.tau;
    return {std::exp(-x), x == 0.0 ? term.alpha : term.alpha * (-std::expm1(-x) / x)};
}

/// HEML with a given law and a Prony series, for blocks of tetrahedra (element_block.h). With the
/// memory (viscous_history.h) as the last step left it, the stress at positions x is
///     S_total = S(x) + sum of H_i - (sum of alpha_i) S_memory,
/// which is (1 - sum of alpha_i) S + sum of H_i where S(x) is the one remembered, and answers any
/// change since then with the instantaneous moduli.
template <class LawType>
struct ViscousKernel : HemlKernel<LawType> {
    using Elastic = HemlKernel<LawType>;
    using Corners = typename Elastic::Corners;
    struct Element : Elastic::Element {
        Mat3 inverse_edges;  ///< V^-1, 1/m
    };

    std::vector<PronyTerm> terms;
    std::vector<PronyStep> steps;  ///< of the terms, for the dt last given to begin_step
    double long_time_share = 1.0;  ///< 1 - sum of alpha_i

    ViscousKernel(const Elastic& elastic, std::vector<PronyTerm> prony)
        : Elastic(elastic), terms(std::move(prony)), steps(terms.size()) {
        for (const PronyTerm& term : terms) long_time_share -= term.alpha;
    }

    /// Numbers that an element remembers: S after the last step, then the H_i, in the frame of
    /// rest.
    static constexpr std::size_t history_size(std::size_t num_terms) { return 6 * (num_terms + 1); }

    Element precompute(const Corners& X) const requires(!Elastic::has_fibres) {
        return {Elastic::precompute(X), inverse_edges(X)};
    }
    /// @param fibre  their direction at rest, of unit length
    Element precompute(const Corners& X, const Vec3& fibre) const requires Elastic::has_fibres {
        return {Elastic::precompute(X, fibre), inverse_edges(X)};
    }

    /// Of the long-time moduli, joules: what is left when the terms have relaxed.
    double energy(const Element& e, const Corners& x) const {
        return long_time_share * Elastic::energy(e, x);
    }

    Corners forces(const Element& e, const Corners& x, std::span<const double> memory) const {
        const SymmetricTensor relaxed =
            sum_of_terms(memory) - (1.0 - long_time_share) * tensor(memory, 0);
        const Corners elastic = Elastic::forces(e, x);
        Corners f = forces_of_stress(matrix_of(relaxed), e.volume, e.inverse_edges, x);
        for (std::size_t k = 0; k < 4; ++k) f[k] += elastic[k];
        return f;
    }

    /// Second Piola-Kirchhoff stress of the law alone, without viscosity, Pa.
    Mat3 stress(const Element& e, const Corners& x) const {
        // The invariants come from C itself, which is needed anyway: this spares reading Mtr.
        const Mat3 C_minus_1 =
            change_of_right_cauchy_green(squared_links(x) - e.rest_links, e.inverse_edges);
        LinkStrain<double> strain{C_minus_1.trace(), C_minus_1.squaredNorm(),
                                  this->volume_ratio(e, x)};
        if constexpr (Elastic::has_fibres) strain.f = e.fibre.dot(C_minus_1 * e.fibre);
        const double J0 = this->inversion_threshold;
        const LawResponse<double> r = this->law.response(strain, J0);
        Mat3 S = second_piola_kirchhoff(r, C_minus_1, strain.J, J0);
        if constexpr (Elastic::has_fibres) S += 2.0 * r.w_f * e.fibre * e.fibre.transpose();
        return S;
    }

    /// What an element does at the end of a step as a function of its positions there: the share of
    /// the law's forces, and a stress that stays as it is (Pa, frame of rest).
    struct EndOfStep {
        double share;
        Mat3 stress;
    };
    /// By the exact rule from the memory of the step before, dt (s) earlier: with
    /// H_i' = decay H_i + gain (S' - S) the stress is (share) S' + sum of (decay H_i - gain S).
    /// For an infinite dt, the long-time moduli alone.
    EndOfStep end_of_step(std::span<const double> memory, double dt) const {
        double share = long_time_share;
        SymmetricTensor stress = SymmetricTensor::Zero();
        for (std::size_t i = 0; i < terms.size(); ++i) {
            const PronyStep rule = prony_step(terms[i], dt);
            share += rule.gain;
            stress += rule.decay * tensor(memory, i + 1) - rule.gain * tensor(memory, 0);
        }
        return {share, matrix_of(stress)};
    }
    /// Whose gradient are minus the forces, J.
    double potential(const Element& e, const Corners& x, const EndOfStep& end) const {
        const Mat3 twice_E =
            change_of_right_cauchy_green(squared_links(x) - e.rest_links, e.inverse_edges);
        return end.share * Elastic::energy(e, x) +
               0.5 * e.volume * end.stress.cwiseProduct(twice_E).sum();
    }
    Corners forces(const Element& e, const Corners& x, const EndOfStep& end) const {
        const Corners elastic = Elastic::forces(e, x);
        Corners f = forces_of_stress(end.stress, e.volume, e.inverse_edges, x);
        for (std::size_t k = 0; k < 4; ++k) f[k] += end.share * elastic[k];
        return f;
    }

    void begin_step(double dt) {
        for (std::size_t i = 0; i < terms.size(); ++i) steps[i] = prony_step(terms[i], dt);
    }

    /// Brings the memory from the positions `before` to `x`, in the time given to begin_step.
    /// Returns the work done on the element less the growth of energy(), joules: what the terms
    /// took up. It is the work of their stresses over the change of E, by the trapezoidal rule.
    double advance(const Element& e, const Corners& before, const Corners& x,
                   std::span<double> memory) const {
        const double J0 = this->inversion_threshold;
        if (std::min(this->volume_ratio(e, before), this->volume_ratio(e, x)) < J0) {
            // The stress remembered is not all of the law's: work and energy as they are.
            const Corners f = forces(e, before, memory);
            follow(e, x, memory);
            return work_against(f, forces(e, x, memory), before, x) -
                   (energy(e, x) - energy(e, before));
        }
        SymmetricTensor twice_mean = sum_of_terms(memory);
        follow(e, x, memory);
        twice_mean += sum_of_terms(memory);
        const Mat3 twice_dE =
            change_of_right_cauchy_green(squared_links(x) - squared_links(before), e.inverse_edges);
        return 0.25 * e.volume * matrix_of(twice_mean).cwiseProduct(twice_dE).sum();
    }

  private:
    static Mat3 inverse_edges(const Corners& X) {
        Mat3 V;
        V << X[1] - X[0], X[2] - X[0], X[3] - X[0];
        return V.inverse();
    }

    static Eigen::Map<SymmetricTensor> tensor(std::span<double> memory, std::size_t i) {
        return Eigen::Map<SymmetricTensor>(memory.data() + 6 * i);
    }
    static Eigen::Map<const SymmetricTensor> tensor(std::span<const double> memory, std::size_t i) {
        return Eigen::Map<const SymmetricTensor>(memory.data() + 6 * i);
    }

    void follow(const Element& e, const Corners& x, std::span<double> memory) const {
        const SymmetricTensor S = symmetric_tensor(stress(e, x));
        for (std::size_t i = 0; i < terms.size(); ++i) {
            auto H = tensor(memory, i + 1);
            H = steps[i].decay * H + steps[i].gain * (S - tensor(memory, 0));
        }
        tensor(memory, 0) = S;
    }

    SymmetricTensor sum_of_terms(std::span<const double> memory) const {
        SymmetricTensor sum = SymmetricTensor::Zero();
        for (std::size_t i = 0; i < terms.size(); ++i) sum += tensor(memory, i + 1);
        return sum;
    }

    /// Work done against the mean of two states of the element's forces, joules.
    static double work_against(const Corners& f, const Corners& g, const Corners& before,
                               const Corners& x) {
        double work = 0.0;
        for (std::size_t k = 0; k < 4; ++k) work -= 0.5 * (f[k] + g[k]).dot(x[k] - before[k]);
        return work;
    }
};

}  // namespace incise::physics
