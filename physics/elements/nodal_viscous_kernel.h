// Hyper-elastic mass links with memory as the paper has it: a recursion on nodal forces. To compare
// with; viscous_kernel.h is what to use.
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

/// What a term of a Prony series does to a force f in one step, eq. (20):
/// gamma' = gain f' + decay gamma, with gain = dt alpha/(dt + tau) and decay = tau/(dt + tau).
struct NodalPronyStep {
    double decay, gain;
};

NodalPronyStep nodal_prony_step(const PronyTerm& term, double dt);

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
struct NodalViscousKernel : HemlKernel {
    std::vector<PronyTerm> terms;
    std::vector<NodalPronyStep> steps;  ///< of the terms, for the dt last given to begin_step
    double long_time_share = 1.0;       ///< 1 - sum of alpha_i

    NodalViscousKernel(const HemlKernel& elastic, std::vector<PronyTerm> prony);

    /// Numbers that an element remembers: P after the last step, then P of each gamma_i.
    static constexpr std::size_t history_size(std::size_t num_terms) { return 9 * (num_terms + 1); }

    /// Of the long-time moduli, joules.
    double energy(const Element& e, const Corners& x) const;

    Corners forces(const Element& e, const Corners& x, std::span<const double> memory) const;
    /// Their part besides those of the law, whatever the positions.
    Corners forces_of_memory(const Element& e, const Corners& x,
                             std::span<const double> memory) const;

    /// What an element does at the end of a step as a function of its positions there: the share of
    /// the law's forces, and a first Piola-Kirchhoff stress that stays as it is, Pa.
    struct EndOfStep {
        double share;
        Mat3 stress;
    };
    /// By the recursion from the memory of the step before, dt (s) earlier; for an infinite dt, the
    /// long-time moduli alone.
    EndOfStep end_of_step(std::span<const double> memory, double dt) const;
    /// Whose gradient are minus the forces, J.
    double potential(const Element& e, const Corners& x, const EndOfStep& end) const;
    Corners forces(const Element& e, const Corners& x, const EndOfStep& end) const;

    void begin_step(double dt);

    /// Brings the memory from the positions `before` to `x`, in the time given to begin_step.
    /// Returns the work done on the element less the growth of energy(), joules: that of
    /// (sum of alpha_i) P - sum of gamma_i over the change of F, by the trapezoidal rule.
    double advance(const Element& e, const Corners& before, const Corners& x,
                   std::span<double> memory) const;
};

}  // namespace incise::physics
