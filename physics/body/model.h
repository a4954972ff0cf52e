// The mechanical model of a body: its structure, its state and its boundary, and the forces that
// follow from them. It follows the edits of its mesh.
// Source: HEML 2015, section 3; docs/theory.md, Masses and time steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/archive.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/body/body_edit.h"
#include "incise/physics/body/boundary.h"
#include "incise/physics/body/energetics.h"
#include "incise/physics/body/momentum.h"
#include "incise/physics/body/structure.h"
#include "incise/physics/elements/state.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// A body with lumped masses at nodes, and elastic elements between them.
///
/// It has four parts. The structure is what the body is made of, and changes with edits. The state
/// is where it is, and changes with steps: see Integrator. The boundary is what acts on it from
/// outside. The energetics are sums over it.
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

    Model(const Model&) = delete;  // its parts refer to each other
    Model& operator=(const Model&) = delete;

    const Structure& structure() const { return structure_; }
    const State& state() const { return state_; }
    State& state() { return state_; }
    const Boundary& boundary() const { return boundary_; }
    Boundary& boundary() { return boundary_; }
    const Energetics& energetics() const { return energetics_; }
    Energetics& energetics() { return energetics_; }

    /// Sets the number of threads, at least 1. It does not change any result. A new model has one.
    void set_num_threads(int n) { workers_ = Workers(n); }
    const Workers& workers() const { return workers_; }
    Workers& workers() { return workers_; }

    const topology::Mesh& mesh() const { return structure_.mesh(); }
    const fragments::FragmentMesh& fragments() const { return structure_.fragments(); }
    std::span<const double> masses() const { return structure_.masses(); }    ///< kg
    std::span<const Vec3> positions() const { return state_.positions(); }    ///< m
    std::span<const Vec3> velocities() const { return state_.velocities(); }  ///< m/s
    /// Returns the elastic and viscous forces that were last computed, N.
    std::span<const Vec3> elastic_forces() const { return elastic_forces_; }

    /// Returns the positions, m, and velocities, m/s, of the nodes of the mesh, by id.
    /// @thread One thread at a time.
    /// @lifetime Until the model is stepped or edited.
    std::span<const Vec3> mesh_positions() const {
        return structure_.embedding().positions(state_.positions(), state_.version());
    }
    std::span<const Vec3> mesh_velocities() const {
        return structure_.embedding().velocities(state_.velocities(), state_.version());
    }
    /// Returns the elastic force on the material at each node of the mesh, N: its mass times the
    /// acceleration there by elastic forces. Cost: O(n).
    std::vector<Vec3> mesh_elastic_forces() const;
    /// Returns the largest distance of a node of the mesh from its rest position, m.
    double max_displacement() const;
    /// Returns a bound on the distance that a node of the mesh moved in the last step, m.
    double largest_mesh_move() const {
        return structure_.embedding().largest_gain() * state_.largest_move();
    }
    /// Returns the result of a fragment. It is that of each element of the mesh that the fragment
    /// carries: FragmentMesh::fragment_of_cell.
    ElementResult element_result(ElementId e) const {
        return structure_.elements()
            .block_of(fragments(), e)
            .result(e, positions(), state_.history());
    }

    /// Returns the least ratio of current over rest volume in an element: in a hexahedron, wedge or
    /// pyramid of HEML that of one of its tetrahedra. Else it is that of element_result().
    double least_volume_ratio(ElementId e) const {
        return structure_.elements().block_of(fragments(), e).least_volume_ratio(e, positions());
    }

    /// Replaces the state and computes its forces. Viscous elements treat the change as an
    /// instantaneous strain, so that they respond with their instantaneous moduli.
    /// @param positions   by node of the fragments, FragmentMesh::node_capacity() of them, m
    /// @param velocities  likewise, m/s
    /// @param time        the time for the loads, s
    void set_state(std::span<const Vec3> positions, std::span<const Vec3> velocities, double time);

    /// Computes the elastic, viscous and outer forces at the current state and at `time`, s.
    void compute_forces(double time);

    /// Computes in one pass what Energetics::totals(), Energetics::min_volume_ratio() and
    /// compute_forces() need of the elements. It saves time if both energies and forces are needed,
    /// as in a step with an edit. If an edit follows, compute_forces() computes the forces of the
    /// changed blocks again. All results are the same bit for bit as without this call.
    void compute_totals_and_forces();

    /// Advances the viscous history over a motion that the state has made. Returns the energy that
    /// viscosity dissipated, J; 0 without viscosity.
    /// @param before  the positions before the motion, m
    /// @param after   the positions after it, m
    /// @param dt      its duration, s; infinite in statics
    double advance_history(std::span<const Vec3> before, std::span<const Vec3> after, double dt);

    /// Returns the bound on explicit steps in the present positions, s. It is at most that at rest,
    /// and equal to it at small strain. It depends on nothing but the positions and the body.
    /// Source: docs/theory.md, Stable step.
    /// Cost: O(n), about that of the forces.
    /// @thread One thread at a time.
    double stable_step() const { return structure_.stable_step(state_, workers_); }

    /// Follows an edit of the mesh. The update is incremental. The result equals bit for bit a
    /// model that is built on the edited mesh and fragments with the same state and history.
    ///
    /// A copy of a node gets the state of that node. Fragments of an element inherit its fibres and
    /// its viscous history. So an edit that only divides elements changes no mass, momentum or
    /// energy, but for the elastic energy of divided cells that are no tetrahedra. Where a light
    /// fragment joins another one, its mass moves with the corners of the other one from now on:
    /// mass stays; linear and angular momentum are kept by a rigid change of the velocities of the
    /// nodes near the edit that have no constraint; energies and the centre of mass change a
    /// little: docs/theory.md, Fragments. Merged nodes keep their momentum.
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

    /// Replaces the materials. The body keeps positions, velocities and masses. The jump of its
    /// elastic energy counts as external work. Terms of a Prony series keep their stress where the
    /// new material has as many of the same rule; others begin without stress.
    /// Throws InputError, and changes nothing, for another density in a region, and as ElementStore
    /// does. Cost: O(n), that of a new model.
    /// @param table  its fibres are by id of fragments
    /// @param time   for the forces, s
    void set_materials(MaterialTable table, double time);
    /// Takes the added force terms of a model that this one replaces, and computes the forces anew:
    /// for a model that was just read from an archive. Changes nothing if a term throws.
    /// Cost: O(n).
    void take_force_terms(Model& former, double time);

    /// Returns a number that grows when the structure or the boundary changes.
    std::uint64_t version() const { return structure_.version() + boundary_.version(); }

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

  private:
    /// The fragments of a mesh, and the materials with the fibres by fragment: a fragment has those
    /// of its lowest cell.
    struct Fragmented {
        Fragmented(const topology::Mesh& mesh, const MaterialTable& of_mesh,
                   std::span<const Constraint> constraints);
        fragments::FragmentMesh fragments;
        MaterialTable table;
    };
    Model(const topology::Mesh& mesh, Fragmented body, BoundaryConditions boundary_conditions);

    void save_state(ArchiveWriter& ar) const;
    void restore_state(ArchiveReader& ar, double time);
    void follow(const BodyEdit& edit);
    Momenta momenta_of(std::span<const NodeId> nodes) const;
    Momenta momenta_of_removed(const topology::ChangeSet& changes) const;
    std::vector<BodyEdit::Velocity> change_momenta(std::span<const NodeId> nodes,
                                                   const Momenta& by);

    Workers workers_{1};
    Structure structure_;
    State state_;
    Boundary boundary_;
    Energetics energetics_;
    std::vector<Vec3> elastic_forces_;
};

}  // namespace incise::physics
