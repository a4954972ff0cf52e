// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/cut_border.h"

#include <algorithm>

namespace incise::cutting {

using topology::ElementId;
using topology::FaceId;
using topology::Mesh;
using topology::NodeId;

CutBorder::CutBorder(const Mesh& mesh, const CutFront& front, bool snaps) : mesh_(mesh) {
    const auto is_odd = [&](FaceId f) {
        bool odd = false;
        const int size = mesh.face_size(f);
        for (int p = 0; p < size; ++p)
            odd ^= front.is_crossed(mesh.face_corner(f, p), mesh.face_corner(f, (p + 1) % size));
        return odd;
    };
    const auto add = [&](ElementId e) {
        for (const NodeId n : mesh.corners(e)) nodes_.insert(n.value);
    };
    front.for_each([&](NodeId n) {
        if (!mesh.is_alive(n)) return;
        mesh.star(n, star_);
        for (const ElementId e : star_)
            for (int f = 0; f < mesh.num_faces(e); ++f)
                if (is_odd({e, f})) {
                    add(e);
                    break;
                }
    });
    if (!snaps) return;
    std::vector<NodeId> beside;
    front.for_each([&](NodeId n) {
        if (mesh.is_alive(n) && is_beside(n)) beside.push_back(n);
    });
    for (const NodeId n : beside) {
        mesh.star(n, star_);
        for (const ElementId e : star_) add(e);
    }
}

bool CutBorder::is_beside(NodeId n) {
    mesh_.star(n, star_);
    for (const ElementId e : star_)
        for (const NodeId corner : mesh_.corners(e))
            if (nodes_.contains(corner.value)) return true;
    return false;
}

void forget(const Mesh& mesh, const std::vector<NodeId>& nodes, CutFront& front) {
    std::vector<ElementId> star;
    std::vector<NodeId> neighbors;
    for (const NodeId n : nodes) {
        if (!mesh.is_alive(n)) continue;
        mesh.star(n, star);
        neighbors.clear();
        int balance = 0;
        for (const ElementId e : star)
            for (const NodeId other : mesh.corners(e)) {
                if (other == n) continue;
                neighbors.push_back(other);
                if (!front.is_on(other)) balance += front.is_crossed(n, other) ? 1 : -1;
            }
        if (balance <= 0) continue;
        std::sort(neighbors.begin(), neighbors.end());
        neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
        for (const NodeId other : neighbors) front.toggle(n, other);
    }
    front.forget(nodes);
}

}  // namespace incise::cutting
