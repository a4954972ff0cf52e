// One step of symplectic (semi-implicit) Euler, in one pass over the nodes or in stages.
// Source: HEML 2015, eq. (32); docs/theory.md, Masses and time steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/physics/solve/node_lanes.h"

namespace incise::physics {

/// Explicit steps of a body: v += dt f / m, damped implicitly; x += dt v. Prescribed components
/// move to their targets at the end of the step. It keeps arrays from step to step, so that a step
/// takes no memory; otherwise steps do not depend on each other.
///
/// All functions take the body, the beginning of the step, s, and its length, s. The forces are
/// those last computed.
class ExplicitStep {
  public:
    /// Makes the step in one pass.
    /// Throws MotionFailure if the state is no longer finite, or if a node has moved by more than
    /// Structure::size() in this step. The message names an element, the time and the likely cause.
    void move(Model& model, double time, double dt);

    /// Makes the first of two stages that together equal move(): sets the velocities to those of
    /// the end of the step. The velocities may be changed before the second stage, drift(). Without
    /// such changes, the results are those of move() bit for bit.
    void kick(Model& model, double time, double dt);
    /// Changes the velocities of free components between kick() and drift(). The work of an impulse
    /// counts as external; it is the impulse times the mean of the velocities before and after the
    /// step. An impulse on a prescribed component changes the reaction of the constraint instead.
    /// Damping acts on what an impulse does as on what a force does; see response_to_impulses().
    /// @param model     the body
    /// @param impulses  N s, by node id
    void give_impulses(Model& model, std::span<const Vec3> impulses);
    /// Returns the change of velocity by an impulse between kick() and drift(), times the mass of
    /// the node over the impulse: 1 without damping.
    double response_to_impulses() const { return response_to_impulses_; }
    /// Makes the second stage of the step: sets the positions and everything else. It throws as
    /// move() does.
    /// @pre  kick() was called with the same arguments
    void drift(Model& model, double time, double dt);

  private:
    /// Makes a step by calls of move_range(range, reactions), which returns the sums over the nodes
    /// of the range and adds to the reactions of all constraints. Then adds up the ranges and
    /// advances the viscous history.
    template <class MoveRange>
    void move_ranges(Model& model, double time, double dt, MoveRange move_range);

    std::vector<StepSums> sums_;             // scratch, by range of nodes
    std::vector<Reaction> range_reactions_;  // scratch, by range of nodes, then by constraint
    std::vector<Vec3> previous_positions_;   // scratch, of viscous bodies only
    std::vector<Vec3> previous_velocities_;  // from kick to drift, by node id
    std::vector<Vec3> impulses_;             // from kick to drift, by node id, N s; empty: none
    double response_to_impulses_ = 1.0;
};

/// Changes the velocities of free components by those that the forces last computed bring about in
/// a time, s, which may be below 0.
void shift_velocities(Model& model, double time);

}  // namespace incise::physics
