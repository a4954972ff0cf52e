// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/cut_border.h"

#include <algorithm>
#include <array>

namespace incise::cutting {

using topology::ElementId;
using topology::FaceId;
using topology::Mesh;
using topology::NodeId;

namespace {

/// The elements that have a node on the cut. Those round a node hang together through faces at it.
std::vector<ElementId> elements_at(const Mesh& mesh, const CutFront& front) {
    std::vector<std::uint8_t> is_on_cut(mesh.node_capacity());
    std::vector<bool> is_known(mesh.element_capacity());
    std::vector<ElementId> elements;
    const auto is_at_cut = [&](ElementId e) {
        const auto corners = mesh.corners(e);
        return std::any_of(corners.begin(), corners.end(),
                           [&](NodeId n) { return is_on_cut[n.index()] != 0; });
    };
    const auto add = [&](ElementId e) {
        if (is_known[e.index()] || !is_at_cut(e)) return;
        is_known[e.index()] = true;
        elements.push_back(e);
    };
    front.for_each([&](NodeId n) {
        if (!mesh.is_alive(n)) return;
        is_on_cut[n.index()] = 1;
        add(mesh.anchor(n));
    });
    for (std::size_t next = 0; next < elements.size(); ++next)
        for (int f = 0; f < mesh.num_faces(elements[next]); ++f)
            if (const FaceId other = mesh.neighbor({elements[next], f}); other.is_valid())
                add(other.element);
    return elements;
}

/// Whether crossings round one of the element's faces are odd in number.
bool has_odd_face(const Mesh& mesh, const CutFront& front, ElementId e) {
    const topology::CellTraits& t = traits(mesh.kind(e));
    const auto corners = mesh.corners(e);
    // By corner, a bit for each other to which the edge is crossed.
    std::array<unsigned, topology::max_corners> crossed{};
    bool is_any = false;
    for (int k = 0; k < t.num_edges; ++k) {
        const auto [p, q] = t.edges[static_cast<std::size_t>(k)];
        const auto i = static_cast<std::size_t>(p), j = static_cast<std::size_t>(q);
        if (!front.is_crossed(corners[i], corners[j])) continue;
        crossed[i] |= 1u << q;
        crossed[j] |= 1u << p;
        is_any = true;
    }
    if (!is_any) return false;
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        unsigned count = 0;
        for (std::size_t p = 0; p < face.size(); ++p)
            count += crossed[static_cast<std::size_t>(face[p])] >> face[(p + 1) % face.size()] & 1u;
        if (count % 2 == 1) return true;
    }
    return false;
}

}  // namespace

std::vector<std::uint8_t> nodes_beside_border(const Mesh& mesh, const CutFront& front, bool snaps) {
    const std::vector<ElementId> elements = elements_at(mesh, front);
    const auto corners_of_those = [&](auto is_one) {
        std::vector<std::uint8_t> nodes(mesh.node_capacity());
        for (const ElementId e : elements)
            if (is_one(e))
                for (const NodeId n : mesh.corners(e)) nodes[n.index()] = 1;
        return nodes;
    };
    const auto corners_of_those_with = [&](auto is_one) {
        return corners_of_those([&](ElementId e) {
            const auto corners = mesh.corners(e);
            return std::any_of(corners.begin(), corners.end(), is_one);
        });
    };
    const auto of_border =
        corners_of_those([&](ElementId e) { return has_odd_face(mesh, front, e); });
    const auto beside = corners_of_those_with([&](NodeId n) { return of_border[n.index()] != 0; });
    if (!snaps) return beside;
    const auto of_wide_border =
        corners_of_those_with([&](NodeId n) { return beside[n.index()] != 0 && front.is_on(n); });
    return corners_of_those_with([&](NodeId n) { return of_wide_border[n.index()] != 0; });
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
