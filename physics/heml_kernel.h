// Hyper-elastic mass links: the forces of one tetrahedron from its six squared edge lengths.
// Readable double-precision reference.
// Source: HEML 2015, section 3 and appendices A-C; corrections in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "physics/heml_lanes.h"
#include "physics/law.h"
#include "physics/precision.h"
#include "topology/types.h"

namespace incise::physics {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat3 = Eigen::Matrix3d;

/// Squared edge lengths in the order of the paper: 01, 02, 03, 12, 23, 31.
Vec6 squared_links(const std::array<Vec3, 4>& x);

/// The edges 01, 02, 03 as columns.
Mat3 edge_matrix(const std::array<Vec3, 4>& x);

/// What a tetrahedron keeps of its rest shape.
struct LinkElement {
    double volume;    ///< m3
    Vec6 rest_links;  ///< m2
    Vec6 vtr;         ///< traces of the C_k, where C = sum of l_k C_k: 1/m2
    Mat6 Mtr;         ///< traces of C_k C_l: 1/m4

    // Of a law with fibres; else zero.
    Vec3 fibre = Vec3::Zero();             ///< a0: their direction at rest, of unit length
    Vec3 fibre_components = Vec3::Zero();  ///< V^-1 a0, V the rest edges as columns: 1/m
    Vec6 fibre_links = Vec6::Zero();  ///< a0 . C_k a0, so that I4 = sum of l_k a0 . C_k a0: 1/m2
};

/// Eqs. (A.1) to (A.6) and (C.1). Pure in the four rest positions.
LinkElement link_element(const std::array<Vec3, 4>& X);

/// HEML with a given law, for blocks of tetrahedra (element_block.h).
struct HemlKernel {
    static constexpr std::size_t num_corners = 4;
    using Corners = std::array<Vec3, 4>;
    using Element = LinkElement;
    using Lanes = HemlLanes;

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

    /// Nodal forces: minus the gradient of energy(), eq. (11):
    /// f_i = -[ Vol (w_l^T DLM_i) v^T + w_J dvol/dx_i ].
    Corners forces(const Element& e, const Corners& x) const;

    /// Each corner's part s_i = (lambda + 2 mu) V (1/h_i) sum_j 1/h_j of the nodal bound on the
    /// stiffness at rest (stable_step.h), N/m; h are the altitudes. Fibres that are stretched add
    /// c V |H g_i| sum_j |H g_j|, for c and H see HasFibres, g_i the gradient of corner i's shape
    /// function, of length 1/h_i.
    std::array<double, 4> stiffness_bounds(const Element& e, const Corners& X) const;

    /// @param Mdl  Mtr times dl, the changes of the squared links
    LinkStrain<double> strain(const Element& e, const Vec6& dl, const Vec6& Mdl,
                              const Corners& x) const;
};

}  // namespace incise::physics
