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

/// Any point, to ask a surface whether it is swept.
const MovingPoint origin = {Vec3::Zero(), Vec3::Zero()};

/// Share of an edge: a blade that passes nearer to a node of its own cut passes at the node. Two
/// intersections with an edge at once that are nearer to each other cancel out.
constexpr double nearness = default_snap;

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
                 LoopFront& front, std::span<SuspendedLoops> resting)
        : mesh_(mesh),
          tissue_(tissue),
          surface_(surface),
          front_(front),
          resting_(resting),
          is_swept_(surface.ends_inside({origin, origin, origin}).has_value()),
          num_old_nodes_(mesh.node_capacity()) {}

    Split run() {
        find_crossed_edges();
        if (pending_.empty()) return {};
        edit_.emplace(mesh_);
        divide_warped_faces();
        while (!queue_.empty()) divide_next();
        if (!is_swept_) join_all();
        triangulate_all();
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
    void make_wait_in(LoopFront& front, FaceId f, std::span<const VertexId> path);
    std::vector<VertexId> divide_face(FaceId f, VertexId v, VertexId w);
    void divide_at_centre(FaceId f);
    void triangulate_all();
    void open_faces();

    /// A cut that is not finished, with its blade where it is, or where it ends this step.
    struct Cut {
        LoopFront& front;
        const SuspendedLoops* resting;  // null for the cut that is made
    };
    /// One of the two parts of a divided face, for such a cut.
    struct Half {
        FaceId face;
        std::vector<VertexId> waiting;  ///< nodes of the cut
        bool is_odd;  ///< true if an odd number of times it waits, or crosses an edge later
        std::optional<Vec3> pierced;  ///< where its blade passes through, m
        Vec3 normal;                  ///< times twice the area, m2
        /// True if the cut comes in as often as it goes out, and ends at its blade.
        bool is_settled() const { return is_odd == pierced.has_value(); }
    };
    Half half_of(const Cut& cut, FaceId f) const;
    const Vec3& now(const Cut& cut, VertexId n) const;
    void let_pass(const Cut& cut, CellId e, std::vector<VertexId>& path,
                  bool is_one_of_many = false);
    /// Passes each cut, or each one but that of a front.
    template <class Visit>
    void for_cuts(const LoopFront* but, Visit visit) {
        if (but != &front_) visit(Cut{front_, nullptr});
        for (SuspendedLoops& blade : resting_)
            if (&blade.front != but) visit(Cut{blade.front, &blade});
    }
    std::vector<CellId> star(VertexId v) const;
    void note_rings(VertexId middle, VertexId a, std::span<const CellId> cells);
    std::vector<FaceId> faces_at(VertexId v) const;

    Mesh& mesh_;
    const TissueMotion& tissue_;
    const CutSurface& surface_;
    LoopFront& front_;
    const std::span<SuspendedLoops> resting_;
    const bool is_swept_;
    double time_ = 0.0;  // of the intersection that is the last one so far
    const std::size_t num_old_nodes_;
    std::optional<MeshEdit> edit_;  // once there is something to do

    std::vector<MovingPoint> new_points_;
    std::unordered_map<Edge, EdgeIntersections, EdgeHash> pending_;  // in the order of times
    std::priority_queue<Turn> queue_;
    std::vector<CellId> crossed_;  // in ascending order
    std::vector<VertexId> made_;   // nodes on crossed edges
    /// One cell of each ring, of nodes whose cells are in several rings.
    std::unordered_map<VertexId, std::vector<CellId>> rings_;
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
        EdgeIntersections passed =
            intersections_of(surface_, point(edge.a), point(edge.b), nearness);
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
                        intersections_of(surface_, point(corner), point(centre), nearness));
        }
    }
}

/// True if an intersection with an edge is at an end that is a node of this cut: the blade has come
/// back to it, or has not left it yet.
bool LoopSplitter::is_at_own_node(const Edge& edge, const EdgeIntersection& intersection) const {
    const double length = rest_length(edge.a, edge.b);
    const auto is_at = [&](VertexId end, double share) {
        return front_.is_on(end) && share * length < nearness * front_.local_edge_length(end);
    };
    return is_at(edge.a, intersection.place) || is_at(edge.b, 1.0 - intersection.place);
}

void LoopSplitter::divide_next() {
    const Edge edge = queue_.top().edge;
    time_ = queue_.top().time;
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
    note_rings(middle, a, cells);
    front_.divide(a, b, middle, length);
    for (SuspendedLoops& blade : resting_) blade.front.divide(a, b, middle, length);
    return middle;
}

/// Where an earlier cut ends, two rings of cells can have an edge between the same two nodes, with
/// opened faces between them. A new node of this edge becomes two at the end of the edit.
void LoopSplitter::note_rings(VertexId middle, VertexId a, std::span<const CellId> cells) {
    std::vector<CellId> found, begins;
    for (const CellId e : cells) {
        if (std::ranges::find(found, e) != found.end()) continue;
        begins.push_back(e);
        const std::size_t begin = found.size();
        found.push_back(e);
        for (std::size_t i = begin; i < found.size(); ++i)  // more are added
            for (const auto& [x, y] : {std::pair(a, middle), std::pair(middle, a)}) {
                const CellId next = mesh_.neighbor(find_dart(mesh_, found[i], x, y).face).cell;
                if (next.is_valid() && std::ranges::find(found, next) == found.end())
                    found.push_back(next);
            }
    }
    if (begins.size() > 1) rings_[middle] = std::move(begins);
}

/// Returns the cells at a node.
std::vector<CellId> LoopSplitter::star(VertexId v) const {
    std::vector<CellId> cells;
    topology::collect_star(mesh_, v, mesh_.incident_element(v), cells);
    if (const auto it = rings_.find(v); it != rings_.end())
        for (const CellId e : it->second) {
            if (std::ranges::find(cells, e) != cells.end()) continue;
            std::vector<CellId> more;
            topology::collect_star(mesh_, v, e, more);
            cells.insert(cells.end(), more.begin(), more.end());
        }
    return cells;
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
    std::vector<VertexId> path = divide_face(f, v, w);
    if (path.size() > 2) front.put_on(path[1], front.local_edge_length(v));
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        front.mark(path[i], path[i + 1]);
        front.set_open(f.cell, path[i], path[i + 1]);
        if (other.is_valid()) front.set_open(other.cell, path[i], path[i + 1]);
    }
    for_cuts(&front, [&](const Cut& cut) { let_pass(cut, f.cell, path); });
    const VertexId end = path[1];
    // Other cuts can have divided the cells meanwhile.
    for (const CellId e : star(v))
        if (find_dart(mesh_, e, v, end).is_valid()) close(front, e, v, end);
}

/// Divides a face by an edge between two of its corners, or by two edges if the cells at the face
/// have an edge between them. On the cuts on which the face lies, the edges are marked. Returns the
/// path of the edges.
std::vector<VertexId> LoopSplitter::divide_face(FaceId f, VertexId v, VertexId w) {
    const FaceId other = mesh_.neighbor(f);
    const auto have_edge = [&](CellId e) { return find_dart(mesh_, e, v, w).is_valid(); };
    const LoopFront::Corner at_v = LoopFront::corner(mesh_, f, v),
                            at_w = LoopFront::corner(mesh_, f, w);
    std::vector<LoopFront*> on_cuts;
    for_cuts(nullptr, [&](const Cut& cut) {
        if (cut.front.is_cut_face(mesh_, f)) on_cuts.push_back(&cut.front);
    });
    std::vector<VertexId> path{v, w};
    if (have_edge(f.cell) || (other.is_valid() && have_edge(other.cell))) {
        const VertexId middle = edit_->divide_face_beside(f, v, w);
        std::vector<std::pair<VertexId, double>> sources;
        const topology::VertexRecord& record = edit_->added(middle);
        for (int k = 0; k < record.num_sources; ++k)
            sources.emplace_back(record.sources[static_cast<std::size_t>(k)].node,
                                 record.sources[static_cast<std::size_t>(k)].weight);
        place_new_node(middle, sources);
        path.insert(path.begin() + 1, middle);
    } else {
        edit_->divide_face(f, v, w);
    }
    divided_.push_back(f.cell);
    if (other.is_valid()) divided_.push_back(other.cell);
    for_cuts(nullptr, [&](const Cut& cut) {
        cut.front.divide(at_v, path[1]);
        cut.front.divide(at_w, path[path.size() - 2]);
    });
    for (LoopFront* front : on_cuts)
        for (std::size_t i = 0; i + 1 < path.size(); ++i) front->mark(path[i], path[i + 1]);
    return path;
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
    divided_.insert(divided_.end(), {e, added});
    for (auto& [n, begins] : rings_)
        for (CellId& begin : begins)
            if (begin == e && mesh_.corner_of(e, n) < 0) begin = added;
    front_.divide(mesh_, e, added);
    for (SuspendedLoops& blade : resting_) blade.front.divide(mesh_, e, added);
    for (std::size_t i = 0; i < path.size(); ++i)
        for (const CellId part : {e, added})
            front.set_closed(part, path[i], path[(i + 1) % path.size()]);
    const FaceId face{added, mesh_.num_faces(added) - 1};
    for_cuts(&front, [&](const Cut& cut) { make_wait_in(cut.front, face, path); });
    for_cuts(&front, [&](const Cut& cut) {
        if (cut.resting != nullptr || is_swept_)
            for (const VertexId n : path) join_at(cut.front, n);
    });
}

/// Decides at which corners of a face, which another cut has put into a cell, this cut waits. In
/// one of the two new cells it then has an even number of edges and waiting corners at the node.
void LoopSplitter::make_wait_in(LoopFront& front, FaceId f, std::span<const VertexId> path) {
    for (const VertexId n : path) {
        if (!front.waits(mesh_, f, n)) continue;
        std::size_t count = 0;
        for (int k = 0; k < mesh_.num_faces(f.cell); ++k)
            if (k != f.face && front.waits(mesh_, {f.cell, k}, n)) ++count;
        for (const Edge& edge : front.open_edges(f.cell))
            if (edge.a == n || edge.b == n) ++count;
        if (count % 2 == 0) front.set_idle(LoopFront::corner(mesh_, f, n));
    }
}

/// Returns where a node is when the blade of the cut is where it is, m.
const Vec3& LoopSplitter::now(const Cut& cut, VertexId n) const {
    const std::size_t when = cut.resting == nullptr || cut.resting->has_moved ? 1 : 0;
    if (n.index() < num_old_nodes_)
        return when == 1 ? tissue_.after[n.index()] : tissue_.before[n.index()];
    return new_points_[n.index() - num_old_nodes_][when];
}

LoopSplitter::Half LoopSplitter::half_of(const Cut& cut, FaceId f) const {
    Half half{f, {}, false, std::nullopt, Vec3::Zero()};
    const int size = mesh_.face_size(f);
    const auto at = [&](int p) -> const Vec3& { return now(cut, mesh_.face_corner(f, p)); };
    for (int p = 0; p < size; ++p) {
        const VertexId n = mesh_.face_corner(f, p), next = mesh_.face_corner(f, (p + 1) % size);
        if (cut.front.waits(mesh_, f, n)) {
            half.waiting.push_back(n);
            half.is_odd = !half.is_odd;
        }
        if (cut.front.owes(n, next)) half.is_odd = !half.is_odd;
        if (cut.resting == nullptr)
            if (const auto it = pending_.find(edge_between(n, next)); it != pending_.end())
                half.is_odd ^= it->second.size() % 2 == 1;
        if (p < 2) continue;
        half.normal += (at(p - 1) - at(0)).cross(at(p) - at(0));
        const std::array<MovingPoint, 3> triangle = {MovingPoint{at(0), at(0)},
                                                     MovingPoint{at(p - 1), at(p - 1)},
                                                     MovingPoint{at(p), at(p)}};
        const auto x = cut.resting != nullptr ? cut.resting->edge.end_point_inside(triangle)
                                              : surface_.end_point_inside(triangle);
        if (x) half.pierced = half.pierced ? std::nullopt : x;
    }
    return half;
}

/// Follows the division of a face of a cell by the edges of a path, for another cut. A node of it
/// at an end of the path waits on one side of it. Where the cut goes on from a node that waits on
/// one side to its blade on the other, it crosses the path: it gets a node there, which is added to
/// the path.
/// @param is_one_of_many  the face has more than two parts: of those that the path divides, the
///                        one on its left is settled, as all before it
void LoopSplitter::let_pass(const Cut& cut, CellId e, std::vector<VertexId>& path,
                            bool is_one_of_many) {
    if (cut.front.is_empty() && cut.resting != nullptr) return;
    const Dart along = find_dart(mesh_, e, path[0], path[1]);
    if (!along.is_valid() || cut.front.is_marked(path[0], path[1])) return;
    const FaceId faces[] = {along.face, opposite(mesh_, along).face};
    for (const VertexId end : {path.front(), path.back()}) {
        if (!cut.front.waits(mesh_, faces[0], end) || !cut.front.waits(mesh_, faces[1], end))
            continue;
        const Half half = half_of(cut, faces[0]);
        const bool is_here = half.is_settled();
        cut.front.set_idle(LoopFront::corner(mesh_, faces[is_here ? 1 : 0], end));
    }
    const Half halves[] = {half_of(cut, faces[0]), half_of(cut, faces[1])};
    if (halves[0].is_settled() || (halves[1].is_settled() && !is_one_of_many)) return;
    std::size_t at = 0;
    double place = 0.5;
    if (cut.resting == nullptr) {
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const Edge edge = edge_between(path[i], path[i + 1]);
            EdgeIntersections later =
                intersections_of(surface_, point(edge.a), point(edge.b), nearness);
            if (!is_swept_ && !later.empty()) {
                at = i;
                place = edge.a == path[i] ? later.front().place : 1.0 - later.front().place;
            }
            std::erase_if(later, [&](const EdgeIntersection& x) { return x.time <= time_; });
            if (!is_swept_ || later.size() % 2 == 0) continue;
            receive(edge, std::move(later));
            return;
        }
    }
    for (const std::size_t k : {0u, 1u}) {
        const Half &start = halves[k], &end = halves[1 - k];
        if (start.waiting.size() % 2 == 0 || start.pierced || !end.pierced) continue;
        // The edge that lies best between the node and the blade.
        const Vec3 across = start.normal.cross(*end.pierced - now(cut, start.waiting.front()));
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const double from = across.dot(now(cut, path[i]) - *end.pierced),
                         to = across.dot(now(cut, path[i + 1]) - *end.pierced);
            const double share = from == to ? 0.5 : from / (from - to);
            if (std::abs(share - 0.5) >= least) continue;
            least = std::abs(share - 0.5);
            at = i;
            place = share;
        }
        break;
    }
    const double length = rest_length(path[at], path[at + 1]);
    const VertexId middle =
        divide_edge(path[at], path[at + 1], std::clamp(place, least_place, 1.0 - least_place));
    path.insert(path.begin() + static_cast<std::ptrdiff_t>(at) + 1, middle);
    cut.front.put_on(middle, length);
    if (cut.resting != nullptr || is_swept_)
        join_at(cut.front, middle);
    else
        made_.push_back(middle);
}

/// Divides a face, which lies on a cut, by a node in its middle.
void LoopSplitter::divide_at_centre(FaceId f) {
    const FaceId other = mesh_.neighbor(f);
    const int size = mesh_.face_size(f);
    std::vector<std::pair<VertexId, double>> sources;
    std::vector<LoopFront::Corner> corners;
    for (int p = 0; p < size; ++p) {
        sources.emplace_back(mesh_.face_corner(f, p), 1.0 / size);
        corners.push_back(LoopFront::corner(mesh_, f, sources.back().first));
    }
    std::vector<LoopFront*> on_cuts;
    for_cuts(nullptr, [&](const Cut& cut) {
        if (cut.front.is_cut_face(mesh_, f)) on_cuts.push_back(&cut.front);
    });
    std::vector<const LoopFront*> unsettled;
    for_cuts(nullptr, [&](const Cut& cut) {
        if (!half_of(cut, f).is_settled()) unsettled.push_back(&cut.front);
    });
    const VertexId centre = edit_->divide_face_at_centre(f);
    place_new_node(centre, sources);
    divided_.push_back(f.cell);
    if (other.is_valid()) divided_.push_back(other.cell);
    for (const LoopFront::Corner& corner : corners) {
        for_cuts(nullptr, [&](const Cut& cut) { cut.front.divide(corner, centre); });
        for (LoopFront* front : on_cuts) front->mark(corner.node, centre);
    }
    for (const LoopFront::Corner& corner : corners) {
        std::vector<VertexId> path{corner.node, centre};
        for_cuts(nullptr, [&](const Cut& cut) {
            if (std::ranges::find(unsettled, &cut.front) == unsettled.end())
                let_pass(cut, f.cell, path, true);
        });
    }
}

/// Divides the faces on cuts into triangles. They are plane then, and later cuts do not change the
/// volumes on their two sides.
void LoopSplitter::triangulate_all() {
    time_ = 1.0;
    std::ranges::sort(divided_);
    divided_.erase(std::unique(divided_.begin(), divided_.end()), divided_.end());
    const auto is_done = [&](FaceId f) {
        if (mesh_.face_size(f) == 3 || !mesh_.neighbor(f).is_valid()) return true;
        bool is_cut = false;
        for_cuts(nullptr, [&](const Cut& cut) { is_cut |= cut.front.is_cut_face(mesh_, f); });
        return !is_cut;
    };
    for (std::size_t i = 0; i < divided_.size(); ++i) {  // more are added
        const CellId e = divided_[i];
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            while (!is_done({e, f})) {
                if (const auto ends = next_ear(mesh_, {e, f})) {
                    std::vector<VertexId> path = divide_face({e, f}, ends->first, ends->second);
                    for_cuts(nullptr, [&](const Cut& cut) { let_pass(cut, e, path); });
                } else if (mesh_.face_size({e, f}) <= topology::max_corners) {
                    divide_at_centre({e, f});
                } else {
                    break;
                }
            }
    }
}

/// Opens the faces on this cut and on the suspended cuts.
void LoopSplitter::open_faces() {
    std::ranges::sort(divided_);
    divided_.erase(std::unique(divided_.begin(), divided_.end()), divided_.end());
    for (const CellId e : divided_)
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f};
            if (!mesh_.neighbor(face).is_valid()) continue;
            bool is_cut = false;
            for_cuts(nullptr,
                     [&](const Cut& cut) { is_cut |= cut.front.is_cut_face(mesh_, face); });
            if (!is_cut) continue;
            report_.cut_area += topology::rest_area(mesh_, face);
            ++report_.faces_opened;
            edit_->open(face);
        }
}

}  // namespace

Split split_cells(Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
                  LoopFront& front, const SplitOptions& /*options*/,
                  std::span<SuspendedLoops> resting) {
    return LoopSplitter(mesh, tissue, surface, front, resting).run();
}

}  // namespace incise::cutting
