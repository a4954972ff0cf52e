// Tangent stiffness of one element: minus the derivative of its nodal forces by nodal positions, so
// the symmetric second derivative of its energy, N/m. Rows and columns go by corner, then by axis.
// Source: docs/theory.md, Tangents.
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

ElementTangent<4> element_tangent(const HemlKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x);

/// Of a stress (Pa) that stays as it is in the frame of rest; see forces_of_stress.
ElementTangent<4> tangent_of_stress(const Mat3& S, const LinkElement& e);

/// At the end of a step, as forces() of the same arguments.
ElementTangent<4> element_tangent(const ViscousKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x,
                                  const ViscousKernel::EndOfStep& end);
/// Likewise.
ElementTangent<4> element_tangent(const NodalViscousKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x,
                                  const NodalViscousKernel::EndOfStep& end);

ElementTangent<4> element_tangent(const MassSpringKernel& kernel,
                                  const MassSpringKernel::Element& e, const std::array<Vec3, 4>& x);

ElementTangent<8> element_tangent(const HybmssKernel& kernel, const HybmssKernel::Element& e,
                                  const std::array<Vec3, 8>& x);

/// The tangent without what is negative in it: a sum of such tangents is a direction's sure way
/// down in energy where the tangent itself is indefinite.
/// Source: Teran, Sifakis, Irving, Fedkiw, Robust quasistatic finite elements, SCA 2005.
ElementTangent<4> positive_part(const ElementTangent<4>& K);
ElementTangent<8> positive_part(const ElementTangent<8>& K);

}  // namespace incise::physics
