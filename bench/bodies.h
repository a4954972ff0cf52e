// The bodies of the benchmarks: irregular cubes of about a given number of tetrahedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <random>

#include "incise/physics/body/model.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::bench {

inline topology::Mesh make_cube(std::int64_t num_tetrahedra) {
    const int n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(num_tetrahedra) / 6)));
    auto data =
        topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {n, n, n});
    std::mt19937_64 random(1);
    for (Vec3& x : data.points)
        for (int c = 0; c < 3; ++c) {
            const double jitter = static_cast<double>(random() >> 11) * 0x1.0p-53 - 0.5;
            if (x[c] > 0.0 && x[c] < 1.0) x[c] += 0.3 * jitter / n;
        }
    return topology::Mesh::build(data).mesh;
}

inline physics::MaterialTable make_material(const physics::Law& law) {
    return {{{1000.0, physics::HyperElasticLinks{law}}}, {{0, 0}}};
}

}  // namespace incise::bench
