// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/triangulation.h"

#include <cmath>

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

std::optional<std::pair<VertexId, VertexId>> next_ear(const Mesh& mesh, FaceId face,
                                                      const std::function<bool(VertexId)>& waits) {
    const topology::Ears ears(mesh, face);
    constexpr double flat = 1e-12;  // by rounding: corners on a line
    for (const bool may_wait : {false, true}) {
        const auto best = ears.best([&](VertexId before, VertexId corner, VertexId after) {
            return (may_wait || !waits(corner)) && !have_edge(mesh, face, before, after);
        });
        if (!best) continue;
        const double quality = ears.quality_of(*best);
        if (may_wait ? std::abs(quality) < flat : quality < flat) continue;
        return std::pair(ears.corner(*best + 1), ears.corner(*best + ears.size() - 1));
    }
    return std::nullopt;
}

}  // namespace incise::cutting
