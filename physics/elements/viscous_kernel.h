// Viscosity of HEML: a Prony series on the second Piola-Kirchhoff stress.
// Source: HEML 2015, section 3.5, but on stress instead of nodal forces, and with an exact rule
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

/// Returns the second Piola-Kirchhoff stress, Pa, rest frame:
/// S = dw/dE = second_stress_without_volume() + w_J J C^-1.
/// The last term equals w_J cof(C) / J and has no limit for J -> 0. For |J| below J0 it is replaced
/// by w_J cof(C) J / J0^2, which is finite for flat elements. The laws with ln J are extended there
/// too.
Mat3 second_piola_kirchhoff(const LawResponse<double>& r, const Mat3& twice_strain, double J,
                            double J0, const Vec3& fibre = Vec3::Zero());

/// Returns the nodal forces of a second Piola-Kirchhoff stress S, Pa: f_i = -Vol F S grad N_i, N.
std::array<Vec3, 4> forces_of_stress(const Mat3& S, const LinkElement& e,
                                     const std::array<Vec3, 4>& x);

/// Returns the step of a term for the time `dt`, s, which may be infinite. The rule is exact for a
/// stress that is linear in time during the step. For dt = 0 it is the limit: an instantaneous
/// change.
PronyStep prony_step(const PronyTerm& term, double dt);

/// The kernel of HEML with a given law and a Prony series, for blocks of tetrahedra
/// (element_block.h). The memory (viscous_history.h) is that of the end of the last step. The
/// stress at positions x is
///     S_total = S(x) + sum of H_i - (sum of alpha_i) S_memory.
/// If S(x) equals S_memory, it is (1 - sum of alpha_i) S + sum of H_i. A change of strain since the
/// last step meets the instantaneous moduli.
struct ViscousKernel : HemlKernel {
    using MemoryLanes = SimdViscousElements;

    std::vector<PronyTerm> terms;
    std::vector<PronyStep> steps;  ///< by term, for the dt of the last begin_step()
    double long_time_share = 1.0;  ///< 1 - sum of alpha_i

    ViscousKernel(const HemlKernel& elastic, std::vector<PronyTerm> prony);

    /// Returns how many numbers an element stores: S after the last step, then the H_i, all in the
    /// rest frame.
    static constexpr std::size_t history_size(std::size_t num_terms) { return 6 * (num_terms + 1); }

    /// Returns the elastic energy of the long-time moduli, J: that after all terms have relaxed.
    double energy(const Element& e, const Corners& x) const;

    /// Returns the nodal forces of S_total, N.
    Corners forces(const Element& e, const Corners& x, std::span<const double> memory) const;
    /// Returns forces() without the forces of the law, N.
    Corners forces_of_memory(const Element& e, const Corners& x,
                             std::span<const double> memory) const;

    /// Returns the second Piola-Kirchhoff stress of the law alone, without viscosity, Pa.
    Mat3 stress(const Element& e, const Corners& x) const;

    /// The response of an element at the end of a step, as a function of its positions there: a
    /// share of the forces of the law, and a constant stress, Pa, rest frame.
    struct EndOfStep {
        double share;
        Mat3 stress;
    };
    /// Returns the response at the end of a step of `dt`, s, by the exact rule. `memory` is that of
    /// the beginning of the step. With H_i' = decay H_i + gain (S' - S) the stress is
    /// (share) S' + sum of (decay H_i - gain S). If `dt` is infinite, it is that of the long-time
    /// moduli.
    EndOfStep end_of_step(std::span<const double> memory, double dt) const;
    /// Returns the potential whose negative gradient are the forces at the end of a step, J.
    double potential(const Element& e, const Corners& x, const EndOfStep& end) const;
    /// Returns the nodal forces at the end of a step, N.
    Corners forces(const Element& e, const Corners& x, const EndOfStep& end) const;

    /// Sets the length of the step for advance(), s.
    void begin_step(double dt);

    /// Advances the memory from the positions `before` to `x`, in the time of begin_step().
    /// Returns the work done on the element minus the increase of energy(), J. This is the work of
    /// the stresses H_i over the change of E, by the trapezoidal rule. If the volume ratio is below
    /// the inversion threshold before or after, it is computed from the forces instead.
    double advance(const Element& e, const Corners& before, const Corners& x,
                   std::span<double> memory) const;
};

}  // namespace incise::physics
