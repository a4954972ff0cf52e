// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "incise/base/error.h"
#include "incise/cutting/exact/cut_plan.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/cutting/tools/separator.h"

namespace incise::cutting {

using topology::ChangeSet;
using topology::Mesh;

static_assert(topology::Follower<Cutter>);

namespace {

/// Carries out a plan. Faces of removed elements do not count as opened.
Split carry_out(const CutPlan& plan, Mesh& mesh) {
    if (plan.is_empty()) return {};
    Split done{execute(plan, mesh), {}};
    for (const topology::FacePair& pair : done.changes.faces_opened) {
        if (!mesh.is_alive(pair.a.cell) || !mesh.is_alive(pair.b.cell)) continue;
        ++done.report.faces_opened;
        done.report.cut_area += topology::rest_area(mesh, pair.a);
    }
    return done;
}

Box box_round(const std::vector<Vec3>& edge_before, const std::vector<Vec3>& edge_after) {
    Box box;
    for (const Vec3& x : edge_before) box.extend(x);
    for (const Vec3& x : edge_after) box.extend(x);
    return box;
}

}  // namespace

Cutter::Cutter(const Mesh& mesh, std::span<const Vec3> positions, bool has_loops)
    : boxes_(mesh, positions),
      before_(mesh, positions),
      now_(mesh, positions),
      has_loops_(has_loops || std::ranges::any_of(mesh.elements(), [&](CellId e) {
                     return mesh.kind(e) != topology::CellKind::tetrahedron;
                 })) {
    constexpr double share_of_cell = 1e-7;
    double volume = 0.0;
    for (const CellId e : mesh.elements()) volume += topology::rest_volume(mesh, e);
    if (mesh.num_elements() > 0)
        shift_ = share_of_cell * std::cbrt(volume / static_cast<double>(mesh.num_elements()));
}

void Cutter::follow_motion(const Mesh& mesh, std::span<const Vec3> positions) {
    std::swap(before_, now_);
    now_.assign(positions);
    for (auto& [n, opened] : opened_) move_inside(n, opened, positions);
    double largest = 0.0;
    for (std::size_t n = 0; n < positions.size(); ++n)
        largest = std::max(largest, (now_.values()[n] - before_.values()[n]).squaredNorm());
    boxes_.move(mesh, now_.values(), std::sqrt(largest));
    for (Cut& cut : cuts_) cut.has_moved = false;
}

/// Moves a node of opened faces into the body by its margin.
void Cutter::move_inside(VertexId n, OpenedNode& opened, std::span<const Vec3> positions) {
    opened.is_moved = true;
    const Vec3& x = positions[n.index()];
    Vec3 outwards = Vec3::Zero();
    for (const auto& [previous, next] : opened.around)
        outwards += (positions[next.index()] - x).cross(positions[previous.index()] - x);
    if (const double norm = outwards.norm(); norm > 0.0) now_[n] -= opened.margin / norm * outwards;
}

std::optional<topology::CellPoint> Cutter::tissue_at(const Mesh& mesh,
                                                     std::span<const Vec3> positions, const Vec3& x,
                                                     double moved) {
    boxes_.refresh(mesh, positions);
    const Box near(x - Vec3::Constant(moved), x + Vec3::Constant(moved));
    std::optional<topology::CellPoint> found;
    boxes_.for_each_near(
        mesh, [&](const Box& box) { return box.intersects(near); },
        [&](CellId e) {
            if (found) return;
            Box box;
            for (const VertexId n : mesh.corners(e)) box.extend(positions[n.index()]);
            if (!box.contains(x)) return;
            constexpr double rounding = 1e-9;  // of the size of the element
            const topology::CellPoint point = topology::point_near(mesh, e, positions, x);
            if ((point.position(positions) - x).norm() <= rounding * box.diagonal().norm())
                found = point;
        });
    return found;
}

CutId Cutter::begin_cut(double snap) {
    const auto unused = std::ranges::find(cuts_, false, &Cut::is_in_use);
    const CutId id{static_cast<std::size_t>(unused - cuts_.begin())};
    if (unused == cuts_.end()) cuts_.emplace_back();
    cuts_[id.index].is_in_use = true;
    cuts_[id.index].snap = snap;
    return id;
}

const Cutter::Cut& Cutter::cut_of(CutId id) const {
    if (!has_cut(id))
        throw InputError("there is no cut " + std::to_string(id.index) + " in progress");
    return cuts_[id.index];
}

Cutter::Cut& Cutter::cut_of(CutId id) { return const_cast<Cut&>(std::as_const(*this).cut_of(id)); }

/// Returns the edge of the blade of a cut a little to one side. A blade often stops exactly on
/// nodes, edges and faces of a mesh, where rounding would decide what it has crossed: nodes that a
/// cut has made lie off their edges by rounding. The directions have no simple ratios to those of a
/// mesh. Each cut has its own, as blades also stop exactly in each other's planes.
std::vector<Vec3> Cutter::shifted(std::size_t cut, std::vector<Vec3> edge) const {
    if (!has_loops_) return edge;
    // Shares of 1 that never come close to each other as the number of the cut grows.
    const Vec3 ratio(0.819172513, 0.671043607, 0.549700478);
    Vec3 direction;
    for (int c = 0; c < 3; ++c) {
        double whole = 0.0;
        direction[c] = 0.5 + 0.5 * std::modf(static_cast<double>(cut + 1) * ratio[c], &whole);
    }
    for (Vec3& x : edge) x += shift_ * direction;
    return edge;
}

template <class Front>
std::vector<SuspendedCutOf<Front>> Cutter::suspended_cuts(std::optional<std::size_t> worker,
                                                          Front Cut::*front) {
    std::vector<SuspendedCutOf<Front>> resting;
    for (std::size_t i = 0; i < cuts_.size(); ++i)
        if (Cut& cut = cuts_[i]; i != worker && !(cut.*front).is_empty())
            resting.push_back(
                {cut.*front, {shifted(i, cut.edge), shifted(i, cut.edge)}, cut.has_moved});
    return resting;
}

Split Cutter::noted(Split done, std::optional<std::size_t> worker) {
    if (!done.changes.is_empty())
        own_edit_ = {done.changes.epoch_after, worker, done.report.elements_crossed > 0};
    return done;
}

Split Cutter::split(CutId id, Mesh& mesh, const std::vector<Vec3>& edge_before,
                    const std::vector<Vec3>& edge_after) {
    Cut& cut = cut_of(id);
    const TissueMotion tissue = motion(mesh);
    Split done;
    if (has_loops_) {
        if (tissue.may_meet(box_round(edge_before, edge_after))) {
            auto resting = suspended_cuts(id.index, &Cut::loops);
            done = noted(split_cells(mesh, tissue,
                                     SweptEdge(shifted(id.index, edge_before),
                                               shifted(id.index, edge_after)),
                                     cut.loops, resting),
                         id.index);
        }
    } else if (!cut.front.is_empty() || tissue.may_meet(box_round(edge_before, edge_after))) {
        auto resting = suspended_cuts(id.index, &Cut::front);
        done = noted(cutting::split(mesh, tissue, SweptEdge(edge_before, edge_after), cut.front,
                                    {cut.snap}, snap_history_, resting),
                     id.index);
    }
    cut.edge = edge_after;
    cut.has_moved = true;
    return done;
}

Split Cutter::end_cut(CutId id, Mesh& mesh, const fragments::FragmentMesh& fragments,
                      const BladeEnd& blade) {
    Cut& cut = cut_of(id);
    if (has_loops_) {
        cut.loops = {};
        return {};
    }
    auto resting = suspended_cuts(id.index, &Cut::front);
    TissueMotion tissue = motion(mesh);
    tissue.before = tissue.after;  // it rests
    return noted(
        finish(mesh, fragments, tissue, blade, cut.front, {cut.snap}, snap_history_, resting),
        id.index);
}

Split Cutter::split(Mesh& mesh, const CutSurface& surface, double snap) {
    if (has_loops_) {
        LoopFront front;
        auto resting = suspended_cuts(std::nullopt, &Cut::loops);
        const bool has_new =
            std::ranges::any_of(opened_, [](const auto& entry) { return !entry.second.is_moved; });
        if (has_new && resting.empty()) {  // a blade at work has to see nodes move, not jump
            const std::vector<Vec3> positions(now_.values().begin(), now_.values().end());
            double largest = 0.0;
            for (auto& [n, opened] : opened_) {
                if (opened.is_moved) continue;
                move_inside(n, opened, positions);
                largest = std::max(largest, opened.margin);
            }
            boxes_.move(mesh, now_.values(), largest);
        }
        return noted(split_cells(mesh, motion(mesh), surface, front, resting), std::nullopt);
    }
    CutFront front;
    auto resting = suspended_cuts(std::nullopt, &Cut::front);
    return noted(cutting::split(mesh, motion(mesh), surface, front, {snap}, snap_history_, resting),
                 std::nullopt);
}

Split Cutter::separate(Mesh& mesh, const std::vector<Vec3>& edge_before,
                       const std::vector<Vec3>& edge_after) {
    const TissueMotion tissue = motion(mesh);
    if (!tissue.may_meet(box_round(edge_before, edge_after))) return {};
    return noted(carry_out({{}, faces_to_open(tissue, edge_before, edge_after)}, mesh),
                 std::nullopt);
}

Split Cutter::carve(Mesh& mesh, const CarverShape& shape, const Pose& pose_before,
                    const Pose& pose_after) {
    const auto covered = covered_elements(motion(mesh), shape, pose_before, pose_after);
    return noted(carry_out({covered, {}}, mesh), std::nullopt);
}

void Cutter::apply(const Mesh& mesh, const ChangeSet& changes) {
    if (changes.is_empty()) return;
    const OwnEdit own = changes.epoch_after == own_edit_.epoch ? own_edit_ : OwnEdit{};
    before_.apply(mesh, changes);  // throws, before any change, for an edit out of turn
    now_.apply(mesh, changes);
    own_edit_ = {};
    if (!own.history_followed) snap_history_.apply(mesh, changes);
    for (std::size_t i = 0; i < cuts_.size(); ++i)
        if (i != own.cut) {
            cuts_[i].front.apply(mesh, changes);
            cuts_[i].loops.apply(mesh, changes);
        }
    boxes_.apply(mesh, changes);
    if (has_loops_) find_opened(mesh, changes);
}

/// Finds the opened faces at each node that an edit has touched.
void Cutter::find_opened(const Mesh& mesh, const ChangeSet& changes) {
    for (const topology::VertexRecord& record : changes.nodes_removed) opened_.erase(record.id);
    std::vector<VertexId> touched;
    for (const CellId e : topology::touched_cells(changes))
        if (e.index() < mesh.element_capacity() && mesh.is_alive(e))
            std::ranges::copy(mesh.corners(e), std::back_inserter(touched));
    std::ranges::sort(touched);
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    std::vector<CellId> star;
    for (const VertexId n : touched) {
        OpenedNode opened;
        if (const auto before = opened_.find(n); before != opened_.end()) {
            opened.is_moved = before->second.is_moved;
            opened_.erase(before);
        }
        mesh.star(n, star);
        const Vec3& x = mesh.rest_position(n);
        Vec3 outwards = Vec3::Zero();
        double area = 0.0, longest = 0.0;
        for (const CellId e : star) {
            const bool is_whole = mesh.whole_cell(e).has_value();
            for (int f = 0; f < mesh.num_faces(e); ++f) {
                const FaceId face{e, f};
                const int size = mesh.face_size(face);
                for (int p = 0; p < size; ++p) {
                    const VertexId at = mesh.face_corner(face, p);
                    longest = std::max(longest, (mesh.rest_position(at) - x).norm());
                    // Faces of whole cells were opened whole, or lie beside what was removed.
                    if (at != n || is_whole || !mesh.is_on_cut(face)) continue;
                    const VertexId previous = mesh.face_corner(face, (p + size - 1) % size),
                                   next = mesh.face_corner(face, (p + 1) % size);
                    const Vec3 normal =
                        (mesh.rest_position(next) - x).cross(mesh.rest_position(previous) - x);
                    outwards += normal;
                    area += normal.norm();
                    opened.around.emplace_back(previous, next);
                }
            }
        }
        // At the end of a cut, both of its sides meet.
        constexpr double least_share = 0.1;
        if (!(outwards.norm() > least_share * area)) continue;
        opened.margin = default_snap * longest;
        opened_[n] = std::move(opened);
    }
}

std::vector<FaceId> Cutter::contradictory_faces(CutId id, const Mesh& mesh) const {
    const Cut& cut = cut_of(id);
    std::vector<FaceId> found;
    if (cut.front.is_empty() && cut.loops.is_empty()) return found;
    const SweptEdge edge(shifted(id.index, cut.edge), shifted(id.index, cut.edge));
    const auto at = [&](VertexId n) { return MovingPoint{now_[n], now_[n]}; };
    for (const CellId e : mesh.elements())
        for (int k = 0; k < mesh.num_faces(e); ++k) {
            const FaceId face{e, k};
            const int size = mesh.face_size(face);
            if (has_loops_ ? cut.loops.is_cut_face(mesh, face) : size != 3) continue;
            bool is_odd = false, is_pierced = false;
            for (int p = 0; p < size; ++p) {
                const VertexId n = mesh.face_corner(face, p),
                               next = mesh.face_corner(face, (p + 1) % size);
                is_odd ^= cut.front.is_crossed(n, next) || cut.loops.passed_at(n, next).is_valid();
                is_odd ^= cut.loops.waits(mesh, face, n);
                if (p > 1)
                    is_pierced ^= edge.ends_inside({at(mesh.face_corner(face, 0)),
                                                    at(mesh.face_corner(face, p - 1)), at(n)})
                                      .value_or(false);
            }
            if (is_odd != is_pierced) found.push_back(face);
        }
    return found;
}

bool Cutter::is_on(const Mesh& mesh) const {
    const auto is_there = [&](VertexId n) { return n.index() < mesh.node_capacity(); };
    return boxes_.cover(mesh) && now_.values().size() == mesh.node_capacity() &&
           std::ranges::all_of(
               cuts_,
               [&](const Cut& cut) { return cut.front.is_on(mesh) && cut.loops.is_on(mesh); }) &&
           std::ranges::all_of(opened_, [&](const auto& entry) {
               return is_there(entry.first) &&
                      std::ranges::all_of(entry.second.around, [&](const auto& neighbours) {
                          return is_there(neighbours.first) && is_there(neighbours.second);
                      });
           });
}

}  // namespace incise::cutting
