// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/darts.h"

#include <algorithm>

namespace incise::topology {

Dart find_dart(const Mesh& mesh, FaceId f, VertexId from, VertexId to) {
    const int size = mesh.face_size(f);
    for (int p = 0; p < size; ++p)
        if (mesh.face_corner(f, p) == from && mesh.face_corner(f, p + 1 == size ? 0 : p + 1) == to)
            return {f, p};
    return {};
}

Dart find_dart(const Mesh& mesh, CellId e, VertexId from, VertexId to) {
    const int count = mesh.num_faces(e);
    for (int f = 0; f < count; ++f)
        if (const Dart d = find_dart(mesh, FaceId{e, f}, from, to); d.is_valid()) return d;
    return {};
}

void append_cells_at_edge(const Mesh& mesh, CellId e, VertexId a, VertexId b,
                          std::vector<CellId>& cells) {
    std::vector<CellId> star;
    collect_star(mesh, a, e, star);
    std::ranges::copy_if(star, std::back_inserter(cells),
                         [&](CellId other) { return find_dart(mesh, other, a, b).is_valid(); });
}

}  // namespace incise::topology
