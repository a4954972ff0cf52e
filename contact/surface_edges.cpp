// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/surface_edges.h"

#include <algorithm>
#include <utility>

#include "incise/topology/geometry.h"

namespace incise::contact {

namespace {

/// The normals of the two triangles at a sharp edge differ by more than 25 degrees. Between flatter
/// ones, nodes that meet triangles leave less overlap than a tenth of an element.
constexpr double cosine_of_sharp = 0.9;
/// A sharp edge goes on in another one if it does not turn by more than 37 degrees.
constexpr double cosine_of_straight = 0.8;

}  // namespace

Vec3 area_of(const Triangle& triangle, std::span<const Vec3> x) {
    return topology::doubled_area(x[triangle[0].index()], x[triangle[1].index()],
                                  x[triangle[2].index()]);
}

void SurfaceEdges::set_triangles(std::span<const Triangle> triangles,
                                 std::span<const Vec3> rest_positions) {
    list(triangles, rest_positions);
    join(rest_positions);
}

std::uint32_t SurfaceEdges::find(const std::array<VertexId, 2>& nodes) const {
    const auto it = std::ranges::lower_bound(edges_, nodes, {}, &SurfaceEdge::nodes);
    return it == edges_.end() || it->nodes != nodes
               ? no_edge
               : static_cast<std::uint32_t>(it - edges_.begin());
}

/// Lists the edges at which two triangles meet. Nodes of a surface are such that no more do.
void SurfaceEdges::list(std::span<const Triangle> triangles, std::span<const Vec3> X) {
    struct Side {
        VertexId to;
        std::uint32_t triangle;
        std::uint8_t corner;
        bool is_reversed;
    };
    // The sides of the triangles, by the lower one of their nodes.
    std::vector<std::size_t> begins(X.size() + 1, 0);
    const auto for_each_side = [&](const auto& visit) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
            for (std::uint8_t k = 0; k < 3; ++k) {
                const VertexId a = triangles[t][k], b = triangles[t][(k + 1) % 3];
                visit(std::min(a, b), Side{std::max(a, b), t, k, b < a});
            }
    };
    for_each_side([&](VertexId from, const Side&) { ++begins[from.index() + 1]; });
    for (std::size_t n = 1; n < begins.size(); ++n) begins[n] += begins[n - 1];
    std::vector<Side> sides(begins.back());
    std::vector<std::size_t> ends(begins.begin(), begins.end() - 1);
    for_each_side([&](VertexId from, const Side& side) { sides[ends[from.index()]++] = side; });

    edges_.clear();
    of_triangle_.assign(triangles.size(), {no_edge, no_edge, no_edge});
    for (std::size_t n = 0; n + 1 < begins.size(); ++n) {
        const auto of_node = std::span(sides).subspan(begins[n], begins[n + 1] - begins[n]);
        std::ranges::sort(of_node, {}, [](const Side& s) { return std::pair(s.to, s.triangle); });
        for (std::size_t i = 0; i + 1 < of_node.size(); ++i) {
            const Side &one = of_node[i], &two = of_node[i + 1];
            if (one.to != two.to || one.is_reversed == two.is_reversed) continue;
            const Vec3 a = area_of(triangles[one.triangle], X),
                       b = area_of(triangles[two.triangle], X);
            const VertexId third = triangles[two.triangle][(two.corner + 2) % 3];
            const bool is_sharp = a.dot(b) < cosine_of_sharp * a.norm() * b.norm() &&
                                  a.dot(X[third.index()] - X[n]) < 0.0;
            const auto number = static_cast<std::uint32_t>(edges_.size());
            of_triangle_[one.triangle][one.corner] = of_triangle_[two.triangle][two.corner] =
                number;
            edges_.push_back({{VertexId(n), one.to}, {one.triangle, two.triangle}, is_sharp});
            ++i;
        }
    }
}

/// Finds in which sharp edges others go on.
void SurfaceEdges::join(std::span<const Vec3> rest_positions) {
    struct End {
        VertexId node;
        std::uint32_t edge;
        std::size_t end;  // of the edge: 0 or 1
    };
    std::vector<End> ends;
    for (std::uint32_t edge = 0; edge < edges_.size(); ++edge)
        if (edges_[edge].is_sharp)
            for (std::size_t end = 0; end < 2; ++end)
                ends.push_back({edges_[edge].nodes[end], edge, end});
    std::ranges::sort(ends, {}, [](const End& at) { return std::pair(at.node, at.edge); });
    const auto away = [&](const End& at) -> Vec3 {  // from the node
        const auto& nodes = edges_[at.edge].nodes;
        return (rest_positions[nodes[1 - at.end].index()] - rest_positions[at.node.index()])
            .stableNormalized();
    };
    for (std::size_t begin = 0; begin < ends.size();) {
        std::size_t end = begin;
        while (end < ends.size() && ends[end].node == ends[begin].node) ++end;
        for (std::size_t i = begin; i < end; ++i) {
            double least = -cosine_of_straight;
            for (std::size_t k = begin; k < end; ++k) {
                const double cosine = away(ends[i]).dot(away(ends[k]));
                if (k == i || cosine >= least) continue;
                least = cosine;
                edges_[ends[i].edge].next[ends[i].end] = ends[k].edge;
            }
        }
        begin = end;
    }
}

}  // namespace incise::contact
