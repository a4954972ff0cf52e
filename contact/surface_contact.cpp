// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/surface_contact.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "incise/base/archive.h"
#include "incise/base/error.h"
#include "incise/contact/way_inside.h"
#include "incise/topology/geometry.h"

namespace incise::contact {

namespace {

// Lengths are parts of the mean length of an element.
constexpr double node_reach =
    0.15;  // at which a node is a point of contact: farther than it moves in a step
constexpr double edge_reach = 0.05;  // likewise, two edges
/// By how much more than these pairs are found: `widest_skin` or a half or a quarter of it.
constexpr double widest_skin = 0.5, narrowest_skin = 0.125;
/// With more pairs than that for each node, the skin becomes narrower; with less, wider.
constexpr double many_pairs = 32.0, few_pairs = 4.0;
/// What has moved by more than this part of the skin, when a search is due, is looked for again. If
/// it is more than this part of the surface, all is.
constexpr double moved_skin = 0.25, most_moved = 0.25;
/// Pairs of a part of the surface are found within so much of the skin: the rest may already have
/// moved by half of it since its pairs were found.
constexpr double skin_of_part = 1.5;
/// Of a node that is deeper, it is asked in each step if it is still in the tissue. It is a part of
/// the local length.
constexpr double deepest = 0.4;
/// How far the projection of a node may be outside a triangle, as a weight: at the rim of a surface
/// no other triangle goes on there. A node that is deeper than `deepest_at_rim` is beside it.
constexpr double rim = 0.25, deepest_at_rim = 0.05;
/// An overlap that is deeper on another triangle is looked at twice. It is a part of the local
/// length.
constexpr double deep_start = 0.02;
/// An overlap of this part of an element is none: the twins of a cut have the same position.
constexpr double rounding = 1e-10;

}  // namespace

void add_shares(const physics::Model& model, VertexId n, double weight, ContactSolver& solver) {
    model.structure().embedding().for_each(
        n, [&](NodeId node, double share) { solver.add_weight(node, weight * share); });
}

void add_surface_weights(const physics::Model& model, const ContactSolver::OnSurface& at,
                         ContactSolver& solver) {
    solver.note_surface(at);
    for (std::size_t k = 0; k < at.vertices.size(); ++k)
        if (at.weights[k] != 0.0) add_shares(model, at.vertices[k], at.weights[k], solver);
}

void SurfaceContact::add_points(const physics::Model& model, ContactSolver& solver) {
    const std::span<const Vec3> positions = model.mesh_positions();
    const double moved = 2.0 * model.largest_mesh_move();
    room_ -= moved;
    if (room_ < 0.0 && has_moved_far(positions) && !find_pairs_of_moved(model)) find_pairs(model);
    max_penetration_ = 0.0;
    touches_.resize(near_.size());
    for (std::size_t i = 0; i < near_.size(); ++i) {
        NearNode& near = near_[i];
        near.room -= moved;
        if (near.touched >= 0 || near.room < 0.0) find_touched(i, model);
        if (near.touched < 0) continue;
        const double gap = touches_[i].gap;
        near.slack = gap > 0.0 ? 0.0 : std::max(gap, near.slack);
        max_penetration_ = std::max(max_penetration_, -gap);
    }
    first_point_ = solver.size();
    nodes_of_points_.clear();
    for (std::size_t i = 0; i < near_.size(); ++i)
        if (near_[i].touched >= 0 && !is_with_twin(i)) add_point(i, model, solver);
    edges_.add_points(
        model, {surface(), lengths_, edge_reach * size_, rounding * size_, settings_.friction},
        solver);
    max_penetration_ = std::max(max_penetration_, edges_.max_penetration());
}

void SurfaceContact::take_impulses(const ContactSolver& solver) {
    for (NearNode& near : near_) near.impulse.setZero();
    for (std::size_t k = 0; k < nodes_of_points_.size(); ++k)
        near_[nodes_of_points_[k]].impulse = solver.impulse(first_point_ + k);
    edges_.take_impulses(solver);
}

/// True if a node touches another one, which touches it as well and has the lower id: then one
/// point of contact is enough. So it is with the two nodes that a cut has made of one.
bool SurfaceContact::is_with_twin(std::size_t i) const {
    constexpr double nearly_one = 0.9, least_cosine = 0.9;
    const auto node_under = [&](std::size_t k) {
        const Triangle& triangle = triangles_[static_cast<std::size_t>(near_[k].touched)];
        for (int corner = 0; corner < 3; ++corner)
            if (touches_[k].weights[corner] > nearly_one)
                return triangle[static_cast<std::size_t>(corner)];
        return VertexId();
    };
    const VertexId n = pairs_.nodes()[i], other = node_under(i);
    if (!other.is_valid() || n < other) return false;
    const std::int32_t of_other = near_of_node_[other.index()];
    if (of_other < 0) return false;
    const auto k = static_cast<std::size_t>(of_other);
    return near_[k].touched >= 0 && node_under(k) == n &&
           touches_[i].normal.dot(touches_[k].normal) < -least_cosine;
}

/// Notes where the nodes are in the pairs.
void SurfaceContact::number_nodes(std::size_t node_capacity) {
    near_of_node_.assign(node_capacity, -1);
    for (std::size_t i = 0; i < pairs_.nodes().size(); ++i)
        near_of_node_[pairs_.nodes()[i].index()] = static_cast<std::int32_t>(i);
}

/// Lists the triangles of the surface in the order of their faces, whatever edits led to it.
void SurfaceContact::list_triangles(const physics::Model& model,
                                    const topology::BoundarySurface& surface) {
    struct Row {
        FaceId face;
        Triangle triangle;
        bool is_cut;
    };
    std::vector<Row> rows;
    rows.reserve(surface.triangles().size());
    for (std::size_t t = 0; t < surface.triangles().size(); ++t)
        rows.push_back({surface.faces()[t], surface.triangles()[t], surface.is_cut()[t] != 0});
    std::ranges::sort(rows, {}, [](const Row& row) { return std::tie(row.face, row.triangle); });
    faces_.clear();
    triangles_.clear();
    takes_part_.clear();
    for (const Row& row : rows) {
        faces_.push_back(row.face);
        triangles_.push_back(row.triangle);
        takes_part_.push_back(settings_.self || row.is_cut ? 1 : 0);
    }
    list_lengths(model);
    tree_.set_triangles(triangles_, model.mesh().rest_positions());
    pairs_.set_surface(tree_, body(model));
    edges_.set_surface(tree_, body(model));
}

/// Lists the local lengths: at a node, the least mean length of the edges of a fragment with a face
/// there, and at most that of the body. Where a mesh is finer, less overlap tells what is no
/// contact but a face round a corner.
void SurfaceContact::list_lengths(const physics::Model& model) {
    lengths_.assign(model.mesh().node_capacity(), size_);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        const fragments::FragmentMesh& fragments = model.fragments();
        const auto corners = fragments.corners(fragments.fragment_of_cell(faces_[t].cell));
        double sum = 0.0, count = 0.0;
        for (std::size_t i = 0; i < corners.size(); ++i)
            for (std::size_t k = 0; k < i; ++k, count += 1.0)
                sum += (fragments.rest_position(corners[i]) - fragments.rest_position(corners[k]))
                           .norm();
        for (const VertexId n : triangles_[t])
            lengths_[n.index()] = std::min(lengths_[n.index()], sum / count);
    }
}

// Near the edit, pairs are found anew. Those of other nodes stay, with the new numbers of
// triangles.
void SurfaceContact::follow(const physics::Model& model, const topology::BoundarySurface& surface) {
    const std::vector<FaceId> old_faces = std::move(faces_);
    const std::vector<Triangle> old_triangles = std::move(triangles_);
    const std::span<const Vec3> positions = model.mesh_positions();
    list_triangles(model, surface);
    tree_.fit(positions);

    constexpr std::int32_t none = -1;
    std::vector<std::int32_t> number_of_old(old_triangles.size(), none);
    Box changed;
    const auto extend = [&](const Triangle& triangle) {
        for (const VertexId n : triangle) changed.extend(positions[n.index()]);
    };
    std::size_t next = 0;  // of the old ones, in the same order
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        const auto key = std::tie(faces_[t], triangles_[t]);
        while (next < old_triangles.size() && std::tie(old_faces[next], old_triangles[next]) < key)
            extend(old_triangles[next++]);
        if (next < old_triangles.size() && std::tie(old_faces[next], old_triangles[next]) == key)
            number_of_old[next++] = static_cast<std::int32_t>(t);
        else
            extend(triangles_[t]);
    }
    while (next < old_triangles.size()) extend(old_triangles[next++]);
    const std::size_t num_known = std::min(positions_of_pairs_.size(), positions.size());
    positions_of_pairs_.resize(positions.size(), Vec3::Zero());
    if (changed.isEmpty()) return;
    // Twice as far as pairs reach: the triangles of nodes that are found anew may have moved since
    // their own were found.
    const double distance = (node_reach + skin_of_part * skin_) * size_;
    const Box near_edit(changed.min() - Vec3::Constant(2.0 * distance),
                        changed.max() + Vec3::Constant(2.0 * distance));
    const Vec3 mean = mean_move(positions.first(num_known));
    std::vector<std::uint8_t> is_chosen(positions.size(), 0);
    const auto is_near_edit = [&](VertexId n) {
        if (n.index() < num_known && !near_edit.contains(positions[n.index()])) return false;
        positions_of_pairs_[n.index()] = positions[n.index()] - mean;
        is_chosen[n.index()] = 1;
        return true;
    };
    std::vector<NodeAndTriangle> touching;
    for (const auto& [n, t] : touching_pairs())
        if (number_of_old[t] >= 0)
            touching.emplace_back(n, static_cast<std::uint32_t>(number_of_old[t]));
    const std::vector<NearNode> known = std::move(near_);
    const std::vector<VertexId> known_nodes(pairs_.nodes().begin(), pairs_.nodes().end());
    pairs_.find_again(tree_, body(model), positions, distance, number_of_old, is_near_edit,
                      touching);
    edges_.find_again(tree_, body(model), positions, distance - (node_reach - edge_reach) * size_,
                      is_chosen, is_chosen);
    // What nodes touch stays what it is if the triangle is still there.
    near_.assign(pairs_.nodes().size(), {});
    for (std::size_t i = 0; i < near_.size(); ++i) {
        const auto it = std::ranges::lower_bound(known_nodes, pairs_.nodes()[i]);
        if (it == known_nodes.end() || *it != pairs_.nodes()[i]) continue;
        const NearNode& before = known[static_cast<std::size_t>(it - known_nodes.begin())];
        const std::int32_t touched =
            before.touched < 0 ? none : number_of_old[static_cast<std::size_t>(before.touched)];
        if (touched < 0) continue;
        near_[i] = before;
        near_[i].touched = touched;
    }
    if (num_known == 0) room_ = skin_ * size_;
    number_nodes(positions.size());
    if (has_many_pairs()) find_pairs(model);
}

void SurfaceContact::restore(ArchiveReader& ar, const physics::Model& model,
                             const topology::BoundarySurface& surface) {
    list(ar, *this);
    const auto require = [](bool holds) {
        if (!holds) throw InputError("its contact is that of another body");
    };
    require(settings_.enabled && settings_.friction >= 0.0 && size_ > 0.0 &&
            positions_of_pairs_.size() == model.mesh().node_capacity() && std::isfinite(room_) &&
            skin_ >= narrowest_skin && skin_ <= widest_skin);
    list_triangles(model, surface);
    edges_.restore(ar, model.mesh().node_capacity());
    require(near_.size() == pairs_.nodes().size() &&
            pairs_.fits(model.mesh().node_capacity(), triangles_.size()));
    number_nodes(model.mesh().node_capacity());
    for (const NearNode& near : near_)
        require(near.touched < static_cast<std::int64_t>(triangles_.size()) && near.slack <= 0.0 &&
                !std::isnan(near.room) && near.impulse.allFinite());
}

/// Returns by how much the surface has moved since the pairs were found, in the mean, m. It tells
/// what moves with the rest from what does not.
/// @param positions  of the nodes that count: those with lower ids than their number
Vec3 SurfaceContact::mean_move(std::span<const Vec3> positions) const {
    Vec3 sum = Vec3::Zero();
    double count = 0.0;
    for (const Triangle& triangle : triangles_) {
        const std::size_t n = triangle[0].index();
        if (n >= positions.size()) continue;
        sum += positions[n] - positions_of_pairs_[n];
        count += 1.0;
    }
    return count > 0.0 ? Vec3(sum / count) : Vec3::Zero();
}

/// Returns true if two parts of the surface may have moved by more than the skin towards each other
/// since the pairs were found. Else says how far they may still move.
bool SurfaceContact::has_moved_far(std::span<const Vec3> positions) {
    if (triangles_.empty()) return false;
    const Vec3 mean = mean_move(positions);
    double square = 0.0;
    for (const Triangle& triangle : triangles_)
        for (const VertexId n : triangle)
            square = std::max(
                square,
                (positions[n.index()] - positions_of_pairs_[n.index()] - mean).squaredNorm());
    room_ = skin_ * size_ - 2.0 * std::sqrt(square);
    return room_ < 0.0;
}

/// Finds anew the pairs with what has moved, if that is a small part of the surface: a crumb that
/// flies, or what a tool pushes. Else returns false.
///
/// Parts of the surface then have pairs of different times. For what is looked for again,
/// positions_of_pairs_ are those from which it would have moved by the mean: so all parts are
/// compared with the same mean.
bool SurfaceContact::find_pairs_of_moved(const physics::Model& model) {
    if (has_many_pairs()) return false;
    const std::span<const Vec3> positions = model.mesh_positions();
    const Vec3 mean = mean_move(positions);
    const double square = std::pow(moved_skin * skin_ * size_, 2);
    auto& [is_node, is_triangle, near_part, known, known_nodes] = part_;
    std::vector<std::uint8_t>& is_near = near_part;
    is_node.assign(positions.size(), 0);
    is_triangle.assign(triangles_.size(), 0);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        for (const VertexId n : triangles_[t])
            if ((positions[n.index()] - positions_of_pairs_[n.index()] - mean).squaredNorm() >
                square)
                is_node[n.index()] = is_triangle[t] = 1;
    if (static_cast<double>(std::ranges::count(is_triangle, 1)) >
        most_moved * static_cast<double>(triangles_.size()))
        return false;
    for (std::size_t n = 0; n < is_node.size(); ++n)
        if (is_node[n] != 0) positions_of_pairs_[n] = positions[n] - mean;

    tree_.fit(positions);
    const double distance = (node_reach + skin_of_part * skin_) * size_;
    is_near = is_node;
    constexpr std::size_t group_size = 8;
    std::size_t in_group = 0;
    Box group;
    const auto note_near_group = [&] {
        const Vec3 margin = Vec3::Constant(distance);
        const NormalCone any_direction{Vec3::UnitZ(), std::numbers::pi};
        tree_.for_each_against(Box(group.min() - margin, group.max() + margin), any_direction,
                               [&](std::uint32_t t) {
                                   for (const VertexId n : triangles_[t]) is_near[n.index()] = 1;
                               });
        group.setEmpty();
        in_group = 0;
    };
    for (const std::uint32_t t : tree_.order()) {
        if (is_triangle[t] == 0) continue;
        group.extend(tree_.box(t));
        if (++in_group == group_size) note_near_group();
    }
    if (in_group > 0) note_near_group();
    const std::span<const NodeAndTriangle> touching = touching_pairs();
    std::swap(known, near_);
    known_nodes.assign(pairs_.nodes().begin(), pairs_.nodes().end());
    pairs_.find_moved(tree_, body(model), positions, distance, {is_triangle, is_node, is_near},
                      touching);
    edges_.find_again(tree_, body(model), positions, distance - (node_reach - edge_reach) * size_,
                      is_node, is_near);
    near_.assign(pairs_.nodes().size(), {});
    for (std::size_t i = 0; i < near_.size(); ++i) {
        const VertexId n = pairs_.nodes()[i];
        const auto it = std::ranges::lower_bound(known_nodes, n);
        if (it == known_nodes.end() || *it != n) continue;
        near_[i] = known[static_cast<std::size_t>(it - known_nodes.begin())];
        if (is_near[n.index()] != 0) near_[i].room = 0.0;
    }
    has_moved_far(positions);
    number_nodes(positions.size());
    return true;
}

void SurfaceContact::find_pairs(const physics::Model& model) {
    std::map<VertexId, NearNode> known;
    for (std::size_t i = 0; i < near_.size(); ++i)
        if (near_[i].touched >= 0) known.emplace(pairs_.nodes()[i], near_[i]);
    const std::span<const NodeAndTriangle> touching = touching_pairs();
    const std::span<const Vec3> positions = model.mesh_positions();
    tree_.fit(positions);
    const auto find = [&] {
        pairs_.find(tree_, body(model), positions, (node_reach + skin_) * size_, touching);
    };
    if (pairs_per_node() < few_pairs) skin_ = std::min(widest_skin, 2.0 * skin_);
    if (has_many_pairs()) skin_ *= 0.5;
    find();
    while (has_many_pairs()) {
        skin_ *= 0.5;
        find();
    }
    edges_.find(tree_, body(model), positions, (edge_reach + skin_) * size_);
    near_.assign(pairs_.nodes().size(), {});
    for (std::size_t i = 0; i < near_.size(); ++i)
        if (const auto it = known.find(pairs_.nodes()[i]); it != known.end()) near_[i] = it->second;
    positions_of_pairs_.assign(positions.begin(), positions.end());
    room_ = skin_ * size_;
    number_nodes(positions.size());
}

/// Returns the pairs that touch, in the order of their nodes.
std::span<const NodeAndTriangle> SurfaceContact::touching_pairs() {
    auto& touching = touching_;
    touching.clear();
    for (std::size_t i = 0; i < near_.size(); ++i)
        if (near_[i].touched >= 0)
            touching.emplace_back(pairs_.nodes()[i], static_cast<std::uint32_t>(near_[i].touched));
    return touching;
}

double SurfaceContact::pairs_per_node() const {
    return static_cast<double>(pairs_.size()) / static_cast<double>(pairs_.nodes().size() + 1);
}

/// True if a narrower skin is worth while: between the sides of many cuts a node has so many
/// triangles in its reach that they cost more than to look for them more often.
bool SurfaceContact::has_many_pairs() const {
    return skin_ > narrowest_skin && pairs_per_node() > many_pairs;
}

/// Returns where a node is above a triangle. Its gap is infinite if the triangle has no area.
SurfaceContact::Touch SurfaceContact::touch(VertexId n, std::size_t t,
                                            std::span<const Vec3> positions) const {
    const auto& [na, nb, nc] = triangles_[t];
    const Vec3 &a = positions[na.index()], &b = positions[nb.index()], &c = positions[nc.index()];
    const Vec3 area = topology::doubled_area(a, b, c);
    const double square = area.squaredNorm();
    if (!(square > 0.0)) return {};
    const Vec3 x = positions[n.index()] - a;
    Touch touch;
    touch.normal = area / std::sqrt(square);
    touch.weights[2] = (b - a).cross(x).dot(area) / square;
    touch.weights[1] = x.cross(c - a).dot(area) / square;
    touch.weights[0] = 1.0 - touch.weights[1] - touch.weights[2];
    touch.gap = touch.normal.dot(x);
    return touch;
}

/// Returns the local length at a node and a triangle, m.
double SurfaceContact::length_at(VertexId n, std::size_t t) const {
    double length = lengths_[n.index()];
    for (const VertexId corner : triangles_[t]) length = std::min(length, lengths_[corner.index()]);
    return length;
}

/// True if a node is above or below a triangle, or so far outside it, as a weight, and near enough.
bool SurfaceContact::is_over(VertexId n, std::size_t t, const Touch& at, double outside) const {
    // Of a node at a corner, rounding decides over which triangle it is.
    constexpr double tolerance = 1e-6;
    const double least_weight = at.weights.minCoeff();
    return least_weight >= -outside - tolerance && at.gap < node_reach * size_ &&
           (least_weight >= -tolerance || at.gap > -deepest_at_rim * length_at(n, t));
}

/// Finds the triangle that a node touches, and where: the one it touched, as long as it is over it,
/// or else the nearest one.
void SurfaceContact::find_touched(std::size_t i, const physics::Model& model) {
    const std::span<const Vec3> positions = model.mesh_positions();
    NearNode& near = near_[i];
    const VertexId n = pairs_.nodes()[i];
    const std::int32_t before = near.touched;
    double gap_before = std::numeric_limits<double>::infinity();
    if (before >= 0) {
        const auto t = static_cast<std::size_t>(before);
        touches_[i] = touch(n, t, positions);
        gap_before = touches_[i].gap;
        if (gap_before > -deepest * length_at(n, t) && is_over(n, t, touches_[i], 0.0)) return;
    }
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = 0;
    for (const std::uint32_t t : pairs_.triangles_of(i)) {
        const auto& [a, b, c] = triangles_[t];
        const double square = squared_distance(positions[n.index()], positions[a.index()],
                                               positions[b.index()], positions[c.index()]);
        if (square >= least) continue;
        least = square;
        nearest = t;
    }
    const Touch at = touches_[i] = touch(n, nearest, positions);
    near.touched = is_over(n, nearest, at, rim) ? static_cast<std::int32_t>(nearest) : -1;
    near.room = std::sqrt(least) - node_reach * size_;
    if (near.touched < 0) return;
    // An overlap that is there at once may be none: the node is beside the triangle, or behind a
    // thin part of the body. One that it brings along from the triangle before is one.
    const double length = length_at(n, nearest);
    const double least_overlap = near.touched == before           ? deepest * length
                                 : gap_before < -rounding * size_ ? deep_start * length
                                                                  : rounding * size_;
    // Round a sharp corner of the body itself a way inside is no overlap: none begins so deep.
    const bool is_round_corner = before < 0 && at.gap <= -deepest * length;
    if (is_round_corner || (at.gap < -least_overlap &&
                            !is_way_inside(model.mesh(), positions, faces_[nearest],
                                           triangles_[nearest], at.weights, positions[n.index()])))
        near.touched = -1;
    else if (before < 0)
        near.slack = std::min(0.0, at.gap);
}

void SurfaceContact::add_point(std::size_t i, const physics::Model& model, ContactSolver& solver) {
    const NearNode& near = near_[i];
    const Touch& at = touches_[i];
    ContactPoint point;
    point.normal = at.normal;
    point.gap = at.gap - near.slack;
    if (std::abs(point.gap) < rounding * size_) point.gap = 0.0;
    point.friction = settings_.friction;
    point.impulse = near.impulse;
    nodes_of_points_.push_back(i);
    solver.begin(point);
    const auto& [a, b, c] = triangles_[static_cast<std::size_t>(near.touched)];
    add_surface_weights(
        model,
        {{pairs_.nodes()[i], a, b, c}, {1.0, -at.weights[0], -at.weights[1], -at.weights[2]}},
        solver);
}

}  // namespace incise::contact
