// HybMSS, the hybrid mass-spring system, on one hexahedron: springs along edges and diagonals, and
// an energy of the volume, which allows any Poisson ratio.
// Source: HybMSS 2020, section 5; corrections in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "incise/base/types.h"
#include "incise/physics/elements/precision.h"
#include "incise/physics/elements/simd_hybmss_elements.h"
#include "incise/physics/laws/material.h"

namespace incise::physics {

/// The mean edges a, b and c of a hexahedron with its corners in the order of VTK. In this order a
/// leads from corner 0 to 1, b from 0 to 3 and c from 0 to 4.
struct BoxFrame {
    using Corners = std::array<Vec3, 8>;

    /// By corner, the end of a, b and c at which it is: -1 the first, 1 the second.
    static constexpr std::array<std::array<int, 3>, 8> sides = {{{-1, -1, -1},
                                                                 {1, -1, -1},
                                                                 {1, 1, -1},
                                                                 {-1, 1, -1},
                                                                 {-1, -1, 1},
                                                                 {1, -1, 1},
                                                                 {1, 1, 1},
                                                                 {-1, 1, 1}}};

    Vec3 a, b, c;  ///< each is the mean of four edges, m; HybMSS 2020, eq. (5.14)

    explicit BoxFrame(const Corners& x)
        : a(0.25 * ((x[1] - x[0]) + (x[2] - x[3]) + (x[5] - x[4]) + (x[6] - x[7]))),
          b(0.25 * ((x[3] - x[0]) + (x[2] - x[1]) + (x[7] - x[4]) + (x[6] - x[5]))),
          c(0.25 * ((x[4] - x[0]) + (x[5] - x[1]) + (x[6] - x[2]) + (x[7] - x[3]))) {}

    /// Returns the volume of the mean deformation, m3, eq. (5.13). It is exact for an affine
    /// deformation.
    double volume() const { return a.dot(b.cross(c)); }
};

/// The share of one cell in its springs: stiffnesses (N/m) and rest lengths (m) by group. The
/// groups are edges along a, b and c, face diagonals across a, b and c, and inner diagonals.
///
/// A cell has a quarter of the spring of each edge, half of that of each face diagonal, and all of
/// its inner springs. The shares of neighbouring cells add up to the shared springs of the paper. A
/// cell that is removed takes its share with it.
struct SpringContributions {
    std::array<double, 7> stiffnesses, lengths;
};

/// Returns the springs with which a box with edges a, b and c is isotropic at small strain, with
/// the shear modulus G:
///   k_f = (G V / (b^2 c^2) - 4 k_c / l_c^2) l_f^2 / 2     (of the face across a)
///   k_e = (G V (3 - a^2/b^2 - a^2/c^2) + 4 k_c a^4 / l_c^2) / a^2     (along a)
/// For a cube this is eq. (5.12), with k_f = A k_c. For another box k_c is chosen so that the mean
/// of k_f is A k_c, or as near to this as possible without springs that are too weak.
///
/// Returns nothing if the longest edge is more than 1.42 times the shortest. It also returns
/// nothing for A = 0 if the box is no cube, since such a box needs face diagonals.
/// Source: docs/theory.md, The hybrid mass-spring system.
/// @param edges          lengths of a, b and c, m
/// @param shear_modulus  G, Pa
/// @param ratio          A, stiffness of face over inner diagonals; see HybridSprings
std::optional<SpringContributions> spring_contributions(const Vec3& edges, double shear_modulus,
                                                        double ratio);

/// Returns the reason why a hexahedron with these corners at rest, m, cannot be a cell of this
/// material: it is no box, or spring_contributions() returns nothing. Returns nothing if it can.
std::optional<std::string> why_no_cell(const HybridSprings& material,
                                       const std::array<Vec3, 8>& corners);

/// Precomputed values of a cell at rest.
struct HybmssElement {
    double volume;  ///< m3
    SpringContributions springs;
};

/// The kernel of HybMSS, with the energy W = sum of k/2 (l - l0)^2 + kappa V/2 (V'/V - 1)^2. V' is
/// BoxFrame::volume(). It is the reference for its SIMD version.
struct HybmssKernel {
    static constexpr std::size_t num_corners = 8;
    using Corners = std::array<Vec3, 8>;
    using Element = HybmssElement;
    using Lanes = SimdHybmssElements;

    /// The two corners of each spring, by group, four springs in each.
    static constexpr std::array<std::array<std::array<std::size_t, 2>, 4>, 7> springs = {{
        {{{0, 1}, {3, 2}, {4, 5}, {7, 6}}},  // along a
        {{{0, 3}, {1, 2}, {4, 7}, {5, 6}}},  // along b
        {{{0, 4}, {1, 5}, {2, 6}, {3, 7}}},  // along c
        {{{0, 7}, {3, 4}, {1, 6}, {2, 5}}},  // in the faces across a
        {{{0, 5}, {1, 4}, {3, 6}, {2, 7}}},  // across b
        {{{0, 2}, {1, 3}, {4, 6}, {5, 7}}},  // across c
        {{{0, 6}, {1, 7}, {2, 4}, {3, 5}}},  // inner diagonals
    }};

    HybridSprings material;
    Precision precision = Precision::double_precision;  ///< of the forces by SIMD

    /// Returns the precomputed values of a cell with its corners at X, m, at rest.
    /// @pre  why_no_cell() returns nothing
    Element precompute(const Corners& X) const;

    /// Returns current over rest volume; negative for an inverted cell.
    double volume_ratio(const Element& e, const Corners& x) const {
        return BoxFrame(x).volume() / e.volume;
    }

    /// Returns the P-wave modulus at rest, with the absolute value of kappa, times the rest volume,
    /// J.
    double stiffness_energy(const Element& e) const {
        return (3.0 * material.shear_modulus + std::abs(material.volume_modulus)) * e.volume;
    }

    /// Returns the elastic energy, J.
    double energy(const Element& e, const Corners& x) const {
        double sum = 0.0;
        for (std::size_t g = 0; g < springs.size(); ++g) {
            double squares = 0.0;
            for (const auto& [i, j] : springs[g]) {
                const double d = (x[j] - x[i]).norm() - e.springs.lengths[g];
                squares += d * d;
            }
            sum += 0.5 * e.springs.stiffnesses[g] * squares;
        }
        const double strain = volume_ratio(e, x) - 1.0;
        return sum + 0.5 * material.volume_modulus * e.volume * strain * strain;
    }

    /// Returns the nodal forces, N: minus the gradient of energy(). Those of the volume are
    /// eqs. (5.15) and (5.16), with the factor 1/4 that is missing in (5.16) as printed.
    Corners forces(const Element& e, const Corners& x) const {
        Corners f;
        f.fill(Vec3::Zero());
        for (std::size_t g = 0; g < springs.size(); ++g) {
            const double k = e.springs.stiffnesses[g];
            if (k == 0.0) continue;
            for (const auto& [i, j] : springs[g]) {
                const Vec3 v = x[j] - x[i];
                const double length = v.norm();
                if (length == 0.0) continue;  // the force has no direction
                const Vec3 pull = k * (length - e.springs.lengths[g]) / length * v;
                f[i] += pull;
                f[j] -= pull;
            }
        }
        if (material.volume_modulus == 0.0) return f;
        const BoxFrame now(x);
        const Vec3 across_a = now.b.cross(now.c), across_b = now.c.cross(now.a),
                   across_c = now.a.cross(now.b);
        const double pressure = -material.volume_modulus * (now.a.dot(across_a) / e.volume - 1.0);
        for (std::size_t k = 0; k < num_corners; ++k) {
            const auto& side = BoxFrame::sides[k];
            f[k] +=
                0.25 * pressure * (side[0] * across_a + side[1] * across_b + side[2] * across_c);
        }
        return f;
    }

    /// Returns the contribution of the cell to the bound on the stiffness of each corner at rest
    /// (stable_step.h), N/m.
    std::array<double, 8> stiffness_bounds(const Element& e, const Corners& X) const;

    /// Returns the factor by which the bounds grow from rest to the corners x, m; it is 1 at rest.
    /// Source: docs/theory.md, Stable step.
    double stiffening(const Element& e, const Corners& x) const;
};

}  // namespace incise::physics
