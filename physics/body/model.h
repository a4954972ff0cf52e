// The mechanical model of a body: state, lumped masses, forces and the explicit step. It follows
// the edits of its mesh. Source: HEML 2015, section 3; docs/theory.md, Masses and time steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/fragments/embedding.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/body/body_edit.h"
#include "incise/physics/body/constraints.h"
#include "incise/physics/body/force_term.h"
#include "incise/physics/body/loads.h"
#include "incise/physics/body/momentum.h"
#include "incise/physics/body/node_lanes.h"
#include "incise/physics/body/node_sums.h"
#include "incise/physics/elements/element_store.h"
#include "incise/physics/elements/stable_step.h"
#include "incise/physics/elements/state.h"
#include "incise/topology/change_set.h"
#include "incise/topology/follower.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// The gravity, damping, constraints and loads of a body.
struct BoundaryConditions {
    Vec3 gravity = Vec3::Zero();  ///< m/s2
    double damping = 0.0;         ///< mass-proportional, 1/s
    std::vector<Constraint> constraints;
    std::vector<Load> loads;
};

/// Sums over the body.
struct Totals {
    double mass = 0.0;                     ///< kg
    double rest_volume = 0.0;              ///< m3
    double kinetic_energy = 0.0;           ///< J, of the current velocities
    double elastic_energy = 0.0;           ///< J; of viscous elements that of the long-time moduli
    double gravity_energy = 0.0;           ///< J, zero at the origin
    Vec3 momentum = Vec3::Zero();          ///< kg m/s
    Vec3 angular_momentum = Vec3::Zero();  ///< kg m2/s, about the origin
    Vec3 centre_of_mass = Vec3::Zero();    ///< m
    static void archive(auto& ar, auto& self) {
        ar(self.mass, self.rest_volume, self.kinetic_energy, self.elastic_energy,
           self.gravity_energy, self.momentum, self.angular_momentum, self.centre_of_mass);
    }
};

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

/// A body with lumped masses at nodes, and elastic elements between them.
///
/// The mesh is the material. The elements are its fragments (fragments::FragmentMesh): a cut
/// divides the material exactly, and the fragments of an element move as the whole would. Without
/// cuts, elements and nodes are those of the mesh, with the same ids.
///
/// All arrays are indexed by node of the fragments, unless they are said to be by node of the mesh.
/// Dead nodes have no mass. They keep their last positions and velocities, so that an edit can be
/// undone.
class Model {
  public:
    /// Builds a body at rest in the rest positions, and computes the forces of this state. The
    /// fragments are those of FragmentMesh, also of a mesh with carriers. The constraints hold
    /// their nodes: no fragment at them is light. The fibres of the table are by element of the
    /// mesh. The model reads the mesh and never changes it. Throws InputError as ElementStore and
    /// Constraints do.
    /// @lifetime The mesh must outlive the model.
    Model(const topology::Mesh& mesh, const MaterialTable& table,
          const BoundaryConditions& boundary_conditions = {});
    /// Builds the same of a body that was cut.
    /// @param fragments  of the mesh; the fibres of the table are by id of fragments
    Model(const topology::Mesh& mesh, fragments::FragmentMesh fragments, const MaterialTable& table,
          BoundaryConditions boundary_conditions = {});

    /// Restores a model from the bytes that save() has written. The result equals the saved model
    /// bit for bit.
    /// Throws InputError for the data of another mesh. Cost: that of a new model.
    /// @param mesh   the mesh of the saved model
    /// @param table  the materials of the saved model; the fibres are read from the archive
    /// @param ar     the reader, at the beginning of the model
    /// @param time   the time of the saved state, s
    Model(const topology::Mesh& mesh, MaterialTable table, ArchiveReader& ar, double time);

    /// Sets the number of threads, at least 1. It does not change any result. A new model has one.
    void set_num_threads(int n) { workers_ = Workers(n); }
    int num_threads() const { return workers_.num_threads(); }
    const Workers& workers() const { return workers_; }

    const State& state() const { return state_; }
    std::span<const Vec3> positions() const { return state_.positions(); }    ///< m
    std::span<const Vec3> velocities() const { return state_.velocities(); }  ///< m/s
    std::span<const Vec3> elastic_forces() const { return elastic_forces_; }  ///< N
    std::span<const double> masses() const { return masses_; }                ///< kg

    /// Returns the positions, m, and velocities, m/s, of the nodes of the mesh, by id.
    /// @thread One thread at a time.
    /// @lifetime Until the model is stepped or edited.
    std::span<const Vec3> mesh_positions() const {
        return embedding_.positions(state_.positions(), state_.version());
    }
    std::span<const Vec3> mesh_velocities() const {
        return embedding_.velocities(state_.velocities(), state_.version());
    }
    /// Returns the mass of the material at each node of the mesh, kg: a quarter of that of each
    /// tetrahedron, and an eighth of that of each hexahedron. Cost: O(n).
    std::vector<double> mesh_masses() const;
    /// Returns the elastic force on the material at each node of the mesh, N: its mass times the
    /// acceleration there by elastic forces. Cost: O(n).
    std::vector<Vec3> mesh_elastic_forces() const;

    /// Replaces the state and computes its forces. Viscous elements treat the change as an
    /// instantaneous strain, so that they respond with their instantaneous moduli.
    /// @param positions   by node of the fragments, FragmentMesh::node_capacity() of them, m
    /// @param velocities  likewise, m/s
    /// @param time        the time for the loads, s
    void set_state(std::span<const Vec3> positions, std::span<const Vec3> velocities, double time);

    /// Returns the history of the viscous elements; empty if there are none. It is a part of the
    /// state, and each step advances it together with the positions.
    const ViscousHistory& history() const { return state_.history(); }
    /// Replaces the history, for example after set_state(). The forces stay as they are until
    /// compute_forces() is called.
    /// @param values  in the order of ViscousHistory::values()
    void set_history(std::span<const double> values) { state_.change().history.set_values(values); }

    /// Computes the elastic, viscous and outer forces at the current state and at `time`, s.
    void compute_forces(double time);

    /// Computes in one pass what totals(), min_volume_ratio() and compute_forces() need of the
    /// elements. It saves time if both energies and forces are needed, as in a step with an edit.
    /// If an edit follows, compute_forces() computes the forces of the changed blocks again. All
    /// results are the same bit for bit as without this call.
    void compute_totals_and_forces();

    /// Makes one step of symplectic (semi-implicit) Euler with the forces last computed:
    /// v += dt f / m, damped implicitly; x += dt v. Prescribed components move to their targets at
    /// time + dt. Source: HEML 2015, eq. (32).
    /// Throws MotionFailure if the state is no longer finite, or if a node has moved by more than
    /// size() in this step. The message names an element, the time and the likely cause.
    void integrate(double time, double dt);
    /// Changes the velocities of free components by those that the forces last computed bring about
    /// in a time, s, which may be below 0.
    void shift_velocities(double time);
    /// Makes the first of two stages that together equal integrate(): sets the velocities to those
    /// of the end of the step. The velocities may be changed before the second stage, drift().
    /// Without such changes, the results are those of integrate() bit for bit.
    void kick(double time, double dt);
    /// Changes the velocities of free components between kick() and drift(). The work of an impulse
    /// counts as external; it is the impulse times the mean of the velocities before and after the
    /// step. An impulse on a prescribed component changes the reaction of the constraint instead.
    /// Damping acts on what an impulse does as on what a force does; see response_to_impulses().
    /// @param impulses  N s, by node id
    void give_impulses(std::span<const Vec3> impulses);
    /// Returns the change of velocity by an impulse between kick() and drift(), times the mass of
    /// the node over the impulse: 1 without damping.
    double response_to_impulses() const { return response_to_impulses_; }
    /// Returns the work of the impulses of the last step, J, with what they do on prescribed
    /// components.
    double impulse_work() const { return impulse_work_; }
    /// Makes the second stage of the step: sets the positions and everything else. It throws as
    /// integrate() does.
    /// @pre  kick() was called with the same arguments
    void drift(double time, double dt);

    /// Begins a step of an implicit solver or of statics, which finds the end of the step itself.
    /// Such a step may consist of several parts; see take_step().
    void begin_step();
    /// Moves to the end of a step, or of a part of it, and advances the history. Returns the energy
    /// that viscosity dissipated, J. The forces stay as they are until compute_forces() is called.
    /// @param positions   at the end, m, by node id
    /// @param velocities  at the end, m/s, by node id
    /// @param reactions   forces of the constraints on their nodes, N, by node id; zero in free
    ///                    components
    /// @param dt          time since the present state, s; infinite in statics
    /// @pre  begin_step() was called before the first part
    double take_step(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                     std::span<const Vec3> reactions, double dt);
    /// Adds to external_work() and dissipated_energy(), J.
    void record_work(double external_work, double dissipated_energy);

    /// Follows an edit of the mesh. The update is incremental. The result equals bit for bit a
    /// model that is built on the edited mesh and fragments with the same state and history.
    ///
    /// A copy of a node gets the state of that node. Fragments of an element inherit its fibres and
    /// its viscous history. So an edit that only divides elements changes no mass, momentum or
    /// energy. Where a light fragment joins another one, its mass moves with the corners of the
    /// other one from now on: mass stays; linear and angular momentum are kept by a rigid change of
    /// the velocities of the nodes near the edit that have no constraint; energies and the centre
    /// of mass change a little: docs/theory.md, Fragments. Merged nodes keep their momentum.
    ///
    /// The forces stay as they are until compute_forces() is called.
    /// Throws InputError for an edit out of turn, and for one that goes back. Cost: proportional to
    /// the touched stars.
    /// @param mesh     the mesh of the model, after the edit
    /// @param changes  the record of the edit
    BodyEdit apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);
    /// Applies an edit that is known, in both directions: the inverse of the last one takes it
    /// back, and then the edit itself makes it again. Before any motion, the inverse restores the
    /// former state bit for bit.
    /// Throws InputError, and changes nothing, for an edit out of turn.
    /// @param mesh  the mesh of the model, on which edit.material was replayed
    /// @param edit  what the other apply() has returned, or its inverse()
    /// Cost: that of the edit, and on the way back O(n) in the nodes of constraints.
    void apply(const topology::Mesh& mesh, const BodyEdit& edit);

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

    /// Appends a load to the list. The forces stay as they are until compute_forces() is called.
    void add_load(Load load);
    /// Replaces load `i`. The forces stay as they are until compute_forces() is called.
    void set_load(std::size_t i, Load load);
    /// Removes load `i`; the indices of later loads decrease by one. The forces stay as they are
    /// until compute_forces() is called.
    void remove_load(std::size_t i);
    /// Replaces the factor of load `i`. The forces stay as they are until compute_forces() is
    /// called.
    void set_load_factor(std::size_t i, TimeCurve<double> factor) {
        loads_.set_factor(i, std::move(factor));
    }
    /// Sets the gravity, m/s2. The forces stay as they are until compute_forces() is called.
    void set_gravity(const Vec3& gravity) { loads_.set_gravity(gravity); }
    /// Sets the mass-proportional damping, 1/s.
    void set_damping(double damping) { damping_ = damping; }
    const Loads& loads() const { return loads_; }

    /// Replaces the materials. The body keeps positions, velocities and masses. The jump of its
    /// elastic energy counts as external work. Terms of a Prony series keep their stress where the
    /// new material has as many of the same rule; others begin without stress.
    /// Throws InputError, and changes nothing, for another density in a region, and as ElementStore
    /// does. Cost: O(n), that of a new model.
    /// @param table  its fibres are by id of fragments
    /// @param time   for the forces, s
    void set_materials(MaterialTable table, double time);

    /// Adds a term to the outer forces. Archives do not contain added terms: after a restore, the
    /// caller must add them again. Throws InputError, and adds nothing, for a bound on the
    /// stiffness that is not finite or below 0. Cost: O(n), for the stable step.
    void add_force_term(std::unique_ptr<ForceTerm> term);
    /// Removes an added term. Returns false if the model does not have it. Cost: O(n).
    bool remove_force_term(const ForceTerm* term);
    /// Takes the added terms of a model that this one replaces, and computes the forces anew: for
    /// a model that was just read from an archive. Changes nothing if a term throws.
    /// Cost: O(n).
    void take_force_terms(Model& former, double time);

    /// Writes everything but the mesh, the materials and the added force terms: state, history,
    /// work, reactions, fibres, constraints and loads. Cost: O(n).
    void save(ArchiveWriter& ar) const;
    /// Writes of save() what remains if mesh and fragments are known: not the fibres either.
    /// Cost: O(#nodes).
    void save_motion(ArchiveWriter& ar) const;
    /// Restores what save_motion() has written, and computes the forces.
    /// @pre  mesh and fragments are those of that time: all edits since were taken back
    /// Throws InputError for the data of another body. Cost: O(n), about that of a step.
    void restore_motion(ArchiveReader& ar, double time);

    const ElementStore& elements() const { return elements_; }
    const Constraints& constraints() const { return constraints_; }
    double damping() const { return damping_; }  ///< 1/s
    double size() const { return body_size_; }   ///< diagonal of the box around the rest mesh, m
    std::span<const Vec3> outer_forces() const {
        return outer_forces_;
    }  ///< N, of gravity, loads and added terms
    /// Sets `forces` (N, by node id) to the outer forces at other positions (m) and at `time`, s.
    /// @pre  compute_forces() or begin_step() was called since the last edit or change of loads
    void outer_forces_at(std::span<const Vec3> positions, double time,
                         std::span<Vec3> forces) const;
    /// Passes the tangents of the outer forces to `sink`; see ForceTerm::visit_tangents.
    /// @pre  compute_forces() or begin_step() was called since the last edit or change of loads
    void visit_outer_tangents(std::span<const Vec3> positions, double time,
                              TangentSink& sink) const;
    /// Returns the elastic energy, J; of viscous elements that of the long-time moduli.
    /// @thread One thread at a time.
    double elastic_energy() const;
    /// Returns a number that grows with each edit, also with each undo of an edit. It also grows
    /// when a constraint, a load or a force term is added, or a constraint or a load is removed.
    std::uint64_t structure_version() const { return structure_version_; }

    /// Returns the largest distance that a node moved in the last step, m. If the step had several
    /// parts, it is the sum over the parts.
    double largest_move() const { return largest_move_; }
    /// Returns a bound on the distance that a node of the mesh moved in the last step, m.
    double largest_mesh_move() const { return embedding_.largest_gain() * largest_move_; }

    /// Returns the bound on explicit steps at rest, s; see StableStep. The bound ignores damping,
    /// which only increases the stable step.
    double rest_stable_step() const { return stable_step_.value(); }
    /// Returns the bound on explicit steps in the present positions, s. It is at most that at rest,
    /// and equal to it at small strain. It depends on nothing but the positions and the body.
    /// Source: docs/theory.md, Stable step.
    /// Cost: O(n), about that of the forces.
    /// @thread One thread at a time.
    double stable_step() const;
    /// Returns the same bound if only the given nodes counted, s. Dead nodes do not count.
    /// Cost: proportional to the stars of the nodes.
    double stable_step(std::span<const NodeId> nodes) const;

    /// Returns the bound on the stiffness of a living node at rest, N/m, from which the stable step
    /// is computed.
    double stiffness_bound(std::size_t node) const {
        return stable_step_.quotient(node) * masses_[node];
    }

    /// Returns the stable step of one fragment if its nodes had no other one, s.
    double element_stable_step(ElementId e) const;

    /// Returns a cell of the mesh at the node that sets the stable step.
    CellId limiting_cell() const {
        const NodeId n(stable_step_.limiting_node());
        return fragments_.cells_of(fragments_.incident_element(n)).front();
    }
    /// Returns the sum of modulus times rest volume over the elements, J. This is the order of the
    /// elastic energy at a strain of one. Rounding errors of the elastic energy are small against
    /// it.
    double stiffness_energy() const;

    /// Returns the sums over the body. Cost: O(#nodes + #elements) after a motion. After an edit
    /// without motion, only the touched ranges of nodes and blocks of elements are computed again.
    /// @thread One thread at a time.
    Totals totals() const;
    /// Returns the least volume ratio of all elements. Cost and threads as for totals().
    double min_volume_ratio() const;
    /// Returns current volume / rest volume - 1. Not a number without elements.
    double volume_change() const;
    /// Returns the largest distance of a node from its rest position, m.
    double max_displacement() const;
    /// Returns the result of a fragment. It is that of each element of the mesh that the fragment
    /// carries: FragmentMesh::fragment_of_cell.
    ElementResult element_result(ElementId e) const {
        return elements_.block_of(fragments_, e).result(e, positions(), history());
    }

    /// Returns the direction of the fibres at rest, by fragment. It is zero where there are none.
    /// Empty if no material has fibres.
    std::span<const Vec3> fibres() const { return elements_.fibres(); }

    /// Returns the density of the material of a region, kg/m3.
    double density(int region) const { return elements_.density(region); }

    /// Returns the work of gravity, loads, added terms and constraints since the start, J.
    double external_work() const { return external_work_; }
    /// Returns the energy that damping, viscosity and the rules of implicit steps and statics have
    /// taken since the start, J. Energy that viscous elements can still return counts as dissipated
    /// until they return it.
    double dissipated_energy() const { return dissipated_energy_; }

    std::size_t num_constraints() const { return constraints_.size(); }
    const std::string& constraint_name(std::size_t i) const { return constraints_.name(i); }
    /// Returns the reaction of each constraint, mean over the last step.
    std::span<const Reaction> reactions() const { return reactions_; }
    /// Sets the reactions to the means over several steps, of which the last one was the last.
    /// @pre  there is one for each constraint
    void set_reactions(std::span<const Reaction> means) {
        std::ranges::copy(means, reactions_.begin());
    }

    const topology::Mesh& mesh() const { return mesh_; }
    const fragments::FragmentMesh& fragments() const { return fragments_; }
    const fragments::Embedding& embedding() const { return embedding_; }

  private:
    /// The fragments of a mesh, and the materials with the fibres by fragment: a fragment has those
    /// of its lowest cell.
    struct Parts {
        Parts(const topology::Mesh& mesh, const MaterialTable& of_mesh,
              std::span<const Constraint> constraints);
        fragments::FragmentMesh fragments;
        MaterialTable table;
    };
    Model(const topology::Mesh& mesh, Parts parts, BoundaryConditions boundary_conditions);

    /// The motion of one node in a step.
    struct NodeStep {
        Vec3 x, v;    ///< at the end of the step, m and m/s
        double work;  ///< of constraints, J
    };
    /// Makes a step by calls of move_range(range, reactions), which returns the sums over the nodes
    /// of the range and adds to the reactions of all constraints. Then adds up the ranges and
    /// advances the viscous history.
    template <class MoveRange>
    void step_ranges(double time, double dt, MoveRange move_range);
    /// Moves the nodes of a range, and no others. Adds to `reactions`, those of all constraints.
    StepSums move_nodes(NodeRange range, const State::Values& values, double time, double dt,
                        std::span<Reaction> reactions);
    /// Moves one living node; see move_nodes(). `slowing` is 1/(1 + damping dt).
    StepSums move_node(std::size_t n, const State::Values& values, double time, double dt,
                       double slowing, std::span<Reaction> reactions);
    /// Returns the number of consecutive nodes from `n` on, before `end`, that are alive and have
    /// no constraint, rounded down to a multiple of nodes_together.
    std::size_t num_free_nodes(std::size_t n, std::size_t end) const;
    /// Moves the prescribed components of node `n` to their targets at time + dt.
    /// @param n          the node
    /// @param v          velocity at the beginning of the step, m/s
    /// @param time       beginning of the step, s
    /// @param dt         length of the step, s
    /// @param force      force on the node without constraints, N
    /// @param free       motion of the node without constraints
    /// @param reactions  of all constraints; added to
    NodeStep constrain_node(std::size_t n, const Vec3& v, double time, double dt, const Vec3& force,
                            NodeStep free, std::span<Reaction> reactions) const;
    /// Adds the reactions that balance an impulse on the prescribed components of node `n` at `x`.
    /// `force` is the impulse divided by the length of the step, N.
    void add_reactions_to_impulse(std::size_t n, const Vec3& force, const Vec3& x,
                                  std::span<Reaction> reactions) const;
    /// Adds a force, N, along one axis on a node at `x` to the reaction of a constraint.
    void add_reaction(int constraint, int component, double force, const Vec3& x,
                      std::span<Reaction> reactions) const;
    void set_outer_forces(NodeRange range, std::span<const Vec3> positions, double time,
                          std::span<Vec3> forces) const;

    void save_state(ArchiveWriter& ar) const;
    void restore_state(ArchiveReader& ar, double time);
    NodeSums sums_of(NodeRange range) const;
    BodyView view() const { return {mesh_, fragments_, elements_, masses_, state_.positions()}; }
    void update_outer_terms();
    void constrain_fragments();
    void resize(std::size_t num_nodes);
    void gather(NodeId n);
    void follow(const BodyEdit& edit);
    void edit_elements(const fragments::FragmentChanges& changes);
    Momenta momenta_of(std::span<const NodeId> nodes) const;
    Momenta momenta_of_removed(const topology::ChangeSet& changes) const;
    std::vector<BodyEdit::Velocity> change_momenta(std::span<const NodeId> nodes,
                                                   const Momenta& by);

    const topology::Mesh& mesh_;
    fragments::FragmentMesh fragments_;
    std::uint64_t structure_version_ = 0;
    Workers workers_{1};
    ElementStore elements_;
    State state_;
    fragments::Embedding embedding_;
    double damping_;
    double body_size_;

    std::vector<Vec3> elastic_forces_, outer_forces_;
    std::vector<double> masses_;
    StableStep stable_step_;
    mutable KeptNodeSums node_sums_;
    Constraints constraints_;
    Loads loads_;
    std::vector<std::unique_ptr<ForceTerm>> added_terms_;
    std::vector<Reaction> reactions_;  // by constraint
    double external_work_ = 0.0, dissipated_energy_ = 0.0, largest_move_ = 0.0;
    std::vector<StepSums> step_sums_;        // scratch, by range of nodes
    std::vector<Reaction> range_reactions_;  // scratch, by range of nodes, then by constraint
    std::vector<ElementId> star_;            // scratch
    mutable std::vector<double> highest_of_ranges_;  // scratch of stable_step(), by range of nodes
    std::vector<Vec3> previous_positions_;           // scratch, of viscous bodies only
    std::vector<Vec3> previous_velocities_;          // from kick to drift, by node id
    std::vector<Vec3> impulses_;  // from kick to drift, by node id, N s; empty: none
    double impulse_work_ = 0.0;   // of the last step, J
    double response_to_impulses_ = 1.0;
};

}  // namespace incise::physics
