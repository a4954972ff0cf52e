// What other cuts that are not finished make of new edges and faces.
// Source: docs/cutting.md, Cells of any shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "incise/cutting/exact/loop_step.h"
#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::Dart;

/// Decides which nodes wait in a face that a cut has put into a cell. In each of the two new cells
/// such a node then has an even number of open edges and of faces in which it waits.
void LoopStep::make_wait_in(LoopFront& front, FaceId f, std::span<const VertexId> path) {
    for (const VertexId n : path) {
        if (!front.is_on(n)) continue;
        std::size_t count = 0;
        for (int k = 0; k < mesh_.num_faces(f.cell); ++k)
            if (k != f.face && front.waits({f.cell, k}, n)) ++count;
        for (const Edge& edge : front.open_edges(f.cell))
            if (edge.a == n || edge.b == n) ++count;
        front.set_waiting(mesh_, f, n, count % 2 == 1);
    }
}

/// Where a cut has divided a face by the edges of a path, lets it pass the path at one of its ends
/// if it is to cross the path again: its nodes do not lie exactly where the blade has been.
void LoopStep::cross_again(LoopFront& front, CellId e, std::span<const VertexId> path) {
    const Dart along = find_dart(mesh_, e, path[0], path[1]);
    const FaceId parts[] = {along.face, opposite(mesh_, along).face};
    for_cuts(nullptr, [&](const Cut& cut) {
        if (&cut.front != &front) return;
        const Half halves[] = {half_of(cut, parts[0]), half_of(cut, parts[1])};
        if (halves[0].is_settled() || halves[1].is_settled()) return;
        const auto x = halves[0].pierced ? halves[0].pierced : halves[1].pierced;
        const auto distance = [&](VertexId n) { return x ? (now(cut, n) - *x).norm() : 0.0; };
        const VertexId n =
            distance(path.back()) < distance(path.front()) ? path.back() : path.front();
        if (cut.resting == nullptr && !is_swept_)
            for (const FaceId part : parts)
                front.set_waiting(mesh_, part, n, !front.waits(part, n));
        else
            front.toggle_passed({n, n == path.front() ? path[1] : path[path.size() - 2]});
    });
}

/// Returns where a node is when the blade of the cut is where it is, m.
Vec3 LoopStep::now(const Cut& cut, VertexId n) const {
    return point(n)[cut.resting == nullptr || cut.resting->has_moved ? 1 : 0];
}

LoopStep::Half LoopStep::half_of(const Cut& cut, FaceId f) const {
    Half half{{}, false, std::nullopt, Vec3::Zero()};
    const int size = mesh_.face_size(f);
    const auto at = [&](int p) { return now(cut, mesh_.face_corner(f, p)); };
    for (int p = 0; p < size; ++p) {
        const VertexId n = mesh_.face_corner(f, p), next = mesh_.face_corner(f, (p + 1) % size);
        if (cut.front.waits(f, n)) {
            half.waiting.push_back(n);
            half.is_odd = !half.is_odd;
        }
        if (cut.front.passed_at(n, next).is_valid()) half.is_odd = !half.is_odd;
        if (cut.resting == nullptr)
            if (const auto it = pending_.find(edge_between(n, next)); it != pending_.end())
                half.is_odd ^= it->second.size() % 2 == 1;
        if (p < 2) continue;
        half.normal += (at(p - 1) - at(0)).cross(at(p) - at(0));
        std::array<MovingPoint, 3> triangle;
        for (std::size_t k = 0; k < 3; ++k)
            triangle[k][0] = triangle[k][1] = at(k == 0 ? 0 : p - 2 + static_cast<int>(k));
        const auto x = cut.resting != nullptr ? cut.resting->edge.end_point_inside(triangle)
                                              : surface_.end_point_inside(triangle);
        if (x) half.pierced = half.pierced ? std::nullopt : x;
    }
    return half;
}

/// Takes up what the moving cut crosses of new edges later in this step. Returns false if it
/// crosses none of them an odd number of times.
bool LoopStep::receive_later(std::span<const VertexId> path) {
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const Edge edge = edge_between(path[i], path[i + 1]);
        EdgeIntersections later =
            intersections_of(surface_, point(edge.a), point(edge.b), nearness);
        std::erase_if(later, [&](const EdgeIntersection& x) { return x.time <= time_; });
        if (later.size() % 2 == 0) continue;
        receive(edge, std::move(later));
        return true;
    }
    return false;
}

/// Returns which edge of a path a cut crosses, and at which share of it: on the straight way from
/// the node that waits to the blade, or where its surface is.
std::pair<std::size_t, double> LoopStep::passing_place(const Cut& cut,
                                                       std::span<const VertexId> path,
                                                       std::span<const Half, 2> halves) const {
    for (const std::size_t k : {0u, 1u}) {
        const Half &start = halves[k], &end = halves[1 - k];
        if (start.waiting.size() % 2 == 0 || start.pierced || !end.pierced) continue;
        const Vec3 across = start.normal.cross(*end.pierced - now(cut, start.waiting.front()));
        std::pair<std::size_t, double> best{0, 0.5};
        double least = std::numeric_limits<double>::infinity();  // from the middle of an edge
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const double from = across.dot(now(cut, path[i]) - *end.pierced),
                         to = across.dot(now(cut, path[i + 1]) - *end.pierced);
            const double share = from == to ? 0.5 : from / (from - to);
            if (std::abs(share - 0.5) >= least) continue;
            least = std::abs(share - 0.5);
            best = {i, share};
        }
        return best;
    }
    if (cut.resting == nullptr && !is_swept_)
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const Edge edge = edge_between(path[i], path[i + 1]);
            const auto found = intersections_of(surface_, point(edge.a), point(edge.b), nearness);
            if (found.empty()) continue;
            const double share = found.front().place;
            return {i, edge.a == path[i] ? share : 1.0 - share};
        }
    return {0, 0.5};
}

/// Follows the division of a face of a cell by the edges of a path, for another cut. A node of it
/// at an end of the path waits on one side of it. Where the cut goes on from a node that waits on
/// one side to its blade on the other, it crosses the path: it gets a node there, which is added to
/// the path.
/// @param is_one_of_many  the face has more than two parts: of those that the path divides, the
///                        one on its left is settled, as all before it
void LoopStep::let_pass(const Cut& cut, CellId e, std::vector<VertexId>& path, Passed& passed,
                        bool is_one_of_many) {
    if (cut.front.is_empty() && cut.resting != nullptr) return;
    const Dart along = find_dart(mesh_, e, path[0], path[1]);
    if (!along.is_valid() || cut.front.lies_on(path[0], path[1])) return;
    const FaceId faces[] = {along.face, opposite(mesh_, along).face};
    for (const VertexId end : {path.front(), path.back()}) {
        if (!cut.front.waits(faces[0], end) || !cut.front.waits(faces[1], end)) continue;
        const Half half = half_of(cut, faces[0]);
        const bool is_here = half.is_settled();
        cut.front.set_waiting(mesh_, faces[is_here ? 1 : 0], end, false);
    }
    const Half halves[] = {half_of(cut, faces[0]), half_of(cut, faces[1])};
    if (halves[0].is_settled() || (halves[1].is_settled() && !is_one_of_many)) return;
    if (passes_left_ == 0) return;
    --passes_left_;
    if (cut.resting == nullptr && is_swept_ && receive_later(path)) return;
    const auto [at, place] = passing_place(cut, path, halves);
    const double length = rest_length(path[at], path[at + 1]);
    const VertexId middle =
        divide_edge(path[at], path[at + 1], std::clamp(place, least_place_, 1.0 - least_place_));
    path.insert(path.begin() + static_cast<std::ptrdiff_t>(at) + 1, middle);
    wait_at(cut.front, middle, length);
    passed.push_back({cut, middle});
}

/// Lets all cuts, or all but that of a front, pass a path. They join their nodes there once each of
/// them has passed: what a cut does depends on where the others wait.
void LoopStep::let_all_pass(const LoopFront* but, CellId e, std::vector<VertexId>& path) {
    Passed passed;
    for_cuts(but, [&](const Cut& cut) { let_pass(cut, e, path, passed); });
    join(passed);
}

/// Joins the nodes that cuts have got where they pass a path.
void LoopStep::join(const Passed& passed) {
    for (const auto& [cut, n] : passed)
        if (cut.resting != nullptr || is_swept_)
            join_at(cut.front, n);
        else
            made_.push_back(n);
}

}  // namespace incise::cutting
