// A cut in one class: its passes over the crossed elements share what the class holds, hence a
// long file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/splitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <queue>
#include <string>
#include <unordered_map>
#include <utility>

#include "incise/cutting/exact/blade_stop.h"
#include "incise/cutting/exact/creases.h"
#include "incise/cutting/exact/crossing_counts.h"
#include "incise/cutting/exact/cut_end.h"
#include "incise/cutting/exact/edge_intersections.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/recognition.h"
#include "incise/cutting/exact/separation.h"
#include "incise/cutting/exact/surface_boundary.h"
#include "incise/cutting/exact/turn.h"
#include "incise/topology/mesh_edit.h"

namespace incise::cutting {

using topology::CellKind;
using topology::Mesh;
using topology::MeshEdit;

namespace {

/// The least snap, as a share of an edge. Nearer to an end than this, rounding would decide.
constexpr double smallest_snap = 1e-7;

/// Share of an edge. An intersection that is nearer to an end on the surface is none of its own. It
/// comes from a bend of the surface, or because the motion of tissue between two steps is taken as
/// straight.
constexpr double bend = 0.25;

/// How often an edge is divided in one step. At creases it could go on for ever.
constexpr int max_generation = 6;

/// Returns the intersection at which an edge is divided first. It is the one to which the blade
/// comes first, as in smaller steps. Of those that the blade meets at once, it is the middle one.
const EdgeIntersection& first_of(const EdgeIntersections& intersections) {
    const auto is_earlier = [](const EdgeIntersection& a, const EdgeIntersection& b) {
        return a.time < b.time;
    };
    const double time =
        std::min_element(intersections.begin(), intersections.end(), is_earlier)->time;
    const auto is_first = [&](const EdgeIntersection& p) { return p.time == time; };
    auto skipped = std::count_if(intersections.begin(), intersections.end(), is_first) / 2;
    return *std::find_if(intersections.begin(), intersections.end(),
                         [&](const EdgeIntersection& p) { return is_first(p) && skipped-- == 0; });
}

/// Where the path of a blade ends, and the fragments of the body before that.
struct PathEnd {
    const BladeEnd& blade;
    const fragments::FragmentMesh& fragments;
};

/// Makes the edit of one step of a cut: see split() and finish(). Used once.
class Splitter {
  public:
    Splitter(Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface, CutFront& front,
             const SplitOptions& options, SnapHistory& snap_history,
             std::span<SuspendedCut> resting, const PathEnd* end = nullptr)
        : mesh_(mesh),
          tissue_(tissue),
          surface_(surface),
          front_(front),
          snap_history_(snap_history),
          suspended_(resting),
          snap_(std::max(options.snap, smallest_snap)),
          num_old_nodes_(mesh.node_capacity()) {
        if (end)
            end_.emplace(mesh, end->fragments, end->blade, [&](VertexId n) { return point(n)[1]; });
    }

    Split run() {
        find_crossed_edges();
        if (touched_.empty()) {
            leave_behind({});
            return {};
        }
        edit_.emplace(mesh_);
        while (!queue_.empty()) divide_next();
        put_on_lying_nodes();
        divide_at_end();
        part();
        Split result{edit_->commit(), report_};
        front_.apply(mesh_, result.changes, true);
        snap_history_.apply(mesh_, result.changes);
        leave_behind(result.changes);
        return result;
    }

  private:
    /// An edge to be divided, unless one of its ends comes to count as on the surface.
    struct Pending {
        CellId element;  // one of those that have the edge
        EdgeIntersections intersections;
    };
    MovingPoint point(VertexId n) const {
        if (n.index() < num_old_nodes_)
            return {tissue_.before[n.index()], tissue_.after[n.index()]};
        return new_points_[n.index() - num_old_nodes_];
    }

    void leave_behind(const topology::ChangeSet& changes) {
        cutting::leave_behind(
            mesh_, surface_, [&](VertexId n) { return final_position(n, changes); },
            report_.elements_crossed > 0, front_);
    }

    /// Returns the position of a node after the step. A copy is where its source is.
    Vec3 final_position(VertexId n, const topology::ChangeSet& changes) const {
        if (n.index() >= num_old_nodes_ + new_points_.size()) {
            const std::size_t row = n.index() - changes.node_capacity_before;
            n = changes.nodes_added[row].sources[0].node;
        }
        return point(n)[1];
    }

    int generation(VertexId n) const {
        return n.index() < num_old_nodes_ ? 0 : generations_[n.index() - num_old_nodes_];
    }

    Vec3 rest_edge(VertexId from, VertexId to) const {
        return mesh_.rest_position(to) - mesh_.rest_position(from);
    }
    double rest_length(const Edge& edge) const { return rest_edge(edge.a, edge.b).norm(); }

    void find_crossed_edges();
    EdgeIntersections intersections(const Edge& edge) const {
        return intersections_of(surface_, point(edge.a), point(edge.b), snap_);
    }
    void receive(const Edge& edge, CellId element, EdgeIntersections intersections);
    CutRecord record_at(VertexId n, const EdgeIntersection& intersection) const;
    bool is_at(VertexId end, double distance, const EdgeIntersection& intersection) const;
    bool passes_by(VertexId n, VertexId other, const EdgeIntersection& intersection) const;
    void resolve(const Edge& edge, const EdgeIntersections& intersections);
    bool is_to_be_divided(const Edge& edge, EdgeIntersections& intersections);
    void divide_next();
    bool may_be_divided(const Edge& edge) const {
        return std::max(generation(edge.a), generation(edge.b)) < max_generation;
    }
    VertexId divide(const Edge& edge, CellId element, const EdgeIntersection& intersection);
    struct Division {
        VertexId middle;
        std::vector<VertexId> ring;  // the other nodes of the elements round the edge
        const std::vector<MeshEdit::DividedElement>& elements;
    };
    Division bisect(const Edge& edge, CellId element, double place);
    void place_halves(const Edge& edge, const Division& division, double local_edge_length);
    void divide_at_end();
    VertexId divide_on_cut(const Edge& edge, CellId element, double place);
    void part();
    std::optional<CutFront::Place> position_at_crease(CellId e) const;
    void open(FaceId f);
    void put_on_lying_nodes();
    void put_on(VertexId n, bool is_exact, double local_edge_length);
    void snap_to(VertexId n, double local_edge_length);

    Mesh& mesh_;
    const TissueMotion& tissue_;
    const CutSurface& surface_;
    CutFront& front_;
    SnapHistory& snap_history_;
    const std::span<SuspendedCut> suspended_;
    const double snap_;  // share of an edge: nearer nodes count as on the surface
    const std::size_t num_old_nodes_;
    std::optional<MeshEdit> edit_;  // once there is something to do
    std::optional<CutEnd> end_;     // only in finish()

    std::vector<MovingPoint> new_points_;
    double now_ = 0.0;              // the time in the step of what is being done
    std::vector<int> generations_;  // of the new nodes: one more than that of their edges' ends
    std::unordered_map<Edge, Pending, EdgeHash> pending_;
    std::priority_queue<Turn> queue_;
    NodesOnSurface lying_;         // on the surface to rounding
    std::vector<CellId> touched_;  // crossed, parts of such, or with a face on the surface
    SplitReport report_;
};

void Splitter::find_crossed_edges() {
    EdgeList edges;
    std::vector<std::pair<CellId, std::size_t>> edges_of_elements;
    const auto may_meet = [&](const Box& box) { return surface_.may_meet(box); };
    tissue_.for_each_near(may_meet, [&](CellId e) {
        const auto corners = mesh_.corners(e);
        std::array<MovingPoint, topology::max_corners> points;
        std::ranges::transform(corners, points.begin(), [&](VertexId n) { return point(n); });
        if (!surface_.may_meet_hull(std::span(points).first(corners.size()))) return;
        const topology::CellTraits& t = traits(mesh_.kind(e));
        for (int k = 0; k < t.num_edges; ++k) {
            const auto [p, q] = t.edges[static_cast<std::size_t>(k)];
            const Edge edge = edge_between(corners[static_cast<std::size_t>(p)],
                                           corners[static_cast<std::size_t>(q)]);
            edges_of_elements.emplace_back(e, edges.add(edge, e));
        }
    });

    struct Found {
        EdgeList::Entry entry;
        EdgeIntersections intersections;
    };
    std::vector<Found> found;
    std::vector<bool> is_crossed(edges.entries().size());
    for (std::size_t i = 0; i < edges.entries().size(); ++i) {
        const EdgeList::Entry& entry = edges.entries()[i];
        EdgeIntersections passed = intersections(entry.edge);
        if (passed.empty()) continue;
        is_crossed[i] = true;
        found.push_back({entry, std::move(passed)});
    }
    for (const auto& [e, edge] : edges_of_elements)
        if (is_crossed[edge] && (touched_.empty() || touched_.back() != e)) touched_.push_back(e);
    report_.elements_crossed = touched_.size();
    lying_ = NodesOnSurface(surface_, tissue_, edges.entries(), smallest_snap);
    CellId last;
    for (const auto& [e, edge] : edges_of_elements) {
        if (lying_.is_empty()) break;
        if (e != last && lying_.have_face_of(mesh_, e)) touched_.push_back(e);
        last = e;
    }
    if (!found.empty()) recognize(tissue_, surface_, edges.entries(), snap_history_, front_);
    for (const Found& f : found)
        if (f.intersections.size() % 2 == 1) front_.toggle(f.entry.edge.a, f.entry.edge.b);
    for (Found& f : found) receive(f.entry.edge, f.entry.element, std::move(f.intersections));
}

/// Opens the faces on this cut and on the suspended cuts.
void Splitter::part() {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    const PlaceOnCut unknown;
    const PlaceOnCut position_at_crease = [&](CellId e) { return this->position_at_crease(e); };
    std::vector<FaceId> faces = faces_to_separate(
        mesh_, front_, touched_, surface_.has_creases() ? position_at_crease : unknown);
    if (end_) faces = end_->faces_to_open(faces);
    for (const SuspendedCut& blade : suspended_)
        std::ranges::copy(faces_to_separate(mesh_, blade.front, touched_, unknown),
                          std::back_inserter(faces));
    for (const FaceId f : faces) open(f);
}

/// Returns the side of an element by its middle. Corners that the edit has made are not used:
/// rounding has moved them off their edges, and intersections are counted as if it had not.
std::optional<CutFront::Place> Splitter::position_at_crease(CellId e) const {
    std::array<MovingPoint, 4> points;
    VertexId old;
    for (std::size_t k = 0; k < 4; ++k) {
        const VertexId n = mesh_.corners(e)[k];
        points[k] = point(n);
        if (n.index() < num_old_nodes_) old = n;
    }
    if (!old.is_valid()) return std::nullopt;
    return CutFront::Place{old, is_crossed_from_middle(surface_, points, point(old))};
}

void Splitter::open(FaceId f) {
    if (!mesh_.neighbor(f).is_valid()) return;  // another cut has opened it
    report_.cut_area += topology::rest_area(mesh_, f);
    ++report_.faces_opened;
    edit_->open(f);
}

/// Puts the nodes that lie on the surface on the cut, once all edges are divided. If they were on
/// the cut before, a bend of the surface or another branch near them would count as passing by
/// them.
void Splitter::put_on_lying_nodes() {
    for (const auto& [n, normal, local_edge_length] : lying_) {
        if (front_.is_on(n)) continue;
        snap_to(n, local_edge_length);
        const Vec3 x = point(n)[1];
        snap_history_.add(n, {normal, Vec3::Zero(), false, front_.rank(n), surface_.identity(), x});
    }
}

void Splitter::put_on(VertexId n, bool is_exact, double local_edge_length) {
    front_.put_on(n, is_exact, local_edge_length,
                  front_.is_on(n) ? front_.rank(n) : snap_history_.take_rank());
}

void Splitter::snap_to(VertexId n, double local_edge_length) {
    if (!front_.is_on(n) && n.index() < num_old_nodes_) ++report_.nodes_snapped;
    put_on(n, false, local_edge_length);
}

CutRecord Splitter::record_at(VertexId n, const EdgeIntersection& intersection) const {
    const Vec3 x = point(n)[1];
    const bool is_exact = front_.is_on(n) && !front_.is_near(n);
    return {intersection.normal, intersection.point - x, is_exact,
            front_.rank(n),      surface_.identity(),    x};
}

/// True if an intersection with an edge counts as at the end of the edge.
/// @param distance  of the intersection from this end, as a share of the edge
bool Splitter::is_at(VertexId end, double distance, const EdgeIntersection& intersection) const {
    if (distance < snap_) return true;
    const double size = (point(end)[1] - intersection.point).norm();
    return snap_history_.has(end, record_at(end, intersection), size);
}

/// True if an intersection with the edge from `n` to `other` is none of its own: the surface only
/// passes by `n`, which is near it.
bool Splitter::passes_by(VertexId n, VertexId other, const EdgeIntersection& intersection) const {
    if (!front_.is_near(n)) return false;
    if (!surface_.has_creases()) return true;
    const double length = (point(other)[1] - point(n)[1]).norm();
    return is_same_branch(snap_history_.of(n), record_at(n, intersection), length);
}

// At a node near the surface, the nearest intersection with each edge counts as at the node.
bool Splitter::is_to_be_divided(const Edge& edge, EdgeIntersections& intersections) {
    auto begin = intersections.begin(), end = intersections.end();
    const auto drop_bends = [&] {
        while (begin != end && front_.is_on(edge.a) && begin->place < bend) ++begin;
        while (begin != end && front_.is_on(edge.b) && (end - 1)->place > 1.0 - bend) --end;
    };
    const auto counts_as_on = [&](VertexId n) { return front_.is_on(n) || lying_.contains(n); };
    const auto are_both_on = [&] { return counts_as_on(edge.a) && counts_as_on(edge.b); };
    if (begin != end && passes_by(edge.a, edge.b, *begin)) ++begin;
    if (begin != end && passes_by(edge.b, edge.a, *(end - 1))) --end;
    drop_bends();
    if (begin == end || are_both_on()) return false;  // only rounding is between them
    const double length = rest_length(edge);
    const auto is_near_a = [&](const EdgeIntersection& p) { return is_at(edge.a, p.place, p); };
    const auto is_near_b = [&](const EdgeIntersection& p) {
        return is_at(edge.b, 1.0 - p.place, p);
    };
    // What is near both ends is at the nearer one.
    const auto is_at_a = [&](const EdgeIntersection& p) {
        return is_near_a(p) && (nearer_end(edge, p) == edge.a || !is_near_b(p));
    };
    const auto is_at_b = [&](const EdgeIntersection& p) {
        return is_near_b(p) && (nearer_end(edge, p) == edge.b || !is_near_a(p));
    };
    const auto bring = [&](VertexId n, const EdgeIntersection& intersection) {
        if (front_.is_on(n)) return;
        snap_to(n, length);
        snap_history_.add(n, record_at(n, intersection));
    };
    for (; begin != end && is_at_a(*begin); ++begin) bring(edge.a, *begin);
    for (; begin != end && is_at_b(*(end - 1)); --end) bring(edge.b, *(end - 1));
    drop_bends();
    if (begin == end || are_both_on()) return false;
    intersections = EdgeIntersections(begin, end);
    return true;
}

void Splitter::receive(const Edge& edge, CellId element, EdgeIntersections intersections) {
    queue_.push({first_of(intersections).time, rest_length(edge), edge});
    pending_.insert_or_assign(edge, Pending{element, std::move(intersections)});
}

/// Records the intersections of an edge that is not divided: they count as at its ends.
void Splitter::resolve(const Edge& edge, const EdgeIntersections& intersections) {
    for (const EdgeIntersection& intersection : intersections) {
        const bool is_at_a = front_.is_near(edge.a), is_at_b = front_.is_near(edge.b);
        const VertexId nearer = nearer_end(edge, intersection);
        if (is_at_a && (!is_at_b || nearer == edge.a))
            snap_history_.add(edge.a, record_at(edge.a, intersection));
        if (is_at_b && (!is_at_a || nearer == edge.b))
            snap_history_.add(edge.b, record_at(edge.b, intersection));
    }
}

void Splitter::divide_next() {
    const auto [time, length, edge] = queue_.top();
    queue_.pop();
    now_ = time;
    const auto place = pending_.find(edge);
    const CellId element = place->second.element;
    EdgeIntersections due = std::move(place->second.intersections), later;
    pending_.erase(place);
    // Later intersections are decided when the blade is there, as if they were in another step.
    const auto is_later = [&](const EdgeIntersection& intersection) {
        return intersection.time > now_ + at_once;
    };
    std::ranges::copy_if(due, std::back_inserter(later), is_later);
    if (!later.empty()) std::erase_if(due, is_later);
    if (EdgeIntersections left = due; is_to_be_divided(edge, left)) {
        const EdgeIntersection& intersection = first_of(left);
        if (may_be_divided(edge)) {
            const VertexId middle = divide(edge, element, intersection);
            snap_history_.add(middle, record_at(middle, intersection));
            return;
        }
        const VertexId end = nearer_end(edge, intersection);
        snap_to(end, rest_length(edge));
        snap_history_.add(
            end, record_at(end, intersection));  // at a crease, also for a node made on the cut
    }
    resolve(edge, due);
    if (!later.empty()) receive(edge, element, std::move(later));
}

Splitter::Division Splitter::bisect(const Edge& edge, CellId element, double t) {
    const MovingPoint from = point(edge.a), to = point(edge.b);
    const MeshEdit::Bisection& halves = edit_->bisect(element, edge.a, edge.b, t);
    const VertexId middle = halves.node;
    if (end_) end_->follow(halves.elements);
    generations_.push_back(1 + std::max(generation(edge.a), generation(edge.b)));
    ++report_.edges_divided;
    new_points_.push_back({(1.0 - t) * from[0] + t * to[0], (1.0 - t) * from[1] + t * to[1]});

    std::vector<VertexId> ring;
    for (const auto& [kept, added] : halves.elements) {
        touched_.push_back(kept);
        touched_.push_back(added);
        for (const VertexId n : mesh_.corners(added)) {
            if (n == middle || n == edge.b) continue;
            ring.push_back(n);
            // Edges at the second end now belong to the added half only.
            const auto waiting = pending_.find(edge_between(edge.b, n));
            if (waiting != pending_.end()) waiting->second.element = added;
        }
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    const auto placed = [&](VertexId n) { return PlacedNode{n, point(n)[1]}; };
    snap_history_.follow_division(placed(edge.a), placed(edge.b), placed(middle),
                                  rest_length(edge));
    return {middle, std::move(ring), halves.elements};
}

/// Keeps the sides of the halves on this cut and on the suspended cuts.
/// @pre  the intersections of this cut with the new edges are counted
void Splitter::place_halves(const Edge& edge, const Division& division, double local_edge_length) {
    const auto& [middle, ring, elements] = division;
    front_.place_halves(mesh_, edge.a, edge.b, middle, elements);
    for (const SuspendedCut& blade : suspended_) {
        position_of_suspended(blade, edge, middle, ring, local_edge_length, snap_history_,
                              [&](VertexId n) { return point(n); });
        blade.front.place_halves(mesh_, edge.a, edge.b, middle, elements);
    }
}

/// Divides an edge where the surface crosses it, and returns the new node.
VertexId Splitter::divide(const Edge& edge, CellId element, const EdgeIntersection& intersection) {
    const double local_edge_length = rest_length(edge);
    const Division division = bisect(edge, element, intersection.place);
    const VertexId middle = division.middle;
    const std::vector<VertexId>& ring = division.ring;
    put_on(middle, true, local_edge_length);

    const auto holder = [&](VertexId other) {
        CellId found;
        for (const auto& [kept, added] : division.elements)
            for (const CellId e : {kept, added})
                if (mesh_.corner_of(e, other) >= 0) found = e;
        return found;
    };
    const auto ask = [&](VertexId other) { return intersections(edge_between(other, middle)); };
    std::vector<EdgeIntersections> to_ring;
    to_ring.reserve(ring.size());
    for (const VertexId n : ring) to_ring.push_back(ask(n));
    EdgeIntersections to_a = ask(edge.a), to_b = ask(edge.b);
    const auto has_boundary = [&](VertexId p, VertexId q, VertexId r) {
        return surface_.ends_inside({point(p), point(q), point(r)});
    };
    place_on_side(front_, edge.a, edge.b, middle, ring, has_boundary,
                  [&](std::size_t i) { return (to_ring[i].size() + to_b.size()) % 2 == 1; });
    place_halves(edge, division, local_edge_length);
    // What the blade did earlier concerns the edge that was there then. In smaller steps, the new
    // edges would not be examined for it.
    const auto take = [&](VertexId other, EdgeIntersections&& passed) {
        std::erase_if(passed,
                      [&](const EdgeIntersection& p) { return p.time < intersection.time; });
        if (!passed.empty()) receive(edge_between(other, middle), holder(other), std::move(passed));
    };
    take(edge.a, std::move(to_a));
    take(edge.b, std::move(to_b));
    for (std::size_t i = 0; i < ring.size(); ++i) take(ring[i], std::move(to_ring[i]));
    return middle;
}

/// Divides faces on the cut at the blade's edge where they go on ahead of it.
void Splitter::divide_at_end() {
    if (!end_) return;
    const PlaceOnCut unknown;
    const auto faces = Sides(mesh_, front_, touched_, unknown).separated_faces();
    for (const auto& [edge, element, intersection] : end_->crossed_edges(faces, snap_))
        receive(edge, element, {intersection});
    while (!queue_.empty()) {
        const Edge edge = queue_.top().edge;
        queue_.pop();
        const auto [element, intersections] = std::move(pending_.extract(edge).mapped());
        if (end_->is_at(edge.a) || end_->is_at(edge.b)) continue;
        const EdgeIntersection& intersection = intersections.front();
        if (may_be_divided(edge))
            end_->put_at(divide_on_cut(edge, element, intersection.place));
        else
            end_->put_at(nearer_end(edge, intersection));
    }
}

/// Divides an edge whose ends are both on the cut, and returns the new node. It is on the cut, too,
/// on the side of one of the ends.
VertexId Splitter::divide_on_cut(const Edge& edge, CellId element, double t) {
    const double local_edge_length = rest_length(edge);
    const Division division = bisect(edge, element, t);
    const auto& [middle, ring, elements] = division;
    put_on(middle, !front_.is_near(edge.a) && !front_.is_near(edge.b), local_edge_length);
    place_on_side(
        front_, edge.a, edge.b, middle, ring,
        [](VertexId, VertexId, VertexId) { return std::optional(false); },
        [](std::size_t) { return false; });
    place_halves(edge, division, local_edge_length);
    return middle;
}

}  // namespace

Split split(Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface, CutFront& front,
            const SplitOptions& options, SnapHistory& snap_history,
            std::span<SuspendedCut> resting) {
    return Splitter(mesh, tissue, surface, front, options, snap_history, resting).run();
}

Split finish(Mesh& mesh, const fragments::FragmentMesh& fragments, const TissueMotion& tissue,
             const BladeEnd& blade, CutFront& front, const SplitOptions& options,
             SnapHistory& snap_history, std::span<SuspendedCut> resting) {
    if (front.is_empty()) return {};
    const BladeEnd end = away_from_cut(blade, nodes_of(front, mesh, tissue.after));
    const PathEnd path_end{end, fragments};
    const double distance = place_of(end, tissue, fragments).exit_distance;
    Split result = Splitter(mesh, tissue, end.continuation(distance), front, options, snap_history,
                            resting, &path_end)
                       .run();
    front = {};
    return result;
}

}  // namespace incise::cutting
