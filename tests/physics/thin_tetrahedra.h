// Tetrahedra as meshes and cuts leave them at worst: needles, slivers, caps and wedges.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>

#include "incise/topology/mesh.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {

/// Calls visit(rest positions, ratio) for each shape, about 1 cm long, whose least altitude is
/// about `ratio` of that, with each order of its corners that keeps it right side out, in some
/// pose. Ratios go down to 1e-5.
template <class Visit>
void for_each_thin_tetrahedron(Visit visit) {
    test::Random random(36);
    for (const double r : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const std::pair<const char*, Tetrahedron> shapes[] = {
            {"needle",
             {Vec3(0, 0, 0), {1, 0.3 * r, 0.2 * r}, {1, 1.3 * r, 0.2 * r}, {1, 0.3 * r, 1.2 * r}}},
            {"sliver", {Vec3(0, 0, 0), {1, 1, 0}, {0, 1, r}, {1, 0, r}}},
            {"cap", {Vec3(0, 0, 0), {1, 0, 0}, {0.4, 1, 0}, {0.45, 0.35, r}}},
            {"wedge", {Vec3(0, 0, 0), {r, 0, 0}, {0.3, 1, 0}, {0.3, 0.4, 1}}}};
        for (const auto& [name, shape] : shapes) {
            std::array<std::size_t, 4> order{0, 1, 2, 3};
            do {
                const Mat3 R = 0.01 * random_rotation(random);
                const Vec3 shift = random.vector(0.01);
                Tetrahedron X;
                for (std::size_t k = 0; k < 4; ++k) X[k] = R * shape[order[k]] + shift;
                if ((X[1] - X[0]).cross(X[2] - X[0]).dot(X[3] - X[0]) <= 0.0) continue;
                SCOPED_TRACE(name);
                SCOPED_TRACE(r);
                SCOPED_TRACE(testing::PrintToString(order));
                visit(X, r);
            } while (std::ranges::next_permutation(order).found);
        }
    }
}

inline topology::Mesh mesh_of(const Tetrahedron& X) {
    topology::MeshData data;
    data.points.assign(X.begin(), X.end());
    const std::array<std::int64_t, 4> corners{0, 1, 2, 3};
    data.add_cell(topology::CellKind::tetrahedron, corners);
    return topology::Mesh::build(data).mesh;
}

}  // namespace incise::physics
