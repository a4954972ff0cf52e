// One step of a cut through cells of any shape. For loop_splitter.cpp and its parts alone.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <queue>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "incise/cutting/exact/edge_intersections.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/loop_splitter.h"
#include "incise/cutting/exact/turn.h"
#include "incise/topology/darts.h"
#include "incise/topology/mesh_edit.h"

namespace incise::cutting {

/// Makes the edit of one step of a cut: see split_cells(). Used once.
class LoopStep {
  public:
    LoopStep(topology::Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
             LoopFront& front, const SplitOptions& options, std::span<SuspendedLoops> resting,
             std::optional<std::unordered_set<CellId>> only = std::nullopt,
             const EarlierCuts& earlier = {})
        : mesh_(mesh),
          tissue_(tissue),
          surface_(surface),
          front_(front),
          nearness_of_nodes_(0.5 * std::max(options.snap, least_tolerance)),
          resting_(resting.begin(), resting.end()),
          only_(std::move(only)),
          earlier_(earlier),
          is_swept_(surface.is_swept()),
          num_old_nodes_(mesh.node_capacity()) {}

    Split run();

  private:
    /// Share of an edge: a surface at once that passes nearer to a node of its own cut passes at
    /// the node. Two intersections with an edge at once that are nearer to each other cancel out.
    static constexpr double nearness = default_snap;
    /// Share of an edge: the same for a blade in tissue that moves, which does not come back to the
    /// same place exactly, and for one in tissue at rest.
    static constexpr double nearness_of_blade = 0.1, nearness_at_rest = 1e-3;

    MovingPoint point(VertexId n) const {
        if (n.index() < num_old_nodes_)
            return {tissue_.before[n.index()], tissue_.after[n.index()]};
        return new_points_[n.index() - num_old_nodes_];
    }
    bool stays_whole(CellId e) const { return only_ && !only_->contains(e); }
    static bool is_edge_of(const topology::Mesh& mesh, FaceId f, VertexId a, VertexId b) {
        return find_dart(mesh, f, a, b).is_valid() || find_dart(mesh, f, b, a).is_valid();
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

    /// A cut that is not finished, with its blade where it is, or where it ends this step.
    struct Cut {
        LoopFront& front;
        const SuspendedLoops* resting;  // null for the cut that is made
    };
    /// One of the two parts of a divided face, for such a cut.
    struct Half {
        std::vector<VertexId> waiting;  ///< nodes of the cut
        bool is_odd;  ///< true if an odd number of times it waits, or crosses an edge later
        std::optional<Vec3> pierced;  ///< where its blade passes through, m
        Vec3 normal;                  ///< times twice the area, m2
        /// True if the cut comes in as often as it goes out, and ends at its blade.
        bool is_settled() const { return is_odd == pierced.has_value(); }
    };
    /// Passes each cut, or each one but that of a front.
    template <class Visit>
    void for_cuts(const LoopFront* but, Visit visit) {
        if (but != &front_) visit(Cut{front_, nullptr});
        for (SuspendedLoops& blade : resting_)
            if (&blade.front != but) visit(Cut{blade.front, &blade});
    }

    // What the surface crosses: loop_splitter.cpp.
    EdgeIntersections new_intersections(const Edge& edge) const;
    void find_crossed_edges();
    void receive(const Edge& edge, EdgeIntersections intersections);
    void divide_pending(const Edge& edge, VertexId middle, double place);
    void divide_warped_faces();
    void divide_next();
    std::optional<VertexId> node_through(const Edge& edge, const EdgeIntersection& x) const;
    double longest_edge_at(VertexId n) const;
    void go_through(VertexId n, VertexId end);

    // How edges, faces and cells are divided and opened: loop_division.cpp.
    VertexId divide_edge(VertexId a, VertexId b, double place);
    void note_rings(VertexId middle, VertexId a, std::span<const CellId> cells);
    std::vector<CellId> star(VertexId v) const;
    std::vector<FaceId> faces_at(VertexId v) const;
    void wait_at(LoopFront& front, VertexId n, double local_edge_length);
    std::optional<VertexId> end_of_gap(const LoopFront& front, FaceId f, VertexId v) const;
    std::optional<VertexId> waiting_partner(const LoopFront& front, FaceId f, VertexId v) const;
    template <class Divide>
    void for_faces_where_waits(const LoopFront& front, VertexId v, Divide divide);
    void join_at(LoopFront& front, VertexId v);
    void join_all();
    void join(LoopFront& front, FaceId f, VertexId v, VertexId w);
    void join_along(LoopFront& front, FaceId f, VertexId v, VertexId w);
    void close_at(LoopFront& front, std::span<const CellId> cells, VertexId v, VertexId w);
    std::vector<LoopFront*> cuts_with(FaceId f);
    std::pair<VertexId, double> place_beside(FaceId f, VertexId v, VertexId w) const;
    std::vector<VertexId> divide_face(FaceId f, VertexId v, VertexId w);
    VertexId divide_face_at_centre(FaceId f);
    using FaceStates = std::vector<std::pair<LoopFront*, LoopFront::FaceState>>;
    FaceStates take_states(FaceId f);
    void divide_at_centre(FaceId f);
    void triangulate_all();
    void open_faces();

    // How a cut goes through cells: loop_closing.cpp.
    std::vector<VertexId> path_from(const LoopFront& front, CellId e, VertexId v, VertexId w) const;
    VertexId turn(const LoopFront& front, topology::Dart arriving, bool is_left) const;
    bool parts_evenly(const LoopFront& front, CellId e, VertexId from, VertexId n,
                      VertexId to) const;
    std::vector<FaceId> faces_beside(CellId e, std::span<const VertexId> path, bool is_left) const;
    bool lies_on_surface(FaceId f) const;
    std::vector<FaceId> faces_within(CellId e, std::span<const VertexId> path) const;
    CellId divide_cell(LoopFront& front, CellId e, std::span<const VertexId> path);
    void close_along(LoopFront& front, std::span<const FaceId> faces, double local_edge_length);
    void close(LoopFront& front, CellId e, VertexId v, VertexId w);
    void close_all();

    // Where the blade comes to a cut again: loop_returns.cpp.
    void meet_earlier_cuts();
    bool goes_along(const LoopFront& cut) const;
    bool is_along(const LoopFront& cut, VertexId n, const Vec3& normal) const;
    std::array<VertexId, 2> nodes_near(const LoopFront& cut, const Edge& edge,
                                       const EdgeIntersection& x) const;
    std::optional<VertexId> own_node_at(const Edge& edge, const EdgeIntersection& x) const;
    void pass_at(VertexId v, VertexId end);
    void settle();
    std::optional<LoopFront::EdgeAt> edge_to_pass(FaceId f) const;
    bool parts_nodes(CellId e) const;
    void close_parted();
    bool lengthen_path(CellId e);

    // What other cuts make of it: loop_passing.cpp.
    void make_wait_in(LoopFront& front, FaceId f, std::span<const VertexId> path);
    Vec3 now(const Cut& cut, VertexId n) const;
    Half half_of(const Cut& cut, FaceId f) const;
    void cross_again(LoopFront& front, CellId e, std::span<const VertexId> path);
    using Passed = std::vector<std::pair<Cut, VertexId>>;
    void let_pass(const Cut& cut, CellId e, std::vector<VertexId>& path, Passed& passed,
                  bool is_one_of_many = false);
    void let_all_pass(const LoopFront* but, CellId e, std::vector<VertexId>& path);
    void join(const Passed& passed);
    bool receive_later(std::span<const VertexId> path);
    std::pair<std::size_t, double> passing_place(const Cut& cut, std::span<const VertexId> path,
                                                 std::span<const Half, 2> halves) const;

    topology::Mesh& mesh_;
    const TissueMotion& tissue_;
    const CutSurface& surface_;
    LoopFront& front_;
    /// Share of the longest edge at a node: a cut goes through a node that is nearer to it. Faces
    /// that it opens count as inside the body by twice as much: so the node is on its own side.
    const double nearness_of_nodes_;
    /// Share of an edge: a node is not made nearer to an end, so that no edge is without length.
    const double least_place_ = std::min(nearness_of_nodes_, 2e-3);
    std::vector<SuspendedLoops> resting_;
    std::optional<std::unordered_set<CellId>> only_;  // if set, this cut leaves other cells whole
    const EarlierCuts earlier_;
    const bool is_swept_;
    double time_ = 0.0;  // of the intersection that is the last one so far
    const std::size_t num_old_nodes_;
    std::optional<topology::MeshEdit> edit_;  // once there is something to do

    std::vector<MovingPoint> new_points_;
    std::unordered_map<Edge, EdgeIntersections, EdgeHash> pending_;  // in the order of times
    std::priority_queue<Turn> queue_;
    std::vector<CellId> crossed_;                  // in ascending order
    std::vector<VertexId> made_;                   // nodes on crossed edges, or at their ends
    std::vector<VertexId> met_again_;              // nodes of the cut at which the blade has passed
    std::unordered_set<VertexId> passed_through_;  // those of them that were there before
    mutable std::unordered_map<VertexId, double> longest_edges_;  // at nodes, at rest, m
    /// One cell of each ring, of nodes whose cells are in several rings.
    std::unordered_map<VertexId, std::vector<CellId>> rings_;
    std::vector<CellId> divided_;  // cells at divided edges and faces, and parts of such
    /// Nodes that cuts may still get on new edges. No step needs as many: the bound is there so
    /// that a contradiction, as rounding could make it, ends.
    std::size_t passes_left_ = 0;
    static std::size_t most_passes(std::size_t num_cells) { return 64 + 16 * num_cells; }
    SplitReport report_;
};

}  // namespace incise::cutting
