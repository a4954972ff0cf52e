// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/loop_splitter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "incise/cutting/exact/blade_stop.h"
#include "incise/cutting/exact/loop_step.h"
#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::Dart;
using topology::Mesh;

namespace {

/// True if the corners of a quadrilateral lie in a plane at rest, to the rounding of their
/// coordinates.
bool is_plane(const Mesh& mesh, FaceId f) {
    const auto at = [&](int p) -> Vec3 { return mesh.rest_position(mesh.face_corner(f, p)); };
    const Vec3 u = at(1) - at(0), v = at(2) - at(0), w = at(3) - at(0);
    const double a = u.norm(), b = v.norm(), c = w.norm();
    const double reach = std::max(at(0).cwiseAbs().maxCoeff(), std::max({a, b, c}));
    constexpr double rounding = 1e-15;
    return std::abs(u.cross(v).dot(w)) <= rounding * reach * (a * b + b * c + c * a);
}

}  // namespace

Split LoopStep::run() {
    find_crossed_edges();
    if (pending_.empty()) return {};
    meet_earlier_cuts();
    edit_.emplace(mesh_);
    divide_warped_faces();
    passes_left_ = most_passes(crossed_.size());
    while (!queue_.empty()) divide_next();
    time_ = 1.0;  // nothing is crossed later
    if (is_swept_) {
        settle();
        if (only_) close_all();
        close_parted();
    } else {
        join_all();
    }
    triangulate_all();
    open_faces();
    Split result{edit_->commit(), report_};
    if (!is_swept_) front_.keep_nodes_only();
    front_.apply(mesh_, result.changes);
    if (is_swept_) front_.leave_behind(mesh_);
    return result;
}

/// Returns where the surface crosses an edge. One that comes again does not cross an edge at a node
/// that it has made before. It crosses an edge with such an end, as chords are, only if the two
/// ends are parted.
EdgeIntersections LoopStep::new_intersections(const Edge& edge) const {
    EdgeIntersections found = intersections_of(surface_, point(edge.a), point(edge.b), nearness);
    const auto* known = earlier_.on_surface;
    if (!known || found.empty()) return found;
    const bool is_a_known = known->contains(edge.a), is_b_known = known->contains(edge.b);
    if (is_a_known || is_b_known) found.resize(found.size() % 2);
    std::erase_if(found, [&](const EdgeIntersection& x) {
        return (is_a_known && x.place < nearness) || (is_b_known && x.place > 1.0 - nearness);
    });
    return found;
}

void LoopStep::find_crossed_edges() {
    EdgeList edges;
    std::vector<std::pair<CellId, std::size_t>> edges_of_cells;
    std::vector<MovingPoint> points;
    const auto may_meet = [&](const Box& box) { return surface_.may_meet(box); };
    tissue_.for_each_near(may_meet, [&](CellId e) {
        points.clear();
        for (const VertexId n : mesh_.corners(e)) points.push_back(point(n));
        if (!surface_.may_meet_hull(points)) return;
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            for (int p = 0; p < mesh_.face_size({e, f}); ++p) {
                const Dart d{{e, f}, p};
                const VertexId a = from(mesh_, d), b = to(mesh_, d);
                if (a < b) edges_of_cells.emplace_back(e, edges.add({a, b}, e));
            }
    });
    std::vector<bool> may_be_crossed(edges.entries().size(), !only_);
    if (only_)
        for (const auto& [e, edge] : edges_of_cells)
            if (!stays_whole(e)) may_be_crossed[edge] = true;
    std::vector<bool> is_crossed(edges.entries().size());
    for (std::size_t i = 0; i < edges.entries().size(); ++i) {
        if (!may_be_crossed[i]) continue;
        const Edge& edge = edges.entries()[i].edge;
        EdgeIntersections passed = new_intersections(edge);
        if (passed.empty()) continue;
        is_crossed[i] = true;
        receive(edge, std::move(passed));
    }
    for (const auto& [e, edge] : edges_of_cells)
        if (is_crossed[edge] && (crossed_.empty() || crossed_.back() != e)) crossed_.push_back(e);
    report_.elements_crossed = static_cast<std::size_t>(
        std::ranges::count_if(crossed_, [&](CellId e) { return !stays_whole(e); }));
}

void LoopStep::receive(const Edge& edge, EdgeIntersections intersections) {
    if (intersections.empty()) return;
    std::ranges::stable_sort(intersections, {}, &EdgeIntersection::time);
    queue_.push({intersections.front().time, rest_length(edge.a, edge.b), edge});
    pending_.insert_or_assign(edge, std::move(intersections));
}

/// Divides the quadrilaterals of crossed cells that are not plane at rest into four triangles each,
/// about their middles. The volume stays the same, and all faces are plane.
void LoopStep::divide_warped_faces() {
    for (const CellId e : crossed_) {
        const int count = mesh_.num_faces(e);
        for (int f = 0; f < count; ++f) {
            const FaceId face{e, f};
            if (mesh_.face_size(face) != 4 || is_plane(mesh_, face)) continue;
            std::vector<VertexId> corners;
            for (int p = 0; p < 4; ++p) corners.push_back(mesh_.face_corner(face, p));
            const CellId other = mesh_.neighbor(face).cell;
            const bool may_be_crossed =
                !stays_whole(e) || (other.is_valid() && !stays_whole(other));
            const VertexId centre = divide_face_at_centre(face);
            if (!may_be_crossed) continue;
            for (const VertexId corner : corners)
                receive({corner, centre}, new_intersections({corner, centre}));
        }
    }
}

void LoopStep::divide_next() {
    const Edge edge = queue_.top().edge;
    time_ = queue_.top().time;
    queue_.pop();
    const auto found = pending_.find(edge);
    if (found == pending_.end()) return;
    EdgeIntersections intersections = std::move(found->second);
    pending_.erase(found);
    const EdgeIntersection first = intersections.front();
    intersections.erase(intersections.begin());
    if (const auto node = node_through(edge, first)) {
        receive(edge, std::move(intersections));
        go_through(*node, *node == edge.a ? edge.b : edge.a);
        return;
    }
    if (const auto node = own_node_at(edge, first)) {
        receive(edge, std::move(intersections));
        const LoopFront::EdgeAt passed{*node, *node == edge.a ? edge.b : edge.a};
        if (is_swept_) {
            front_.toggle_passed(passed);
            if (tissue_.is_at_rest) met_again_.push_back(*node);
        } else
            pass_at(passed.node, passed.end);
        return;
    }
    if (!intersections.empty()) pending_.emplace(edge, std::move(intersections));
    const double place = std::clamp(first.place, least_place_, 1.0 - least_place_);
    const double length = rest_length(edge.a, edge.b);
    const VertexId middle = divide_edge(edge.a, edge.b, place);
    ++report_.edges_divided;
    wait_at(front_, middle, length);
    for (const VertexId end : {edge.a, edge.b}) front_.set_crossed({middle, end});
    made_.push_back(middle);
    if (is_swept_) join_at(front_, middle);
}

/// Returns the end of an edge through which the cut goes there, if it has not crossed the edge
/// before: a node that is on the cut so, or one so near that it counts as lying on the surface.
std::optional<VertexId> LoopStep::node_through(const Edge& edge, const EdgeIntersection& x) const {
    for (const VertexId node : nodes_near(front_, edge, x))
        if (node.is_valid()) {
            const bool is_again =
                front_.is_marked(edge.a, edge.b) || front_.is_crossed(edge.a, edge.b);
            return front_.is_through(node) && !is_again ? std::optional(node) : std::nullopt;
        }
    if (front_.passed_at(edge.a, edge.b).is_valid()) return std::nullopt;
    const Vec3 along = point(edge.b)[1] - point(edge.a)[1];
    const double sine = x.normal.isZero(0.0) ? 1.0 : std::abs(x.normal.dot(along)) / along.norm(),
                 height = sine * rest_length(edge.a, edge.b);
    constexpr double rounded_up = 1.0 + 1e-9;
    const auto is_near = [&](VertexId n, double share) {
        if (front_.is_on(n) && !front_.is_through(n)) return false;
        const double most = nearness_of_nodes_ * longest_edge_at(n);
        if (share * height > most) return false;
        // That is over the plane of the surface at the intersection.
        return surface_.comes_within(
            point(n)[1], rounded_up * most * along.norm() / rest_length(edge.a, edge.b));
    };
    const bool is_a = x.place <= 0.5;
    if (is_a ? is_near(edge.a, x.place) : is_near(edge.b, 1.0 - x.place))
        return is_a ? edge.a : edge.b;
    return std::nullopt;
}

/// Returns the length of the longest edge at a node, at rest, m.
double LoopStep::longest_edge_at(VertexId n) const {
    const auto [it, is_new] = longest_edges_.try_emplace(n, 0.0);
    if (!is_new) return it->second;
    for (const FaceId f : faces_at(n)) {
        const int size = mesh_.face_size(f);
        for (int p = 0; p < size; ++p)
            if (mesh_.face_corner(f, p) == n)
                it->second =
                    std::max({it->second, rest_length(n, mesh_.face_corner(f, (p + 1) % size)),
                              rest_length(n, mesh_.face_corner(f, (p + size - 1) % size))});
    }
    return it->second;
}

/// Takes this cut through a node, to the other side of an edge there.
void LoopStep::go_through(VertexId n, VertexId end) {
    if (!front_.is_on(n) && n.index() < num_old_nodes_) ++report_.nodes_snapped;
    front_.put_through(n, rest_length(n, end));
    front_.set_crossed({n, end});
    if (passed_through_.insert(n).second) made_.push_back(n);
    pass_at(n, end);
    if (is_swept_) join_at(front_, n);
}

/// Follows the division of an edge: the intersections that are still to come are with its halves.
void LoopStep::divide_pending(const Edge& edge, VertexId middle, double place) {
    const auto found = pending_.find(edge);
    if (found == pending_.end()) return;
    const EdgeIntersections intersections = std::move(found->second);
    pending_.erase(found);
    EdgeIntersections to_a, to_b;
    for (EdgeIntersection later : intersections) {
        const double at = later.place;
        // The lower id is the first end: the middle is the second one of both halves.
        if (at < place) {
            later.place = at / place;
            to_a.push_back(later);
        } else {
            later.place = (1.0 - at) / (1.0 - place);
            to_b.push_back(later);
        }
    }
    receive({edge.a, middle}, std::move(to_a));
    receive({edge.b, middle}, std::move(to_b));
}

Split split_cells(Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
                  LoopFront& front, const SplitOptions& options, std::span<SuspendedLoops> resting,
                  const EarlierCuts& earlier) {
    return LoopStep(mesh, tissue, surface, front, options, resting, std::nullopt, earlier).run();
}

Split finish_cells(Mesh& mesh, const fragments::FragmentMesh& fragments, const TissueMotion& tissue,
                   const BladeEnd& blade, LoopFront& front, const SplitOptions& options,
                   std::span<SuspendedLoops> resting, const EarlierCuts& earlier) {
    if (front.is_empty()) return {};
    const BladeEnd end = away_from_cut(blade, nodes_of(front, mesh, tissue.after));
    const BladePlace place = place_of(end, tissue, fragments);
    Split result = LoopStep(mesh, tissue, end.continuation(place.exit_distance), front, options,
                            resting, cells_to_part(end, place, mesh, tissue.after, front), earlier)
                       .run();
    front.draw_back(mesh);
    return result;
}

}  // namespace incise::cutting
