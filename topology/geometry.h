// Volumes and centres of cells of all kinds, from their corner positions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// Returns the signed volume of a tetrahedron. It is positive if a, b, c run anticlockwise as seen
/// from d.
inline double tetrahedron_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a) / 6.0;
}

/// Returns the signed volume of a cell with straight edges. Quadrilateral faces are the bilinear
/// patches of the trilinear map, so that cells which share such a face have no gap between them.
/// The flux of x through a patch is the mean of the fluxes through its two triangulations.
inline double signed_volume(CellKind kind, std::span<const Vec3> corners) {
    const Vec3& o = corners[0];
    if (kind == CellKind::tetrahedron)
        return tetrahedron_volume(o, corners[1], corners[2], corners[3]);
    const CellTraits& t = traits(kind);
    const auto flux = [&](int i, int j, int k) {
        const auto at = [&](int corner) -> Vec3 {
            return corners[static_cast<std::size_t>(corner)] - o;
        };
        return at(i).dot(at(j).cross(at(k))) / 6.0;
    };
    double volume = 0.0;
    for (int f = 0; f < t.num_faces; ++f) {
        const auto v = t.face(f);
        if (v.size() == 3)
            volume += flux(v[0], v[1], v[2]);
        else
            volume += 0.5 * (flux(v[0], v[1], v[2]) + flux(v[0], v[2], v[3]) +
                             flux(v[0], v[1], v[3]) + flux(v[1], v[2], v[3]));
    }
    return volume;
}

/// Returns the mean of the corners.
inline Vec3 centre(std::span<const Vec3> corners) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
}

}  // namespace incise::topology
