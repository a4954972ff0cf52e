// The deformation of hexahedra, wedges and pyramids on lanes, shared by forces and stiffening.
// Equations: docs/theory.md, Hexahedra, wedges and pyramids. Compiled for each kind of processor:
// lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/physics/elements/simd_centre_elements.h"
#include "incise/physics/simd/gather_lanes.h"
#include "incise/physics/simd/link_forces.h"

namespace incise::physics::INCISE_PROCESSOR {

using CellNumbers = Lanes<double>;
using CellVectors = Lanes3<double>;

/// Returns all points of cells, from their corners relative to any origin.
/// @param weights  of the group; null: those of faces that are not divided
template <topology::CellKind kind>
[[gnu::always_inline]] inline void set_centres(
    std::array<CellVectors, CentreDivision<kind>::num_points>& points,
    const CentreWeights<kind>* weights, std::size_t first) {
    using Division = CentreDivision<kind>;
    CellVectors sum = points[0];
    for (std::size_t k = 1; k < Division::num_corners; ++k) sum = sum + points[k];
    std::size_t next = Division::num_corners;
    for (int f = 0; f < Division::traits.num_faces; ++f) {
        const auto face = Division::traits.face(f);
        if (face.size() != 4) continue;
        const auto at = [&](std::size_t p) { return points[static_cast<std::size_t>(face[p])]; };
        if (weights) {
            const auto& of_face = weights->faces[next - Division::num_corners];
            points[next++] = CellNumbers::load(of_face.even + first) * (at(0) + at(2)) +
                             CellNumbers::load(of_face.odd + first) * (at(1) + at(3));
        } else {
            points[next++] = CellNumbers(0.25) * (at(0) + at(1) + at(2) + at(3));
        }
    }
    points[next] = CellNumbers(1.0 / static_cast<double>(Division::num_corners)) * sum;
}

/// ln g and g'/g of VirtualCentreKernel.
struct Growth {
    CellNumbers logarithm, rate;
    Growth(CellNumbers J, double J0) {
        const CellNumbers above = max(J, J0);
        logarithm = log(above) + min(J - J0, 0.0) * (1.0 / J0);
        rate = 1.0 / above;
    }
};

/// The points of the part of a group of cells that starts at lane `first`, and their volume ratios.
template <topology::CellKind kind>
struct CellLanes {
    using Division = CentreDivision<kind>;
    static constexpr auto parts = Division::parts();

    const CentreShares<kind>* shares;  ///< of the group; null: all are 1
    std::size_t first;
    std::array<CellVectors, Division::num_points> x;  ///< relative to corner 0, m
    std::array<CellNumbers, Division::num_parts> ratios;
    CellNumbers mean = 0.0;

    [[gnu::always_inline]] inline CellLanes(const CentreGroup<kind>& group,
                                            const CentreExtras<kind>& of_group,
                                            std::size_t first_lane, const LocalVector* positions)
        : shares(of_group.shares), first(first_lane) {
        x[0] = {0.0, 0.0, 0.0};
        const auto corners = gather_edges<double>(positions, group.offsets, first);
        std::copy(corners.begin(), corners.end(), x.begin() + 1);
        set_centres<kind>(x, of_group.weights, first);
        const CellNumbers per_volume = CellNumbers::load(group.per_volume + first);
        for (std::size_t t = 0; t < Division::num_parts; ++t) {
            const auto v = edges(t);
            const MetricGroup<double>& part = group.parts[t];
            ratios[t] =
                dot(cross(v[0], v[1]), v[2]) * CellNumbers::load(part.per_six_volumes + first);
            CellNumbers of_volume = CellNumbers::load(part.volume + first) * per_volume;
            if (shares) of_volume *= share(t);
            mean += of_volume * ratios[t];
        }
    }

    /// Returns how much of a tetrahedron is material.
    [[gnu::always_inline]] inline CellNumbers share(std::size_t t) const {
        return shares ? CellNumbers::load(shares->parts[t] + first) : CellNumbers(1.0);
    }

    /// Returns the edges of a tetrahedron from its first point.
    [[gnu::always_inline]] inline LinkVectors<double> edges(std::size_t t) const {
        const CellVectors& origin = x[parts[t][0]];
        return {x[parts[t][1]] - origin, x[parts[t][2]] - origin, x[parts[t][3]] - origin};
    }
};

}  // namespace incise::physics::INCISE_PROCESSOR
