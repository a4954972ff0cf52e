// Tangent of one element: minus the derivative of its nodal forces by its nodal positions, N/m. It
// is the second derivative of its energy, hence symmetric. Rows and columns go by corner, then by
// axis. Source: docs/theory.md, Tangents.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "incise/physics/elements/heml_kernel.h"
#include "incise/physics/elements/hybmss_kernel.h"
#include "incise/physics/elements/mass_spring_kernel.h"
#include "incise/physics/elements/nodal_viscous_kernel.h"
#include "incise/physics/elements/viscous_kernel.h"

namespace incise::physics {

template <std::size_t num_corners>
using ElementTangent = Eigen::Matrix<double, 3 * num_corners, 3 * num_corners>;

/// Returns the tangent of HemlKernel::forces at the corners x, m.
ElementTangent<4> element_tangent(const HemlKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x);

/// Returns the tangent of forces_of_stress() for a constant stress S, Pa, in the rest frame.
ElementTangent<4> tangent_of_stress(const Mat3& S, const LinkElement& e);

/// Returns the tangent of ViscousKernel::forces at the end of a step.
ElementTangent<4> element_tangent(const ViscousKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x,
                                  const ViscousKernel::EndOfStep& end);
/// Returns the tangent of NodalViscousKernel::forces at the end of a step.
ElementTangent<4> element_tangent(const NodalViscousKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x,
                                  const NodalViscousKernel::EndOfStep& end);

/// Returns the tangent of MassSpringKernel::forces at the corners x, m.
ElementTangent<4> element_tangent(const MassSpringKernel& kernel,
                                  const MassSpringKernel::Element& e, const std::array<Vec3, 4>& x);

/// Returns the tangent of HybmssKernel::forces at the corners x, m.
ElementTangent<8> element_tangent(const HybmssKernel& kernel, const HybmssKernel::Element& e,
                                  const std::array<Vec3, 8>& x);

/// Returns the tangent without its negative eigenvalues. A Newton direction from a sum of such
/// tangents decreases the energy, even where the exact tangent is indefinite.
/// Source: J. Teran, E. Sifakis, G. Irving, R. Fedkiw, Robust quasistatic finite elements and flesh
/// simulation, SCA 2005.
ElementTangent<4> positive_part(const ElementTangent<4>& K);
/// Returns the same for a pyramid, a wedge and a hexahedron.
ElementTangent<5> positive_part(const ElementTangent<5>& K);
ElementTangent<6> positive_part(const ElementTangent<6>& K);
ElementTangent<8> positive_part(const ElementTangent<8>& K);

}  // namespace incise::physics
