// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/explicit_step.h"

#include <algorithm>
#include <cmath>

#include "incise/physics/body/motion_failure.h"

namespace incise::physics {

namespace {

/// The motion of one node in a step.
struct NodeStep {
    Vec3 x, v;    ///< at the end of the step, m and m/s
    double work;  ///< of constraints, J
};

/// What moves the nodes of a body in one step.
class NodeMover {
  public:
    NodeMover(Model& model, double time, double dt)
        : structure_(model.structure()),
          boundary_(model.boundary()),
          values_(model.state().change()),
          masses_(model.masses()),
          elastic_forces_(model.elastic_forces()),
          outer_forces_(model.boundary().outer_forces()),
          time_(time),
          dt_(dt),
          damping_(boundary_.damping()) {}

    /// Moves the nodes of a range, and no others. Adds to `reactions`, those of all constraints.
    StepSums move_nodes(NodeRange range, std::span<Reaction> reactions) const;
    /// Gives the nodes of a range their velocities at the end of the step.
    void kick(NodeRange range) const;
    /// Moves one node with the velocity that it has now.
    /// @param n                  the node
    /// @param previous_velocity  at the beginning of the step, m/s
    /// @param impulse            since kick(), N s
    /// @param reactions          of all constraints; added to
    StepSums drift(std::size_t n, const Vec3& previous_velocity, const Vec3& impulse,
                   std::span<Reaction> reactions) const;

  private:
    double slowing() const { return 1.0 / (1.0 + damping_ * dt_); }
    bool is_dead(std::size_t n) const { return masses_[n] == 0.0; }
    const std::array<int, 3>* constraint_of(std::size_t n) const {
        return boundary_.constraints().of_node(n);
    }
    /// Returns the number of consecutive nodes from `n` on, before `end`, that are alive and have
    /// no constraint, rounded down to a multiple of nodes_together.
    std::size_t num_free_nodes(std::size_t n, std::size_t end) const;
    StepSums move_node(std::size_t n, double slowing, std::span<Reaction> reactions) const;
    /// Moves the prescribed components of a node to their targets at the end of the step.
    /// @param n          the node
    /// @param v          velocity at the beginning of the step, m/s
    /// @param force      force on the node without constraints, N
    /// @param free       motion of the node without constraints
    /// @param reactions  of all constraints; added to
    NodeStep constrain_node(std::size_t n, const Vec3& v, const Vec3& force, NodeStep free,
                            std::span<Reaction> reactions) const;
    /// Adds the reactions that balance an impulse on the prescribed components of node `n` at `x`.
    /// `force` is the impulse divided by the length of the step, N.
    void add_reactions_to_impulse(std::size_t n, const Vec3& force, const Vec3& x,
                                  std::span<Reaction> reactions) const;

    const Structure& structure_;
    const Boundary& boundary_;
    State::Values values_;
    std::span<const double> masses_;
    std::span<const Vec3> elastic_forces_, outer_forces_;
    double time_, dt_, damping_;
};

StepSums NodeMover::move_nodes(NodeRange range, std::span<Reaction> reactions) const {
    const double slowing = this->slowing();
    StepSums sums;
    for (std::size_t n = range.begin; n < range.end;) {
        if (const std::size_t count = num_free_nodes(n, range.end)) {
            sums += move_free_nodes({&masses_[n], &elastic_forces_[n], &outer_forces_[n],
                                     &values_.positions[n], &values_.velocities[n]},
                                    count, dt_, slowing);
            n += count;
            continue;
        }
        const std::size_t end = std::min(n + nodes_together, range.end);
        for (; n < end; ++n)
            if (!is_dead(n)) sums += move_node(n, slowing, reactions);
    }
    return sums;
}

std::size_t NodeMover::num_free_nodes(std::size_t n, std::size_t end) const {
    std::size_t count = 0;
    for (std::size_t i = n; i < end && !is_dead(i) && !constraint_of(i); ++i) ++count;
    return count - count % nodes_together;
}

// The sums are returned by value, so that they stay in registers.
StepSums NodeMover::move_node(std::size_t n, double slowing, std::span<Reaction> reactions) const {
    const double mass = masses_[n];
    const Vec3 x = values_.positions[n], v = values_.velocities[n];
    const Vec3 outer = outer_forces_[n], force = elastic_forces_[n] + outer;
    NodeStep step;
    step.v = slowing * (v + dt_ / mass * force);
    step.x = x + dt_ * step.v;
    step.work = 0.0;
    if (constraint_of(n)) step = constrain_node(n, v, force, step, reactions);
    values_.positions[n] = step.x;
    values_.velocities[n] = step.v;
    const double square = step.v.squaredNorm();
    return {.work = step.work + outer.dot(step.x - x),
            .impulse_work = 0.0,
            .mass_times_square = mass * square,
            .largest_square = square};
}

NodeStep NodeMover::constrain_node(std::size_t n, const Vec3& v, const Vec3& force, NodeStep step,
                                   std::span<Reaction> reactions) const {
    const auto& constraint = *constraint_of(n);
    const double mass = masses_[n];
    const Vec3& x = values_.positions[n];
    boundary_.constraints().prescribe(constraint, structure_.fragments(), NodeId(n), time_ + dt_,
                                      step.x);
    for (int c = 0; c < 3; ++c) {
        const int s = constraint[static_cast<std::size_t>(c)];
        if (s < 0) continue;
        step.v[c] = (step.x[c] - x[c]) / dt_;
        const double reaction = mass * ((step.v[c] - v[c]) / dt_ + damping_ * step.v[c]) - force[c];
        boundary_.add_reaction(s, c, reaction, step.x, reactions);
        // The inertial part of the reaction does its work at the mean velocity, (v + v')/2. If a
        // constraint starts to move a node at once, this is exactly the kinetic energy of the node.
        step.work +=
            reaction * (step.x[c] - x[c]) - 0.5 * mass * (step.v[c] - v[c]) * (step.v[c] - v[c]);
    }
    return step;
}

void NodeMover::kick(NodeRange range) const {
    const double slowing = this->slowing();
    for (std::size_t n = range.begin; n < range.end; ++n) {
        if (is_dead(n)) continue;
        const Vec3 force = elastic_forces_[n] + outer_forces_[n];
        Vec3& v = values_.velocities[n];
        v = slowing * (v + dt_ / masses_[n] * force);
        const auto* constraint = constraint_of(n);
        if (!constraint) continue;
        const Vec3& x = values_.positions[n];
        Vec3 target = x + dt_ * v;
        boundary_.constraints().prescribe(*constraint, structure_.fragments(), NodeId(n),
                                          time_ + dt_, target);
        for (int c = 0; c < 3; ++c)
            if ((*constraint)[static_cast<std::size_t>(c)] >= 0) v[c] = (target[c] - x[c]) / dt_;
    }
}

StepSums NodeMover::drift(std::size_t n, const Vec3& previous_velocity, const Vec3& impulse,
                          std::span<Reaction> reactions) const {
    if (is_dead(n)) return {};
    const Vec3 x = values_.positions[n], outer = outer_forces_[n];
    NodeStep step{x + dt_ * values_.velocities[n], values_.velocities[n], 0.0};
    Vec3 free_impulse = impulse;
    if (const auto* constraint = constraint_of(n)) {
        for (int c = 0; c < 3; ++c)
            if ((*constraint)[static_cast<std::size_t>(c)] >= 0) free_impulse[c] = 0.0;
        step = constrain_node(n, previous_velocity, elastic_forces_[n] + outer, step, reactions);
        add_reactions_to_impulse(n, impulse / dt_, step.x, reactions);
    }
    values_.positions[n] = step.x;
    values_.velocities[n] = step.v;
    const double square = step.v.squaredNorm();
    const double of_impulse = 0.5 * free_impulse.dot(previous_velocity + step.v);
    // What impulses do on prescribed components is part of the work of the constraint.
    const double of_prescribed = (impulse - free_impulse).dot(step.v);
    return {.work = step.work + outer.dot(step.x - x) + of_impulse,
            .impulse_work = of_impulse + of_prescribed,
            .mass_times_square = masses_[n] * square,
            .largest_square = square};
}

void NodeMover::add_reactions_to_impulse(std::size_t n, const Vec3& force, const Vec3& x,
                                         std::span<Reaction> reactions) const {
    const auto& constraint = *constraint_of(n);
    for (int c = 0; c < 3; ++c)
        if (const int s = constraint[static_cast<std::size_t>(c)]; s >= 0 && force[c] != 0.0)
            boundary_.add_reaction(s, c, -force[c], x, reactions);
}

}  // namespace

void ExplicitStep::move(Model& model, double time, double dt) {
    const NodeMover mover(model, time, dt);
    move_ranges(model, time, dt, [&](NodeRange range, std::span<Reaction> reactions) {
        return mover.move_nodes(range, reactions);
    });
}

template <class MoveRange>
void ExplicitStep::move_ranges(Model& model, double time, double dt, MoveRange move_range) {
    const std::size_t num_nodes = model.masses().size(), num_ranges = num_node_ranges(num_nodes);
    const std::size_t num_constraints = model.boundary().constraints().size();
    const bool is_viscous = !model.state().history().is_empty();
    sums_.assign(num_ranges, {});
    range_reactions_.assign(num_ranges * num_constraints, {});
    if (is_viscous) previous_positions_.resize(num_nodes);
    model.workers().for_each_range(num_nodes, [&](NodeRange range) {
        if (is_viscous)
            for (std::size_t n = range.begin; n < range.end; ++n)
                previous_positions_[n] = model.positions()[n];
        sums_[range.number] = move_range(
            range,
            std::span(range_reactions_).subspan(range.number * num_constraints, num_constraints));
    });
    StepSums sums;
    for (const StepSums& range : sums_) sums += range;
    model.boundary().clear_reactions();
    const std::span<Reaction> reactions = model.boundary().reactions();
    for (std::size_t i = 0; i < range_reactions_.size(); ++i)
        reactions[i % num_constraints] += range_reactions_[i];
    Energetics& energetics = model.energetics();
    energetics.set_impulse_work(sums.impulse_work);
    energetics.record_work(sums.work, model.boundary().damping() * sums.mass_times_square * dt);
    const double largest_move = std::sqrt(sums.largest_square) * dt;
    model.state().set_largest_move(largest_move);
    if (!sums.is_finite() || largest_move > model.structure().size())
        throw failure_of_step(model, time, dt);
    energetics.record_work(0.0, model.advance_history(previous_positions_, model.positions(), dt));
}

void ExplicitStep::kick(Model& model, double time, double dt) {
    const auto velocities = model.velocities();
    previous_velocities_.assign(velocities.begin(), velocities.end());
    impulses_.clear();
    response_to_impulses_ = 1.0 / (1.0 + model.boundary().damping() * dt);
    const NodeMover mover(model, time, dt);
    model.workers().for_each_range(previous_velocities_.size(),
                                   [&](NodeRange range) { mover.kick(range); });
}

void ExplicitStep::give_impulses(Model& model, std::span<const Vec3> impulses) {
    const State::Values values = model.state().change();
    const auto masses = model.masses();
    impulses_.resize(impulses.size(), Vec3::Zero());
    for (std::size_t n = 0; n < impulses.size(); ++n) {
        if (masses[n] == 0.0 || impulses[n].isZero(0.0)) continue;
        const auto* constraint_of = model.boundary().constraints().of_node(n);
        for (int c = 0; c < 3; ++c) {
            impulses_[n][c] += impulses[n][c];
            if (constraint_of && (*constraint_of)[static_cast<std::size_t>(c)] >= 0) continue;
            values.velocities[n][c] += response_to_impulses_ * impulses[n][c] / masses[n];
        }
    }
}

void ExplicitStep::drift(Model& model, double time, double dt) {
    const NodeMover mover(model, time, dt);
    move_ranges(model, time, dt, [&](NodeRange range, std::span<Reaction> reactions) {
        StepSums sums;
        for (std::size_t n = range.begin; n < range.end; ++n)
            sums += mover.drift(n, previous_velocities_[n],
                                impulses_.empty() ? Vec3(Vec3::Zero()) : impulses_[n], reactions);
        return sums;
    });
}

void shift_velocities(Model& model, double time) {
    const State::Values values = model.state().change();
    const auto masses = model.masses();
    const auto elastic = model.elastic_forces(), outer = model.boundary().outer_forces();
    model.workers().for_each_range(masses.size(), [&](NodeRange range) {
        for (std::size_t n = range.begin; n < range.end; ++n) {
            if (masses[n] == 0.0) continue;  // dead
            const Vec3 change = time / masses[n] * (elastic[n] + outer[n]);
            const auto* constraint_of = model.boundary().constraints().of_node(n);
            for (int c = 0; c < 3; ++c)
                if (!constraint_of || (*constraint_of)[static_cast<std::size_t>(c)] < 0)
                    values.velocities[n][c] += change[c];
        }
    });
}

}  // namespace incise::physics
