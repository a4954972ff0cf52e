// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/cutter.h"

#include <algorithm>
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
        if (!mesh.is_alive(pair.a.element) || !mesh.is_alive(pair.b.element)) continue;
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
    : boxes_(mesh, positions), before_(mesh, positions) {}

void Cutter::begin_motion(std::span<const Vec3> positions) {
    before_.assign(positions);
    for (Cut& cut : cuts_) cut.has_moved = false;
}

void Cutter::end_motion(const Mesh& mesh, std::span<const Vec3> positions, double largest_move) {
    boxes_.move(mesh, positions, largest_move);
}

std::optional<topology::CellPoint> Cutter::tissue_at(const Mesh& mesh,
                                                     std::span<const Vec3> positions, const Vec3& x,
                                                     double moved) {
    boxes_.refresh(mesh, positions);
    const Box near(x - Vec3::Constant(moved), x + Vec3::Constant(moved));
    std::optional<topology::CellPoint> found;
    boxes_.for_each_near(
        mesh, [&](const Box& box) { return box.intersects(near); },
        [&](ElementId e) {
            if (found) return;
            Box box;
            for (const NodeId n : mesh.corners(e)) box.extend(positions[n.index()]);
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

Split Cutter::split(CutId id, Mesh& mesh, std::span<const Vec3> positions,
                    const std::vector<Vec3>& edge_before, const std::vector<Vec3>& edge_after) {
    Cut& cut = cut_of(id);
    const TissueMotion tissue = motion(mesh, positions);
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

Split Cutter::end_cut(CutId id, Mesh& mesh, const topology::FragmentMesh& fragments,
                      std::span<const Vec3> positions, const BladeEnd& blade) {
    Cut& cut = cut_of(id);
    auto resting = suspended_cuts(id.index);
    boxes_.refresh(mesh, positions);
    return noted(finish(mesh, fragments, {mesh, positions, positions, &boxes_}, blade, cut.front,
                        {cut.snap}, snap_history_, resting),
                 id.index);
}

Split Cutter::split(Mesh& mesh, std::span<const Vec3> positions, const CutSurface& surface,
                    double snap) {
    CutFront front;
    auto resting = suspended_cuts(std::nullopt);
    return noted(cutting::split(mesh, motion(mesh, positions), surface, front, {snap},
                                snap_history_, resting),
                 std::nullopt);
}

Split Cutter::separate(Mesh& mesh, std::span<const Vec3> positions,
                       const std::vector<Vec3>& edge_before, const std::vector<Vec3>& edge_after) {
    const TissueMotion tissue = motion(mesh, positions);
    if (!tissue.may_meet(box_round(edge_before, edge_after))) return {};
    return noted(carry_out({{}, faces_to_open(tissue, edge_before, edge_after)}, mesh),
                 std::nullopt);
}

Split Cutter::carve(Mesh& mesh, std::span<const Vec3> positions, const CarverShape& shape,
                    const Pose& pose_before, const Pose& pose_after) {
    const auto covered = covered_elements(motion(mesh, positions), shape, pose_before, pose_after);
    return noted(carry_out({covered, {}}, mesh), std::nullopt);
}

void Cutter::apply(const Mesh& mesh, const ChangeSet& changes) {
    if (changes.is_empty()) return;
    const OwnEdit own = changes.epoch_after == own_edit_.epoch ? own_edit_ : OwnEdit{};
    before_.apply(mesh, changes);  // throws, before any change, for an edit out of turn
    own_edit_ = {};
    if (!own.history_followed) snap_history_.apply(mesh, changes);
    for (std::size_t i = 0; i < cuts_.size(); ++i)
        if (i != own.cut) cuts_[i].front.apply(mesh, changes);
    boxes_.apply(mesh, changes);
}

bool Cutter::is_on(const Mesh& mesh) const {
    return boxes_.cover(mesh) &&
           std::ranges::all_of(cuts_, [&](const Cut& cut) { return cut.front.is_on(mesh); });
}

}  // namespace incise::cutting
