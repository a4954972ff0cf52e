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
#include "incise/physics/body/node_set.h"
#include "incise/physics/body/time_curve.h"
#include "incise/topology/mesh.h"
#include "incise/topology/pose.h"

namespace incise::physics {

/// A constraint that prescribes some components of the positions of some nodes:
/// x(t) = p + R(t) (X - p) + u(t), with the rest position X.
/// A grasp prescribes x(t) = grip(t) applied to `gripped` instead. The nodes then start from their
/// positions in the deformed body and move rigidly with the pose.
struct Constraint {
    std::string name = {};
    NodeSet nodes = {};
    std::array<bool, 3> components{true, true, true};  ///< which of x, y and z are prescribed
    TimeCurve<Vec3> displacement = {};                 ///< u, m; empty: none
    TimeCurve<double> angle = {};                      ///< of R, rad, about the axis; empty: none
    Vec3 point = Vec3::Zero();                         ///< p, on the axis, m
    Vec3 axis = Vec3::UnitZ();                         ///< of unit length
    TimeCurve<Pose> grip = {};            ///< motion of the frame of a grasp; empty: no grasp
    std::map<NodeId, Vec3> gripped = {};  ///< positions of the nodes in the frame of the grasp, m

    /// Returns the prescribed position of a node at `time`, s. Only the components that the
    /// constraint prescribes are meaningful.
    /// @pre  the node is a member
    Vec3 target(const topology::Mesh& mesh, NodeId n, double time) const;

    /// Follows an edit; see NodeSet. A new node of a grasp gets the weighted mean of the positions
    /// of its sources. `mesh` is the mesh after the edit.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if a member is no node of the mesh, if a pose of the grasp is unsound, or
    /// if `gripped` lacks a member.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) {
        ar(self.name, self.nodes, self.components, self.displacement, self.angle, self.point,
           self.axis, self.grip, self.gripped);
    }
};

/// Returns a grasp of nodes at their current positions.
/// @param name       the name of the constraint
/// @param nodes      the nodes to grasp
/// @param positions  current, m, by node id
/// @param pose       the current pose of the frame of the grasp
Constraint make_grip(std::string name, std::vector<NodeId> nodes, std::span<const Vec3> positions,
                     const Pose& pose);

/// Two constraints that prescribe the same component of a node.
struct ConstraintConflict {
    NodeId node;
    std::size_t component;
    std::size_t first, second;  ///< indices of the constraints, in ascending order
};

/// Thrown if two constraints prescribe the same component of a node.
struct ConflictingConstraints : InputError {
    ConflictingConstraints(const std::string& text, const ConstraintConflict& what)
        : InputError(text), conflict(what) {}
    ConstraintConflict conflict;
};

/// Returns the pairs of constraints that prescribe the same component of a living node. Each pair
/// is given once, with its first such node and component. The first of a pair is the earliest
/// constraint of that component. The pairs are in the order of their second constraints.
/// Cost: O(n) in the nodes of the mesh and of all constraints.
std::vector<ConstraintConflict> find_conflicts(const topology::Mesh& mesh,
                                               std::span<const Constraint> constraints);

/// Returns a message: "node 3 is held in x by both 'floor' and 'clamp'; ..."
std::string describe(const ConstraintConflict& conflict, const topology::Mesh& mesh,
                     std::span<const Constraint> constraints);

/// All constraints of a body, looked up by node.
class Constraints {
  public:
    /// Throws InputError, naming node and constraints, if two constraints prescribe the same
    /// component of a node.
    Constraints(const topology::Mesh& mesh, std::vector<Constraint> constraints);

    std::span<const Constraint> all() const { return constraints_; }
    std::size_t size() const { return constraints_.size(); }
    const std::string& name(std::size_t i) const { return constraints_[i].name; }
    /// Returns the point p of constraint `i`, m, about which its nodes turn.
    const Vec3& point(std::size_t i) const { return constraints_[i].point; }

    /// Returns the index of the constraint of each component of node `n`, or -1 for a free
    /// component. Returns null if the node has no constraint.
    const std::array<int, 3>* of_node(std::size_t n) const {
        return n < row_of_node_.size() && row_of_node_[n] >= 0
                   ? &rows_[static_cast<std::size_t>(row_of_node_[n])]
                   : nullptr;
    }
    /// Sets the prescribed components of `x` to their targets at `time`.
    /// @param constraint_of  as of_node() returns it for the node
    /// @param mesh           the mesh of the body
    /// @param n              the node
    /// @param time           s
    /// @param x              position, m; free components stay as they are
    void prescribe(const std::array<int, 3>& constraint_of, const topology::Mesh& mesh, NodeId n,
                   double time, Vec3& x) const;

    /// Appends a constraint; see Model::add_constraint.
    void add(const topology::Mesh& mesh, Constraint constraint);
    /// Removes a constraint; see Model::remove_constraint.
    void remove(const topology::Mesh& mesh, std::size_t i);
    void set_grip(std::size_t i, TimeCurve<Pose> grip) { constraints_[i].grip = std::move(grip); }

    /// Follows an edit; `mesh` is the mesh after the edit. Cost: proportional to the nodes that the
    /// edit added and removed.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

  private:
    void index(const topology::Mesh& mesh, NodeId n);
    void index_all(const topology::Mesh& mesh);

    std::vector<Constraint> constraints_;
    std::vector<std::int32_t> row_of_node_;  // by node id, an index into rows_; -1: free
    std::vector<std::array<int, 3>> rows_;   // each that occurs, once: few, as nodes share them
};

}  // namespace incise::physics
