// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/loop_splitter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>

#include "incise/cutting/exact/edge_intersections.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/triangulation.h"
#include "incise/cutting/exact/turn.h"
#include "incise/topology/darts.h"
#include "incise/topology/mesh_edit.h"

namespace incise::cutting {

using topology::CellKind;
using topology::Dart;
using topology::Mesh;
using topology::MeshEdit;

namespace {

/// Share of an edge: a node is not made nearer to an end, so that no edge is without length.
constexpr double least_place = 2e-3;

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

/// Makes the edit of one step of a cut: see split_cells(). Used once.
class LoopSplitter {
  public:
    LoopSplitter(Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
                 LoopFront& front, const SplitOptions& options, std::span<SuspendedLoops> resting)
        : mesh_(mesh),
          tissue_(tissue),
          surface_(surface),
          front_(front),
          resting_(resting),
          snap_(options.snap),
          is_swept_(surface.ends_inside({MovingPoint{}, MovingPoint{}, MovingPoint{}}).has_value()),
          num_old_nodes_(mesh.node_capacity()) {}

    Split run() {
        find_crossed_edges();
        if (pending_.empty()) return {};
        edit_.emplace(mesh_);
        divide_warped_faces();
        while (!queue_.empty()) divide_next();
        if (!is_swept_) join_all();
        open_faces();
        Split result{edit_->commit(), report_};
        front_.apply(mesh_, result.changes);
        front_.leave_behind(mesh_);
        return result;
    }

  private:
    MovingPoint point(VertexId n) const {
        if (n.index() < num_old_nodes_)
            return {tissue_.before[n.index()], tissue_.after[n.index()]};
        return new_points_[n.index() - num_old_nodes_];
    }
    double rest_length(VertexId a, VertexId b) const {
        return (mesh_.rest_position(b) - mesh_.rest_position(a)).norm();
    }
    /// Gives a new node its motion: that of the points it lies between.
    void place_new_node(VertexId n, std::span<const std::pair<VertexId, double>> sources) {
        assert(n.index() == num_old_nodes_ + new_points_.size());
        (void)n;
        MovingPoint x{Vec3::Zero(), Vec3::Zero()};
        for (const auto& [source, weight] : sources) {
            const MovingPoint at = point(source);
            for (std::size_t i = 0; i < 2; ++i) x[i] += weight * at[i];
        }
        new_points_.push_back(x);
    }

    void find_crossed_edges();
    void receive(const Edge& edge, EdgeIntersections intersections);
    void divide_warped_faces();
    void divide_next();
    bool is_at_own_node(const Edge& edge, const EdgeIntersection& intersection) const;
    VertexId divide_edge(VertexId a, VertexId b, double place);
    std::optional<VertexId> waiting_partner(const LoopFront& front, FaceId f, VertexId v) const;
    void join_at(LoopFront& front, VertexId v);
    void join(LoopFront& front, FaceId f, VertexId v, VertexId w);
    void join_all();
    void close(LoopFront& front, CellId e, VertexId v, VertexId w);
    std::vector<VertexId> path_from(const LoopFront& front, CellId e, VertexId v, VertexId w) const;
    /// One of the two parts of a divided face.
    struct Half {
        std::vector<VertexId> waiting;  ///< nodes of a cut
        std::optional<Vec3> pierced;    ///< where its blade passes through, m
        Vec3 normal;                    ///< times twice the area, m2
    };
    Half half_of(const SuspendedLoops& blade, FaceId f) const;
    void pass_edges(SuspendedLoops& blade, CellId e, std::vector<VertexId>& path);
    void open_faces();
    /// Passes the front of each other cut.
    template <class Visit>
    void for_other_cuts(const LoopFront& front, Visit visit) {
        if (&front != &front_) visit(front_);
        for (SuspendedLoops& blade : resting_)
            if (&blade.front != &front) visit(blade.front);
    }
    std::vector<CellId> star(VertexId v) const {
        std::vector<CellId> cells;
        topology::collect_star(mesh_, v, mesh_.incident_element(v), cells);
        return cells;
    }
    std::vector<FaceId> faces_at(VertexId v) const;

    Mesh& mesh_;
    const TissueMotion& tissue_;
    const CutSurface& surface_;
    LoopFront& front_;
    const std::span<SuspendedLoops> resting_;
    const double snap_;
    const bool is_swept_;
    const std::size_t num_old_nodes_;
    std::optional<MeshEdit> edit_;  // once there is something to do

    std::vector<MovingPoint> new_points_;
    std::unordered_map<Edge, EdgeIntersections, EdgeHash> pending_;  // in the order of times
    std::priority_queue<Turn> queue_;
    std::vector<CellId> crossed_;  // in ascending order
    std::vector<VertexId> made_;   // nodes on crossed edges
    std::vector<CellId> divided_;  // cells at divided edges and faces, and parts of such
    SplitReport report_;
};

void LoopSplitter::find_crossed_edges() {
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
    std::vector<bool> is_crossed(edges.entries().size());
    for (std::size_t i = 0; i < edges.entries().size(); ++i) {
        const Edge& edge = edges.entries()[i].edge;
        if (front_.is_marked(edge.a, edge.b)) continue;  // the cut comes back to itself
        EdgeIntersections passed = intersections_of(surface_, point(edge.a), point(edge.b), snap_);
        if (passed.empty()) continue;
        is_crossed[i] = true;
        receive(edge, std::move(passed));
    }
    for (const auto& [e, edge] : edges_of_cells)
        if (is_crossed[edge] && (crossed_.empty() || crossed_.back() != e)) crossed_.push_back(e);
    report_.elements_crossed = crossed_.size();
}

void LoopSplitter::receive(const Edge& edge, EdgeIntersections intersections) {
    if (intersections.empty()) return;
    std::ranges::stable_sort(intersections, {}, &EdgeIntersection::time);
    queue_.push({intersections.front().time, rest_length(edge.a, edge.b), edge});
    pending_.insert_or_assign(edge, std::move(intersections));
}

/// Divides the quadrilaterals of crossed cells that are not plane at rest into four triangles each,
/// about their middles. The volume stays the same, and all faces are plane.
void LoopSplitter::divide_warped_faces() {
    for (const CellId e : crossed_) {
        const int count = mesh_.num_faces(e);
        for (int f = 0; f < count; ++f) {
            const FaceId face{e, f};
            if (mesh_.face_size(face) != 4 || is_plane(mesh_, face)) continue;
            std::array<std::pair<VertexId, double>, 4> sources;
            for (int p = 0; p < 4; ++p)
                sources[static_cast<std::size_t>(p)] = {mesh_.face_corner(face, p), 0.25};
            const VertexId centre = edit_->divide_face_at_centre(face);
            place_new_node(centre, sources);
            for (const auto& [corner, weight] : sources)
                receive({corner, centre},
                        intersections_of(surface_, point(corner), point(centre), snap_));
        }
    }
}

/// True if an intersection with an edge is at an end that is a node of this cut: the blade has come
/// back to it, or has not left it yet.
bool LoopSplitter::is_at_own_node(const Edge& edge, const EdgeIntersection& intersection) const {
    const double length = rest_length(edge.a, edge.b);
    const auto is_at = [&](VertexId end, double share) {
        return front_.is_on(end) && share * length < snap_ * front_.local_edge_length(end);
    };
    return is_at(edge.a, intersection.place) || is_at(edge.b, 1.0 - intersection.place);
}

void LoopSplitter::divide_next() {
    const Edge edge = queue_.top().edge;
    queue_.pop();
    const auto found = pending_.find(edge);
    if (found == pending_.end()) return;
    EdgeIntersections intersections = std::move(found->second);
    pending_.erase(found);
    const EdgeIntersection first = intersections.front();
    intersections.erase(intersections.begin());
    if (front_.owes(edge.a, edge.b) || is_at_own_node(edge, first)) {
        front_.toggle_debt(edge.a, edge.b);
        receive(edge, std::move(intersections));
        return;
    }
    const double place = std::clamp(first.place, least_place, 1.0 - least_place);
    const double length = rest_length(edge.a, edge.b);
    const VertexId middle = divide_edge(edge.a, edge.b, place);
    ++report_.edges_divided;
    front_.put_on(middle, length);
    made_.push_back(middle);
    EdgeIntersections to_a, to_b;
    for (EdgeIntersection& later : intersections) {
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
    if (is_swept_) join_at(front_, middle);
}

/// Divides an edge for all cuts.
VertexId LoopSplitter::divide_edge(VertexId a, VertexId b, double place) {
    std::vector<CellId> cells;
    append_cells_at_edge(mesh_, mesh_.incident_element(a), a, b, cells);
    assert(!cells.empty());
    divided_.insert(divided_.end(), cells.begin(), cells.end());
    const double length = rest_length(a, b);
    const VertexId middle = edit_->divide_edge(find_dart(mesh_, cells.front(), a, b), place);
    place_new_node(middle, std::array{std::pair(a, 1.0 - place), std::pair(b, place)});
    front_.divide(a, b, middle, length);
    for (SuspendedLoops& blade : resting_) blade.front.divide(a, b, middle, length);
    return middle;
}

/// Returns the faces at a node, each by one of its sides.
std::vector<FaceId> LoopSplitter::faces_at(VertexId v) const {
    std::vector<FaceId> faces;
    for (const CellId e : star(v))
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh_.neighbor(face);
            if (other.is_valid() && other < face) continue;
            for (int p = 0; p < mesh_.face_size(face); ++p)
                if (mesh_.face_corner(face, p) == v) faces.push_back(face);
        }
    return faces;
}

/// Returns another node that waits in the face.
std::optional<VertexId> LoopSplitter::waiting_partner(const LoopFront& front, FaceId f,
                                                      VertexId v) const {
    for (int p = 0; p < mesh_.face_size(f); ++p)
        if (const VertexId n = mesh_.face_corner(f, p); n != v && front.waits(mesh_, f, n))
            return n;
    return std::nullopt;
}

/// Joins a node with those that wait for it in the faces at it. In a face that is plane, a straight
/// edge of a blade enters and leaves by turns: so pairs in the order of time are the true ones.
void LoopSplitter::join_at(LoopFront& front, VertexId v) {
    for (bool is_done = false; !is_done;) {
        is_done = true;
        for (const FaceId f : faces_at(v)) {
            if (!front.waits(mesh_, f, v)) continue;
            const auto partner = waiting_partner(front, f, v);
            if (!partner) continue;
            join(front, f, v, *partner);
            is_done = false;  // faces have other numbers now
            break;
        }
    }
}

/// Joins nodes where the surface is there at once: all that it crosses are known. Of the two ways
/// to pair neighbours round a face, the shorter one is taken.
void LoopSplitter::join_all() {
    for (const VertexId v : made_)
        for (bool is_done = false; !is_done;) {
            is_done = true;
            for (const FaceId f : faces_at(v)) {
                if (!front_.waits(mesh_, f, v)) continue;
                std::vector<VertexId> waiting;
                for (int p = 0; p < mesh_.face_size(f); ++p)
                    if (const VertexId n = mesh_.face_corner(f, p); front_.waits(mesh_, f, n))
                        waiting.push_back(n);
                if (waiting.size() < 2) continue;
                const auto length_of = [&](std::size_t begin) {
                    double sum = 0.0;
                    for (std::size_t i = begin; i + 1 < waiting.size() + begin; i += 2)
                        sum += rest_length(waiting[i % waiting.size()],
                                           waiting[(i + 1) % waiting.size()]);
                    return sum;
                };
                const std::size_t begin = length_of(1) < length_of(0) ? 1 : 0;
                join(front_, f, waiting[begin], waiting[(begin + 1) % waiting.size()]);
                is_done = false;
                break;
            }
        }
}

/// Divides a face by an edge between two nodes of a cut.
void LoopSplitter::join(LoopFront& front, FaceId f, VertexId v, VertexId w) {
    const FaceId other = mesh_.neighbor(f);
    const auto have_edge = [&](CellId e) { return find_dart(mesh_, e, v, w).is_valid(); };
    std::vector<LoopFront*> on_cuts;  // on which the face lies: its new edges do, too
    for_other_cuts(front, [&](LoopFront& cut) {
        if (cut.is_cut_face(mesh_, f)) on_cuts.push_back(&cut);
    });
    std::vector<VertexId> path{v, w};
    if (have_edge(f.cell) || (other.is_valid() && have_edge(other.cell))) {
        const std::size_t row = mesh_.node_capacity();
        const VertexId middle = edit_->divide_face_beside(f, v, w);
        assert(middle.index() == row);
        (void)row;
        std::vector<std::pair<VertexId, double>> sources;
        const topology::VertexRecord& record = edit_->added(middle);
        for (int k = 0; k < record.num_sources; ++k)
            sources.emplace_back(record.sources[static_cast<std::size_t>(k)].node,
                                 record.sources[static_cast<std::size_t>(k)].weight);
        place_new_node(middle, sources);
        front.put_on(middle, front.local_edge_length(v));
        path.insert(path.begin() + 1, middle);
    } else {
        edit_->divide_face(f, v, w);
    }
    divided_.push_back(f.cell);
    if (other.is_valid()) divided_.push_back(other.cell);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        front.mark(path[i], path[i + 1]);
        front.set_open(f.cell, path[i], path[i + 1]);
        if (other.is_valid()) front.set_open(other.cell, path[i], path[i + 1]);
        for (LoopFront* cut : on_cuts) cut->mark(path[i], path[i + 1]);
    }
    for (SuspendedLoops& blade : resting_)
        if (&blade.front != &front) pass_edges(blade, f.cell, path);
    const VertexId end = path[1];
    // Other cuts can have divided the cells meanwhile.
    std::vector<CellId> cells;
    append_cells_at_edge(mesh_, mesh_.incident_element(v), v, end, cells);
    for (const CellId e : cells) close(front, e, v, end);
}

/// Returns the closed path of open edges of a cell that begins with an edge; empty if it is not
/// closed.
std::vector<VertexId> LoopSplitter::path_from(const LoopFront& front, CellId e, VertexId v,
                                              VertexId w) const {
    const std::vector<Edge>& open = front.open_edges(e);
    std::vector<VertexId> path{v, w};
    for (;;) {
        VertexId next;
        for (const Edge& edge : open) {
            if (edge.a != path.back() && edge.b != path.back()) continue;
            const VertexId far = edge.a == path.back() ? edge.b : edge.a;
            if (far == path[path.size() - 2]) continue;
            if (next.is_valid()) return {};  // two ways: it stays whole
            next = far;
        }
        if (!next.is_valid()) return {};
        if (next == v) return path;
        if (std::ranges::find(path, next) != path.end()) return {};
        path.push_back(next);
    }
}

/// Divides a cell if the edge completes a closed path.
void LoopSplitter::close(LoopFront& front, CellId e, VertexId v, VertexId w) {
    if (std::ranges::find(front.open_edges(e), edge_between(v, w)) == front.open_edges(e).end())
        return;
    const std::vector<VertexId> path = path_from(front, e, v, w);
    if (path.empty()) return;
    const CellId added = edit_->divide_cell(e, path);
    divided_.push_back(added);
    front_.divide(mesh_, e, added);
    for (SuspendedLoops& blade : resting_) blade.front.divide(mesh_, e, added);
    for (std::size_t i = 0; i < path.size(); ++i)
        for (const CellId part : {e, added})
            front.set_closed(part, path[i], path[(i + 1) % path.size()]);
    const FaceId face{added, mesh_.num_faces(added) - 1};
    bool is_waited_in = false;
    for_other_cuts(front, [&](LoopFront& cut) {
        for (const VertexId n : path) is_waited_in |= cut.waits(mesh_, face, n);
    });
    if (is_waited_in) {  // its triangles would not know which of them it waits in
        for_other_cuts(front, [&](LoopFront& cut) {
            if (&cut != &front_ || is_swept_)
                for (const VertexId n : path) join_at(cut, n);
        });
        return;
    }
    const double length = front.local_edge_length(v);
    triangulate(
        mesh_, *edit_, face, [&](VertexId a, VertexId b) { front.mark(a, b); },
        [&](VertexId centre, std::span<const std::pair<VertexId, double>> sources) {
            place_new_node(centre, sources);
            front.put_on(centre, length);
        });
}

/// Lets another cut pass the edges that have divided a face of a cell, if they are between a node
/// that waits there and the blade. Adds the node that it makes to the path of the edges.
void LoopSplitter::pass_edges(SuspendedLoops& blade, CellId e, std::vector<VertexId>& path) {
    const Dart along = find_dart(mesh_, e, path[0], path[1]);
    if (!along.is_valid()) return;
    const Half halves[] = {half_of(blade, along.face), half_of(blade, opposite(mesh_, along).face)};
    for (const std::size_t k : {0u, 1u}) {
        const Half &start = halves[k], &end = halves[1 - k];
        if (start.waiting.size() % 2 == 0 || start.pierced || !end.pierced) continue;
        // The edge that lies best between the node and the blade.
        const Vec3 to_blade = *end.pierced - blade.now(point(start.waiting.front()));
        const Vec3 across = start.normal.cross(to_blade);
        std::size_t best = 0;
        double place = 0.5, least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const double from = across.dot(blade.now(point(path[i])) - *end.pierced),
                         to = across.dot(blade.now(point(path[i + 1])) - *end.pierced);
            const double at = from == to ? 0.5 : from / (from - to);
            const double beside = std::abs(at - 0.5);
            if (beside >= least) continue;
            least = beside;
            best = i;
            place = std::clamp(at, least_place, 1.0 - least_place);
        }
        const double length = rest_length(path[best], path[best + 1]);
        const VertexId middle = divide_edge(path[best], path[best + 1], place);
        path.insert(path.begin() + static_cast<std::ptrdiff_t>(best) + 1, middle);
        blade.front.put_on(middle, length);
        join_at(blade.front, middle);
        return;
    }
}

/// Returns what another cut has in a face.
LoopSplitter::Half LoopSplitter::half_of(const SuspendedLoops& blade, FaceId f) const {
    Half half{{}, std::nullopt, Vec3::Zero()};
    const int size = mesh_.face_size(f);
    const auto at = [&](int p) { return point(mesh_.face_corner(f, p)); };
    for (int p = 0; p < size; ++p) {
        if (blade.front.waits(mesh_, f, mesh_.face_corner(f, p)))
            half.waiting.push_back(mesh_.face_corner(f, p));
        if (p < 2) continue;
        half.normal +=
            (blade.now(at(p - 1)) - blade.now(at(0))).cross(blade.now(at(p)) - blade.now(at(0)));
        if (const auto x = blade.point_inside({at(0), at(p - 1), at(p)}))
            half.pierced = half.pierced ? std::nullopt : x;
    }
    return half;
}

/// Opens the faces on this cut and on the suspended cuts.
void LoopSplitter::open_faces() {
    std::ranges::sort(divided_);
    divided_.erase(std::unique(divided_.begin(), divided_.end()), divided_.end());
    for (const CellId e : divided_)
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f};
            if (!mesh_.neighbor(face).is_valid()) continue;
            const bool is_cut = front_.is_cut_face(mesh_, face) ||
                                std::ranges::any_of(resting_, [&](const SuspendedLoops& blade) {
                                    return blade.front.is_cut_face(mesh_, face);
                                });
            if (!is_cut) continue;
            report_.cut_area += topology::rest_area(mesh_, face);
            ++report_.faces_opened;
            edit_->open(face);
        }
}

}  // namespace

Split split_cells(Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
                  LoopFront& front, const SplitOptions& options,
                  std::span<SuspendedLoops> resting) {
    return LoopSplitter(mesh, tissue, surface, front, options, resting).run();
}

}  // namespace incise::cutting
