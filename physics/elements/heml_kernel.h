// HEML, hyper-elastic mass links: strain, energy and forces of one tetrahedron, in doubles. The
// strain comes from the deformation gradient and not from squared lengths, since this loses less to
// rounding in thin elements: docs/theory.md, Accuracy.
// Source: HEML 2015, section 3 and appendices A-C; corrections in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
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

/// Returns the squared edge lengths, m2, in the order of the paper: 01, 02, 03, 12, 23, 31.
inline Vec6 squared_links(const std::array<Vec3, 4>& x) {
    Vec6 l;
    l << (x[1] - x[0]).squaredNorm(), (x[2] - x[0]).squaredNorm(), (x[3] - x[0]).squaredNorm(),
        (x[2] - x[1]).squaredNorm(), (x[3] - x[2]).squaredNorm(), (x[1] - x[3]).squaredNorm();
    return l;
}

/// Returns the matrix with the edges 01, 02 and 03 as columns, m.
inline Mat3 edge_matrix(const std::array<Vec3, 4>& x) {
    Mat3 v;
    v << x[1] - x[0], x[2] - x[0], x[3] - x[0];
    return v;
}

/// Precomputed values of a tetrahedron at rest that its SIMD versions need.
struct LinkMetric {
    double volume;       ///< m3
    Vec6 rest_links;     ///< squared_links() at rest, m2
    Mat3 inverse_edges;  ///< V^-1, 1/m; row i is the gradient of the shape function N_(i + 1)
    /// a0, the direction of the fibres at rest, of unit length; zero for a law without fibres.
    Vec3 fibre = Vec3::Zero();
};
/// Precomputed values of a tetrahedron at rest.
struct LinkElement : LinkMetric {
    Mat3 edges;  ///< V = edge_matrix() at rest, m
};

/// Returns the values of a tetrahedron with its corners at X, m, at rest. They depend only on the
/// arguments.
LinkElement link_element(const std::array<Vec3, 4>& X, const Vec3& fibre = Vec3::Zero());

/// Returns F - 1 of an element with its corners at x, m. It is exactly zero at rest.
Mat3 displacement_gradient(const LinkElement& e, const std::array<Vec3, 4>& x);

/// The deformation of an element.
struct Deformation {
    Mat3 F;                     ///< deformation gradient, dx/dX
    Mat3 twice_strain;          ///< C - 1 = 2E, with the Green-Lagrange strain E
    LinkStrain<double> strain;  ///< the invariants of the strain
};
/// Returns the deformation of an element with its corners at x, m.
Deformation deformation(const LinkElement& e, const std::array<Vec3, 4>& x);

/// Returns the nodal forces of a first Piola-Kirchhoff stress P, Pa: f_i = -Vol P grad N_i, N.
std::array<Vec3, 4> forces_of_first_stress(const LinkElement& e, const Mat3& P);

/// Returns the second Piola-Kirchhoff stress without the term of J, Pa:
/// 2 w_a 1 + 4 w_b (C - 1) + 2 w_f a0 a0^T.
Mat3 second_stress_without_volume(const LawResponse<double>& r, const Mat3& twice_strain,
                                  const Vec3& fibre);

/// Returns the cofactor matrix of F, which is dJ/dF.
Mat3 cofactors(const Mat3& F);

/// The kernel of HEML with a given law, for blocks of tetrahedra (element_block.h). It is the
/// reference for its SIMD version.
struct HemlKernel {
    static constexpr std::size_t num_corners = 4;
    using Corners = std::array<Vec3, 4>;
    using Element = LinkElement;
    using Lanes = SimdHemlElements;
    /// What a block stores of an element: only the inverse takes long to compute.
    struct Stored {
        Mat3 inverse_edges;
    };

    Law law;
    double inversion_threshold;
    Precision precision = Precision::double_precision;  ///< of the forces by SIMD

    /// Returns the precomputed values of an element. They depend only on the arguments.
    /// @param X      corners at rest, m
    /// @param fibre  direction of the fibres at rest, of unit length; ignored by a law without
    ///               fibres
    Element precompute(const Corners& X, const Vec3& fibre = Vec3::Zero()) const;

    Stored stored(const Element& e) const { return {e.inverse_edges}; }
    /// Returns what the lanes need of the element that precompute() gave.
    /// @param X       corners at rest, m
    /// @param volume  of the element, m3
    /// @param fibre   of the element; zero for a law without fibres
    LinkMetric for_lanes(const Stored& stored, const Corners& X, double volume,
                         const Vec3& fibre) const {
        return {volume, squared_links(X), stored.inverse_edges, fibre};
    }
    /// Returns the element that precompute() gave; see for_lanes().
    Element restored(const Stored& stored, const Corners& X, double volume,
                     const Vec3& fibre) const {
        return {for_lanes(stored, X, volume, fibre), edge_matrix(X)};
    }

    /// Returns current over rest volume; negative for an inverted element.
    double volume_ratio(const Element& e, const Corners& x) const;

    /// Returns the highest P-wave modulus at rest times the rest volume, J.
    double stiffness_energy(const Element& e) const;

    /// Returns the elastic energy, J.
    double energy(const Element& e, const Corners& x) const;

    /// Returns the first Piola-Kirchhoff stress dw/dF, Pa.
    Mat3 first_piola_kirchhoff(const Element& e, const Corners& x) const;

    /// Returns the nodal forces, N: minus the gradient of energy(), eq. (11).
    Corners forces(const Element& e, const Corners& x) const;

    /// Returns the contribution of the element to the bound on the stiffness of each corner at rest
    /// (stable_step.h), N/m: s_i = (lambda + 2 mu) V (1/h_i) sum_j 1/h_j, with the altitudes h.
    /// Fibres under tension add c V |H g_i| sum_j |H g_j|. Here g_i is the gradient of the shape
    /// function of corner i, of length 1/h_i; for c and H see HasFibres.
    std::array<double, 4> stiffness_bounds(const Element& e, const Corners& X) const;

    /// Returns the factor by which the bounds grow from rest to the corners x, m: the stiffness at
    /// x is at most stiffness_bounds() times this factor, which is 1 at rest. Viscosity does not
    /// count. Source: docs/theory.md, Stable step.
    double stiffening(const Element& e, const Corners& x) const;
};

}  // namespace incise::physics
