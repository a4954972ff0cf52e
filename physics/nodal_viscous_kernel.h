// Hyper-elastic mass links with memory as the paper has it: a recursion on nodal forces. To compare
// with; viscous_kernel.h is what to use.
// Source: HEML 2015, section 3.5, eqs. (14) to (20), signs corrected: docs/theory.md, Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "physics/heml_kernel.h"
#include "physics/material.h"

namespace incise::physics {

/// What a term of a Prony series does to a force f in one step, eq. (20):
/// gamma' = gain f' + decay gamma, with gain = dt alpha/(dt + tau) and decay = tau/(dt + tau).
struct NodalPronyStep {
    double decay, gain;
};

inline NodalPronyStep nodal_prony_step(const PronyTerm& term, double dt) {
    if (std::isinf(dt)) return {0.0, term.alpha};
    return {term.tau / (dt + term.tau), dt * term.alpha / (dt + term.tau)};
}

/// HEML with a given law and the nodal recursion of a Prony series, for blocks of tetrahedra
/// (element_block.h): the force on a node is f - sum of gamma_i.
///
/// The recursion is linear and a node's force is the sum over its elements, so each element keeps
/// its own part of the gamma_i, and these follow every edit. The forces of a linear element are
/// those of its first Piola-Kirchhoff stress P, f_k = -Vol P grad N_k; P is remembered in their
/// place, as parts of a divided element have the P of the whole but other corners.
///
/// Limits. First order in dt. Not frame-indifferent: P has one leg in the current frame and does
/// not turn with the body; an element that relaxed and then turns has a moment, and forces of
/// another size. So angular momentum is not kept, and turning may give energy instead of taking it.
template <class LawType>
struct NodalViscousKernel : HemlKernel<LawType> {
    using Elastic = HemlKernel<LawType>;
    using Corners = typename Elastic::Corners;
    struct Element : Elastic::Element {
        Mat3 edges, inverse_edges;  ///< rest edges 01, 02, 03 as columns, m; 1/m
    };

    std::vector<PronyTerm> terms;
    std::vector<NodalPronyStep> steps;  ///< of the terms, for the dt last given to begin_step
    double long_time_share = 1.0;       ///< 1 - sum of alpha_i

    NodalViscousKernel(const Elastic& elastic, std::vector<PronyTerm> prony)
        : Elastic(elastic), terms(std::move(prony)), steps(terms.size()) {
        for (const PronyTerm& term : terms) long_time_share -= term.alpha;
    }

    /// Numbers that an element remembers: P after the last step, then P of each gamma_i.
    static constexpr std::size_t history_size(std::size_t num_terms) { return 9 * (num_terms + 1); }

    Element precompute(const Corners& X) const requires(!Elastic::has_fibres) {
        return with_edges(Elastic::precompute(X), X);
    }
    /// @param fibre  their direction at rest, of unit length
    Element precompute(const Corners& X, const Vec3& fibre) const requires Elastic::has_fibres {
        return with_edges(Elastic::precompute(X, fibre), X);
    }

    /// Of the long-time moduli, joules.
    double energy(const Element& e, const Corners& x) const {
        return long_time_share * Elastic::energy(e, x);
    }

    Corners forces(const Element& e, const Corners& x, std::span<const double> memory) const {
        const Mat3 relaxed = e.volume * (sum_of_terms(memory) * e.inverse_edges.transpose());
        Corners f = Elastic::forces(e, x);
        for (std::size_t k = 1; k < 4; ++k) {
            const Vec3 part = relaxed.col(static_cast<int>(k) - 1);
            f[k] += part;
            f[0] -= part;
        }
        return f;
    }

    /// What an element does at the end of a step as a function of its positions there: the share of
    /// the law's forces, and a first Piola-Kirchhoff stress that stays as it is, Pa.
    struct EndOfStep {
        double share;
        Mat3 stress;
    };
    /// By the recursion from the memory of the step before, dt (s) earlier; for an infinite dt, the
    /// long-time moduli alone.
    EndOfStep end_of_step(std::span<const double> memory, double dt) const {
        EndOfStep end{1.0, Mat3::Zero()};
        for (std::size_t i = 0; i < terms.size(); ++i) {
            const NodalPronyStep rule = nodal_prony_step(terms[i], dt);
            end.share -= rule.gain;
            end.stress -= rule.decay * tensor(memory, i + 1);
        }
        return end;
    }
    /// Whose gradient are minus the forces, J.
    double potential(const Element& e, const Corners& x, const EndOfStep& end) const {
        Mat3 v;
        v << x[1] - x[0], x[2] - x[0], x[3] - x[0];
        return end.share * Elastic::energy(e, x) +
               e.volume * end.stress.cwiseProduct(v * e.inverse_edges).sum();
    }
    Corners forces(const Element& e, const Corners& x, const EndOfStep& end) const {
        const Mat3 held = e.volume * (end.stress * e.inverse_edges.transpose());
        Corners f = Elastic::forces(e, x);
        for (Vec3& force : f) force *= end.share;
        for (std::size_t k = 1; k < 4; ++k) {
            const Vec3 part = held.col(static_cast<int>(k) - 1);
            f[k] -= part;
            f[0] += part;
        }
        return f;
    }

    void begin_step(double dt) {
        for (std::size_t i = 0; i < terms.size(); ++i) steps[i] = nodal_prony_step(terms[i], dt);
    }

    /// Brings the memory from the positions `before` to `x`, in the time given to begin_step.
    /// Returns the work done on the element less the growth of energy(), joules: that of
    /// (sum of alpha_i) P - sum of gamma_i over the change of F, by the trapezoidal rule.
    double advance(const Element& e, const Corners& before, const Corners& x,
                   std::span<double> memory) const {
        Mat3 twice_mean = relaxing_stress(memory);
        const Mat3 P = first_piola_kirchhoff(e, x);
        for (std::size_t i = 0; i < terms.size(); ++i) {
            auto gamma = tensor(memory, i + 1);
            gamma = steps[i].decay * gamma + steps[i].gain * P;
        }
        tensor(memory, 0) = P;
        twice_mean += relaxing_stress(memory);
        Mat3 dv;
        dv << (x[1] - x[0]) - (before[1] - before[0]), (x[2] - x[0]) - (before[2] - before[0]),
            (x[3] - x[0]) - (before[3] - before[0]);
        return 0.5 * e.volume * twice_mean.cwiseProduct(dv * e.inverse_edges).sum();
    }

  private:
    static Element with_edges(const typename Elastic::Element& element, const Corners& X) {
        Mat3 V;
        V << X[1] - X[0], X[2] - X[0], X[3] - X[0];
        return {element, V, V.inverse()};
    }

    static Eigen::Map<Mat3> tensor(std::span<double> memory, std::size_t i) {
        return Eigen::Map<Mat3>(memory.data() + 9 * i);
    }
    static Eigen::Map<const Mat3> tensor(std::span<const double> memory, std::size_t i) {
        return Eigen::Map<const Mat3>(memory.data() + 9 * i);
    }

    // P = -sum of f_k X_k^T / Vol: as f_k = -Vol P grad N_k and sum of grad N_k X_k^T = 1.
    Mat3 first_piola_kirchhoff(const Element& e, const Corners& x) const {
        const Corners f = Elastic::forces(e, x);
        Mat3 forces;
        forces << f[1], f[2], f[3];
        return -1.0 / e.volume * (forces * e.edges.transpose());
    }

    Mat3 sum_of_terms(std::span<const double> memory) const {
        Mat3 sum = Mat3::Zero();
        for (std::size_t i = 0; i < terms.size(); ++i) sum += tensor(memory, i + 1);
        return sum;
    }

    Mat3 relaxing_stress(std::span<const double> memory) const {
        return (1.0 - long_time_share) * tensor(memory, 0) - sum_of_terms(memory);
    }
};

}  // namespace incise::physics
