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

Cutter::Cutter(const Mesh& mesh, std::span<const Vec3> positions)
    : boxes_(mesh, positions), before_(mesh, positions), now_(mesh, positions) {}

void Cutter::follow_motion(const Mesh& mesh, std::span<const Vec3> positions) {
    std::swap(before_, now_);
    now_.assign(positions);
    double largest = 0.0;
    for (std::size_t n = 0; n < positions.size(); ++n)
        largest = std::max(largest, (positions[n] - before_.values()[n]).squaredNorm());
    boxes_.move(mesh, positions, std::sqrt(largest));
    for (Cut& cut : cuts_) cut.has_moved = false;
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
            if ((point.position(mesh, positions) - x).norm() <= rounding * box.diagonal().norm())
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

std::vector<SuspendedCut> Cutter::suspended_cuts(std::optional<std::size_t> worker) {
    std::vector<SuspendedCut> resting;
    for (std::size_t i = 0; i < cuts_.size(); ++i)
        if (Cut& cut = cuts_[i]; i != worker && !cut.front.is_empty())
            resting.push_back({cut.front, {cut.edge, cut.edge}, cut.has_moved});
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
    if (!cut.front.is_empty() || tissue.may_meet(box_round(edge_before, edge_after))) {
        auto resting = suspended_cuts(id.index);
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
    auto resting = suspended_cuts(id.index);
    TissueMotion tissue = motion(mesh);
    tissue.before = tissue.after;  // it rests
    return noted(
        finish(mesh, fragments, tissue, blade, cut.front, {cut.snap}, snap_history_, resting),
        id.index);
}

Split Cutter::split(Mesh& mesh, const CutSurface& surface, double snap) {
    CutFront front;
    auto resting = suspended_cuts(std::nullopt);
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
        if (i != own.cut) cuts_[i].front.apply(mesh, changes);
    boxes_.apply(mesh, changes);
}

std::vector<FaceId> Cutter::contradictory_faces(CutId id, const Mesh& mesh) const {
    const Cut& cut = cut_of(id);
    std::vector<FaceId> found;
    if (cut.front.is_empty()) return found;
    const SweptEdge edge(cut.edge, cut.edge);
    for (const CellId e : mesh.elements())
        for (int k = 0; k < traits(mesh.kind(e)).num_faces; ++k) {
            const FaceId face{e, k};
            if (mesh.face_size(face) != 3) continue;
            std::array<MovingPoint, 3> triangle;
            bool is_odd = false;
            for (int p = 0; p < 3; ++p) {
                const VertexId n = mesh.face_corner(face, p);
                triangle[static_cast<std::size_t>(p)] = {now_[n], now_[n]};
                is_odd ^= cut.front.is_crossed(n, mesh.face_corner(face, (p + 1) % 3));
            }
            if (is_odd != edge.ends_inside(triangle)) found.push_back(face);
        }
    return found;
}

bool Cutter::is_on(const Mesh& mesh) const {
    return boxes_.cover(mesh) && now_.values().size() == mesh.node_capacity() &&
           std::ranges::all_of(cuts_, [&](const Cut& cut) { return cut.front.is_on(mesh); });
}

}  // namespace incise::cutting
