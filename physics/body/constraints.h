// Kinematic constraints: nodes that are fixed, moved, turned or grasped.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/base/types.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/body/body_edit.h"
#include "incise/physics/body/time_curve.h"
#include "incise/physics/body/vertex_set.h"
#include "incise/topology/mesh.h"
#include "incise/topology/pose.h"

namespace incise::physics {

/// A constraint that prescribes some components of the positions of some nodes:
/// x(t) = p + R(t) (X - p) + u(t), with the rest position X.
/// A grasp prescribes x(t) = grip(t) applied to the position that the node had in the frame of the
/// grasp at first. The nodes move rigidly with the pose.
///
/// `nodes` are nodes of the mesh, and follow its edits. A cut makes nodes of the fragments that are
/// none of the mesh: see Constraints.
struct Constraint {
    std::string name = {};
    VertexSet nodes = {};
    std::array<bool, 3> components{true, true, true};  ///< which of x, y and z are prescribed
    TimeCurve<Vec3> displacement = {};                 ///< u, m; empty: none
    TimeCurve<double> angle = {};                      ///< of R, rad, about the axis; empty: none
    Vec3 point = Vec3::Zero();                         ///< p, on the axis, m
    Vec3 axis = Vec3::UnitZ();                         ///< of unit length
    TimeCurve<Pose> grip = {};  ///< motion of the frame of a grasp; empty: no grasp
    /// By node of the fragments, its position in the frame of the grasp, m; kept by Constraints.
    std::map<NodeId, Vec3> gripped = {};

    /// Returns the prescribed position of a node of the fragments at `time`, s. Only the components
    /// that the constraint prescribes are meaningful.
    /// @pre  the constraint prescribes the node
    Vec3 target(const fragments::FragmentMesh& fragments, NodeId n, double time) const;

    /// Throws InputError if a member is no node of the mesh, or if a pose of the grasp is unsound.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) {
        ar(self.name, self.nodes, self.components, self.displacement, self.angle, self.point,
           self.axis, self.grip, self.gripped);
    }
};

/// Returns a grasp of nodes at the positions that they have when it is added to a body.
/// @param name   the name of the constraint
/// @param nodes  the nodes to grasp
/// @param pose   the pose of the frame of the grasp when it is added
Constraint make_grip(std::string name, std::vector<VertexId> nodes, const Pose& pose);

/// Two constraints that prescribe different values of the same component of a node.
struct ConstraintConflict {
    VertexId node;
    std::size_t component;
    std::size_t first, second;  ///< indices of the constraints, in ascending order
};

/// Thrown if two constraints prescribe different values of the same component of a node.
struct ConflictingConstraints : InputError {
    ConflictingConstraints(const std::string& text, const ConstraintConflict& what)
        : InputError(text), conflict(what) {}
    ConstraintConflict conflict;
};

/// Returns the pairs of constraints that prescribe different values of the same component of a
/// living node. Values are the same if both constraints move it along that component by the same
/// keys, or not at all, and turn it by the same keys about the same axis, or not at all; those of
/// grasps always differ. Each pair is given once, with its first such node and component. The first
/// of a pair is the earliest constraint of that component. The pairs are in the order of their
/// second constraints. Cost: O(n) in the nodes of the mesh and of all constraints.
std::vector<ConstraintConflict> find_conflicts(const topology::Mesh& mesh,
                                               std::span<const Constraint> constraints);

/// Returns a message: "node 3 is held in x by both 'floor' and 'clamp'; ..."
std::string describe(const ConstraintConflict& conflict, const topology::Mesh& mesh,
                     std::span<const Constraint> constraints);

/// All constraints of a body, looked up by node of its fragments.
///
/// In a body without cuts, a constraint prescribes its nodes. After cuts, it prescribes the corners
/// of fragments that its material is between. A corner is prescribed if a fragment at it has a node
/// of the constraint, and if the position of this node depends on the corner. So the copies of a
/// node of a clamped face are prescribed as long as their fragments touch the face; a copy with no
/// material at the face is free. Two constraints with different nodes may want the same corner, and
/// two constraints may prescribe the same value of a node. The earlier one gets it, with the
/// reaction there.
class Constraints {
  public:
    /// Throws InputError, naming node and constraints, if two constraints prescribe different
    /// values of the same component of a node. Grasps begin at the positions of the body.
    Constraints(const BodyView& body, std::vector<Constraint> constraints);

    std::span<const Constraint> all() const { return constraints_; }
    std::size_t size() const { return constraints_.size(); }
    const std::string& name(std::size_t i) const { return constraints_[i].name; }
    /// Returns the point p of constraint `i`, m, about which its nodes turn.
    const Vec3& point(std::size_t i) const { return constraints_[i].point; }

    /// Returns the index of the constraint of each component of node `n` of the fragments, or -1
    /// for a free component. Returns null if the node has no constraint.
    const std::array<int, 3>* of_node(std::size_t n) const {
        return n < row_of_node_.size() && row_of_node_[n] >= 0
                   ? &rows_[static_cast<std::size_t>(row_of_node_[n])]
                   : nullptr;
    }
    /// Sets the prescribed components of `x` to their targets at `time`.
    /// @param constraint_of  as of_node() returns it for the node
    /// @param fragments      those of the body
    /// @param n              the node of the fragments
    /// @param time           s
    /// @param x              position, m; free components stay as they are
    void prescribe(const std::array<int, 3>& constraint_of,
                   const fragments::FragmentMesh& fragments, NodeId n, double time, Vec3& x) const;

    /// Appends a constraint; see Boundary::add_constraint.
    void add(const BodyView& body, Constraint constraint);
    /// Removes a constraint; see Boundary::remove_constraint.
    void remove(const BodyView& body, std::size_t i);
    void set_grip(std::size_t i, TimeCurve<Pose> grip) { constraints_[i].grip = std::move(grip); }

    /// Follows an edit. A copy of a grasped node is grasped where that node is.
    /// Cost: proportional to the touched nodes; for an edit that goes back as for a new object.
    void apply(const BodyView& body, const BodyEdit& edit);

  private:
    void require_agreement(const topology::Mesh& mesh) const;
    /// Calls visit(n) for each node of the fragments on which a node of the mesh depends; some of
    /// them more than once.
    template <class Visit>
    static void for_each_corner(const BodyView& body, VertexId member, Visit visit);
    bool does_prescribe(std::size_t constraint, const BodyView& body, NodeId n) const;
    void index(const BodyView& body, NodeId n);
    void index_all(const BodyView& body);
    void begin_grasps(NodeId n, std::span<const Vec3> positions);

    std::vector<Constraint> constraints_;
    // By constraint, in ascending order: nodes before any cut whose copies it may prescribe.
    std::vector<std::vector<NodeId>> origins_;
    std::vector<std::int32_t> row_of_node_;  // by node of the fragments, an index into rows_; or -1
    std::vector<std::array<int, 3>> rows_;   // each that occurs, once: few, as nodes share them
};

}  // namespace incise::physics
