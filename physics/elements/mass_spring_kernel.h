// The classical mass-spring model on one tetrahedron, as a baseline for comparison.
// Source: Van Gelder 1998; docs/theory.md, Springs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>

#include "incise/base/types.h"
#include "incise/topology/geometry.h"

namespace incise::physics {

/// The kernel of linear springs along the six edges; for their stiffness see MassSprings in
/// material.h. The energy does not depend on the volume, so that springs do not resist inversion.
struct MassSpringKernel {
    static constexpr std::size_t num_corners = 4;
    using Corners = std::array<Vec3, 4>;
    struct Element {
        double volume;                       ///< m3
        std::array<double, 6> rest_lengths;  ///< m, in the order of `edges`
        std::array<double, 6> stiffnesses;   ///< N/m, the share of this element
    };
    /// The two corners of each edge.
    static constexpr std::array<std::array<std::size_t, 2>, 6> edges = {
        {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}, {3, 1}}};

    double young;  ///< Young's modulus, Pa

    Element precompute(const Corners& X) const {
        Element e{};
        e.volume = topology::tetrahedron_volume(X[0], X[1], X[2], X[3]);
        for (std::size_t k = 0; k < edges.size(); ++k) {
            e.rest_lengths[k] = (X[edges[k][1]] - X[edges[k][0]]).norm();
            e.stiffnesses[k] = young * e.volume / (e.rest_lengths[k] * e.rest_lengths[k]);
        }
        return e;
    }

    double volume_ratio(const Element& e, const Corners& x) const {
        return topology::tetrahedron_volume(x[0], x[1], x[2], x[3]) / e.volume;
    }

    /// Returns the modulus times the rest volume, J.
    double stiffness_energy(const Element& e) const { return young * e.volume; }

    double energy(const Element& e, const Corners& x) const {
        double sum = 0.0;
        for (std::size_t k = 0; k < edges.size(); ++k) {
            const double d = (x[edges[k][1]] - x[edges[k][0]]).norm() - e.rest_lengths[k];
            sum += 0.5 * e.stiffnesses[k] * d * d;
        }
        return sum;
    }

    Corners forces(const Element& e, const Corners& x) const {
        Corners f{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        for (std::size_t k = 0; k < edges.size(); ++k) {
            const auto [i, j] = edges[k];
            const Vec3 v = x[j] - x[i];
            const double length = v.norm();
            if (length == 0.0) continue;  // the force has no direction
            const Vec3 pull = e.stiffnesses[k] * (length - e.rest_lengths[k]) / length * v;
            f[i] += pull;
            f[j] -= pull;
        }
        return f;
    }

    /// Returns the contribution of the element to the bound on the stiffness of each corner at rest
    /// (stable_step.h), N/m. A spring k adds 2k to both of its ends: k on the diagonal of the
    /// matrix, and k beside it.
    std::array<double, 4> stiffness_bounds(const Element& e, const Corners&) const {
        std::array<double, 4> s{};
        for (std::size_t k = 0; k < edges.size(); ++k)
            for (const std::size_t i : edges[k]) s[i] += 2.0 * e.stiffnesses[k];
        return s;
    }

    /// Returns 1: the bounds hold at any strain. Along a spring its stiffness stays k, and across
    /// it is k (1 - l0/l), below k.
    double stiffening(const Element&, const Corners&) const { return 1.0; }
};

}  // namespace incise::physics
