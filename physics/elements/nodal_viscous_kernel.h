// Viscosity of HEML as in the paper: a recursion on nodal forces, for comparison with the kernel of
// viscous_kernel.h, which is recommended.
// Source: HEML 2015, section 3.5, eqs. (14) to (20), signs corrected: docs/theory.md, Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "incise/physics/elements/heml_kernel.h"
#include "incise/physics/laws/material.h"

namespace incise::physics {

/// One step of a term of a Prony series on a force f, eq. (20): gamma' = gain f' + decay gamma.
/// Here gain = dt alpha/(dt + tau) and decay = tau/(dt + tau).
struct NodalPronyStep {
    double decay, gain;
};

/// Returns the step of a term for the time `dt`, s, which may be infinite.
NodalPronyStep nodal_prony_step(const PronyTerm& term, double dt);

/// The kernel of HEML with a given law and the nodal recursion of a Prony series, for blocks of
/// tetrahedra (element_block.h). The force on a node is f - sum of gamma_i.
///
/// The recursion is linear, and the force on a node is a sum over its elements. Each element
/// therefore stores its own part of the gamma_i, which follows every edit. The forces of a linear
/// element are those of its first Piola-Kirchhoff stress P, f_k = -Vol P grad N_k. The element
/// stores P instead of forces, since parts of a divided element have other corners but the same P.
///
/// Limits: The rule is of first order in dt. It is not frame-indifferent: one index of P belongs to
/// the current frame, so that P would have to rotate with the body, but the stored P does not. An
/// element that relaxed and then rotates has a moment, and its forces change in size. Angular
/// momentum is therefore not kept, and rotation may add energy.
struct NodalViscousKernel : HemlKernel {
    std::vector<PronyTerm> terms;
    std::vector<NodalPronyStep> steps;  ///< by term, for the dt of the last begin_step()
    double long_time_share = 1.0;       ///< 1 - sum of alpha_i

    NodalViscousKernel(const HemlKernel& elastic, std::vector<PronyTerm> prony);

    /// Returns how many numbers an element stores: P after the last step, then P of each gamma_i.
    static constexpr std::size_t history_size(std::size_t num_terms) { return 9 * (num_terms + 1); }

    /// Returns the elastic energy of the long-time moduli, J.
    double energy(const Element& e, const Corners& x) const;

    /// Returns the nodal forces, N, with the viscous stress in `memory`.
    Corners forces(const Element& e, const Corners& x, std::span<const double> memory) const;
    /// Returns forces() without the forces of the law, N. They do not depend on the positions.
    Corners forces_of_memory(const Element& e, const Corners& x,
                             std::span<const double> memory) const;

    /// The response of an element at the end of a step, as a function of its positions there: a
    /// share of the forces of the law, and a constant first Piola-Kirchhoff stress, Pa.
    struct EndOfStep {
        double share;
        Mat3 stress;
    };
    /// Returns the response at the end of a step of `dt`, s, by the recursion. If `dt` is infinite,
    /// it is that of the long-time moduli. `memory` is that of the beginning of the step.
    EndOfStep end_of_step(std::span<const double> memory, double dt) const;
    /// Returns the potential whose negative gradient are the forces at the end of a step, J.
    double potential(const Element& e, const Corners& x, const EndOfStep& end) const;
    /// Returns the nodal forces at the end of a step, N.
    Corners forces(const Element& e, const Corners& x, const EndOfStep& end) const;

    /// Sets the length of the step for advance(), s.
    void begin_step(double dt);

    /// Advances the memory from the positions `before` to `x`, in the time of begin_step().
    /// Returns the work done on the element minus the increase of energy(), J. This is the work of
    /// (sum of alpha_i) P - sum of gamma_i over the change of F, by the trapezoidal rule.
    double advance(const Element& e, const Corners& before, const Corners& x,
                   std::span<double> memory) const;
};

}  // namespace incise::physics
