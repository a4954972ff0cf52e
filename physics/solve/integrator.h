// How a body gets from one moment to the next: explicitly, implicitly, or from one equilibrium to
// the next.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/physics/solve/newton.h"

namespace incise::physics {

class Integrator {
  public:
    virtual ~Integrator() = default;

    /// Takes the body from `time` to time + dt, s. Forces are then to be computed.
    /// Throws PhysicsError if there is no way.
    virtual void step(Model& model, double time, double dt) = 0;
    /// Called after the edits of a step, `time` being its end. Whether it has moved the body.
    virtual bool equilibrate(Model&, double /*time*/) { return false; }

    /// What it keeps from step to step, for one that goes on with a restored model; most keep
    /// nothing.
    virtual void save(ArchiveWriter&) const {}
    virtual void restore(ArchiveReader&, const Model&) {}
};

/// Changes velocities between the two stages of an explicit step, as contact does.
class VelocityProjection {
  public:
    virtual ~VelocityProjection() = default;
    /// Gives impulses to the nodes of the model, whose velocities are those of the end of the step,
    /// from `time` to time + dt, s: see Model::give_impulses.
    virtual void project(Model& model, double time, double dt) = 0;
};

/// Semi-implicit Euler, in steps below the bound of stability. A step has the stages kick, project
/// and drift; without projections it is one pass over the nodes: Model::integrate.
class SemiImplicitEuler final : public Integrator {
  public:
    void step(Model& model, double time, double dt) override;
    /// They act in the order in which they are added.
    void add_projection(std::unique_ptr<VelocityProjection> projection) {
        projections_.push_back(std::move(projection));
    }

  private:
    std::vector<std::unique_ptr<VelocityProjection>> projections_;
};

/// Implicit (backward) Euler: x' = x + dt v', m (v' - v)/dt = f(x', v'), with the forces, viscous
/// and damping ones too, of the end of the step. Stable at any dt; of first order; it damps what
/// changes faster than dt. Steps that Newton's method does not solve are halved, up to ten times.
/// Books: loads and constraints work with their forces of the end of the step, and what the rule
/// takes from the energy by itself counts as dissipated.
class ImplicitEuler final : public Integrator {
  public:
    void step(Model& model, double time, double dt) override;

  private:
    void part_of_step(Model& model, double time, double dt, int halvings);

    NewtonSolver newton_{false};
    std::vector<Vec3> x_, velocities_, predicted_positions_, elastic_, outer_,
        reactions_;  // by node id
};

/// Equilibrium at each moment: no inertia, no velocities, viscosity relaxed. From one moment to the
/// next in one increment, or where Newton's method fails in smaller ones: constraints and loads go
/// with the time, and what was out of balance before (after a cut, or under loads that are there
/// from the start) is let go in proportion. Its work counts as dissipated. Pieces that can move
/// freely stay where they are; they must be in equilibrium under their loads.
class Statics final : public Integrator {
  public:
    void step(Model& model, double time, double dt) override;
    /// To the equilibrium of the edited body.
    bool equilibrate(Model& model, double time) override;
    void save(ArchiveWriter& ar) const override { newton_.save(ar); }
    void restore(ArchiveReader& ar, const Model& model) override { newton_.restore(ar, model); }

  private:
    void require_equilibrium_of_free_components(const Model& model, double time);
    /// The components of a force that no constraint takes.
    Vec3 free_part(std::size_t node, const Vec3& force) const;
    /// Moves the body to x_ and records the work of the increment.
    /// @param from  share of the load step before the increment, from 0 to 1
    /// @param to    share of the load step after it
    void take_increment(Model& model, double from, double to);

    NewtonSolver newton_{true};
    std::uint64_t structure_version_ = 0;  // of the model, at the last equilibrium
    std::vector<Vec3> x_, velocities_, elastic_, outer_, reactions_, holding_, imbalance_,
        next_elastic_, next_outer_;  // by node id
};

}  // namespace incise::physics
