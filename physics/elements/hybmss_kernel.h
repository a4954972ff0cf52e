// The hybrid mass-spring system on one hexahedron: springs along its edges and diagonals, and a
// term of its volume that sets Poisson's ratio free. HybMSS 2020, section 5, with the corrections
// listed in docs/theory.md.
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

/// The corners of a hexahedron, in VTK's order, as the corners of a box: along its edges a from
/// corner 0 to 1, b from 0 to 3 and c from 0 to 4.
struct BoxFrame {
    using Corners = std::array<Vec3, 8>;

    /// Which end of a, b and c each corner is at.
    static constexpr std::array<std::array<int, 3>, 8> sides = {{{-1, -1, -1},
                                                                 {1, -1, -1},
                                                                 {1, 1, -1},
                                                                 {-1, 1, -1},
                                                                 {-1, -1, 1},
                                                                 {1, -1, 1},
                                                                 {1, 1, 1},
                                                                 {-1, 1, 1}}};

    Vec3 a, b, c;  ///< means over the four edges along each, m; HybMSS 2020, eq. (5.14)

    explicit BoxFrame(const Corners& x)
        : a(0.25 * ((x[1] - x[0]) + (x[2] - x[3]) + (x[5] - x[4]) + (x[6] - x[7]))),
          b(0.25 * ((x[3] - x[0]) + (x[2] - x[1]) + (x[7] - x[4]) + (x[6] - x[5]))),
          c(0.25 * ((x[4] - x[0]) + (x[5] - x[1]) + (x[6] - x[2]) + (x[7] - x[3]))) {}

    /// Eq. (5.13): that of the mean deformation, exact for affine ones.
    double volume() const { return a.dot(b.cross(c)); }
};

/// Stiffnesses (N/m) and rest lengths (m) of one cell's shares in its springs, by group: edges
/// along a, b and c, face diagonals across a, b and c, inner diagonals. A cell owns a quarter of
/// each of its edges' springs, half of each face diagonal's and its inner ones, so that the shares
/// of neighbours add up to what the paper's shared springs are, and a cell that goes takes its own.
struct SpringContributions {
    std::array<double, 7> stiffnesses, lengths;
};

/// Springs that make a box with edges a, b, c of shear modulus G isotropic at small strain:
///   k_f = (G V / (b^2 c^2) - 4 k_c / l_c^2) l_f^2 / 2     (of the face across a)
///   k_e = (G V (3 - a^2/b^2 - a^2/c^2) + 4 k_c a^4 / l_c^2) / a^2     (along a)
/// For a cube this is eq. (5.12), k_f = A k_c. For other boxes k_c is what gives the mean of the
/// face diagonals the ratio A, or the nearest to it that leaves no spring too weak: A is a wish.
/// Nothing if the longest edge is more than 1.42 times the shortest; or for A = 0 and other boxes
/// than cubes, which cannot be without face diagonals.
/// Source: derived in docs/theory.md.
std::optional<SpringContributions> spring_contributions(const Vec3& edges, double shear_modulus,
                                                        double ratio);

/// Why a hexahedron cannot be a cell of this material: its corners are not those of a box, or the
/// box has no springs. Nothing if it can. Corners at rest, m.
std::optional<std::string> why_no_cell(const HybridSprings& material,
                                       const std::array<Vec3, 8>& corners);

/// What a cell keeps of its rest shape.
struct HybmssElement {
    double volume;  ///< m3
    SpringContributions springs;
};

/// W = sum of k/2 (l - l0)^2 + kappa V/2 (V'/V - 1)^2, V' the volume of BoxFrame.
struct HybmssKernel {
    static constexpr std::size_t num_corners = 8;
    using Corners = std::array<Vec3, 8>;
    using Element = HybmssElement;
    using Lanes = SimdHybmssElements;

    /// Springs by group, four each.
    static constexpr std::array<std::array<std::array<std::size_t, 2>, 4>, 7> springs = {{
        {{{0, 1}, {3, 2}, {4, 5}, {7, 6}}},  // along a
        {{{0, 3}, {1, 2}, {4, 7}, {5, 6}}},  // along b
        {{{0, 4}, {1, 5}, {2, 6}, {3, 7}}},  // along c
        {{{0, 7}, {3, 4}, {1, 6}, {2, 5}}},  // in the faces across a
        {{{0, 5}, {1, 4}, {3, 6}, {2, 7}}},  // across b
        {{{0, 2}, {1, 3}, {4, 6}, {5, 7}}},  // across c
        {{{0, 6}, {1, 7}, {2, 4}, {3, 5}}},  // through the inside
    }};

    HybridSprings material;
    Precision precision = Precision::double_precision;  ///< of the lanes

    /// Of a hexahedron that can be a cell: why_no_cell.
    Element precompute(const Corners& X) const;

    double volume_ratio(const Element& e, const Corners& x) const {
        return BoxFrame(x).volume() / e.volume;
    }

    /// P-wave modulus at rest times rest volume, J.
    double stiffness_energy(const Element& e) const {
        return (3.0 * material.shear_modulus + std::abs(material.volume_modulus)) * e.volume;
    }

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

    /// Minus the gradient of energy(), N; of the volume term eq. (5.15) and (5.16), the latter
    /// with the factor 1/4 that is missing in print.
    Corners forces(const Element& e, const Corners& x) const {
        Corners f;
        f.fill(Vec3::Zero());
        for (std::size_t g = 0; g < springs.size(); ++g) {
            const double k = e.springs.stiffnesses[g];
            if (k == 0.0) continue;
            for (const auto& [i, j] : springs[g]) {
                const Vec3 v = x[j] - x[i];
                const double length = v.norm();
                if (length == 0.0) continue;  // no direction to push in
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

    /// Each corner's part of the nodal bound on the stiffness at rest (stable_step.h), N/m.
    std::array<double, 8> stiffness_bounds(const Element& e, const Corners& X) const;
};

}  // namespace incise::physics
