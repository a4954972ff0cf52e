// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/cut_front.h"

#include <algorithm>
#include <array>
#include <unordered_set>

namespace incise::cutting {

using topology::Mesh;

void CutFront::put_on(VertexId n, bool is_exact, double local_edge_length, std::uint64_t rank) {
    const auto [place, is_new] = nodes_.try_emplace(n, Node{is_exact, local_edge_length, rank, n});
    place->second.local_edge_length = std::max(place->second.local_edge_length, local_edge_length);
    num_new_ += is_new;
    has_changed_ = true;
}

bool CutFront::is_crossed(VertexId a, VertexId b) const {
    const auto place = crossed_.find(a);
    return place != crossed_.end() &&
           std::find(place->second.begin(), place->second.end(), b) != place->second.end();
}

void CutFront::toggle(VertexId a, VertexId b) {
    has_changed_ = true;
    const auto toggle_from = [&](VertexId from, VertexId to) {
        auto& others = crossed_[from];
        const auto place = std::find(others.begin(), others.end(), to);
        if (place == others.end()) {
            others.push_back(to);
            return;
        }
        others.erase(place);
        if (others.empty()) crossed_.erase(from);
    };
    toggle_from(a, b);
    toggle_from(b, a);
}

std::optional<CutFront::Place> CutFront::place_of(CellId e,
                                                  std::span<const VertexId, 4> corners) const {
    for (const VertexId n : corners)
        if (!is_on(n)) return Place{n};
    // Until this corner came to the cut, it gave the side of the element. So the element keeps its
    // side, and its faces that opened in earlier steps are those that a single step would open.
    VertexId last;
    for (const VertexId n : corners)
        if (is_near(n) && (!last.is_valid() || rank(n) > rank(last))) last = n;
    if (last.is_valid()) return Place{last};
    const auto place = places_.find(e);
    if (place == places_.end()) return std::nullopt;
    const auto& [corner, is_crossed] = place->second;
    return Place{corners[static_cast<std::size_t>(corner)], is_crossed};
}

void CutFront::place_halves(const Mesh& mesh, VertexId a, VertexId b, VertexId middle,
                            std::span<const topology::MeshEdit::DividedElement> elements) {
    for (const auto& [kept, added] : elements) {
        std::array<VertexId, 4> whole;
        std::ranges::replace_copy(mesh.corners(kept), whole.begin(), middle, b);
        const std::optional<Place> place = place_of(kept, whole);
        places_.erase(kept);
        if (!place) continue;
        for (const auto& [half, lost] : {std::pair(kept, b), std::pair(added, a)}) {
            const auto corners = mesh.corners(half);
            if (!std::ranges::all_of(corners, [&](VertexId n) { return is_on(n); })) continue;
            const bool is_beyond = place->corner == lost;
            const VertexId corner = is_beyond ? middle : place->corner;
            places_[half] = {
                mesh.corner_of(half, corner),
                is_beyond ? place->is_crossed == is_crossed(lost, middle) : place->is_crossed};
        }
    }
}

bool CutFront::is_on(const topology::Mesh& mesh) const {
    std::unordered_set<VertexId> followers;
    const auto is_sound = [&](const auto& node) {
        const VertexId n = node.first, twin = node.second.next_twin;
        return n.is_valid() && n.index() < mesh.node_capacity() && is_on(twin) &&
               followers.insert(twin).second;
    };
    const auto is_element = [&](CellId e) {
        return e.is_valid() && e.index() < mesh.element_capacity();
    };
    const auto is_place = [&](const auto& place) {
        return is_element(place.first) && place.second.corner >= 0 && place.second.corner < 4;
    };
    return std::ranges::all_of(nodes_, is_sound) && std::ranges::all_of(places_, is_place);
}

// If both ends of an edge were copied, too many pairs of copies are noted as crossed. The mesh has
// no such edges, so nothing depends on them.
void CutFront::apply(const Mesh&, const topology::ChangeSet& changes, bool has_opened_faces_of_it) {
    if (is_empty() || changes.is_empty()) return;
    has_changed_ = true;
    for (const topology::VertexRecord& record : changes.nodes_added) {
        if (record.num_sources != 1) continue;
        const VertexId source = record.sources[0].node;
        if (const auto place = nodes_.find(source); place != nodes_.end()) {
            Node copy = place->second;
            if (!has_opened_faces_of_it) copy.next_twin = record.id;
            if (nodes_.emplace(record.id, copy).second) {
                ++num_new_;
                if (has_opened_faces_of_it) nodes_.at(source).next_twin = record.id;
            }
        }
        const auto place = crossed_.find(source);
        if (place == crossed_.end()) continue;
        for (const VertexId other : std::vector<VertexId>(place->second)) toggle(record.id, other);
    }
}

void CutFront::forget(const Mesh& mesh, const std::vector<VertexId>& nodes) {
    for (const VertexId n : nodes) {
        if (const auto place = nodes_.find(n); place != nodes_.end()) {
            VertexId before = n;
            while (next_twin(before) != n) before = next_twin(before);
            nodes_.at(before).next_twin = place->second.next_twin;
            nodes_.erase(place);
        }
        const auto place = crossed_.find(n);
        if (place == crossed_.end()) continue;
        for (const VertexId other : std::vector<VertexId>(place->second)) {
            // Edges to nodes off the cut are forgotten with the node. Others also belong to their
            // other end.
            if (!is_on(other)) toggle(n, other);
        }
    }
    std::erase_if(places_, [&](const auto& place) {
        const CellId e = place.first;
        return !mesh.is_alive(e) ||
               std::ranges::any_of(mesh.corners(e), [&](VertexId n) { return !is_on(n); });
    });
}

}  // namespace incise::cutting
