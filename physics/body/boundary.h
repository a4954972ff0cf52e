// What acts on a body from outside: gravity, damping, constraints, loads and force terms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "incise/base/archive.h"
#include "incise/physics/body/constraints.h"
#include "incise/physics/body/force_term.h"
#include "incise/physics/body/loads.h"
#include "incise/physics/body/structure.h"

namespace incise::physics {

/// The gravity, damping, constraints and loads of a body.
struct BoundaryConditions {
    Vec3 gravity = Vec3::Zero();  ///< m/s2
    double damping = 0.0;         ///< mass-proportional, 1/s
    std::vector<Constraint> constraints;
    std::vector<Load> loads;
};

/// Returns the nodes of all constraints but grasps, which come and go. Throws InputError for a
/// constraint of another mesh.
std::vector<VertexId> constrained_by(const topology::Mesh& mesh,
                                     std::span<const Constraint> constraints);

/// The force that a constraint exerts on the body, N, and its torque about Constraint::point, N m.
struct Reaction {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();

    Reaction& operator+=(const Reaction& o) {
        force += o.force;
        torque += o.torque;
        return *this;
    }
    friend Reaction operator*(double factor, const Reaction& r) {
        return {factor * r.force, factor * r.torque};
    }
    static void archive(auto& ar, auto& self) { ar(self.force, self.torque); }
};

/// Gravity, damping, constraints, loads and force terms of a body, and the forces of all of them.
/// Changes act from the next forces on: call Model::compute_forces() after them.
class Boundary {
  public:
    /// Keeps the fragments at constraints heavy. Throws InputError as Constraints does.
    /// @lifetime Structure and state must outlive it.
    Boundary(Structure& structure, const State& state, BoundaryConditions conditions);

    const Constraints& constraints() const { return constraints_; }
    const Loads& loads() const { return loads_; }
    double damping() const { return damping_; }  ///< mass-proportional, 1/s
    /// Returns a number that grows when a constraint, a load or a force term is added, replaced or
    /// removed.
    std::uint64_t version() const { return version_; }
    /// Returns a number that grows when gravity is set.
    std::uint64_t gravity_version() const { return gravity_version_; }

    /// Appends a constraint to the list. Throws InputError, and changes nothing, if another
    /// constraint prescribes another value of a component of a node. Cost: O(n) in the nodes of the
    /// mesh and of all constraints.
    void add_constraint(Constraint constraint);
    /// Replaces constraint `i`. Throws and costs as add_constraint().
    void set_constraint(std::size_t i, Constraint constraint);
    /// Removes constraint `i`; the indices of later constraints decrease by one. Cost as for
    /// add_constraint().
    void remove_constraint(std::size_t i);
    /// Replaces the motion of the grasp that is constraint `i`; see Constraint::grip.
    void set_grip(std::size_t i, TimeCurve<Pose> grip) {
        constraints_.set_grip(i, std::move(grip));
    }

    /// Appends a load to the list.
    void add_load(Load load);
    /// Replaces load `i`.
    void set_load(std::size_t i, Load load);
    /// Removes load `i`; the indices of later loads decrease by one.
    void remove_load(std::size_t i);
    /// Replaces the factor of load `i`.
    void set_load_factor(std::size_t i, TimeCurve<double> factor) {
        loads_.set_factor(i, std::move(factor));
    }
    /// Sets the gravity, m/s2.
    void set_gravity(const Vec3& gravity) {
        loads_.set_gravity(gravity);
        ++gravity_version_;
    }
    void set_damping(double damping) { damping_ = damping; }  ///< 1/s

    /// Adds a term to the outer forces. Archives do not contain added terms: after a restore, the
    /// caller must add them again. Throws InputError, and adds nothing, for a bound on the
    /// stiffness that is not finite or below 0. Cost: O(n), for the stable step.
    void add_force_term(std::unique_ptr<ForceTerm> term);
    /// Removes an added term. Returns false if the body does not have it. Cost: O(n).
    bool remove_force_term(const ForceTerm* term);
    bool has_force_terms() const { return !added_terms_.empty(); }
    /// Exchanges the added terms with those of another boundary. Call sum_stiffness() after it.
    void swap_force_terms(Boundary& other) { added_terms_.swap(other.added_terms_); }
    /// Sums the stiffness of all nodes again, for the stable step. Cost: O(n).
    void sum_stiffness();

    /// Prepares the forces for the current body, once in each step and after each change.
    void update();
    /// Returns the forces of gravity, loads and added terms, N, as they were last computed.
    std::span<const Vec3> outer_forces() const { return outer_forces_; }
    /// Computes outer_forces() of one range of nodes.
    void compute_forces(NodeRange range, double time) {
        set_forces(range, state_.positions(), time, outer_forces_);
    }
    /// Sets `forces` (N, by node id) to the outer forces at other positions (m) and at `time`, s.
    /// @pre  update() was called since the last edit or change of loads
    void outer_forces_at(std::span<const Vec3> positions, double time, const Workers& workers,
                         std::span<Vec3> forces) const;
    /// Passes the tangents of the outer forces to `sink`; see ForceTerm::visit_tangents.
    /// @pre  as for outer_forces_at()
    void visit_tangents(std::span<const Vec3> positions, double time, TangentSink& sink) const;
    /// Returns the bound on the stiffness of the added terms at a node, N/m.
    double stiffness_bound(NodeId n) const;

    /// Returns the reaction of each constraint, mean over the last step.
    std::span<const Reaction> reactions() const { return reactions_; }
    std::span<Reaction> reactions() { return reactions_; }
    /// Sets all reactions to zero.
    void clear_reactions() { reactions_.assign(constraints_.size(), {}); }
    /// Sets the reactions to the means over several steps, of which the last one was the last.
    /// @pre  there is one for each constraint
    void set_reactions(std::span<const Reaction> means) {
        std::ranges::copy(means, reactions_.begin());
    }
    /// Adds a force, N, along one axis on a node at `x` to the reaction of a constraint.
    void add_reaction(int constraint, int component, double force, const Vec3& x,
                      std::span<Reaction> reactions) const;

    /// Follows an edit that the structure and the state have followed.
    void apply(const BodyView& body, const BodyEdit& edit);

    /// Writes all but the reactions and the added terms.
    void save(ArchiveWriter& ar) const;
    /// Replaces all but the added terms by what save() wrote. Grasps stay as they were saved.
    void restore(ArchiveReader& ar);
    void save_reactions(ArchiveWriter& ar) const { ar(reactions_); }
    /// Throws InputError, and changes nothing, for those of another body.
    void restore_reactions(ArchiveReader& ar);

  private:
    BodyView view() const { return structure_.view(state_); }
    void constrain_fragments();
    void set_forces(NodeRange range, std::span<const Vec3> positions, double time,
                    std::span<Vec3> forces) const;

    Structure& structure_;
    const State& state_;
    double damping_;
    Constraints constraints_;
    Loads loads_;
    std::vector<std::unique_ptr<ForceTerm>> added_terms_;
    std::vector<Vec3> outer_forces_;
    std::vector<Reaction> reactions_;  // by constraint
    std::uint64_t version_ = 0, gravity_version_ = 0;
};

/// Reads what Boundary::save() wrote. Throws InputError for what does not fit the mesh.
BoundaryConditions read_boundary_conditions(const topology::Mesh& mesh, ArchiveReader& ar);

}  // namespace incise::physics
