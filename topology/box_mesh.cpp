// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/box_mesh.h"

namespace incise::topology {

namespace {

/// Returns the i-th of n + 1 equidistant coordinates from 0 to `size`. The last is exactly `size`,
/// so that a selection up to the far face selects it.
double coordinate(std::int64_t i, std::int64_t n, double size) {
    return i == n ? size : static_cast<double>(i) * size / static_cast<double>(n);
}

}  // namespace

MeshData box_mesh(CellKind kind, const Vec3& origin, const Vec3& size, std::array<int, 3> cells) {
    const std::int64_t nx = cells[0], ny = cells[1], nz = cells[2];
    MeshData mesh;
    const auto num_cells =
        static_cast<std::size_t>((kind == CellKind::hexahedron ? 1 : 6) * nx * ny * nz);
    mesh.kinds.reserve(num_cells);
    mesh.regions.reserve(num_cells);
    mesh.offsets.reserve(num_cells + 1);
    mesh.corners.reserve(num_cells * static_cast<std::size_t>(traits(kind).num_corners));
    mesh.points.reserve(static_cast<std::size_t>((nx + 1) * (ny + 1) * (nz + 1)));
    for (std::int64_t k = 0; k <= nz; ++k)
        for (std::int64_t j = 0; j <= ny; ++j)
            for (std::int64_t i = 0; i <= nx; ++i) {
                const Vec3 step(coordinate(i, nx, size.x()), coordinate(j, ny, size.y()),
                                coordinate(k, nz, size.z()));
                mesh.points.push_back(origin + step);
            }

    const std::int64_t along[3] = {1, nx + 1, (nx + 1) * (ny + 1)};  // index steps in x, y, z
    // The six paths along edges from the lowest corner of a brick to its highest one. For odd
    // permutations two corners are exchanged, so that every tetrahedron has positive volume.
    constexpr int paths[6][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {2, 1, 0}, {2, 0, 1}, {0, 2, 1}};
    for (std::int64_t k = 0; k < nz; ++k)
        for (std::int64_t j = 0; j < ny; ++j)
            for (std::int64_t i = 0; i < nx; ++i) {
                const std::int64_t p = i + along[1] * j + along[2] * k;
                if (kind == CellKind::hexahedron) {
                    const std::int64_t q = p + along[2];
                    const std::int64_t corners[8] = {p, p + 1, p + 1 + along[1], p + along[1],
                                                     q, q + 1, q + 1 + along[1], q + along[1]};
                    mesh.add_cell(kind, corners);
                    continue;
                }
                for (int path = 0; path < 6; ++path) {
                    const std::int64_t a = p + along[paths[path][0]];
                    const std::int64_t b = a + along[paths[path][1]];
                    const std::int64_t c = b + along[paths[path][2]];
                    const bool odd = path % 2 == 1;
                    const std::int64_t corners[4] = {p, odd ? b : a, odd ? a : b, c};
                    mesh.add_cell(CellKind::tetrahedron, corners);
                }
            }
    return mesh;
}

}  // namespace incise::topology
