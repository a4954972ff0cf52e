// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/display_mesh.h"

#include <algorithm>
#include <set>

namespace incise::live {

DisplayMesh::DisplayMesh(const topology::Mesh& mesh) {
    std::set<int> regions;
    for (const CellId e : mesh.elements()) regions.insert(mesh.region(e));
    regions_.assign(regions.begin(), regions.end());
}

void DisplayMesh::update(const topology::BoundarySurface& surface, const topology::Mesh& mesh) {
    nodes_.clear();
    tags_.clear();
    elements_.clear();
    next_.clear();
    first_.assign(mesh.node_capacity(), none);
    const auto triangles = surface.triangles();
    triangles_.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const CellId e = surface.faces()[t].cell;
        const auto region = std::ranges::lower_bound(regions_, mesh.region(e));
        std::uint32_t tag = static_cast<std::uint32_t>(region - regions_.begin());
        if (surface.is_cut()[t]) tag |= is_cut;
        for (std::size_t i = 0; i < 3; ++i) triangles_[t][i] = vertex(triangles[t][i], tag, e);
    }
}

std::uint32_t DisplayMesh::vertex(VertexId n, std::uint32_t tag, CellId e) {
    std::uint32_t* link = &first_[n.index()];
    for (; *link != none; link = &next_[*link])
        if (tags_[*link] == tag) return *link;
    const auto added = static_cast<std::uint32_t>(nodes_.size());
    *link = added;  // before the list grows
    nodes_.push_back(n);
    tags_.push_back(tag);
    elements_.push_back(e);
    next_.push_back(none);
    return added;
}

}  // namespace incise::live
