// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/triangulation.h"

#include <vector>

#include "incise/topology/darts.h"
#include "incise/topology/face_triangles.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// True if a cell at the face has an edge between two corners.
bool have_edge(const Mesh& mesh, FaceId f, VertexId a, VertexId b) {
    const FaceId other = mesh.neighbor(f);
    return find_dart(mesh, f.cell, a, b).is_valid() ||
           (other.is_valid() && find_dart(mesh, other.cell, a, b).is_valid());
}

}  // namespace

void triangulate(
    const Mesh& mesh, topology::MeshEdit& edit, FaceId face,
    const std::function<void(VertexId, VertexId)>& on_edge,
    const std::function<void(VertexId, std::span<const std::pair<VertexId, double>>)>& on_node) {
    while (mesh.face_size(face) > 3) {
        const topology::Ears ears(mesh, face);
        if (const auto best = ears.best([&](VertexId before, VertexId after) {
                return !have_edge(mesh, face, before, after);
            })) {
            const VertexId before = ears.corner(*best + ears.size() - 1),
                           after = ears.corner(*best + 1);
            edit.divide_face(face, after, before);  // the rest keeps the number
            on_edge(before, after);
            continue;
        }
        if (ears.size() > topology::max_corners) return;
        std::vector<std::pair<VertexId, double>> sources;
        for (std::size_t p = 0; p < ears.size(); ++p)
            sources.emplace_back(ears.corner(p), 1.0 / static_cast<double>(ears.size()));
        const VertexId centre = edit.divide_face_at_centre(face);
        on_node(centre, sources);
        for (const auto& [corner, weight] : sources) on_edge(corner, centre);
    }
}

}  // namespace incise::cutting
