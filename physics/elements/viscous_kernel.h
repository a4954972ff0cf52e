// Hyper-elastic mass links with memory: a Prony series on the second Piola-Kirchhoff stress.
// Source: HEML 2015, section 3.5; on stress instead of nodal forces, and with the exact rule
// instead of eq. (20): docs/theory.md, Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "incise/physics/elements/heml_kernel.h"
#include "incise/physics/elements/simd_viscous_elements.h"
#include "incise/physics/laws/material.h"

namespace incise::physics {

/// S = dw/dE = second_stress_without_volume + w_J J C^-1, pascals, frame of rest. The last term has
/// no limit for J -> 0: it is w_J cof(C) / J. For |J| below J0, where the laws with ln J are
/// extended anyway, it is taken as w_J cof(C) J / J0^2, which is finite for flat elements.
Mat3 second_piola_kirchhoff(const LawResponse<double>& r, const Mat3& twice_strain, double J,
                            double J0, const Vec3& fibre = Vec3::Zero());

/// Nodal forces of a stress S (Pa) in the frame of rest, f_i = -Vol F S grad N_i, newtons.
std::array<Vec3, 4> forces_of_stress(const Mat3& S, const LinkElement& e,
                                     const std::array<Vec3, 4>& x);

/// The exact rule for a stress that is linear in time during the step; for dt = 0 its limit, an
/// instantaneous change.
PronyStep prony_step(const PronyTerm& term, double dt);

/// HEML with a given law and a Prony series, for blocks of tetrahedra (element_block.h). With the
/// memory (viscous_history.h) as the last step left it, the stress at positions x is
///     S_total = S(x) + sum of H_i - (sum of alpha_i) S_memory,
/// which is (1 - sum of alpha_i) S + sum of H_i where S(x) is the one remembered, and answers any
/// change since then with the instantaneous moduli.
struct ViscousKernel : HemlKernel {
    using MemoryLanes = SimdViscousElements;

    std::vector<PronyTerm> terms;
    std::vector<PronyStep> steps;  ///< of the terms, for the dt last given to begin_step
    double long_time_share = 1.0;  ///< 1 - sum of alpha_i

    ViscousKernel(const HemlKernel& elastic, std::vector<PronyTerm> prony);

    /// Numbers that an element remembers: S after the last step, then the H_i, in the frame of
    /// rest.
    static constexpr std::size_t history_size(std::size_t num_terms) { return 6 * (num_terms + 1); }

    /// Of the long-time moduli, joules: what is left when the terms have relaxed.
    double energy(const Element& e, const Corners& x) const;

    Corners forces(const Element& e, const Corners& x, std::span<const double> memory) const;
    /// Their part besides those of the law.
    Corners forces_of_memory(const Element& e, const Corners& x,
                             std::span<const double> memory) const;

    /// Second Piola-Kirchhoff stress of the law alone, without viscosity, Pa.
    Mat3 stress(const Element& e, const Corners& x) const;

    /// What an element does at the end of a step as a function of its positions there: the share of
    /// the law's forces, and a stress that stays as it is (Pa, frame of rest).
    struct EndOfStep {
        double share;
        Mat3 stress;
    };
    /// By the exact rule from the memory of the step before, dt (s) earlier: with
    /// H_i' = decay H_i + gain (S' - S) the stress is (share) S' + sum of (decay H_i - gain S).
    /// For an infinite dt, the long-time moduli alone.
    EndOfStep end_of_step(std::span<const double> memory, double dt) const;
    /// Whose gradient are minus the forces, J.
    double potential(const Element& e, const Corners& x, const EndOfStep& end) const;
    Corners forces(const Element& e, const Corners& x, const EndOfStep& end) const;

    void begin_step(double dt);

    /// Brings the memory from the positions `before` to `x`, in the time given to begin_step.
    /// Returns the work done on the element less the growth of energy(), joules: what the terms
    /// took up. It is the work of their stresses over the change of E, by the trapezoidal rule.
    double advance(const Element& e, const Corners& before, const Corners& x,
                   std::span<double> memory) const;
};

}  // namespace incise::physics
