// The body in motion: state, masses, forces, integrator. It follows the mesh through edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/physics/body/constraints.h"
#include "incise/physics/body/force_term.h"
#include "incise/physics/body/loads.h"
#include "incise/physics/body/node_lanes.h"
#include "incise/physics/body/node_sums.h"
#include "incise/physics/elements/element_store.h"
#include "incise/physics/elements/stable_step.h"
#include "incise/physics/elements/state.h"
#include "incise/topology/change_set.h"
#include "incise/topology/follower.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// What acts on a body besides its own elasticity.
struct BoundaryConditions {
    Vec3 gravity = Vec3::Zero();  ///< m/s2
    double damping = 0.0;         ///< mass-proportional, 1/s
    std::vector<Constraint> constraints;
    std::vector<Load> loads;
};

/// Totals over the body. Angular momentum is about the origin.
struct Totals {
    double mass = 0.0;            ///< kg
    double rest_volume = 0.0;     ///< m3
    double kinetic_energy = 0.0;  ///< J, of the velocities as they stand
    double elastic_energy = 0.0;  ///< J; of viscous elements that of the long-time moduli
    double gravity_energy = 0.0;  ///< J, zero at the origin
    Vec3 momentum = Vec3::Zero();
    Vec3 angular_momentum = Vec3::Zero();
    Vec3 centre_of_mass = Vec3::Zero();  ///< m
    static void archive(auto& ar, auto& self) {
        ar(self.mass, self.rest_volume, self.kinetic_energy, self.elastic_energy,
           self.gravity_energy, self.momentum, self.angular_momentum, self.centre_of_mass);
    }
};

/// What a constraint does to the body: force, N, and moment about the constraint's point, N m.
struct Reaction {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();

    Reaction& operator+=(const Reaction& o) {
        force += o.force;
        moment += o.moment;
        return *this;
    }
    static void archive(auto& ar, auto& self) { ar(self.force, self.moment); }
};

/// Lumped masses at the nodes of a mesh, elastic elements between them. All arrays are indexed by
/// node id; slots of dead nodes keep their last values, so that an undone edit finds them again.
class Model {
  public:
    /// Starts at rest in the rest positions, with the forces of that state.
    /// @param mesh must outlive the model, which reads it and never changes it
    /// Throws InputError: see ElementStore, Constraints.
    Model(const topology::Mesh& mesh, const MaterialTable& table,
          BoundaryConditions boundary_conditions = {});

    /// Goes on from what save() has written of a model of this mesh.
    /// @param table  of that model; its fibres come from the archive
    /// @param time   of the state, s
    /// To the bit the same model then.
    /// Throws InputError for the data of another mesh. Cost: that of a new model.
    Model(const topology::Mesh& mesh, MaterialTable table, ArchiveReader& ar, double time);

    /// How many threads compute, at least 1; of no influence on any result. At first one.
    void set_num_threads(int n) { workers_ = Workers(n); }
    int num_threads() const { return workers_.num_threads(); }

    const State& state() const { return state_; }
    std::span<const Vec3> positions() const { return state_.positions(); }    ///< m
    std::span<const Vec3> velocities() const { return state_.velocities(); }  ///< m/s
    std::span<const Vec3> elastic_forces() const { return elastic_forces_; }  ///< N
    std::span<const double> masses() const { return masses_; }                ///< kg

    /// Replaces the state; sizes are those of node_capacity. The forces follow. Viscous elements
    /// take it for an instantaneous strain, to which the moduli as entered answer.
    void set_state(std::span<const Vec3> positions, std::span<const Vec3> velocities, double time);

    /// What viscous elements remember; empty if there are none. Like the positions it belongs to
    /// the state: integrate() brings it to the positions that it leaves.
    const ViscousHistory& history() const { return state_.history(); }
    /// Replaces it after set_state(); values as of history().values(). Forces are those of before
    /// until compute_forces is called.
    void set_history(std::span<const double> values) { state_.change().history.set_values(values); }

    /// Elastic, viscous and outer forces at the present positions and `time`: functions of these
    /// and of the history as it stands.
    void compute_forces(double time);

    /// Does the work of totals() and min_volume_ratio() and, on elements that no edit touches
    /// before it is called, of compute_forces() in one pass: for who needs both, as an edit's books
    /// and the step around it do. Results are to the bit what they are without.
    void compute_totals_and_forces();

    /// One step of semi-implicit Euler, from the forces last computed:
    /// v += dt f / m, damped implicitly; x += dt v. Supported components go to where they have
    /// to be at time + dt. Source: HEML 2015, eq. (32).
    /// Throws MotionFailure, naming an element, the time and the likely cause, if the state is no
    /// longer finite or a node has moved by more than the body's size in this step.
    void integrate(double time, double dt);
    /// The same step in two stages, between which somebody else may change the velocities. The
    /// first: velocities of the end of the step, those of prescribed components too; the second:
    /// positions and all else. With nothing between them the bits are those of integrate().
    void kick(double time, double dt);
    /// Changes the velocities of free components between kick() and drift().
    /// @param impulses N s, by node id. Work of their mean power counts as external; those on
    ///                 prescribed components change the reaction of their constraints instead
    void give_impulses(std::span<const Vec3> impulses);
    void drift(double time, double dt);

    /// For implicit integration and statics, which find the end of a step by themselves and hand it
    /// over. A step may come in several parts: begin_step() goes before the first.
    void begin_step();
    /// Goes to the given positions and velocities (m, m/s, by node id), dt after the present ones;
    /// infinite in statics. Viscous elements follow, whose energy comes back, J; forces are those
    /// of before until compute_forces is called.
    /// @param reactions of constraints on their nodes, N, by node id, zero in free components
    double take_step(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                     std::span<const Vec3> reactions, double dt);
    /// Adds to external_work() and dissipated_energy(), J.
    void record_work(double external_work, double dissipated_energy);

    /// Follows an edit of the mesh; incremental, and equal bit for bit to a model built afresh on
    /// the edited mesh with the same state and history. Copied nodes copy their state, a node
    /// between others takes a mean of theirs with the weights of the record, merged ones keep
    /// momentum. Dividing an edge from a to b at (1 - t) a + t b keeps mass, momentum, centre of
    /// mass and the elastic energy of all laws (not of springs), but lumped masses lose angular
    /// momentum m t (1 - t) (x_b - x_a) x (v_b - v_a) and kinetic energy m t (1 - t) |v_b - v_a|^2
    /// / 2, m being a quarter of the mass of the elements round the edge. Parts of an element
    /// inherit its fibres and its history of viscosity. The inverse of an edit, applied before
    /// anything moved, gives the former state back to the bit. Forces are those of before until
    /// compute_forces is called. Throws InputError for a change out of turn. Cost: proportional to
    /// the stars touched.
    /// @param mesh  of the model
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Adds a constraint at the end of the list. Throws InputError, and changes nothing, if it
    /// prescribes what another one does. Cost: O(#nodes) of it.
    void add_constraint(Constraint constraint);
    /// Removes constraint `i`; those behind it move up. Cost: O(n) in the nodes of all constraints.
    void remove_constraint(std::size_t i);
    /// Gives the grip of constraint `i` another way; see Constraint::grip.
    void set_grip(std::size_t i, TimeCurve<Pose> grip) {
        constraints_.set_grip(i, std::move(grip));
    }

    /// Adds a load at the end of the list. Forces are those of before until compute_forces is
    /// called, as with the next two.
    void add_load(Load load);
    /// Removes load `i`; those behind it move up.
    void remove_load(std::size_t i);
    /// Gives load `i` another factor of time.
    void set_load_factor(std::size_t i, TimeCurve<double> factor) {
        loads_.set_factor(i, std::move(factor));
    }
    const Loads& loads() const { return loads_; }

    /// Adds a term to the forces from outside. Archives do not hold it: who restores a model adds
    /// it again. Cost: O(n), for the stable step.
    void add_force_term(std::unique_ptr<ForceTerm> term);
    /// Takes the added terms of a model that this one replaces, and computes the forces anew: for
    /// a model that was just read from an archive. Cost: O(n).
    void take_force_terms(Model& former, double time);

    /// Everything but the mesh and the materials: state, history, work, reactions, fibres,
    /// constraints and loads. Cost: O(n).
    void save(ArchiveWriter& ar) const;

    const ElementStore& elements() const { return elements_; }
    const Constraints& constraints() const { return constraints_; }
    double damping() const { return damping_; }  ///< 1/s
    double size() const { return body_size_; }   ///< diagonal of the box around it at the start, m
    std::span<const Vec3> outer_forces() const {
        return outer_forces_;
    }  ///< N, of loads, gravity and added terms
    /// Sets `forces` (N, by node id) to those from outside at other positions (m) and `time`.
    /// @pre compute_forces or begin_step was called since the last edit
    void outer_forces_at(std::span<const Vec3> positions, double time,
                         std::span<Vec3> forces) const;
    /// See ForceTerm::visit_tangents; @pre likewise.
    void visit_outer_tangents(std::span<const Vec3> positions, double time,
                              TangentSink& sink) const;
    /// J; of viscous elements that of the long-time moduli.
    double elastic_energy() const;
    /// Grows with every change of what the body consists of: edits (undone ones count twice),
    /// constraints and loads that are added or removed.
    std::uint64_t structure_version() const { return structure_version_; }

    /// How far the fastest node went in the last step, m.
    double largest_move() const { return largest_move_; }

    /// Bound on dt at rest, seconds; see StableStep. With damping the bound only grows.
    double stable_step() const { return stable_step_.value(); }

    /// What bounds the stiffness of a living node at rest, by which the stable step is found, N/m.
    double stiffness_bound(std::size_t node) const {
        return stable_step_.quotient(node) * masses_[node];
    }

    /// The same bound for the element alone, were its nodes no other's, seconds.
    double element_stable_step(ElementId e) const;

    /// The element with the lowest id at the node that sets the stable step.
    ElementId limiting_element() const {
        return mesh_.incident_element(NodeId(stable_step_.limiting_node()));
    }
    /// Energy that a strain of the order of one would take, J: what rounding errors of the elastic
    /// energy are small against.
    double stiffness_energy() const;

    /// Not by several threads at the same time. Cost: O(#nodes + #elements) after nodes have moved;
    /// after an edit without that what it touched, and a look at each range and block.
    Totals totals() const;
    double min_volume_ratio() const;
    /// Present volume over that at rest, less 1. Not a number without elements.
    double volume_change() const;
    /// Of the node that is farthest from where it is at rest, m.
    double max_displacement() const;
    ElementResult element_result(ElementId e) const {
        return elements_.block_of(mesh_, e).result(e, positions(), history());
    }

    /// By element id, the direction of the fibres at rest, zero where there are none; empty if no
    /// material has fibres. Parts of a divided element have that of the whole.
    std::span<const Vec3> fibres() const { return elements_.fibres(); }

    /// Density of what the elements of a region are made of, kg/m3.
    double density(int region) const { return elements_.density(region); }

    /// Work since the start, joules: of gravity, loads and constraints; and what damping and
    /// viscosity took. What viscous elements can still give back counts as taken until they do.
    double external_work() const { return external_work_; }
    double dissipated_energy() const { return dissipated_energy_; }

    std::size_t num_constraints() const { return constraints_.size(); }
    const std::string& constraint_name(std::size_t i) const { return constraints_.name(i); }
    /// What each constraint did to the body during the last step.
    std::span<const Reaction> reactions() const { return reactions_; }

    const topology::Mesh& mesh() const { return mesh_; }

  private:
    struct NodeStep {
        Vec3 x, v;    ///< at its end
        double work;  ///< that constraints do, J
    };
    /// Takes the body through a step by move_range(range, reactions), which returns the sums of its
    /// nodes and adds to the reactions of all constraints; then adds up, and viscosity follows.
    template <class MoveRange>
    void step_ranges(double time, double dt, MoveRange move_range);
    /// Integrates the nodes of a range, which touches no others.
    /// @param reactions of all constraints; added to
    StepSums move_nodes(NodeRange range, const State::Values& values, double time, double dt,
                        std::span<Reaction> reactions);
    /// Likewise one that is alive.
    /// @param slowing 1/(1 + damping dt)
    StepSums move_node(std::size_t n, const State::Values& values, double time, double dt,
                       double slowing, std::span<Reaction> reactions);
    /// How many nodes from the given one on, a multiple of nodes_together, are alive and held by
    /// nothing, before `end`.
    std::size_t num_free_nodes(std::size_t n, std::size_t end) const;
    /// Leads the constrained components of node `n` to where they have to be at time + dt.
    /// @param v     m/s, of the beginning of the step
    /// @param free  what the node does without constraints
    /// @param force N, on the node without the constraints
    NodeStep constrain_node(std::size_t n, const Vec3& v, double time, double dt, const Vec3& force,
                            NodeStep free, std::span<Reaction> reactions) const;
    /// Constraints also bear what an impulse does to prescribed components: `force`, N, over the
    /// step.
    void add_reactions_to_impulse(std::size_t n, const Vec3& force, const Vec3& x,
                                  std::span<Reaction> reactions) const;
    /// Adds what a constraint does to a component of a node at x, N, to its reaction.
    void add_reaction(int constraint, int component, double force, const Vec3& x,
                      std::span<Reaction> reactions) const;
    void set_outer_forces(NodeRange range, std::span<const Vec3> positions, double time,
                          std::span<Vec3> forces) const;

    void restore_state(ArchiveReader& ar, double time);
    NodeSums sums_of(NodeRange range) const;
    BodyView view() const { return {mesh_, elements_, masses_}; }
    void update_outer_terms();
    void resize(std::size_t num_nodes);
    void gather(NodeId n);
    std::vector<NodeId> touched_nodes(const topology::ChangeSet& changes) const;
    void edit_elements(const topology::ChangeSet& changes);

    const topology::Mesh& mesh_;
    topology::FollowedEpoch epoch_;
    std::uint64_t structure_version_ = 0;
    Workers workers_{1};
    ElementStore elements_;
    State state_;
    double damping_;
    double body_size_;

    std::vector<Vec3> elastic_forces_, outer_forces_;
    std::vector<double> masses_;
    StableStep stable_step_;
    mutable KeptNodeSums node_sums_;
    Constraints constraints_;
    Loads loads_;
    std::vector<std::unique_ptr<ForceTerm>> added_terms_;
    std::vector<Reaction> reactions_;  // of each constraint
    double external_work_ = 0.0, dissipated_energy_ = 0.0, largest_move_ = 0.0;
    std::vector<StepSums> step_sums_;        // scratch, by range of nodes
    std::vector<Reaction> range_reactions_;  // scratch, of all constraints by range of nodes
    std::vector<ElementId> star_;            // scratch
    std::vector<Vec3> previous_positions_;   // scratch, of viscous bodies only
    std::vector<Vec3> previous_velocities_;  // from kick to drift, by node id
    std::vector<Vec3> impulses_;             // likewise, N s; empty: none
};

}  // namespace incise::physics
