// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/first_surface.h"

#include <algorithm>

namespace incise::test {

using topology::ChangeSet;
using topology::Mesh;

namespace {

void add(std::vector<VertexId>& nodes, const std::vector<VertexId>& others) {
    nodes.insert(nodes.end(), others.begin(), others.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

template <class T>
T& grown(std::vector<T>& values, std::size_t index) {
    if (values.size() <= index) values.resize(index + 1);
    return values[index];
}

}  // namespace

FirstSurface::FirstSurface(const Mesh& mesh) : boundary_(mesh.element_capacity()) {
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n) first_nodes_.push_back({VertexId(n)});
    for (std::size_t e = 0; e < mesh.element_capacity(); ++e) ancestors_.emplace_back(e);
    for (const FaceId face : boundary_faces(mesh)) {
        Nodes corners;
        for (int k = 0; k < mesh.face_size(face); ++k) add(corners, {mesh.face_corner(face, k)});
        boundary_[face.cell.index()].push_back(corners);
    }
}

void FirstSurface::apply(const ChangeSet& changes) {
    for (const topology::VertexRecord& record : changes.nodes_added) {
        if (record.num_sources == 0) continue;  // an undo brings it back
        Nodes nodes;
        for (std::size_t k = 0; k < static_cast<std::size_t>(record.num_sources); ++k)
            add(nodes, first_nodes_[record.sources[k].node.index()]);
        grown(first_nodes_, record.id.index()) = nodes;
    }
    for (const topology::CellRecord& record : changes.elements_added) {
        if (!record.parent.is_valid()) continue;
        const CellId ancestor = ancestors_[record.parent.index()];
        grown(ancestors_, record.id.index()) = ancestor;
    }
}

bool FirstSurface::is_on_cut(const Mesh& mesh, FaceId face) const {
    if (mesh.neighbor(face).is_valid()) return false;
    Nodes nodes;
    for (int k = 0; k < mesh.face_size(face); ++k)
        add(nodes, first_nodes_[mesh.face_corner(face, k).index()]);
    return std::ranges::none_of(
        boundary_[ancestors_[face.cell.index()].index()],
        [&](const Nodes& of_face) { return std::ranges::includes(of_face, nodes); });
}

std::vector<FaceId> FirstSurface::faults(const Mesh& mesh) const {
    std::vector<FaceId> faults;
    for (const CellId e : mesh.elements())
        for (int f = 0; f < mesh.num_faces(e); ++f)
            if (mesh.is_on_cut({e, f}) != is_on_cut(mesh, {e, f})) faults.push_back({e, f});
    return faults;
}

}  // namespace incise::test
