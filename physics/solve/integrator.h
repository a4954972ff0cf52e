// Integrators, which move a body from one moment to the next: explicit steps, implicit steps, and
// statics. Equations: docs/theory.md, Masses and time steps, Implicit steps and statics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/physics/solve/newton.h"

namespace incise::physics {

/// A method that moves a body from one moment to the next.
class Integrator {
  public:
    virtual ~Integrator() = default;

    /// Moves the body from `time` to time + dt, s. The forces of the new state are not computed:
    /// call Model::compute_forces afterwards. Throws MotionFailure if the step fails.
    virtual void step(Model& model, double time, double dt) = 0;
    /// Moves the body to its equilibrium after the edits of a step, in statics only. `time` is the
    /// end of the step, s. Returns true if it did so.
    virtual bool equilibrate(Model&, double /*time*/) { return false; }

    /// Save and restore the state that the integrator keeps from step to step, to continue with a
    /// restored model. Most integrators keep none.
    virtual void save(ArchiveWriter&) const {}
    virtual void restore(ArchiveReader&, const Model&) {}
};

/// A change of velocities between the two stages of an explicit step, for example by contact.
class VelocityProjection {
  public:
    virtual ~VelocityProjection() = default;
    /// Looks at the body before a step. Returns false if it will give no impulses in the step.
    virtual bool prepare(const Model& /*model*/, double /*time*/, double /*dt*/) { return true; }
    /// Gives impulses to nodes of the model; see ExplicitStep::give_impulses. The step is from
    /// `time` to time + dt, s, and the velocities of the model are those of its end.
    virtual void project(Model& model, ExplicitStep& step, double time, double dt) = 0;
};

/// Symplectic Euler, for steps below the stable step. A step has the stages kick, project and
/// drift. If no projection will give impulses, it is one pass over the nodes: ExplicitStep::move.
///
/// Velocities are those in the middle of the step before. So where a step differs in length from
/// the one before, the forces act over the mean of both. Source: docs/theory.md, Masses and time
/// steps.
class SemiImplicitEuler final : public Integrator {
  public:
    void step(Model& model, double time, double dt) override;
    void save(ArchiveWriter& ar) const override;
    void restore(ArchiveReader& ar, const Model& model) override;
    /// Adds a projection. Projections act in the order in which they are added.
    /// @lifetime The projection must outlive the integrator.
    void add_projection(VelocityProjection& projection) { projections_.push_back(&projection); }

  private:
    std::vector<VelocityProjection*> projections_, acting_;  // all, and those of a step
    ExplicitStep step_;
    double dt_ = 0.0;  // of the step before, s; 0: none
};

/// Implicit (backward) Euler: x' = x + dt v', m (v' - v)/dt = f(x', v'). The forces f are those of
/// the end of the step, with viscosity and damping. The method has first order, is stable at any
/// dt, and damps motions that change faster than dt. A step that Newton's method does not solve is
/// halved, up to ten times.
///
/// External work is computed with the forces of loads and constraints at the end of the step. The
/// energy that the method itself removes counts as dissipated.
class ImplicitEuler final : public Integrator {
  public:
    void step(Model& model, double time, double dt) override;

  private:
    void substep(Model& model, double time, double dt, int halvings);

    NewtonSolver newton_{false};
    std::vector<Vec3> x_, velocities_, predicted_positions_, elastic_, outer_,
        reactions_;  // by node id
};

/// Equilibrium at each moment, without inertia and velocities, with the long-time moduli.
///
/// A step is one increment. If Newton's method fails, it is several smaller ones. Constraints and
/// loads follow the time within the step. Forces that are out of balance at the beginning, after a
/// cut or under loads present from the start, are released in proportion. Their work counts as
/// dissipated. Free components stay where they are, and must be in equilibrium under their loads.
class Statics final : public Integrator {
  public:
    void step(Model& model, double time, double dt) override;
    /// Moves the body to its equilibrium. Returns false, and does nothing, if the structure of the
    /// model has not changed since the last step.
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
