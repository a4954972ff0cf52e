// Nodes whose motion is given: held still, moved or turned. Their reactions are what it takes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/physics/body/node_set.h"
#include "incise/physics/body/time_curve.h"
#include "incise/topology/mesh.h"
#include "incise/topology/pose.h"

namespace incise::physics {

/// Prescribes some components of the positions of some nodes:
/// x(t) = p + R(t) (X - p) + u(t), X the rest position.
/// With a grip instead: x(t) = grip(t) applied to where the node was in the frame of the grip when
/// it began, so that a grip takes hold of deformed tissue as it is.
struct Constraint {
    std::string name = {};
    NodeSet nodes = {};
    std::array<bool, 3> components{true, true, true};
    TimeCurve<Vec3> displacement = {};    ///< u, metres; empty: none
    TimeCurve<double> angle = {};         ///< radians about the axis; empty: none
    Vec3 point = Vec3::Zero();            ///< p, on the axis
    Vec3 axis = Vec3::UnitZ();            ///< unit vector
    TimeCurve<Pose> grip = {};            ///< empty: none
    std::map<NodeId, Vec3> gripped = {};  ///< by member, m, in the frame of the grip

    /// Where the node is to be at `time`.
    Vec3 target(const topology::Mesh& mesh, NodeId n, double time) const;

    /// @param mesh after the edit
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if it holds what cannot be in the mesh.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) {
        ar(self.name, self.nodes, self.components, self.displacement, self.angle, self.point,
           self.axis, self.grip, self.gripped);
    }
};

/// A grip on nodes where they are now: positions (m, by node id), in the frame of `pose`.
Constraint make_grip(std::string name, std::vector<NodeId> nodes, std::span<const Vec3> positions,
                     const Pose& pose);

/// Two constraints that prescribe the same component of a node.
struct ConstraintConflict {
    NodeId node;
    std::size_t component;
    std::size_t first, second;  ///< indices of the constraints, in ascending order
};

/// Each constraint that prescribes what an earlier one does, with the first that does so: each such
/// pair once, with the first node and component of it; in the order of the second constraints.
/// Cost: O(n) in the nodes of all constraints.
std::vector<ConstraintConflict> find_conflicts(const topology::Mesh& mesh,
                                               std::span<const Constraint> constraints);

/// "node 3 is held in x by both 'floor' and 'clamp'; ..."
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
    /// What its nodes turn about, m.
    const Vec3& point(std::size_t i) const { return constraints_[i].point; }

    /// The constraint of each component of node `n`, -1 for a free one; null for a free node.
    const std::array<int, 3>* of_node(std::size_t n) const {
        return n < row_of_node_.size() && row_of_node_[n] >= 0
                   ? &rows_[static_cast<std::size_t>(row_of_node_[n])]
                   : nullptr;
    }
    /// Sets the prescribed components of `x` to where they are to be at `time`.
    void prescribe(const std::array<int, 3>& constraint_of, const topology::Mesh& mesh, NodeId n,
                   double time, Vec3& x) const;

    /// See Model::add_constraint.
    void add(const topology::Mesh& mesh, Constraint constraint);
    void remove(const topology::Mesh& mesh, std::size_t i);
    void set_grip(std::size_t i, TimeCurve<Pose> grip) { constraints_[i].grip = std::move(grip); }

    /// @param mesh after the edit
    /// Cost: proportional to the nodes that came and went.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

  private:
    void index(const topology::Mesh& mesh, NodeId n);
    void index_all(const topology::Mesh& mesh);

    std::vector<Constraint> constraints_;
    std::vector<std::int32_t> row_of_node_;
    std::vector<std::array<int, 3>> rows_;  // those that occur: few, as many nodes share one
};

}  // namespace incise::physics
