// All cuts of one body: the cuts in progress and the snap history of earlier ones.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/known_surfaces.h"
#include "incise/cutting/exact/loop_splitter.h"
#include "incise/cutting/exact/opened_nodes.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/exact/splitter.h"
#include "incise/cutting/tools/carver.h"
#include "incise/topology/cell_point.h"
#include "incise/topology/change_set.h"
#include "incise/topology/field.h"
#include "incise/topology/mesh.h"
#include "incise/topology/spatial/element_boxes.h"

namespace incise::cutting {

/// The number of the cut of a blade, from Cutter::begin_cut().
struct CutId {
    std::size_t index = 0;
    bool operator==(const CutId&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.index); }
};

/// Holds what the cuts of one body need besides the mesh: boxes for the search of elements, the
/// cuts in progress, and the snap history.
///
/// Each function that cuts makes one edit of the mesh and returns it. The caller passes the edit to
/// all parts that keep values of the body, and calls apply() of the cutter last:
///
///     ...                                               // the tissue moves to `positions`
///     cutter.follow_motion(mesh, positions);
///     const Split done = cutter.split(cut, mesh, edge_before, edge_after);
///     model.apply(mesh, done.changes);
///     cutter.apply(mesh, done.changes);
///
/// Positions are current ones by vertex id, m. The cutter has its own record of them, and all cuts
/// read that record. Each motion begins where the last one has ended. A node may be anywhere, but
/// it must not change its position between two motions: a blade's edge would not sweep that change,
/// and would cross an edge of the mesh twice, or never. The owner of the body gives nodes other
/// positions after an edit, by rounding or because fragments have joined. Such a change is a part
/// of the next motion here.
///
/// A body of tetrahedra only is cut by splitter.h, any other by loop_splitter.h. There, nodes on
/// the faces that a cut has opened count as lying inside the body by the tolerance of a cut: what
/// comes as near to an opened face cuts nothing. So a blade that is withdrawn, or a stroke along a
/// finished cut, does not slice thin layers off it.
class Cutter {
  public:
    /// Starts without cuts in progress. A body that was cut before, as its source says, has the
    /// faces that these cuts have opened. Cost: O(n).
    /// @param mesh       the body
    /// @param positions  of its nodes
    /// @param has_loops  true to cut tetrahedra, too, as other cells are
    Cutter(const topology::Mesh& mesh, std::span<const Vec3> positions, bool has_loops = false);

    /// Follows a motion of the tissue to `positions`. Cuts take it as straight.
    /// Cost: O(n).
    void follow_motion(const topology::Mesh& mesh, std::span<const Vec3> positions);

    /// Has opened faces count as lying inside at once, and not some at each motion, as
    /// follow_motion() does. Does nothing while a cut is in progress. Takes effect at the next
    /// motion. Cost: some ten microseconds a node that cuts have touched since.
    void settle(const topology::Mesh& mesh);

    /// Returns the point of the tissue that lies at `x`, m; nothing if there is none.
    /// @param moved  how far a node may have moved since the last follow_motion(), m
    /// Cost: O(n / 1000), and that of the elements near `x`.
    std::optional<topology::CellPoint> tissue_at(const topology::Mesh& mesh,
                                                 std::span<const Vec3> positions, const Vec3& x,
                                                 double moved);

    /// Begins a cut of a blade. Calls of split() continue the cut. For `snap`, see SplitOptions. In
    /// a body with other cells than tetrahedra it is taken as from 2e-6 to 0.1 while no node moves,
    /// and else as from the default to 0.1.
    CutId begin_cut(double snap);
    /// Cuts along what the edge of a blade sweeps during the last motion of the tissue. Returns the
    /// edit, which may be empty.
    /// Throws InputError for an unknown cut. The mesh is then unchanged. Cost: see cutting::split
    /// and cutting::split_cells.
    Split split(CutId cut, topology::Mesh& mesh, const std::vector<Vec3>& edge_before,
                const std::vector<Vec3>& edge_after);
    /// True if the cut ends inside the body. If false, end_cut() does nothing.
    bool is_in_tissue(CutId cut) const {
        return !cut_of(cut).front.is_empty() || !cut_of(cut).loops.is_empty();
    }
    /// Ends a cut at the present edge of its blade, in tissue at rest. split() can begin the same
    /// cut again.
    /// @param fragments  of the mesh
    /// Throws InputError for an unknown cut. Cost: see cutting::finish and cutting::finish_cells.
    Split end_cut(CutId cut, topology::Mesh& mesh, const fragments::FragmentMesh& fragments,
                  const BladeEnd& blade);
    /// Removes a cut. Its number may be given to a later cut. Throws InputError for an unknown cut.
    void remove_cut(CutId cut) { cut_of(cut) = {}; }

    /// Cuts along a whole surface at once.
    Split split(topology::Mesh& mesh, const CutSurface& surface, double snap);
    /// Opens the faces that lie nearest to what the edge of a blade sweeps: see faces_to_open().
    Split separate(topology::Mesh& mesh, const std::vector<Vec3>& edge_before,
                   const std::vector<Vec3>& edge_after);
    /// Removes the elements that a shape covers on its way from one pose to another: see
    /// covered_elements().
    Split carve(topology::Mesh& mesh, const CarverShape& shape, const Pose& pose_before,
                const Pose& pose_after);

    /// Follows an edit of the mesh, whoever has made it. New nodes are where their sources are.
    /// Throws InputError, and changes nothing, for an edit out of turn.
    /// Cost: proportional to the edit.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Returns the records that earlier cuts have left at nodes.
    const SnapHistory& snap_history() const { return snap_history_; }

    /// True if the mesh has all nodes and elements of the boxes and of the cuts in progress.
    bool is_on(const topology::Mesh& mesh) const;
    /// True if begin_cut() has returned this number and the cut has not been removed.
    bool has_cut(CutId id) const { return id.index < cuts_.size() && cuts_[id.index].is_in_use; }
    /// Returns the triangles that contradict a cut in progress; there are none unless there is a
    /// fault. The cut crosses an odd number of edges of a triangle if the blade's edge pierces it,
    /// and in no other case. A triangle with another number would stay joined for ever.
    /// @pre  the blade has come from outside, its ends have stayed outside, and no motion has been
    ///       followed since split()
    /// Throws InputError for an unknown cut. Cost: O(n).
    std::vector<FaceId> contradictory_faces(CutId cut, const topology::Mesh& mesh) const;
    /// Archives everything except where the present motion began.
    static void archive(auto& ar, auto& self) {
        ar(self.has_loops_, self.shift_, self.cuts_, self.boxes_, self.snap_history_, self.now_,
           self.opened_, self.known_, self.unfinished_, self.num_followed_, self.has_moved_);
    }

  private:
    struct Cut {
        bool is_in_use = false;
        double snap = 0.0;
        CutFront front;
        LoopFront loops;         // instead, where cells are not all tetrahedra
        std::vector<Vec3> edge;  // of the blade, after its last motion
        bool has_moved = false;  // true after split() in the present motion
        static void archive(auto& ar, auto& self) {
            ar(self.is_in_use, self.snap, self.front, self.loops, self.edge, self.has_moved);
        }
    };
    /// An edit that this cutter has made and that apply() has not followed yet.
    struct OwnEdit {
        std::uint64_t epoch = 0;         // after the edit
        std::optional<std::size_t> cut;  // the cut whose front has already followed
        bool history_followed = false;   // true if the snap history has already followed
        bool has_ended = false;          // true if the last unfinished cut has already followed
        double snap = default_snap;      // tolerance of the cut
    };

    Cut& cut_of(CutId id);
    const Cut& cut_of(CutId id) const;
    bool has_cut_in_progress() const;
    Vec3 shift_of(std::size_t cut) const;
    std::vector<Vec3> shifted(std::size_t cut, std::vector<Vec3> edge) const;
    /// Returns the other cuts in progress, whose fronts an edit by cut `worker` may touch.
    template <class Front>
    std::vector<SuspendedCutOf<Front>> suspended_cuts(std::optional<std::size_t> worker,
                                                      Front Cut::*front);
    /// Returns the last motion of the tissue. Cost: that of the boxes that edits have changed.
    TissueMotion motion(const topology::Mesh& mesh) {
        boxes_.refresh(mesh, now_.values());
        return {mesh, before_.values(), now_.values(), &boxes_, !has_moved_};
    }
    bool is_other_than_before(std::size_t num_known) const;
    double tolerance(double snap) const;
    Split noted(Split done, std::optional<std::size_t> worker, double snap = default_snap);
    std::vector<SuspendedLoops> unfinished_cuts();

    topology::ElementBoxes boxes_;
    SnapHistory snap_history_;
    std::vector<Cut> cuts_;  // by CutId
    // Positions before and after the last motion, by vertex id.
    topology::NodeField<VertexId, Vec3> before_, now_;
    OwnEdit own_edit_;
    bool has_loops_;                // true unless all cells are tetrahedra
    bool has_moved_ = false;        // true if the tissue is not at rest in the present motion
    std::size_t num_followed_ = 0;  // nodes of the last motion
    double shift_ = 0.0;            // of blades, m: see shifted()
    OpenedNodes opened_;
    KnownSurfaces known_;
    std::vector<LoopFront> unfinished_;  // of cuts that have ended inside the body
};

}  // namespace incise::cutting
