// All cuts of one body: the cuts in progress, and what earlier ones have left.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/exact/splitter.h"
#include "incise/cutting/tools/carver.h"
#include "incise/topology/change_set.h"
#include "incise/topology/field.h"
#include "incise/topology/mesh.h"
#include "incise/topology/spatial/element_boxes.h"

namespace incise::cutting {

/// A cut of a blade, as Cutter::begin_cut() numbers it.
struct CutId {
    std::size_t index = 0;
    bool operator==(const CutId&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.index); }
};

/// Cuts a body. Holds what cuts need to know besides the mesh: boxes for the search of elements,
/// the cuts in progress, and where earlier cuts passed. One cutter belongs to one body.
///
/// Each function that cuts makes one edit of the mesh and returns it. The caller lets everything
/// follow that keeps values of the body, and calls apply() last:
///
///     cutter.begin_motion(positions);                   // where the tissue is
///     ...                                               // the tissue moves
///     cutter.end_motion(mesh, positions, largest_move);
///     const Split done = cutter.split(cut, mesh, positions, edge_before, edge_after);
///     model.apply(mesh, done.changes);
///     cutter.apply(mesh, done.changes);
///
/// Positions are current ones, by node id, m. They are those of before an edit while that edit is
/// made, and have the new nodes when apply() is called.
class Cutter {
  public:
    /// @param uncut  of the body before the first cut; see SplitOptions
    /// Cost: O(n).
    Cutter(const topology::Mesh& mesh, std::span<const Vec3> positions, UncutBody uncut = {});

    /// Keeps the present positions as those from which the tissue moves. Without this call the
    /// tissue counts as moving from where it was at the call before. Cost: O(n).
    void begin_motion(std::span<const Vec3> positions);
    /// The tissue has moved to `positions`, no node by more than `largest_move`, m.
    /// Cost: now and then O(n).
    void end_motion(const topology::Mesh& mesh, std::span<const Vec3> positions,
                    double largest_move);

    /// Begins a cut of a blade, which goes on from call to call of split().
    CutId begin_cut(double snap);
    /// Cuts along what the edge of a blade sweeps in the last motion of the tissue. Returns what
    /// was done, which may be nothing.
    /// Throws InputError for an unknown cut, UndividableElement for an element that is no
    /// tetrahedron; the mesh is then as it was. Cost: see cutting::split.
    Split split(CutId cut, topology::Mesh& mesh, std::span<const Vec3> positions,
                const std::vector<Vec3>& edge_before, const std::vector<Vec3>& edge_after);
    /// True if the cut has divided elements and ends within one of them: end_cut() has work to do.
    bool is_in_tissue(CutId cut) const { return !cut_of(cut).front.is_empty(); }
    /// Ends a cut where its blade is. The tissue is at rest. The cut can begin again.
    /// Throws as split(). Cost: see cutting::finish.
    Split end_cut(CutId cut, topology::Mesh& mesh, std::span<const Vec3> positions,
                  const BladeEnd& blade);
    /// Forgets a cut. Its number may be given to a later one.
    void remove_cut(CutId cut) { cut_of(cut) = {}; }

    /// Cuts along a whole surface at once. Throws as split().
    Split split(topology::Mesh& mesh, std::span<const Vec3> positions, const CutSurface& surface,
                double snap);
    /// Opens the faces that lie nearest to what the edge of a blade sweeps: faces_to_open.
    Split separate(topology::Mesh& mesh, std::span<const Vec3> positions,
                   const std::vector<Vec3>& edge_before, const std::vector<Vec3>& edge_after);
    /// Removes the elements that a shape covers while it goes from one pose to another:
    /// covered_elements.
    Split carve(topology::Mesh& mesh, std::span<const Vec3> positions, const CarverShape& shape,
                const Pose& pose_before, const Pose& pose_after);

    /// Follows an edit, of this cutter or of anybody else.
    /// Throws InputError, and changes nothing, for an edit out of turn.
    /// Cost: proportional to the edit.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// What earlier cuts have left at nodes.
    const SnapHistory& snap_history() const { return snap_history_; }

    /// True if the mesh has all nodes and elements that the cutter remembers.
    bool is_on(const topology::Mesh& mesh) const;
    /// True for a cut that begin_cut() has numbered and that is not removed.
    bool has_cut(CutId id) const { return id.index < cuts_.size() && cuts_[id.index].is_in_use; }
    /// All but the present motion.
    static void archive(auto& ar, auto& self) {
        ar(self.uncut_, self.cuts_, self.boxes_, self.snap_history_);
    }

  private:
    struct Cut {
        bool is_in_use = false;
        double snap = 0.0;
        CutFront front;
        std::vector<Vec3> edge;  // of the blade, where it is now
        bool has_moved = false;  // in the present motion
        static void archive(auto& ar, auto& self) {
            ar(self.is_in_use, self.snap, self.front, self.edge, self.has_moved);
        }
    };
    /// An edit that this cutter has made and that apply() has not followed yet.
    struct OwnEdit {
        std::uint64_t epoch = 0;         // after it
        std::optional<std::size_t> cut;  // whose front has followed already
        bool history_followed = false;
    };

    Cut& cut_of(CutId id);
    const Cut& cut_of(CutId id) const;
    /// The other cuts in progress: fronts that an edit by `worker` may touch.
    std::vector<SuspendedCut> suspended_cuts(std::optional<std::size_t> worker);
    TissueMotion motion(const topology::Mesh& mesh, std::span<const Vec3> positions) {
        boxes_.refresh(mesh, positions);
        return {mesh, before_.values(), positions, &boxes_};
    }
    Split noted(Split done, std::optional<std::size_t> worker);

    UncutBody uncut_;
    topology::ElementBoxes boxes_;
    SnapHistory snap_history_;
    std::vector<Cut> cuts_;             // by CutId
    topology::NodeField<Vec3> before_;  // positions before the present motion, by node id
    OwnEdit own_edit_;
};

}  // namespace incise::cutting
