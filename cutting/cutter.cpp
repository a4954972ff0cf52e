// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "incise/base/error.h"
#include "incise/cutting/exact/cut_plan.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/cutting/tools/separator.h"
#include "incise/topology/geometry.h"

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

/// Puts some nodes elsewhere, until the end of its life.
class Displacement {
  public:
    /// @param places  where they are to be, m
    Displacement(topology::NodeField<VertexId, Vec3>& x,
                 std::vector<std::pair<VertexId, Vec3>> places)
        : x_(x), places_(std::move(places)) {
        for (const auto& [n, place] : places_)
            farthest_ = std::max(farthest_, (place - x[n]).norm());
        exchange();
    }
    ~Displacement() { exchange(); }
    Displacement(const Displacement&) = delete;
    Displacement& operator=(const Displacement&) = delete;
    /// Returns how far they are from their own places at most, m.
    double farthest() const { return farthest_; }

  private:
    void exchange() {
        for (auto& [n, place] : places_) std::swap(place, x_[n]);
    }

    topology::NodeField<VertexId, Vec3>& x_;
    std::vector<std::pair<VertexId, Vec3>> places_;
    double farthest_ = 0.0;
};

/// Returns the volume of a cell at rest, m3, with all its quadrilaterals whole, as it is in a
/// carrier.
double volume_without_diagonals(const Mesh& mesh, const topology::WholeCell& cell) {
    std::vector<Vec3> x;
    for (const VertexId n : cell.corners()) x.push_back(mesh.rest_position(n));
    return topology::signed_volume(cell.kind, x);
}

/// Returns the mean volume of the carriers at rest, m3, of which cells are left. It is the same, to
/// the bit, for a body that was cut and read from a file: that has the carriers in the same order.
double mean_carrier_volume(const Mesh& mesh) {
    const topology::Carriers& carriers = mesh.source_carriers();
    std::vector<bool> is_counted(carriers.corners.size(), false);
    double volume = 0.0;
    std::size_t count = 0;
    for (const CellId e : mesh.elements()) {
        const std::int64_t row = e.index() < carriers.of_cell.size() ? carriers.of_cell[e.index()]
                                                                     : topology::Carriers::whole;
        if (row == topology::Carriers::whole) {
            const auto cell = mesh.whole_cell(e);
            volume += cell ? volume_without_diagonals(mesh, *cell) : topology::rest_volume(mesh, e);
        } else {
            const auto i = static_cast<std::size_t>(row);
            if (is_counted[i]) continue;
            is_counted[i] = true;
            volume += topology::signed_volume(carriers.corners[i].kind(), carriers.corners[i]);
        }
        ++count;
    }
    return count == 0 ? 0.0 : volume / static_cast<double>(count);
}

}  // namespace

Cutter::Cutter(const Mesh& mesh, std::span<const Vec3> positions, bool has_loops)
    : boxes_(mesh, positions),
      before_(mesh, positions),
      now_(mesh, positions),
      has_loops_(has_loops ||
                 std::ranges::any_of(
                     mesh.elements(),
                     [&](CellId e) { return mesh.kind(e) != topology::CellKind::tetrahedron; })),
      num_followed_(positions.size()) {
    constexpr double share_of_carrier = 1e-7;
    const double size = std::cbrt(mean_carrier_volume(mesh));
    shift_ = share_of_carrier * size;
    if (has_loops_) opened_.find_all(mesh, size);
}

bool Cutter::has_cut_in_progress() const {
    return std::ranges::any_of(cuts_, [](const Cut& cut) { return !cut.loops.is_empty(); });
}

void Cutter::settle(const Mesh& mesh) {
    if (!has_cut_in_progress()) opened_.settle(mesh, std::numeric_limits<std::size_t>::max());
}

/// True if the tissue is not where it was after the last motion.
/// @param num_known  the number of nodes that it had
/// @pre  `now_` has the nodes where they are, `before_` where they counted as lying
bool Cutter::is_other_than_before(std::size_t num_known) const {
    constexpr double rounding = 1e-9;  // of the size of cells
    const double least = rounding * opened_.usual();
    for (std::size_t i = 0; i < num_known; ++i) {
        const Vec3 way = now_.values()[i] - before_.values()[i];
        if (way.squaredNorm() <= least * least) continue;
        const auto offset = opened_.offset_of(VertexId(i));
        if (offset && (way + *offset).squaredNorm() > least * least) return true;
    }
    return false;
}

void Cutter::follow_motion(const Mesh& mesh, std::span<const Vec3> positions) {
    std::swap(before_, now_);
    const std::size_t num_known = std::min(num_followed_, positions.size());
    num_followed_ = positions.size();
    now_.assign(positions);
    has_moved_ = is_other_than_before(num_known);
    constexpr std::size_t most_at_a_time = 500;  // a step takes no longer than one that cuts
    if (!has_cut_in_progress()) opened_.settle(mesh, most_at_a_time);
    opened_.move_all(positions, now_);
    double largest = 0.0;
    for (std::size_t n = 0; n < positions.size(); ++n)
        largest = std::max(largest, (now_.values()[n] - before_.values()[n]).squaredNorm());
    boxes_.move(mesh, now_.values(), std::sqrt(largest));
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

/// Returns by how much the edge of the blade of a cut is taken to be to one side, m. A blade often
/// stops exactly on nodes, edges and faces of a mesh, where rounding would decide what it has
/// crossed: nodes that a cut has made lie off their edges by rounding. The directions have no
/// simple ratios to those of a mesh. Each cut has its own, as blades also stop exactly in each
/// other's planes.
Vec3 Cutter::shift_of(std::size_t cut) const {
    if (!has_loops_) return Vec3::Zero();
    // Shares of 1 that never come close to each other as the number of the cut grows.
    const Vec3 ratio(0.819172513, 0.671043607, 0.549700478);
    Vec3 direction;
    for (int c = 0; c < 3; ++c) {
        double whole = 0.0;
        direction[c] = 0.5 + 0.5 * std::modf(static_cast<double>(cut + 1) * ratio[c], &whole);
    }
    return shift_ * direction;
}

std::vector<Vec3> Cutter::shifted(std::size_t cut, std::vector<Vec3> edge) const {
    if (!has_loops_) return edge;
    const Vec3 shift = shift_of(cut);
    for (Vec3& x : edge) x += shift;
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

/// Returns the cuts that have ended inside the body: their blades are far away.
std::vector<SuspendedLoops> Cutter::unfinished_cuts() {
    const Vec3 far = Vec3::Constant(1e9 * opened_.usual());
    const std::vector<Vec3> edge{far, 1.5 * far};
    std::vector<SuspendedLoops> cuts;
    for (LoopFront& front : unfinished_) cuts.push_back({front, {edge, edge}, false});
    return cuts;
}

/// Returns the tolerance in the present motion of a cut through cells of any shape. In tissue that
/// moves, a cut comes near to the same nodes on one side and then on the other. With a smaller
/// tolerance it would leave thin cells between the nodes and itself, and cut them off later.
double Cutter::tolerance(double snap) const {
    constexpr double largest = 0.1;
    return std::clamp(snap, has_moved_ ? default_snap : least_tolerance, largest);
}

Split Cutter::noted(Split done, std::optional<std::size_t> worker, double snap) {
    if (!done.changes.is_empty())
        own_edit_ = {done.changes.epoch_after, worker, done.report.elements_crossed > 0, false,
                     snap};
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
            auto unfinished = unfinished_cuts();
            const double snap = tolerance(cut.snap);
            done = noted(split_cells(mesh, tissue,
                                     SweptEdge(shifted(id.index, edge_before),
                                               shifted(id.index, edge_after)),
                                     cut.loops, {snap}, resting, {nullptr, unfinished}),
                         id.index, snap);
            std::erase_if(unfinished_, [](const LoopFront& front) { return front.is_empty(); });
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
    TissueMotion tissue = motion(mesh);
    tissue.before = tissue.after;  // it rests, but the blade has come as in the motion
    if (has_loops_) {
        auto resting = suspended_cuts(id.index, &Cut::loops);
        auto unfinished = unfinished_cuts();
        const double snap = tolerance(cut.snap);
        Split done = noted(finish_cells(mesh, fragments, tissue, blade.moved_by(shift_of(id.index)),
                                        cut.loops, {snap}, resting, {nullptr, unfinished}),
                           id.index, snap);
        if (!cut.loops.is_empty()) {
            unfinished_.push_back(std::exchange(cut.loops, {}));
            own_edit_.has_ended = true;
        }
        return done;
    }
    auto resting = suspended_cuts(id.index, &Cut::front);
    return noted(
        finish(mesh, fragments, tissue, blade, cut.front, {cut.snap}, snap_history_, resting),
        id.index);
}

Split Cutter::split(Mesh& mesh, const CutSurface& surface, double snap) {
    if (has_loops_) {
        LoopFront front;
        auto resting = suspended_cuts(std::nullopt, &Cut::loops);
        KnownSurfaces::Seen seen;
        if (resting.empty()) {  // a blade at work has to see nodes move, not jump
            opened_.settle(mesh, std::numeric_limits<std::size_t>::max());
            if (opened_.has_new()) boxes_.move(mesh, now_.values(), opened_.move_new(now_));
            if (const auto number = known_.find(surface, opened_.usual()))
                seen = known_.seen(mesh, surface, *number, now_, opened_.usual());
        }
        auto unfinished = unfinished_cuts();
        Split done;
        {
            const Displacement displacement(now_, std::move(seen.displaced));
            if (displacement.farthest() > 0.0)
                boxes_.move(mesh, now_.values(), displacement.farthest());
            done = split_cells(mesh, motion(mesh), surface, front, {tolerance(snap)}, resting,
                               {&seen.on_surface, unfinished});
        }
        known_.note(mesh, surface, front, done.changes, now_, opened_.usual());
        return noted(std::move(done), std::nullopt, tolerance(snap));
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
    if (has_loops_) {
        opened_.apply(mesh, changes, own.snap);
        known_.apply(changes);
        for (std::size_t i = 0; i + (own.has_ended ? 1 : 0) < unfinished_.size(); ++i)
            unfinished_[i].apply(mesh, changes);
        std::erase_if(unfinished_, [](const LoopFront& cut) { return cut.is_empty(); });
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
            if (has_loops_ ? cut.loops.is_cut_face(face) : size != 3) continue;
            bool is_odd = false, is_pierced = false;
            for (int p = 0; p < size; ++p) {
                const VertexId n = mesh.face_corner(face, p),
                               next = mesh.face_corner(face, (p + 1) % size);
                is_odd ^= cut.front.is_crossed(n, next) || cut.loops.passed_at(n, next).is_valid();
                is_odd ^= cut.loops.waits(face, n);
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
    return boxes_.cover(mesh) && now_.values().size() == mesh.node_capacity() &&
           std::ranges::all_of(
               cuts_,
               [&](const Cut& cut) { return cut.front.is_on(mesh) && cut.loops.is_on(mesh); }) &&
           opened_.is_on(mesh) && known_.is_on(mesh) &&
           std::ranges::all_of(unfinished_, [&](const LoopFront& cut) { return cut.is_on(mesh); });
}

}  // namespace incise::cutting
