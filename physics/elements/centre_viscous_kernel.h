// HEML with a Prony series on hexahedra, wedges and pyramids.
// Source: HEML 2015, section 3.5, on stress: docs/theory.md, Viscosity, and Hexahedra, wedges and
// pyramids.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "incise/physics/elements/virtual_centre_kernel.h"
#include "incise/physics/elements/viscous_kernel.h"

namespace incise::physics {

/// The kernel of VirtualCentreKernel with a Prony series: each tetrahedron of a cell has the memory
/// of ViscousKernel, of the second Piola-Kirchhoff stress on its F'_t, which has the mean volume.
template <topology::CellKind kind>
struct CentreViscousKernel : VirtualCentreKernel<kind> {
    using Elastic = VirtualCentreKernel<kind>;
    using typename Elastic::Corners;
    using typename Elastic::Element;
    static constexpr std::size_t num_parts = Elastic::num_parts;
    using Stresses = std::array<Mat3, num_parts>;

    std::vector<PronyTerm> terms;
    std::vector<PronyStep> steps;  ///< by term, for the dt of the last begin_step()
    double long_time_share = 1.0;  ///< 1 - sum of alpha_i

    CentreViscousKernel(const Elastic& elastic, std::vector<PronyTerm> prony);

    /// Returns how many numbers a cell stores: S of all tetrahedra after the last step, then the
    /// H_i of all of them, for one term after the other.
    static constexpr std::size_t history_size(std::size_t num_terms) {
        return 6 * num_parts * (num_terms + 1);
    }

    // For the following see ViscousKernel.
    double energy(const Element& e, const Corners& x) const;
    Corners forces(const Element& e, const Corners& x, std::span<const double> memory) const;
    Corners forces_of_memory(const Element& e, const Corners& x,
                             std::span<const double> memory) const;
    struct EndOfStep {
        double share;
        Stresses stresses;
    };
    EndOfStep end_of_step(std::span<const double> memory, double dt) const;
    double potential(const Element& e, const Corners& x, const EndOfStep& end) const;
    Corners forces(const Element& e, const Corners& x, const EndOfStep& end) const;
    void begin_step(double dt);
    double advance(const Element& e, const Corners& before, const Corners& x,
                   std::span<double> memory) const;
};

/// Returns the tangent of CentreViscousKernel::forces at the end of a step.
template <topology::CellKind kind>
auto element_tangent(const CentreViscousKernel<kind>& kernel,
                     const typename CentreViscousKernel<kind>::Element& e,
                     const typename CentreViscousKernel<kind>::Corners& x,
                     const typename CentreViscousKernel<kind>::EndOfStep& end) {
    return kernel.tangent(e, x, end.share, &end.stresses);
}

extern template struct CentreViscousKernel<topology::CellKind::hexahedron>;
extern template struct CentreViscousKernel<topology::CellKind::wedge>;
extern template struct CentreViscousKernel<topology::CellKind::pyramid>;

}  // namespace incise::physics
