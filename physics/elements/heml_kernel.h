// Hyper-elastic mass links: strain, energy and forces of one tetrahedron. Readable double-precision
// reference. It takes the strain of the six links from the deformation gradient, which loses less
// to rounding in thin elements than their squared lengths do: docs/theory.md, Accuracy. Source:
// HEML 2015, section 3 and appendices A-C; corrections in docs/theory.md. SPDX-License-Identifier:
// LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "incise/base/types.h"
#include "incise/physics/elements/precision.h"
#include "incise/physics/elements/simd_heml_elements.h"
#include "incise/physics/laws/law.h"

namespace incise::physics {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat3 = Eigen::Matrix3d;

/// Squared edge lengths in the order of the paper: 01, 02, 03, 12, 23, 31.
Vec6 squared_links(const std::array<Vec3, 4>& x);

/// The edges 01, 02, 03 as columns.
Mat3 edge_matrix(const std::array<Vec3, 4>& x);

/// What a tetrahedron keeps of its rest shape. V is edge_matrix at rest.
struct LinkElement {
    double volume;       ///< m3
    Vec6 rest_links;     ///< m2
    Mat3 edges;          ///< V, m
    Mat3 inverse_edges;  ///< V^-1: its rows are the gradients of N_1 to N_3, 1/m
    /// a0 of a law with fibres, their direction at rest, of unit length; else zero.
    Vec3 fibre = Vec3::Zero();
};

/// Pure in the four rest positions.
LinkElement link_element(const std::array<Vec3, 4>& X, const Vec3& fibre = Vec3::Zero());

/// F - 1 of an element with its corners at x. Exactly zero at rest.
Mat3 displacement_gradient(const LinkElement& e, const std::array<Vec3, 4>& x);

/// How an element is deformed.
struct Deformation {
    Mat3 F;                     ///< deformation gradient, x by X
    Mat3 twice_strain;          ///< C - 1 = 2E, E the Green-Lagrange strain
    LinkStrain<double> strain;  ///< its invariants
};
Deformation deformation(const LinkElement& e, const std::array<Vec3, 4>& x);

/// Nodal forces of a first Piola-Kirchhoff stress P (Pa), f_i = -Vol P grad N_i, newtons.
std::array<Vec3, 4> forces_of_first_stress(const LinkElement& e, const Mat3& P);

/// The part of the second Piola-Kirchhoff stress (Pa) that comes from the invariants but J:
/// 2 w_a 1 + 4 w_b (C - 1) + 2 w_f a0 a0^T.
Mat3 second_stress_without_volume(const LawResponse<double>& r, const Mat3& twice_strain,
                                  const Vec3& fibre);

/// dJ/dF: the cofactors of F.
Mat3 cofactors(const Mat3& F);

/// HEML with a given law, for blocks of tetrahedra (element_block.h).
struct HemlKernel {
    static constexpr std::size_t num_corners = 4;
    using Corners = std::array<Vec3, 4>;
    using Element = LinkElement;
    using Lanes = SimdHemlElements;

    Law law;
    double inversion_threshold;
    Precision precision = Precision::double_precision;  ///< of the lanes

    /// Pure in the rest positions and, for a law with fibres, their direction.
    /// @param fibre  of unit length; of no account without fibres
    Element precompute(const Corners& X, const Vec3& fibre = Vec3::Zero()) const;

    double volume_ratio(const Element& e, const Corners& x) const;

    /// Highest P-wave modulus at rest times rest volume, joules.
    double stiffness_energy(const Element& e) const;

    /// Elastic energy, joules.
    double energy(const Element& e, const Corners& x) const;

    /// First Piola-Kirchhoff stress dw/dF, Pa.
    Mat3 first_piola_kirchhoff(const Element& e, const Corners& x) const;

    /// Nodal forces: minus the gradient of energy(), eq. (11).
    Corners forces(const Element& e, const Corners& x) const;

    /// Each corner's part s_i = (lambda + 2 mu) V (1/h_i) sum_j 1/h_j of the nodal bound on the
    /// stiffness at rest (stable_step.h), N/m; h are the altitudes. Fibres that are stretched add
    /// c V |H g_i| sum_j |H g_j|, for c and H see HasFibres, g_i the gradient of corner i's shape
    /// function, of length 1/h_i.
    std::array<double, 4> stiffness_bounds(const Element& e, const Corners& X) const;
};

}  // namespace incise::physics
