// Two bricks of which a cut has divided one, as plain arrays: the smallest body with polyhedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::test {

/// Appends a face to the list of faces of a polyhedron.
inline void add_face(std::vector<std::int64_t>& faces, const std::vector<std::int64_t>& points) {
    faces.push_back(static_cast<std::int64_t>(points.size()));
    faces.insert(faces.end(), points.begin(), points.end());
    ++faces.front();
}

/// Returns two unit cubes side by side along x. The plane z = 1/2 has cut the first one, up to the
/// second one, which has the front of the cut in its face. Cells 0 and 1 are the lower and the
/// upper half of the first cube, with the cut as the top and the bottom; cell 2 is the second cube.
inline topology::MeshData cut_bricks() {
    using topology::CellKind;
    topology::MeshData data;
    const auto corner = [](int x, int y, int z) { return std::int64_t{x + 3 * y + 6 * z}; };
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x) data.points.emplace_back(x, y, z);
    // Of the lower and the upper half at x = 0, then of all at x = 1; each for y = 0 and y = 1.
    for (const double x : {0.0, 0.0, 1.0})
        for (const double y : {0.0, 1.0}) data.points.emplace_back(x, y, 0.5);
    const auto cube = [&](int x) {
        return std::array{corner(x, 0, 0),     corner(x + 1, 0, 0), corner(x + 1, 1, 0),
                          corner(x, 1, 0),     corner(x, 0, 1),     corner(x + 1, 0, 1),
                          corner(x + 1, 1, 1), corner(x, 1, 1)};
    };
    const auto box = [&](const std::array<std::int64_t, 8>& corners) {
        std::vector<std::int64_t> faces{0};
        const auto& hexahedron = topology::traits(CellKind::hexahedron);
        for (int f = 0; f < hexahedron.num_faces; ++f) {
            std::vector<std::int64_t> points;
            for (const int k : hexahedron.face(f))
                points.push_back(corners[static_cast<std::size_t>(k)]);
            add_face(faces, points);
        }
        data.add_polyhedron(faces, 4);
    };
    const std::array a = cube(0), c = cube(1);
    box({a[0], a[1], a[2], a[3], 12, 16, 17, 13});
    box({14, 16, 17, 15, a[4], a[5], a[6], a[7]});
    std::vector<std::int64_t> faces{0};
    add_face(faces, {c[0], 16, 17, c[3]});
    add_face(faces, {16, c[4], c[7], 17});
    add_face(faces, {c[1], c[2], c[6], c[5]});
    add_face(faces, {c[0], c[1], c[5], c[4], 16});
    add_face(faces, {c[3], 17, c[7], c[6], c[2]});
    add_face(faces, {c[0], c[3], c[2], c[1]});
    add_face(faces, {c[4], c[5], c[6], c[7]});
    data.add_polyhedron(faces, 4);
    data.set_on_cut(0, 5);
    data.set_on_cut(1, 4);
    for (const auto& corners : {a, c}) {
        std::vector<Vec3> x;
        for (const std::int64_t p : corners) x.push_back(data.points[static_cast<std::size_t>(p)]);
        data.carriers.corners.emplace_back(CellKind::hexahedron, x);
    }
    data.carriers.of_cell = {0, 0, 1};
    data.points_may_coincide = true;
    return data;
}

}  // namespace incise::test
