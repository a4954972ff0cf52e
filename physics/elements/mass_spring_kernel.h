// The classical mass-spring model on one tetrahedron: a baseline to compare with, not a material.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>

#include "incise/base/types.h"
#include "incise/topology/geometry.h"

namespace incise::physics {

/// Linear springs along the six edges; see MassSprings in material.h for their stiffness. Springs
/// know nothing of volume: flat and inverted elements are not told apart from others.
struct MassSpringKernel {
    static constexpr std::size_t num_corners = 4;
    using Corners = std::array<Vec3, 4>;
    struct Element {
        double volume;                       ///< m3
        std::array<double, 6> rest_lengths;  ///< m, edges as in `edges`
        std::array<double, 6> stiffnesses;   ///< N/m, this element's share
    };
    static constexpr std::array<std::array<std::size_t, 2>, 6> edges = {
        {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}, {3, 1}}};

    double young;

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
            if (length == 0.0) continue;  // no direction to push in
            const Vec3 pull = e.stiffnesses[k] * (length - e.rest_lengths[k]) / length * v;
            f[i] += pull;
            f[j] -= pull;
        }
        return f;
    }

    /// A spring k between two nodes adds k to the diagonal and k beside it: 2k in each row.
    std::array<double, 4> stiffness_bounds(const Element& e, const Corners&) const {
        std::array<double, 4> s{};
        for (std::size_t k = 0; k < edges.size(); ++k)
            for (const std::size_t i : edges[k]) s[i] += 2.0 * e.stiffnesses[k];
        return s;
    }
};

}  // namespace incise::physics
