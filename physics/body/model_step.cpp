// The steps of a model: the explicit step in one pass over the nodes, the same step in stages, and
// the step to a state that an implicit solver has found.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "incise/physics/body/model.h"
#include "incise/physics/body/motion_failure.h"

namespace incise::physics {

void Model::integrate(double time, double dt) {
    const State::Values values = state_.change();
    step_ranges(time, dt, [&](NodeRange range, std::span<Reaction> reactions) {
        return move_nodes(range, values, time, dt, reactions);
    });
}

template <class MoveRange>
void Model::step_ranges(double time, double dt, MoveRange move_range) {
    const std::size_t num_ranges = num_node_ranges(masses_.size());
    step_sums_.assign(num_ranges, {});
    range_reactions_.assign(num_ranges * constraints_.size(), {});
    if (!history().is_empty()) previous_positions_.resize(positions().size());
    workers_.for_each_range(masses_.size(), [&](NodeRange range) {
        if (!history().is_empty())
            for (std::size_t n = range.begin; n < range.end; ++n)
                previous_positions_[n] = positions()[n];
        step_sums_[range.number] = move_range(
            range, std::span(range_reactions_)
                       .subspan(range.number * constraints_.size(), constraints_.size()));
    });
    StepSums sums;
    for (const StepSums& range : step_sums_) sums += range;
    reactions_.assign(constraints_.size(), {});
    for (std::size_t i = 0; i < range_reactions_.size(); ++i)
        reactions_[i % constraints_.size()] += range_reactions_[i];
    external_work_ += sums.work;
    impulse_work_ = sums.impulse_work;
    dissipated_energy_ += damping_ * sums.mass_times_square * dt;
    largest_move_ = std::sqrt(sums.largest_square) * dt;
    if (!sums.is_finite() || largest_move_ > body_size_) throw failure_of_step(*this, time, dt);
    if (!history().is_empty())
        dissipated_energy_ += elements_.advance(previous_positions_, positions(), dt, workers_,
                                                state_.change().history);
}

StepSums Model::move_nodes(NodeRange range, const State::Values& values, double time, double dt,
                           std::span<Reaction> reactions) {
    const double slowing = 1.0 / (1.0 + damping_ * dt);
    StepSums sums;
    for (std::size_t n = range.begin; n < range.end;) {
        if (const std::size_t count = num_free_nodes(n, range.end)) {
            sums += move_free_nodes({&masses_[n], &elastic_forces_[n], &outer_forces_[n],
                                     &values.positions[n], &values.velocities[n]},
                                    count, dt, slowing);
            n += count;
            continue;
        }
        const std::size_t end = std::min(n + nodes_together, range.end);
        for (; n < end; ++n)
            if (masses_[n] != 0.0)  // else the node is dead
                sums += move_node(n, values, time, dt, slowing, reactions);
    }
    return sums;
}

std::size_t Model::num_free_nodes(std::size_t n, std::size_t end) const {
    std::size_t count = 0;
    for (std::size_t i = n; i < end && masses_[i] != 0.0 && !constraints_.of_node(i); ++i) ++count;
    return count - count % nodes_together;
}

// The sums are returned by value, so that they stay in registers.
StepSums Model::move_node(std::size_t n, const State::Values& values, double time, double dt,
                          double slowing, std::span<Reaction> reactions) {
    const double mass = masses_[n];
    const Vec3 x = values.positions[n], v = values.velocities[n];
    const Vec3 outer = outer_forces_[n], force = elastic_forces_[n] + outer;
    NodeStep step;
    step.v = slowing * (v + dt / mass * force);
    step.x = x + dt * step.v;
    step.work = 0.0;
    if (constraints_.of_node(n)) step = constrain_node(n, v, time, dt, force, step, reactions);
    values.positions[n] = step.x;
    values.velocities[n] = step.v;
    const double square = step.v.squaredNorm();
    return {.work = step.work + outer.dot(step.x - x),
            .impulse_work = 0.0,
            .mass_times_square = mass * square,
            .largest_square = square};
}

Model::NodeStep Model::constrain_node(std::size_t n, const Vec3& v, double time, double dt,
                                      const Vec3& force, NodeStep step,
                                      std::span<Reaction> reactions) const {
    const auto& constraint_of = *constraints_.of_node(n);
    const double mass = masses_[n];
    const Vec3& x = positions()[n];
    constraints_.prescribe(constraint_of, fragments_, NodeId(n), time + dt, step.x);
    for (int c = 0; c < 3; ++c) {
        const int s = constraint_of[static_cast<std::size_t>(c)];
        if (s < 0) continue;
        step.v[c] = (step.x[c] - x[c]) / dt;
        const double reaction = mass * ((step.v[c] - v[c]) / dt + damping_ * step.v[c]) - force[c];
        add_reaction(s, c, reaction, step.x, reactions);
        // The inertial part of the reaction does its work at the mean velocity, (v + v')/2. If a
        // constraint starts to move a node at once, this is exactly the kinetic energy of the node.
        step.work +=
            reaction * (step.x[c] - x[c]) - 0.5 * mass * (step.v[c] - v[c]) * (step.v[c] - v[c]);
    }
    return step;
}

void Model::add_reaction(int constraint, int component, double force, const Vec3& x,
                         std::span<Reaction> reactions) const {
    const auto s = static_cast<std::size_t>(constraint);
    reactions[s].force[component] += force;
    reactions[s].torque += (x - constraints_.point(s)).cross(force * Vec3::Unit(component));
}

void Model::shift_velocities(double time) {
    const State::Values values = state_.change();
    workers_.for_each_range(masses_.size(), [&](NodeRange range) {
        for (std::size_t n = range.begin; n < range.end; ++n) {
            if (masses_[n] == 0.0) continue;  // dead
            const Vec3 change = time / masses_[n] * (elastic_forces_[n] + outer_forces_[n]);
            const auto* constraint_of = constraints_.of_node(n);
            for (int c = 0; c < 3; ++c)
                if (!constraint_of || (*constraint_of)[static_cast<std::size_t>(c)] < 0)
                    values.velocities[n][c] += change[c];
        }
    });
}

void Model::kick(double time, double dt) {
    const State::Values values = state_.change();
    previous_velocities_.assign(values.velocities.begin(), values.velocities.end());
    impulses_.clear();
    const double slowing = 1.0 / (1.0 + damping_ * dt);
    response_to_impulses_ = slowing;
    workers_.for_each_range(masses_.size(), [&](NodeRange range) {
        for (std::size_t n = range.begin; n < range.end; ++n) {
            if (masses_[n] == 0.0) continue;  // dead
            const Vec3 force = elastic_forces_[n] + outer_forces_[n];
            Vec3& v = values.velocities[n];
            v = slowing * (v + dt / masses_[n] * force);
            const auto* constraint_of = constraints_.of_node(n);
            if (!constraint_of) continue;
            const Vec3& x = values.positions[n];
            Vec3 target = x + dt * v;
            constraints_.prescribe(*constraint_of, fragments_, NodeId(n), time + dt, target);
            for (int c = 0; c < 3; ++c)
                if ((*constraint_of)[static_cast<std::size_t>(c)] >= 0)
                    v[c] = (target[c] - x[c]) / dt;
        }
    });
}

void Model::give_impulses(std::span<const Vec3> impulses) {
    const State::Values values = state_.change();
    impulses_.resize(impulses.size(), Vec3::Zero());
    for (std::size_t n = 0; n < impulses.size(); ++n) {
        if (masses_[n] == 0.0 || impulses[n].isZero(0.0)) continue;
        const auto* constraint_of = constraints_.of_node(n);
        for (int c = 0; c < 3; ++c) {
            impulses_[n][c] += impulses[n][c];
            if (constraint_of && (*constraint_of)[static_cast<std::size_t>(c)] >= 0) continue;
            values.velocities[n][c] += response_to_impulses_ * impulses[n][c] / masses_[n];
        }
    }
}

void Model::drift(double time, double dt) {
    const State::Values values = state_.change();
    step_ranges(time, dt, [&](NodeRange range, std::span<Reaction> reactions) {
        StepSums sums;
        for (std::size_t n = range.begin; n < range.end; ++n) {
            if (masses_[n] == 0.0) continue;  // dead
            const Vec3 x = values.positions[n], outer = outer_forces_[n];
            NodeStep step{x + dt * values.velocities[n], values.velocities[n], 0.0};
            const Vec3 impulse = impulses_.empty() ? Vec3(Vec3::Zero()) : impulses_[n];
            Vec3 free_impulse = impulse;
            if (const auto* constraint_of = constraints_.of_node(n)) {
                for (int c = 0; c < 3; ++c)
                    if ((*constraint_of)[static_cast<std::size_t>(c)] >= 0) free_impulse[c] = 0.0;
                step = constrain_node(n, previous_velocities_[n], time, dt,
                                      elastic_forces_[n] + outer, step, reactions);
                add_reactions_to_impulse(n, impulse / dt, step.x, reactions);
            }
            values.positions[n] = step.x;
            values.velocities[n] = step.v;
            const double square = step.v.squaredNorm();
            const double of_impulse = 0.5 * free_impulse.dot(previous_velocities_[n] + step.v);
            // What impulses do on prescribed components is part of the work of the constraint.
            const double of_prescribed = (impulse - free_impulse).dot(step.v);
            sums += StepSums{.work = step.work + outer.dot(step.x - x) + of_impulse,
                             .impulse_work = of_impulse + of_prescribed,
                             .mass_times_square = masses_[n] * square,
                             .largest_square = square};
        }
        return sums;
    });
}

void Model::add_reactions_to_impulse(std::size_t n, const Vec3& force, const Vec3& x,
                                     std::span<Reaction> reactions) const {
    const auto& constraint_of = *constraints_.of_node(n);
    for (int c = 0; c < 3; ++c)
        if (const int s = constraint_of[static_cast<std::size_t>(c)]; s >= 0 && force[c] != 0.0)
            add_reaction(s, c, -force[c], x, reactions);
}

void Model::begin_step() {
    update_outer_terms();
    reactions_.assign(constraints_.size(), {});
    largest_move_ = 0.0;
}

double Model::take_step(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                        std::span<const Vec3> reactions, double dt) {
    const double largest_move = largest_move_;
    begin_step();
    const State::Values values = state_.change();
    double largest_square = 0.0;
    for (std::size_t n = 0; n < masses_.size(); ++n) {
        if (masses_[n] == 0.0) continue;  // dead
        largest_square =
            std::max(largest_square, (positions[n] - values.positions[n]).squaredNorm());
        if (const auto* constraint_of = constraints_.of_node(n))
            for (int c = 0; c < 3; ++c) {
                const int s = (*constraint_of)[static_cast<std::size_t>(c)];
                if (s < 0) continue;
                add_reaction(s, c, reactions[n][c], positions[n], reactions_);
            }
    }
    largest_move_ = largest_move + std::sqrt(largest_square);
    double taken = 0.0;
    if (!history().is_empty())
        taken = elements_.advance(values.positions, positions, dt, workers_, values.history);
    std::copy(positions.begin(), positions.end(), values.positions.begin());
    std::copy(velocities.begin(), velocities.end(), values.velocities.begin());
    return taken;
}

void Model::record_work(double external_work, double dissipated_energy) {
    external_work_ += external_work;
    dissipated_energy_ += dissipated_energy;
}

}  // namespace incise::physics
