// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/centre_division.h"

namespace incise::fragments {

using topology::CellKind;

template <CellKind kind>
typename CentreDivision<kind>::Points CentreDivision<kind>::points(const Corners& x,
                                                                   Diagonals diagonals) {
    Points all;
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < num_corners; ++k) {
        all[k] = x[k];
        sum += x[k];
    }
    std::size_t next = num_corners;
    for (int f = 0; f < traits.num_faces; ++f) {
        const auto face = traits.face(f);
        if (face.size() != 4) continue;
        Vec3 of_face = Vec3::Zero();
        if (diagonals.divides(f)) {
            const QuadWeights weights = quad_weights(diagonals, f);
            const auto at = [&](std::size_t p) { return x[static_cast<std::size_t>(face[p])]; };
            all[next++] = weights.even * (at(0) + at(2)) + weights.odd * (at(1) + at(3));
            continue;
        }
        for (const int k : face) of_face += x[static_cast<std::size_t>(k)];
        all[next++] = 0.25 * of_face;
    }
    all[next] = sum / static_cast<double>(num_corners);
    return all;
}

namespace {

template <class Division, class Value>
std::array<Value, Division::num_corners> gather(const std::array<Value, Division::num_points>& f,
                                                Diagonals diagonals) {
    std::array<Value, Division::num_corners> all;
    const Value of_centre =
        f[Division::num_points - 1] / static_cast<double>(Division::num_corners);
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = f[k] + of_centre;
    std::size_t next = all.size();
    for (int i = 0; i < Division::traits.num_faces; ++i) {
        const auto face = Division::traits.face(i);
        if (face.size() != 4) continue;
        const Value of_centre_of_face = f[next++];
        const QuadWeights weights = quad_weights(diagonals, i);
        for (std::size_t p = 0; p < 4; ++p)
            if (const double weight = p % 2 == 0 ? weights.even : weights.odd; weight > 0.0)
                all[static_cast<std::size_t>(face[p])] += weight * of_centre_of_face;
    }
    return all;
}

}  // namespace

template <CellKind kind>
typename CentreDivision<kind>::Corners CentreDivision<kind>::gathered(const Points& f,
                                                                      Diagonals diagonals) {
    return gather<CentreDivision, Vec3>(f, diagonals);
}

template <CellKind kind>
std::array<double, CentreDivision<kind>::num_corners> CentreDivision<kind>::gathered(
    const std::array<double, num_points>& f, Diagonals diagonals) {
    return gather<CentreDivision, double>(f, diagonals);
}

template struct CentreDivision<CellKind::hexahedron>;
template struct CentreDivision<CellKind::wedge>;
template struct CentreDivision<CellKind::pyramid>;

}  // namespace incise::fragments
