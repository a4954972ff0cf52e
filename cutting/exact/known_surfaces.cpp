// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/known_surfaces.h"

#include <algorithm>

#include "incise/cutting/exact/split.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// Positions nearer to each other than this share of the size of cells count as the same.
constexpr double same_place = 1e-6;
/// How far nodes may have moved across a surface that comes again, as a share of the size of cells.
/// What has moved farther may be another part of the tissue.
constexpr double near_known = 0.3;
/// Nodes nearer than this share to the surface, beside nodes on it, may be on its wrong side, too.
constexpr double beside_known = 0.05;

/// Returns the intersection of a surface with the tissue at rest between two points, if their
/// number is odd.
std::optional<Crossing> crossing_between(const CutSurface& surface, const Vec3& a, const Vec3& b) {
    std::vector<Crossing> crossings;
    surface.append_crossings({a, a}, {b, b}, crossings);
    return crossings.size() % 2 == 1 ? std::optional(crossings.front()) : std::nullopt;
}

bool are_along(const Vec3& a, const Vec3& b) {
    return a.cross(b).norm() <= same_place * a.norm() * b.norm();
}

/// Returns the nodes to which a node has an edge.
std::vector<VertexId> neighbors(const Mesh& mesh, VertexId n) {
    std::vector<CellId> star;
    mesh.star(n, star);
    std::vector<VertexId> found;
    for (const CellId e : star)
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const int size = mesh.face_size({e, f});
            for (int p = 0; p < size; ++p) {  // each edge is in two faces, once each way
                if (mesh.face_corner({e, f}, p) != n) continue;
                const VertexId next = mesh.face_corner({e, f}, (p + 1) % size);
                if (std::ranges::find(found, next) == found.end()) found.push_back(next);
            }
        }
    return found;
}

/// Finds the sides of a surface on which its nodes are to be: those of the nodes that they hang
/// together with and that are not near the surface.
class SideSearch {
  public:
    SideSearch(const Mesh& mesh, const CutSurface& surface,
               const topology::NodeField<VertexId, Vec3>& x, double size)
        : mesh_(mesh), surface_(surface), x_(x), size_(size) {}

    /// @param nodes  that were on the surface, in ascending order
    KnownSurfaces::Seen find(std::vector<VertexId> nodes) {
        std::erase_if(nodes, [&](VertexId n) { return !is_within(n, near_known); });
        on_surface_.insert(nodes.begin(), nodes.end());
        for (std::size_t i = 0; i < nodes.size(); ++i)  // more are added
            for (const VertexId n : neighbors(mesh_, nodes[i]))
                if (is_within(n, beside_known) && on_surface_.insert(n).second) nodes.push_back(n);
        for (const VertexId n : nodes)
            for (const VertexId other : neighbors(mesh_, n))
                if (!on_surface_.contains(other) && !is_within(other, near_known)) {
                    put_beside(n, x_[other]);
                    break;
                }
        go_on_from(0);
        for (const VertexId n : nodes)
            if (!places_.contains(n)) place_small_part(n);
        move_neighbors();
        KnownSurfaces::Seen seen{std::move(on_surface_), {}};
        for (const VertexId n : moved_) seen.displaced.emplace_back(n, places_.at(n));
        return seen;
    }

  private:
    bool is_within(VertexId n, double share) const {
        const Vec3 reach = Vec3::Constant(share * size_);
        return surface_.may_meet(Box(x_[n] - reach, x_[n] + reach));
    }
    /// Puts a node on the side of another one, to which it has an edge.
    /// @param other  where that is, m
    void put_beside(VertexId n, const Vec3& other) {
        Vec3 way = Vec3::Zero();
        if (const auto crossing = crossing_between(surface_, x_[n], other)) {
            const Vec3 to = other - x_[n], normal = crossing->normal.normalized();
            way = std::min(1.0, crossing->place + default_snap * size_ / to.norm()) * to;
            moved_.push_back(n);
            ways_[n] = normal.dot(way) * normal;
        }
        places_[n] = x_[n] + way;
        queue_.push_back(n);
    }
    void go_on_from(std::size_t begin) {
        for (std::size_t i = begin; i < queue_.size(); ++i)  // more are added
            for (const VertexId n : neighbors(mesh_, queue_[i]))
                if (on_surface_.contains(n) && !places_.contains(n))
                    put_beside(n, places_.at(queue_[i]));
    }
    /// Places a node of a part of the body that is near the surface as a whole, and all nodes of
    /// the part: on the side of most of them.
    void place_small_part(VertexId n) {
        const std::size_t begin = queue_.size(), num_moved = moved_.size();
        put_beside(n, x_[n]);
        go_on_from(begin);
        if (2 * (moved_.size() - num_moved) <= queue_.size() - begin) return;
        const VertexId other = moved_.back();
        for (std::size_t i = begin; i < queue_.size(); ++i) places_.erase(queue_[i]);
        queue_.resize(begin);
        moved_.resize(num_moved);
        put_beside(other, x_[other]);
        go_on_from(begin);
    }
    /// Moves the nodes beside those that are moved, where the same motion has carried them through
    /// the surface, too.
    void move_neighbors() {
        for (std::size_t i = 0; i < moved_.size(); ++i) {  // more are added
            const Vec3 way = ways_.at(moved_[i]);
            for (const VertexId n : neighbors(mesh_, moved_[i])) {
                if (places_.contains(n) || !crossing_between(surface_, x_[n], x_[n] + way))
                    continue;
                places_[n] = x_[n] + way;
                ways_[n] = way;
                moved_.push_back(n);
            }
        }
    }

    const Mesh& mesh_;
    const CutSurface& surface_;
    const topology::NodeField<VertexId, Vec3>& x_;
    const double size_;
    std::unordered_set<VertexId> on_surface_;
    std::unordered_map<VertexId, Vec3> places_;  // of nodes whose side is known, m
    std::unordered_map<VertexId, Vec3> ways_;    // of those that are moved, across the surface, m
    std::vector<VertexId> queue_, moved_;
};

}  // namespace

std::optional<KnownSurfaces::Number> KnownSurfaces::find(const CutSurface& surface,
                                                         double size) const {
    if (surface.identity() == no_identity) return std::nullopt;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Known& known = known_[i];
        if (known.identity != surface.identity()) continue;
        const Vec3 way = same_place * size * known.normal;
        const auto crossing = crossing_between(surface, known.point - way, known.point + way);
        if (crossing && are_along(crossing->normal, known.normal)) return static_cast<Number>(i);
    }
    return std::nullopt;
}

void KnownSurfaces::note(const Mesh& mesh, const CutSurface& surface, const LoopFront& front,
                         const topology::ChangeSet& changes,
                         const topology::NodeField<VertexId, Vec3>& x, double size) {
    if (surface.identity() == no_identity || front.is_empty()) return;
    auto number = find(surface, size);
    // A place of the surface is where it crosses an edge that was there before.
    const auto know_from = [&](VertexId a, VertexId b) {
        if (number || std::max(a, b).index() >= changes.node_capacity_before) return;
        const auto crossing = crossing_between(surface, x[a], x[b]);
        if (!crossing) return;
        number = static_cast<Number>(known_.size());
        known_.push_back({surface.identity(), x[a] + crossing->place * (x[b] - x[a]),
                          crossing->normal.normalized()});
    };
    for (const topology::VertexRecord& record : changes.nodes_added)
        if (record.num_sources == 2 && front.is_on(record.id))
            know_from(record.sources[0].node, record.sources[1].node);
    if (!number) {  // it has divided no edge, but goes through nodes
        std::vector<std::pair<VertexId, VertexId>> nodes;  // with those of which they are copies
        front.for_each([&](VertexId n) { nodes.emplace_back(n, n); });
        for (const topology::VertexRecord& record : changes.nodes_added)
            if (record.num_sources == 1) nodes.emplace_back(record.id, record.sources[0].node);
        std::ranges::sort(nodes);
        for (const auto& [n, source] : nodes)
            if (!number && front.is_on(source))
                for (const VertexId other : neighbors(mesh, n)) know_from(source, other);
    }
    if (!number) return;
    front.for_each([&](VertexId n) {
        std::vector<Number>& surfaces = surfaces_of_[n];
        const auto at = std::ranges::lower_bound(surfaces, *number);
        if (at == surfaces.end() || *at != *number) surfaces.insert(at, *number);
    });
}

KnownSurfaces::Seen KnownSurfaces::seen(const Mesh& mesh, const CutSurface& surface, Number number,
                                        const topology::NodeField<VertexId, Vec3>& x,
                                        double size) const {
    std::vector<VertexId> nodes;
    for (const auto& [n, surfaces] : surfaces_of_)
        if (std::ranges::binary_search(surfaces, number)) nodes.push_back(n);
    std::ranges::sort(nodes);
    return SideSearch(mesh, surface, x, size).find(std::move(nodes));
}

void KnownSurfaces::apply(const topology::ChangeSet& changes) {
    if (surfaces_of_.empty()) return;
    for (const topology::VertexRecord& record : changes.nodes_removed)
        surfaces_of_.erase(record.id);
    for (const topology::VertexRecord& record : changes.nodes_added) {  // sources first
        std::vector<Number> all;
        for (int s = 0; s < record.num_sources; ++s) {
            const auto of_source =
                surfaces_of_.find(record.sources[static_cast<std::size_t>(s)].node);
            if (of_source == surfaces_of_.end()) {
                all.clear();
                break;
            }
            if (s == 0) {
                all = of_source->second;
                continue;
            }
            std::erase_if(all, [&](Number number) {
                return !std::ranges::binary_search(of_source->second, number);
            });
        }
        if (all.empty()) continue;
        std::vector<Number>& surfaces = surfaces_of_[record.id];
        all.insert(all.end(), surfaces.begin(), surfaces.end());
        std::ranges::sort(all);
        all.erase(std::unique(all.begin(), all.end()), all.end());
        surfaces = std::move(all);
    }
}

bool KnownSurfaces::is_on(const Mesh& mesh) const {
    return std::ranges::all_of(surfaces_of_, [&](const auto& entry) {
        return entry.first.index() < mesh.node_capacity() && std::ranges::is_sorted(entry.second) &&
               std::ranges::all_of(entry.second,
                                   [&](Number number) { return number < known_.size(); });
    });
}

}  // namespace incise::cutting
