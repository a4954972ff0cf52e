// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/edge_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "incise/base/error.h"
#include "incise/contact/rigid_touch.h"
#include "incise/contact/surface_contact.h"
#include "incise/contact/way_inside.h"

namespace incise::contact {

namespace {

/// Edges are a point of contact if they may meet in so many steps like the last one.
constexpr double most_steps = 4.0;
/// Edges that are nearly parallel, by the sine between them, or that cross so near to where a sharp
/// edge ends, as a part of an edge, are no point of contact: nodes there meet triangles.
struct Limits {
    double least_sine, near_end;
};
constexpr Limits to_begin{0.01, 2e-3}, to_stay{1e-3, 1e-6};
/// Where another edge goes on, the crossing belongs to one of the two.
constexpr double at_node = -1e-9;
/// No overlap begins deeper than this part of the local length.
constexpr double deepest_begin = 0.4;
/// An overlap of this part of the local length is one even if the normal is right for one edge
/// only. Less may be rounding, or the rims of two sides of a cut that are pressed on each other.
constexpr double one_sided = 0.005;
/// Where an edge lies flat on a face, its direction out is that of the face. Flat faces bend a
/// little.
constexpr double beside_to_begin = 0.02, beside_to_stay = 0.1;

/// Where two edges cross each other as seen at right angles to both.
struct Crossing {
    std::array<double, 2> at;  ///< parts of the ways from their first nodes to their second ones
    Vec3 normal;               ///< at right angles to both
    /// Above zero if they cross too near to an end or beside it, or are nearly parallel: then they
    /// do not cross before two of their points have come by so much nearer to each other, m.
    double room;
};

/// The edges go from p to q and from a to b.
/// @param ends  of the two edges, true: it ends there; false: another one goes on
Crossing cross(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
               const std::array<std::array<bool, 2>, 2>& ends, const Limits& limits) {
    const double least_sine = limits.least_sine;
    // The bounds are of first order. Half of them is within what the next order adds.
    constexpr double safe = 0.5;
    const Vec3 u = q - p, v = b - a, w = p - a, across = u.cross(v);
    const double u_length = u.norm(), v_length = v.norm(), area = across.norm(),
                 sine = area / (u_length * v_length);
    // No edge turns by more than what its ends move, by its length.
    if (!(sine > least_sine))
        return {
            {}, {}, std::max(0.0, safe * (least_sine - sine) / (1.0 / u_length + 1.0 / v_length))};
    const double vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
    const double s = (uv * vw - vv * uw) / (area * area), t = (uv * s + vw) / vv;
    const auto beside = [&](double part, const std::array<bool, 2>& is_end) {
        return std::max((is_end[0] ? limits.near_end : at_node) - part,
                        part - 1.0 + (is_end[1] ? limits.near_end : at_node));
    };
    const double outside = std::max(beside(s, ends[0]) * u_length, beside(t, ends[1]) * v_length);
    if (!(outside > 0.0)) return {{s, t}, across / area, 0.0};
    // Where the edges cross, their lines move by what the ends do, extrapolated; and by how the
    // direction turns, along the distance of the lines.
    const double extrapolated = 1.0 + 2.0 * std::max({0.0, -s, s - 1.0, -t, t - 1.0});
    const double distance = std::abs(w.dot(across)) / area;
    const double moved = extrapolated + distance / (std::min(u_length, v_length) * sine);
    return {{s, t}, across / area, safe * outside * sine / moved};
}

/// True if a direction is between the normals of two triangles at their common edge, to which it is
/// at right angles; or beside them by so much, as a cosine.
bool is_between(const Vec3& direction, const Vec3& a, const Vec3& b, double beside) {
    const double cosine = a.dot(b) - beside;
    return direction.dot(a + b) > 0.0 && direction.dot(a) >= cosine && direction.dot(b) >= cosine;
}

/// A point of an edge.
struct EdgeAt {
    const SurfaceEdge& edge;
    double at;          ///< part of the way from the first node to the second
    const Vec3 &p, &q;  ///< positions of the nodes, m
};

/// True if the way from a point of an edge to one of another edge goes through the body.
/// @param from       where the way begins
/// @param faces_one  true: it goes in by the second triangle of the edge; false: by the first
bool is_inside(const physics::Model& model, const TissueSurface& surface, const EdgeAt& from,
               const EdgeAt& to, bool faces_one) {
    const std::span<const Vec3> x = model.mesh_positions();
    const std::uint32_t t = from.edge.triangles[faces_one ? 1 : 0];
    const Triangle& triangle = surface.triangles[t];
    Vec3 weights, middle = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        weights[static_cast<int>(k)] = triangle[k] == from.edge.nodes[0]   ? 1.0 - from.at
                                       : triangle[k] == from.edge.nodes[1] ? from.at
                                                                           : 0.0;
        middle += x[triangle[k].index()] / 3.0;
    }
    // To a point a little along the other edge, where it is under the triangle: if the edge lies
    // flat on the triangle, rounding would decide. It stays on the edge: beyond its end no point is
    // known to be on the surface of a body at rest.
    constexpr double along = 0.01;
    const Vec3 way = to.q - to.p;
    const bool is_onward = way.dot(middle - to.p - to.at * way) >= 0.0;
    const double part = std::clamp(is_onward ? to.at + along : to.at - along, 0.0, 1.0);
    return is_way_inside(model.mesh(), x, surface.faces[t], triangle, weights, to.p + part * way);
}

}  // namespace

void EdgeContact::set_surface(const SurfaceTree& tree, const ContactBody& body) {
    const SurfaceEdges old_edges = std::move(edges_);
    edges_ = {};
    edges_.set_triangles(tree.triangles(), body.mesh.rest_positions());
    sharp_.clear();
    // In the order of the tree, in which those that follow each other are near each other.
    std::vector<bool> is_listed(edges_.size(), false);
    for (const std::uint32_t t : tree.order())
        for (const std::uint32_t edge : edges_.of_triangle(t)) {
            if (edge == no_edge || is_listed[edge] || !edges_[edge].is_sharp) continue;
            const auto [one, two] = edges_[edge].triangles;
            if (!body.takes_part[one] && !body.takes_part[two]) continue;
            is_listed[edge] = true;
            sharp_.push_back(edge);
        }
    const auto renumber = [&](auto& pairs) {
        std::erase_if(pairs, [&](auto& pair) {
            const std::uint32_t sharp = edges_.find(old_edges[pair.edges.sharp].nodes),
                                other = edges_.find(old_edges[pair.edges.other].nodes);
            if (sharp == no_edge || other == no_edge || !edges_[sharp].is_sharp) return true;
            pair.edges = in_order(sharp, other);
            return false;
        });
        std::ranges::sort(pairs, {}, [](const auto& pair) { return pair.edges; });
    };
    renumber(pairs_);
    renumber(touching_);
}

void EdgeContact::append_pairs(const SurfaceTree& tree, const ContactBody& body,
                               std::span<const Vec3> positions, double reach,
                               std::span<const std::uint32_t> sharp,
                               std::span<const std::uint8_t> is_moved) {
    constexpr std::size_t group_size = 8;
    const auto box_of = [&](std::uint32_t edge) {
        const auto& [a, b] = edges_[edge].nodes;
        const Vec3 &x = positions[a.index()], &y = positions[b.index()];
        return Box(x.cwiseMin(y), x.cwiseMax(y));
    };
    const Vec3 margin = Vec3::Constant(reach);
    for (std::size_t begin = 0; begin < sharp.size(); begin += group_size) {
        const auto group = sharp.subspan(begin, std::min(group_size, sharp.size() - begin));
        Box box;
        NormalCone normals;
        for (const std::uint32_t edge : group) {
            box.extend(box_of(edge));
            for (const std::uint32_t t : edges_[edge].triangles)
                normals.include({tree.normal(t), 0.0});
        }
        near_.clear();
        tree.for_each_against(Box(box.min() - margin, box.max() + margin), normals,
                              [&](std::uint32_t t) {
                                  for (const std::uint32_t edge : edges_.of_triangle(t))
                                      if (edge != no_edge) near_.push_back(edge);
                              });
        std::ranges::sort(near_);
        near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
        if (!is_moved.empty())
            std::erase_if(near_, [&](std::uint32_t edge) {
                const auto& [a, b] = edges_[edge].nodes;
                return is_moved[a.index()] == 0 && is_moved[b.index()] == 0;
            });
        boxes_.clear();
        for (const std::uint32_t edge : near_) boxes_.push_back(box_of(edge));
        num_tested_ += group.size() * near_.size();
        for (const std::uint32_t edge : group) {
            const Box around = box_of(edge);
            around_.clear();
            for (std::size_t i = 0; i < near_.size(); ++i)
                if (around.squaredExteriorDistance(boxes_[i]) < reach * reach &&
                    are_near(tree, body, positions, reach, edge, near_[i]))
                    found_.push_back({in_order(edge, near_[i]), 0.0});
        }
    }
}

EdgeContact::Edges EdgeContact::in_order(std::uint32_t sharp, std::uint32_t other) const {
    return edges_[other].is_sharp && other < sharp ? Edges{other, sharp} : Edges{sharp, other};
}

/// True if two edges face each other, are near each other, and belong to different parts of the
/// body.
bool EdgeContact::are_near(const SurfaceTree& tree, const ContactBody& body,
                           std::span<const Vec3> positions, double reach, std::uint32_t sharp,
                           std::uint32_t other) {
    // By how much normals may turn until pairs are found again, as a cosine.
    constexpr double margin_of_cosine = 0.5;
    const SurfaceEdge &first = edges_[sharp], &second = edges_[other];
    const auto& [m, n] = first.nodes;
    const auto& [a, b] = second.nodes;
    if (a == m || a == n || b == m || b == n) return false;
    if (!body.takes_part[second.triangles[0]] && !body.takes_part[second.triangles[1]])
        return false;
    const auto sum_of_normals = [&](const SurfaceEdge& edge) -> Vec3 {
        return tree.normal(edge.triangles[0]) + tree.normal(edge.triangles[1]);
    };
    const auto square_of_sine = [](const Vec3& sum) {  // of half of the angle between two normals
        return std::max(0.0, 1.0 - 0.25 * sum.squaredNorm());
    };
    const Vec3 sum = sum_of_normals(first), other_sum = sum_of_normals(second);
    if (-0.25 * sum.dot(other_sum) <
        0.25 * std::sqrt(sum.squaredNorm() * other_sum.squaredNorm()) -
            std::sqrt(square_of_sine(sum) * square_of_sine(other_sum)) - margin_of_cosine)
        return false;
    const Vec3 &p = positions[m.index()], &q = positions[n.index()], &x = positions[a.index()],
               &y = positions[b.index()];
    const auto [s, t] = closest_of_segments(p, q, x, y);
    if ((p + s * (q - p) - x - t * (y - x)).squaredNorm() >= reach * reach) return false;
    // The corners of all fragments at the edge.
    if (around_.empty()) {
        for (const VertexId node : first.nodes) append_fragment_corners(body, node, star_, around_);
        std::ranges::sort(around_);
        around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
    }
    return std::ranges::none_of(second.triangles, [&](std::uint32_t triangle) {
        const ElementId fragment = body.fragments.fragment_of_cell(body.faces[triangle].cell);
        return std::ranges::any_of(body.fragments.corners(fragment), [&](NodeId corner) {
            return std::ranges::binary_search(around_, corner);
        });
    });
}

/// Makes the found pairs, and those that touch, the pairs, with what is known of them.
void EdgeContact::take_found(std::span<const Vec3> positions) {
    for (const Touching& pair : touching_) found_.push_back({pair.edges, 0.0});
    const auto edges_of = [](const Pair& pair) { return pair.edges; };
    std::ranges::sort(found_, {}, edges_of);
    const auto is_same = [](const Pair& one, const Pair& two) { return one.edges == two.edges; };
    found_.erase(std::unique(found_.begin(), found_.end(), is_same), found_.end());
    auto known = pairs_.begin();
    for (Pair& pair : found_) {
        known = std::lower_bound(known, pairs_.end(), pair, [](const Pair& one, const Pair& two) {
            return one.edges < two.edges;
        });
        if (known != pairs_.end() && known->edges == pair.edges) pair.room = known->room;
    }
    std::swap(pairs_, found_);

    auto& is_followed = is_followed_;
    is_followed.assign(positions.size(), 0);
    for (const VertexId n : nodes_) is_followed[n.index()] = 1;
    last_positions_.resize(positions.size(), Vec3::Zero());
    for (const Pair& pair : pairs_)
        for (const std::uint32_t edge : {pair.edges.sharp, pair.edges.other})
            for (const VertexId n : edges_[edge].nodes) {
                if (is_followed[n.index()] == 0) last_positions_[n.index()] = positions[n.index()];
                is_followed[n.index()] = 2;
            }
    nodes_.clear();
    for (std::size_t n = 0; n < is_followed.size(); ++n)
        if (is_followed[n] == 2) nodes_.emplace_back(n);
}

void EdgeContact::find(const SurfaceTree& tree, const ContactBody& body,
                       std::span<const Vec3> positions, double reach) {
    found_.clear();
    append_pairs(tree, body, positions, reach, sharp_, {});
    take_found(positions);
}

void EdgeContact::find_again(const SurfaceTree& tree, const ContactBody& body,
                             std::span<const Vec3> positions, double reach,
                             std::span<const std::uint8_t> is_moved,
                             std::span<const std::uint8_t> is_near) {
    const auto is_at = [&](std::span<const std::uint8_t> is_node, std::uint32_t edge) {
        const auto& [a, b] = edges_[edge].nodes;
        return is_node[a.index()] != 0 || is_node[b.index()] != 0;
    };
    auto& [moved, near] = sharp_again_;
    moved.clear();
    near.clear();
    for (const std::uint32_t edge : sharp_) {
        if (is_at(is_moved, edge))
            moved.push_back(edge);
        else if (is_at(is_near, edge))
            near.push_back(edge);
    }
    found_.clear();
    append_pairs(tree, body, positions, reach, moved, {});
    append_pairs(tree, body, positions, reach, near, is_moved);
    for (const Pair& pair : pairs_)
        if (!is_at(is_moved, pair.edges.sharp) && !is_at(is_moved, pair.edges.other))
            found_.push_back(pair);
    take_found(positions);
}

/// Finds where the edges of a pair touch. Returns false if they do not.
/// @param known  the pair, if it touched in the last step
/// @param reach  distance at which it is a point of contact, m
bool EdgeContact::find_touch(Pair& pair, const Touching* known, const physics::Model& model,
                             const Surface& surface, double reach, Touch& touch) const {
    const std::span<const Vec3> x = model.mesh_positions();
    const SurfaceEdge &first = edges_[pair.edges.sharp], &second = edges_[pair.edges.other];
    const Vec3 &p = x[first.nodes[0].index()], &q = x[first.nodes[1].index()],
               &a = x[second.nodes[0].index()], &b = x[second.nodes[1].index()];
    const Crossing crossing =
        cross(p, q, a, b, {first.ends(), second.ends()}, known == nullptr ? to_begin : to_stay);
    const auto [s, t] = crossing.at;
    if (!(crossing.room <= 0.0)) {
        const auto [s_in, t_in] = closest_of_segments(p, q, a, b);
        pair.room =
            std::max(crossing.room, (p + s_in * (q - p) - a - t_in * (b - a)).norm() - reach);
        return false;
    }
    const Vec3 from_second = p + s * (q - p) - a - t * (b - a);
    pair.room = from_second.norm() - surface.reach;
    if (pair.room >= 0.0 && known == nullptr) return false;
    pair.room = 0.0;
    Vec3 normal = crossing.normal;
    const auto normal_of = [&](std::uint32_t triangle) -> Vec3 {
        return area_of(surface.triangles.triangles[triangle], x).stableNormalized();
    };
    const Vec3 n0 = normal_of(second.triangles[0]), n1 = normal_of(second.triangles[1]);
    const Vec3 m0 = normal_of(first.triangles[0]), m1 = normal_of(first.triangles[1]);
    double size = surface.lengths[first.nodes[0].index()];
    for (const VertexId n : {first.nodes[1], second.nodes[0], second.nodes[1]})
        size = std::min(size, surface.lengths[n.index()]);
    const double beside = known == nullptr ? beside_to_begin : beside_to_stay;
    const auto is_out_of_second = [&] { return is_between(normal, n0, n1, beside); };
    // How far the end of an edge is beyond the other edge. Less than an overlap, and a node there
    // meets triangles: it is the shorter way out. Where a sharp edge goes on, there is no end.
    double to_end = std::numeric_limits<double>::infinity();
    const auto bound_by = [&](const SurfaceEdge& edge, double part, double length) {
        if (edge.ends()[0]) to_end = std::min(to_end, part * length);
        if (edge.ends()[1]) to_end = std::min(to_end, (1.0 - part) * length);
    };
    bound_by(first, s, (q - p).norm());
    bound_by(second, t, (b - a).norm());
    const auto touches = [&] {
        const bool is_out_of_first = is_between(-normal, m0, m1, beside);
        const double overlap = -normal.dot(from_second);
        if (overlap <= (known == nullptr ? one_sided * size : 0.0))
            return is_out_of_second() && is_out_of_first;
        return overlap < to_end && (is_out_of_second() || is_out_of_first);
    };
    if (!touches()) normal = -normal;
    if (!touches()) return false;
    const double gap = normal.dot(from_second);
    if (gap >= reach) {
        pair.room = gap - reach;
        return false;
    }
    if (known == nullptr) {
        known = continued(pair.edges);
        // What goes on has nearly the same gap.
        if (known != nullptr && gap < known->gap - reach - surface.rounding) known = nullptr;
    }
    const double slack = known == nullptr ? std::min(0.0, gap) : known->slack;
    if (known == nullptr) {
        // Round a sharp corner of the body itself there is no overlap.
        if (gap <= -deepest_begin * size) return false;
        // An overlap that is there at once may be none, as between the sides of cuts that cross.
        const bool is_in_second = is_out_of_second();
        const EdgeAt first_at{first, s, p, q}, second_at{second, t, a, b};
        if (gap < -surface.rounding &&
            !is_inside(model, surface.triangles, is_in_second ? second_at : first_at,
                       is_in_second ? first_at : second_at,
                       is_in_second ? normal.dot(n1 - n0) > 0.0 : normal.dot(m1 - m0) < 0.0))
            return false;
    }
    touch = {s,
             t,
             normal,
             gap,
             gap > 0.0 ? 0.0 : std::max(gap, slack),
             known == nullptr ? Vec3::Zero() : known->impulse};
    return true;
}

/// Returns the pair that touched in the last step and goes on in this one, as an edge slides over a
/// node of another one; or null.
const EdgeContact::Touching* EdgeContact::continued(const Edges& edges) const {
    const auto with_next = [&](std::uint32_t edge) {
        return std::array{edge, edges_[edge].next[0], edges_[edge].next[1]};
    };
    for (const std::uint32_t one : with_next(edges.sharp))
        for (const std::uint32_t two : with_next(edges.other)) {
            if (one == no_edge || two == no_edge) continue;
            const Edges key = in_order(one, two);
            const auto it = std::ranges::lower_bound(did_touch_, key, {}, &Touching::edges);
            if (it != did_touch_.end() && it->edges == key) return &*it;
        }
    return nullptr;
}

void EdgeContact::add_points(const physics::Model& model, const Surface& surface,
                             ContactSolver& solver) {
    const std::span<const Vec3> x = model.mesh_positions();
    moves_.resize(x.size());
    for (const VertexId n : nodes_) {
        moves_[n.index()] = (x[n.index()] - last_positions_[n.index()]).norm();
        last_positions_[n.index()] = x[n.index()];
    }
    const auto move_of = [&](std::uint32_t edge) {
        const auto& [a, b] = edges_[edge].nodes;
        return std::max(moves_[a.index()], moves_[b.index()]);
    };
    max_penetration_ = 0.0;
    first_point_ = solver.size();
    std::swap(touching_, did_touch_);
    touching_.clear();
    auto known = did_touch_.begin();
    for (Pair& pair : pairs_) {
        const double moved = move_of(pair.edges.sharp) + move_of(pair.edges.other);
        pair.room -= moved;
        while (known != did_touch_.end() && known->edges < pair.edges) ++known;
        const bool did_touch = known != did_touch_.end() && known->edges == pair.edges;
        if (pair.room >= 0.0 && !did_touch) continue;
        Touch touch;
        if (!find_touch(pair, did_touch ? &*known : nullptr, model, surface,
                        std::min(surface.reach, most_steps * moved), touch))
            continue;
        max_penetration_ = std::max(max_penetration_, -touch.gap);
        ContactPoint point;
        point.normal = touch.normal;
        point.gap = touch.gap - touch.slack;
        if (std::abs(point.gap) < surface.rounding) point.gap = 0.0;
        point.friction = surface.friction;
        point.impulse = touch.impulse;
        touching_.push_back({pair.edges, touch.gap, touch.slack, point.impulse});
        solver.begin(point);
        const auto& [p, q] = edges_[pair.edges.sharp].nodes;
        const auto& [a, b] = edges_[pair.edges.other].nodes;
        add_surface_weights(
            model,
            {{p, q, a, b},
             {1.0 - touch.on_first, touch.on_first, touch.on_second - 1.0, -touch.on_second}},
            solver);
    }
}

void EdgeContact::take_impulses(const ContactSolver& solver) {
    for (std::size_t k = 0; k < touching_.size(); ++k)
        touching_[k].impulse = solver.impulse(first_point_ + k);
}

void EdgeContact::restore(ArchiveReader& ar, std::size_t node_capacity) {
    list(ar, *this);
    const auto are_good = [&](const auto& pairs) {
        return std::ranges::all_of(pairs, [&](const auto& pair) {
            return std::max(pair.edges.sharp, pair.edges.other) < edges_.size();
        });
    };
    if (!are_good(pairs_) || !are_good(touching_) ||
        std::ranges::any_of(pairs_, [](const Pair& pair) { return std::isnan(pair.room); }) ||
        std::ranges::any_of(touching_,
                            [](const Touching& pair) {
                                return !std::isfinite(pair.gap) || !(pair.slack <= 0.0) ||
                                       !pair.impulse.allFinite();
                            }) ||
        last_positions_.size() > node_capacity || std::ranges::any_of(nodes_, [&](VertexId n) {
            return n.index() >= last_positions_.size();
        }))
        throw InputError("its contact is that of another body");
}

}  // namespace incise::contact
