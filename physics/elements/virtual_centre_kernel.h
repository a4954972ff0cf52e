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
#include <string>

#include "incise/base/types.h"
#include "incise/physics/elements/heml_kernel.h"
#include "incise/topology/cell_kind.h"

namespace incise::physics {

/// How a kind of cell is divided. Its centre is the mean of its corners. A face of four corners has
/// a centre, too, the mean of these. Each edge of such a face makes a tetrahedron with both
/// centres, and each face of three corners one with the centre of the cell.
template <topology::CellKind kind>
struct CentreDivision {
    static constexpr topology::CellTraits traits = topology::traits(kind);
    static constexpr std::size_t num_corners = static_cast<std::size_t>(traits.num_corners);
    static constexpr std::size_t count_quads() {
        std::size_t count = 0;
        for (int f = 0; f < traits.num_faces; ++f) count += traits.face(f).size() == 4 ? 1 : 0;
        return count;
    }
    static constexpr std::size_t num_quads = count_quads();
    static constexpr std::size_t num_points = num_corners + num_quads + 1;  ///< the centre is last
    static constexpr std::size_t num_parts =
        4 * num_quads + static_cast<std::size_t>(traits.num_faces) - num_quads;
    /// By tetrahedron, its points: corners, then centres of faces, then the centre of the cell.
    static constexpr std::array<std::array<std::size_t, 4>, num_parts> parts() {
        std::array<std::array<std::size_t, 4>, num_parts> all{};
        std::size_t part = 0, quad = 0;
        for (int f = 0; f < traits.num_faces; ++f) {
            const auto face = traits.face(f);
            const auto corner = [&](std::size_t p) {
                return static_cast<std::size_t>(face[p % face.size()]);
            };
            if (face.size() == 3) {
                all[part++] = {num_points - 1, corner(0), corner(1), corner(2)};
                continue;
            }
            for (std::size_t p = 0; p < 4; ++p)
                all[part++] = {num_points - 1, corner(p), corner(p + 1), num_corners + quad};
            ++quad;
        }
        return all;
    }

    using Corners = std::array<Vec3, num_corners>;
    using Points = std::array<Vec3, num_points>;
    /// Returns the values at all points of a field that is linear in those at the corners.
    static Points points(const Corners& x);
    /// Returns the sums at the corners of what acts at the points, each with its weight.
    static Corners gathered(const Points& f);
};

/// The kernel of HEML with a given law on hexahedra, wedges or pyramids. The energy is
/// W = sum of V_t w(F'_t) over the tetrahedra t, with F'_t = (g(Jm)/g(J_t))^(1/3) F_t: each has its
/// own change of shape, and all have the mean volume ratio Jm of the cell. g(J) is J, and goes on
/// above zero below the inversion threshold. So the cell does not lock as nu nears 1/2, and under
/// an affine deformation it is HEML.
template <topology::CellKind kind>
struct VirtualCentreKernel {
    using Division = CentreDivision<kind>;
    static constexpr std::size_t num_corners = Division::num_corners;
    static constexpr std::size_t num_parts = Division::num_parts;
    using Corners = std::array<Vec3, num_corners>;
    using Tangent = Eigen::Matrix<double, 3 * num_corners, 3 * num_corners>;

    /// Precomputed values of a cell at rest.
    struct Element {
        double volume;                              ///< m3, of all tetrahedra
        Corners rest;                               ///< m
        std::array<double, num_parts> volumes;      ///< of each tetrahedron, m3
        std::array<Mat3, num_parts> inverse_edges;  ///< LinkElement::inverse_edges of each, 1/m
        /// a0, the direction of the fibres at rest, of unit length; zero for a law without fibres.
        Vec3 fibre = Vec3::Zero();
    };

    Law law;
    double inversion_threshold;

    /// Returns the reason why a cell with these corners at rest, m, cannot be an element: one of
    /// its tetrahedra is turned inside out, or flat. Returns nothing if it can.
    static std::optional<std::string> why_no_cell(const Corners& X);

    /// Returns the precomputed values of a cell.
    /// @param X      corners at rest, m
    /// @param fibre  direction of the fibres at rest, of unit length; ignored by a law without
    ///               fibres
    /// @pre  why_no_cell() returns nothing
    Element precompute(const Corners& X, const Vec3& fibre = Vec3::Zero()) const;

    /// Returns current over rest volume; negative for an inverted cell.
    double volume_ratio(const Element& e, const Corners& x) const;
    /// Returns the highest P-wave modulus at rest times the rest volume, J.
    double stiffness_energy(const Element& e) const;
    /// Returns the elastic energy, J.
    double energy(const Element& e, const Corners& x) const;
    /// Returns the nodal forces, N: minus the gradient of energy().
    Corners forces(const Element& e, const Corners& x) const;
    /// Returns minus the derivative of the forces, N/m, rows and columns by corner, then by axis.
    Tangent tangent(const Element& e, const Corners& x) const;

    /// Returns tangent() at rest, in a fraction of the time.
    Tangent rest_tangent(const Element& e) const;

    /// Returns the contribution of the cell to the bound on the stiffness of each corner at rest
    /// (stable_step.h), N/m: the largest eigenvalue of rest_tangent(), with a margin of a fifth for
    /// strained states, for each of them. The sum of cells is then at most the diagonal matrix of
    /// the sums of bounds (I. Fried, 1972).
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

extern template struct CentreDivision<topology::CellKind::hexahedron>;
extern template struct CentreDivision<topology::CellKind::wedge>;
extern template struct CentreDivision<topology::CellKind::pyramid>;
extern template struct VirtualCentreKernel<topology::CellKind::hexahedron>;
extern template struct VirtualCentreKernel<topology::CellKind::wedge>;
extern template struct VirtualCentreKernel<topology::CellKind::pyramid>;

}  // namespace incise::physics
