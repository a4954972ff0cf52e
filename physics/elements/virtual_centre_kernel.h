// HEML on cells of any kind, without locking: a cell is divided into tetrahedra about centres that
// have no freedom of their own. Equations: docs/theory.md, Hexahedra, wedges and pyramids.
// Source: HEML 2015, section 3, for each tetrahedron; E. de Souza Neto, D. Peric, M. Dutko,
// D. Owen, Design of simple low order finite elements for large strain analysis of nearly
// incompressible solids, Int. J. Solids Structures 33, 1996, for the mean volume.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "incise/base/types.h"
#include "incise/fragments/centre_division.h"
#include "incise/physics/elements/heml_kernel.h"
#include "incise/physics/elements/simd_centre_elements.h"
#include "incise/topology/cell_kind.h"

namespace incise::physics {

/// The kernel of HEML with a given law on hexahedra, wedges or pyramids. The energy is
/// W = sum of V_t w(F'_t) over the tetrahedra t, with F'_t = (g(Jm)/g(J_t))^(1/3) F_t: each has its
/// own change of shape, and all have the mean volume ratio Jm of the cell. g(J) is J, and goes on
/// above zero below the inversion threshold. So the cell does not lock as nu nears 1/2, and under
/// an affine deformation it is HEML. It is the reference for its SIMD version.
template <topology::CellKind kind>
struct VirtualCentreKernel {
    using Division = CentreDivision<kind>;
    static constexpr std::size_t num_corners = Division::num_corners;
    static constexpr std::size_t num_parts = Division::num_parts;
    using Corners = std::array<Vec3, num_corners>;
    using Tangent = Eigen::Matrix<double, 3 * num_corners, 3 * num_corners>;
    using Lanes = SimdCentreElements<kind>;

    /// Precomputed values of a cell at rest.
    struct Element {
        double volume;                              ///< m3, of all tetrahedra
        Corners rest;                               ///< m
        std::array<double, num_parts> volumes;      ///< of the material in each, m3
        std::array<Mat3, num_parts> inverse_edges;  ///< LinkElement::inverse_edges of each, 1/m
        /// a0, the direction of the fibres at rest, of unit length; zero for a law without fibres.
        Vec3 fibre = Vec3::Zero();
        bool is_whole = true;                ///< all shares of its tetrahedra are 1
        topology::Diagonals diagonals = {};  ///< that divide its quadrilaterals
    };

    Law law;
    double inversion_threshold;

    /// Returns the reason why a cell with these corners at rest, m, cannot be an element: one of
    /// its tetrahedra is turned inside out, or flat. Returns nothing if it can.
    static std::optional<std::string> why_no_cell(const Corners& X,
                                                  topology::Diagonals diagonals = {});

    /// Returns the precomputed values of a cell.
    /// @param X      corners at rest, m
    /// @param fibre  direction of the fibres at rest, of unit length; ignored by a law without
    ///               fibres
    /// @param part_shares  of each tetrahedron, how much of it is material; empty: all of it
    /// @param diagonals    that divide its quadrilaterals
    /// @pre  why_no_cell() returns nothing; not all shares are zero
    Element precompute(const Corners& X, const Vec3& fibre = Vec3::Zero(),
                       std::span<const double> part_shares = {},
                       topology::Diagonals diagonals = {}) const;

    /// Returns for each corner which part of the mass of the cell it has; they sum to 1. A quarter
    /// of the mass of a tetrahedron is at each of its points. That of a centre goes to the corners
    /// that it is the mean of. So the centre of mass is exact, and each corner has mass.
    std::array<double, num_corners> mass_fractions(const Element& e) const;
    /// Returns current over rest volume of the material; negative for an inverted cell.
    double volume_ratio(const Element& e, const Corners& x) const;
    /// Returns the least ratio of current over rest volume in the cell: of its tetrahedra, and of
    /// those that the edges at each corner make. It is not positive for a cell that is folded
    /// inside, whatever volume_ratio() is. Tetrahedra without material do not count, nor corners
    /// at them, nor corners that are flat at rest.
    double least_volume_ratio(const Element& e, const Corners& x) const;
    /// Returns the highest P-wave modulus at rest times the rest volume, J.
    double stiffness_energy(const Element& e) const;
    /// Returns the elastic energy, J.
    double energy(const Element& e, const Corners& x) const;
    /// Returns the nodal forces, N: minus the gradient of energy().
    Corners forces(const Element& e, const Corners& x) const;
    /// Returns minus the derivative of the forces, N/m, rows and columns by corner, then by axis.
    /// @param e         the cell
    /// @param x         its corners, m
    /// @param share     of the law in the forces
    /// @param constant  second Piola-Kirchhoff stresses on F'_t that act beside it, Pa; null: none
    Tangent tangent(const Element& e, const Corners& x, double share = 1.0,
                    const std::array<Mat3, num_parts>* constant = nullptr) const;

    /// Returns tangent() at rest, in a fraction of the time.
    Tangent rest_tangent(const Element& e) const;

    /// Returns the contribution of the cell to the bound on the stiffness of each corner at rest
    /// (stable_step.h), N/m: its mass times the largest eigenvalue of M^-1 rest_tangent(), with a
    /// margin of a fifth for strained states. M has the masses of mass_fractions(). The sum of
    /// cells is then at most the diagonal matrix of the sums of bounds (I. Fried, 1972).
    std::array<double, num_corners> stiffness_bounds(const Element& e, const Corners& X) const;
    /// Returns the factor by which the bounds grow from rest to the corners x, m: the largest one
    /// of HemlKernel::stiffening of its tetrahedra, with their own volume and with the mean one.
    double stiffening(const Element& e, const Corners& x) const;
};

/// Returns the tangent of VirtualCentreKernel::forces at the corners x, m.
template <topology::CellKind kind>
auto element_tangent(const VirtualCentreKernel<kind>& kernel,
                     const typename VirtualCentreKernel<kind>::Element& e,
                     const typename VirtualCentreKernel<kind>::Corners& x) {
    return kernel.tangent(e, x);
}

extern template struct VirtualCentreKernel<topology::CellKind::hexahedron>;
extern template struct VirtualCentreKernel<topology::CellKind::wedge>;
extern template struct VirtualCentreKernel<topology::CellKind::pyramid>;

}  // namespace incise::physics
