// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/surface_boundary.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace incise::cutting {

using topology::Mesh;

namespace {

/// A front is examined when more than this share of its nodes is new.
constexpr double growth_before_look = 0.5;

/// A blade that is this many edge lengths away from its whole front has probably left it.
constexpr double far_away = 4.0;

/// How many rings of elements round the boundary a front keeps. A blade that turns and comes back
/// beside its path meets its own cut, and must find all of it or nothing.
constexpr std::uint8_t num_rings_kept = 8;

/// A number for each node, by id.
using Marks = std::vector<std::uint8_t>;

bool has_corner(const Mesh& mesh, CellId e, const Marks& marks, std::uint8_t mark) {
    const auto corners = mesh.corners(e);
    return std::any_of(corners.begin(), corners.end(),
                       [&](VertexId n) { return marks[n.index()] == mark; });
}

/// Returns the elements that have a node on the cut. Those at a node are connected through faces at
/// it.
std::vector<CellId> elements_at(const Mesh& mesh, const CutFront& front) {
    constexpr std::uint8_t on_cut = 1;
    Marks marks(mesh.node_capacity());
    std::vector<bool> is_known(mesh.element_capacity());
    std::vector<CellId> elements;
    const auto add = [&](CellId e) {
        if (is_known[e.index()] || !has_corner(mesh, e, marks, on_cut)) return;
        is_known[e.index()] = true;
        elements.push_back(e);
    };
    front.for_each([&](VertexId n) {
        if (!mesh.is_alive(n)) return;
        marks[n.index()] = on_cut;
        add(mesh.incident_element(n));
    });
    // NOLINTNEXTLINE(modernize-loop-convert): the list grows in the loop
    for (std::size_t next = 0; next < elements.size(); ++next)
        for (int f = 0; f < mesh.num_faces(elements[next]); ++f)
            if (const FaceId other = mesh.neighbor({elements[next], f}); other.is_valid())
                add(other.cell);
    return elements;
}

/// The crossed edges of a front by node id, for quick answers about all edges at the front.
class CrossedEdges {
  public:
    CrossedEdges(const Mesh& mesh, const CutFront& front) : places_(mesh.node_capacity()) {
        front.for_each_crossed([&](VertexId n, const std::vector<VertexId>& others) {
            if (n.index() >= places_.size()) return;
            others_.push_back(&others);
            places_[n.index()] = static_cast<std::uint32_t>(others_.size());
        });
    }

    bool contains(VertexId a, VertexId b) const {
        if (places_[a.index()] == 0 || places_[b.index()] == 0) return false;
        const std::vector<VertexId>& others = *others_[places_[a.index()] - 1];
        return std::find(others.begin(), others.end(), b) != others.end();
    }

  private:
    std::vector<const std::vector<VertexId>*> others_;
    std::vector<std::uint32_t> places_;  // by node id: 0 for none, else 1 + the index in others_
};

/// True if the number of intersections round one of the element's faces is odd and the sweep has
/// ended in this face.
bool has_boundary(const Mesh& mesh, const CutSurface& surface, const PositionOf& position,
                  const CrossedEdges& edges, CellId e) {
    const topology::CellTraits& t = traits(mesh.kind(e));
    const auto corners = mesh.corners(e);
    // By corner, a bit for each other corner to which the edge is crossed.
    std::array<unsigned, topology::max_corners> crossed{};
    bool is_any = false;
    for (int k = 0; k < t.num_edges; ++k) {
        const auto [p, q] = t.edges[static_cast<std::size_t>(k)];
        const auto i = static_cast<std::size_t>(p), j = static_cast<std::size_t>(q);
        if (!edges.contains(corners[i], corners[j])) continue;
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
        if (count % 2 == 0) continue;
        std::array<MovingPoint, 3> triangle;
        for (std::size_t p = 0; p < 3; ++p) {
            const Vec3 x = position(corners[static_cast<std::size_t>(face[p])]);
            triangle[p] = {x, x};
        }
        if (surface.ends_inside(triangle).value_or(true)) return true;
    }
    return false;
}

/// Returns by node id the ring of elements round the boundary of the cut in which a node of the
/// front is. It is 1 at the boundary, and 0 for nodes that are farther away than the rings kept.
/// For other nodes it has no meaning.
Marks rings_round_border(const Mesh& mesh, const CutSurface& surface, const PositionOf& position,
                         const CutFront& front) {
    Marks rings(mesh.node_capacity());
    // Across opened faces, too, so that a cut is forgotten on both sides at once.
    const auto reach = [&](CellId e, std::uint8_t ring) {
        for (const VertexId n : mesh.corners(e)) {
            if (rings[n.index()] != 0) continue;
            rings[n.index()] = ring;
            for (VertexId twin = front.next_twin(n); twin != n; twin = front.next_twin(twin))
                rings[twin.index()] = ring;
        }
    };
    const std::vector<CellId> elements = elements_at(mesh, front);
    const CrossedEdges edges(mesh, front);
    for (const CellId e : elements)
        if (has_boundary(mesh, surface, position, edges, e)) reach(e, 1);
    for (std::uint8_t ring = 1; ring < num_rings_kept; ++ring)
        for (const CellId e : elements)
            if (has_corner(mesh, e, rings, ring)) reach(e, static_cast<std::uint8_t>(ring + 1));
    return rings;
}

/// Makes nodes no longer count as on the cut. Each is first put on the side of its neighbours off
/// the cut. No edge to these is crossed then, and the counts of its other edges stay true.
void forget(const Mesh& mesh, const std::vector<VertexId>& nodes, CutFront& front) {
    std::vector<CellId> star;
    std::vector<VertexId> neighbors;
    for (const VertexId n : nodes) {
        if (!mesh.is_alive(n)) continue;
        mesh.star(n, star);
        neighbors.clear();
        int balance = 0;
        for (const CellId e : star)
            for (const VertexId other : mesh.corners(e)) {
                if (other == n) continue;
                neighbors.push_back(other);
                if (!front.is_on(other)) balance += front.is_crossed(n, other) ? 1 : -1;
            }
        if (balance <= 0) continue;
        std::sort(neighbors.begin(), neighbors.end());
        neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
        for (const VertexId other : neighbors) front.toggle(n, other);
    }
    front.forget(mesh, nodes);
}

}  // namespace

void leave_behind(const Mesh& mesh, const CutSurface& surface, const PositionOf& position,
                  bool has_crossed, CutFront& front) {
    if (front.is_empty()) return;
    const auto is_far = [&] {
        bool is_near = false;
        front.for_each([&](VertexId n) {
            is_near =
                is_near || (mesh.is_alive(n) &&
                            surface.ends_near(position(n), far_away * front.local_edge_length(n)));
        });
        return !is_near;
    };
    const bool has_grown = static_cast<double>(front.num_new()) >
                           growth_before_look * static_cast<double>(front.size());
    if (has_crossed ? !has_grown : !front.has_changed() && !is_far()) return;
    const Marks rings = rings_round_border(mesh, surface, position, front);
    forget(mesh, front.nodes_unless([&](VertexId n) {
        return mesh.is_alive(n) && rings[n.index()] != 0;
    }),
           front);
    front.set_reviewed();  // forget() has changed crossed edges
}

}  // namespace incise::cutting
