// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cut_faces.h"

#include <algorithm>
#include <cmath>

#include "incise/topology/cell_kind.h"

namespace incise::topology {

namespace {

/// True if a tetrahedron's face is on no face of its carrier: it is where a cut has divided that.
bool is_within_carrier(const Mesh& mesh, const FragmentMesh& fragments, FaceId face) {
    constexpr double tolerance = 0.02;  // of the carrier's longest edge: cuts move nodes by less
    // Another fragment may carry the cell, so its own carrier counts.
    const auto carrier = fragments.origins_of(fragments.carrier_of_cell(face.element));
    const CellTraits& of_tetrahedron = traits(CellKind::tetrahedron);
    if (carrier.size() != 4) return false;
    const auto corner = [&](int i) {
        return fragments.rest_position(carrier[static_cast<std::size_t>(i)]);
    };
    double longest = 0.0;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < i; ++k) longest = std::max(longest, (corner(i) - corner(k)).norm());
    for (int f = 0; f < of_tetrahedron.num_faces; ++f) {
        const auto side = of_tetrahedron.face(f);
        const Vec3 a = corner(side[0]);
        const Vec3 normal = (corner(side[1]) - a).cross(corner(side[2]) - a).normalized();
        double farthest = 0.0;
        for (int i = 0; i < mesh.face_size(face); ++i)
            farthest = std::max(
                farthest, std::abs(normal.dot(mesh.rest_position(mesh.face_corner(face, i)) - a)));
        if (farthest <= tolerance * longest) return false;
    }
    return true;
}

}  // namespace

bool is_on_cut(const Mesh& mesh, const FragmentMesh& fragments, FaceId face) {
    if (mesh.neighbor(face).is_valid()) return false;
    return mesh.was_inside(face) || is_within_carrier(mesh, fragments, face);
}

}  // namespace incise::topology
