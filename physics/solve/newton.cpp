// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/newton.h"

#include <algorithm>
#include <cmath>

#include "incise/base/error.h"
#include "incise/base/sum.h"

namespace incise::physics {

namespace {

constexpr int max_iterations = 60;
constexpr double tolerance = 1e-11;  // of NewtonReport::scale
// Rounding of positions changes the force at a node by this share of its stiffness times its
// distance from the origin. Rounding in laws changes energies by this share of the energy of a
// strain of the order of one.
constexpr double rounding_of_forces = 1e-15, rounding_of_energy = 1e-14;
// If only rounding is left, the imbalance no longer falls. It may then be above the tolerance by
// this factor.
constexpr double stagnation = 1e3;
// A structure version that no model has: follow() has not been called yet.
constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

/// Sets the displacements of the pins of a partly held component, along each axis, to the mean of
/// those of its constraints.
void follow_constraints(const FreeComponent& piece, const Model& model,
                        std::vector<Vec3>& increments) {
    Vec3 sum = Vec3::Zero(), count = Vec3::Zero();
    for (const NodeId n : piece.nodes)
        if (const auto* constraint_of = model.boundary().constraints().of_node(n.index()))
            for (int c = 0; c < 3; ++c)
                if ((*constraint_of)[static_cast<std::size_t>(c)] >= 0) {
                    sum[c] += increments[n.index()][c];
                    count[c] += 1.0;
                }
    for (const auto& [node, c] : piece.pins)
        if (count[c] > 0.0) increments[node.index()][c] = sum[c] / count[c];
}

}  // namespace

/// The norms of the imbalance, of all forces, and of what rounding may leave of the imbalance, N.
struct NewtonSolver::Forces {
    double imbalance = 0.0, scale = 0.0, rounding = 0.0;
};

void NewtonSolver::follow(const Model& model) {
    if (structure_version_ == model.version()) return;
    if (pins_free_components_)
        free_components_ = find_free_components(model.fragments(), model.positions(),
                                                model.boundary().constraints());
    prepare(model);
}

void NewtonSolver::prepare(const Model& model) {
    const fragments::FragmentMesh& fragments = model.fragments();
    is_free_.assign(fragments.node_capacity(), {true, true, true});
    for (std::size_t n = 0; n < is_free_.size(); ++n)
        if (const auto* constraint_of = model.boundary().constraints().of_node(n))
            for (std::size_t c = 0; c < 3; ++c) is_free_[n][c] = (*constraint_of)[c] < 0;
    for (const FreeComponent& piece : free_components_)
        for (const auto& [node, component] : piece.pins)
            is_free_[node.index()][static_cast<std::size_t>(component)] = false;
    tangent_.set_pattern(fragments, is_free_);
    for (auto* scratch : {&elastic_, &outer_, &middle_, &trial_, &increments_})
        scratch->assign(fragments.node_capacity(), Vec3::Zero());
    structure_version_ = model.version();
}

void NewtonSolver::save(ArchiveWriter& ar) const {
    ar(structure_version_.value_or(never), free_components_);
}

void NewtonSolver::restore(ArchiveReader& ar, const Model& model) {
    const auto structure_version = ar.read<std::uint64_t>();
    ar(free_components_);
    const auto is_there = [&](NodeId n) {
        return n.is_valid() && n.index() < model.fragments().node_capacity();
    };
    for (const FreeComponent& piece : free_components_) {
        const bool fits = std::all_of(piece.nodes.begin(), piece.nodes.end(), is_there) &&
                          std::all_of(piece.pins.begin(), piece.pins.end(), [&](const auto& pin) {
                              return is_there(pin.first) && pin.second >= 0 && pin.second < 3;
                          });
        if (!fits) throw InputError("it pins nodes that are not there");
    }
    if (structure_version == model.version()) prepare(model);
}

NewtonSolver::Forces NewtonSolver::evaluate(const Model& model, const StepProblem& problem,
                                            const std::vector<Vec3>& x) {
    std::fill(elastic_.begin(), elastic_.end(), Vec3::Zero());
    model.structure().elements().add_forces({x, model.state().history(), problem.dt}, elastic_);
    model.boundary().outer_forces_at(x, problem.time, model.workers(), outer_);
    net_.setZero(static_cast<Eigen::Index>(tangent_.num_unknowns()));
    double elastic = 0.0, outer = 0.0, inertial = 0.0, rounding = 0.0;
    for (std::size_t n = 0; n < x.size(); ++n) {
        const double mass = model.masses()[n];
        if (mass == 0.0) continue;  // dead
        Vec3 net = elastic_[n] + outer_[n];
        elastic += elastic_[n].squaredNorm();
        outer += outer_[n].squaredNorm();
        if (problem.inertia > 0.0) {
            const Vec3 force = problem.inertia * mass * (x[n] - problem.predicted_positions[n]);
            inertial += force.squaredNorm();
            net -= force;
        }
        if (!problem.holding.empty()) net += problem.holding[n];
        const double stiffness = model.structure().stiffness_bound(n) + problem.inertia * mass;
        rounding += stiffness * stiffness * x[n].squaredNorm();
        for (int c = 0; c < 3; ++c)
            if (const auto row = tangent_.row_of(n, c); row >= 0) net_[row] = net[c];
    }
    return {net_.norm(), std::sqrt(elastic) + std::sqrt(outer) + std::sqrt(inertial),
            rounding_of_forces * std::sqrt(rounding)};
}

void NewtonSolver::assemble(const Model& model, const StepProblem& problem,
                            const std::vector<Vec3>& x, TangentKind kind,
                            std::span<const Vec3> increments) {
    tangent_.clear(increments);
    model.structure().elements().for_each_block([&](const ElementBlock& block) {
        block.visit_tangents({x, model.state().history(), problem.dt}, kind, tangent_);
    });
    if (kind == TangentKind::exact) model.boundary().visit_tangents(x, problem.time, tangent_);
    if (problem.inertia > 0.0)
        for (std::size_t n = 0; n < x.size(); ++n)
            if (model.masses()[n] > 0.0)
                tangent_.add_diagonal(n, problem.inertia * model.masses()[n]);
}

void NewtonSolver::factorise(const Model& model, const StepProblem& problem,
                             const std::vector<Vec3>& x, std::span<const Vec3> increments) {
    assemble(model, problem, x, TangentKind::exact, increments);
    if (tangent_.factorise(model.workers())) return;
    assemble(model, problem, x, TangentKind::positive, increments);
    // Flat elements and slack springs may leave motions without stiffness.
    double shift = 1e-10 * tangent_.largest_diagonal();
    while (!tangent_.factorise(model.workers())) {
        tangent_.shift(shift);
        shift *= 10.0;
        if (!std::isfinite(shift)) break;  // a state that is not finite
    }
}

double NewtonSolver::potential(const Model& model, const StepProblem& problem,
                               const std::vector<Vec3>& x) const {
    Sum sum;
    model.structure().elements().for_each_block([&](const ElementBlock& block) {
        sum += block.potential({x, model.state().history(), problem.dt});
    });
    if (problem.inertia > 0.0)
        for (std::size_t n = 0; n < x.size(); ++n)
            if (model.masses()[n] > 0.0)
                sum += 0.5 * problem.inertia * model.masses()[n] *
                       (x[n] - problem.predicted_positions[n]).squaredNorm();
    return sum.value();
}

// Along a straight path, by Simpson's rule. This is exact, since the force of pressure is quadratic
// in the positions.
double NewtonSolver::work_of_loads(const Model& model, const StepProblem& problem,
                                   const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    Sum work;
    const auto add = [&](const std::vector<Vec3>& at, double weight) {
        model.boundary().outer_forces_at(at, problem.time, model.workers(), outer_);
        for (std::size_t n = 0; n < from.size(); ++n)
            if (model.masses()[n] > 0.0) work += weight * outer_[n].dot(to[n] - from[n]);
    };
    for (std::size_t n = 0; n < from.size(); ++n) middle_[n] = 0.5 * (from[n] + to[n]);
    add(from, 1.0 / 6.0);
    add(middle_, 4.0 / 6.0);
    add(to, 1.0 / 6.0);
    if (!problem.holding.empty())
        for (std::size_t n = 0; n < from.size(); ++n)
            work += problem.holding[n].dot(to[n] - from[n]);
    return work.value();
}

bool NewtonSolver::find_increments(const Model& model, double time, const std::vector<Vec3>& x) {
    increments_.assign(x.size(), Vec3::Zero());
    bool constraints_move = false;
    for (std::size_t n = 0; n < x.size(); ++n)
        if (const auto* constraint_of = model.boundary().constraints().of_node(n);
            constraint_of && model.masses()[n] > 0.0) {
            Vec3 target = x[n];
            model.boundary().constraints().prescribe(*constraint_of, model.fragments(), NodeId(n),
                                                     time, target);
            increments_[n] = target - x[n];
            constraints_move = constraints_move || !increments_[n].isZero(0.0);
        }
    for (const FreeComponent& piece : free_components_)
        follow_constraints(piece, model, increments_);
    return constraints_move;
}

void NewtonSolver::go_along(const std::vector<Vec3>& x, double share) {
    for (std::size_t n = 0; n < x.size(); ++n) {
        trial_[n] = x[n];
        for (int c = 0; c < 3; ++c)
            if (const auto row = tangent_.row_of(n, c); row >= 0)
                trial_[n][c] += share * direction_[row];
    }
}

bool NewtonSolver::search_line(const Model& model, const StepProblem& problem,
                               const std::vector<Vec3>& x) {
    constexpr double enough = 1e-4, shortest = 1e-6;
    const double slope = -net_.dot(direction_);
    const double start = potential(model, problem, x);
    const double stiffness_energy = model.structure().stiffness_energy();
    for (double share = 1.0; share > shortest; share *= 0.5) {
        go_along(x, share);
        const double end = potential(model, problem, trial_);
        const double work = work_of_loads(model, problem, x, trial_);
        const double noise = rounding_of_energy *
                             (std::abs(start) + std::abs(end) + std::abs(work) + stiffness_energy);
        if (end - start - work <= enough * share * slope + noise) return true;
    }
    return false;
}

NewtonReport NewtonSolver::solve(const Model& model, const StepProblem& problem,
                                 std::vector<Vec3>& x, std::vector<Vec3>& elastic_forces) {
    // The first iteration moves the rest of the body with the constraints.
    bool constraints_move = find_increments(model, problem.time, x);

    NewtonReport report;
    Forces forces = evaluate(model, problem, x);
    double last_imbalance = std::numeric_limits<double>::infinity();
    for (;; ++report.iterations) {
        report.imbalance = forces.imbalance;
        report.scale = forces.scale;
        const double goal = tolerance * forces.scale + forces.rounding;
        const bool falls = forces.imbalance < 0.5 * last_imbalance;
        report.has_converged =
            !constraints_move && std::isfinite(goal) &&
            (forces.imbalance <= goal || (!falls && forces.imbalance <= stagnation * goal));
        if (report.has_converged || report.iterations == max_iterations ||
            !std::isfinite(forces.imbalance) || !std::isfinite(goal))
            break;
        last_imbalance =
            constraints_move ? std::numeric_limits<double>::infinity() : forces.imbalance;

        factorise(model, problem, x,
                  constraints_move ? std::span<const Vec3>(increments_) : std::span<const Vec3>());
        direction_ = net_ + tangent_.load();
        tangent_.solve(direction_);
        if (constraints_move) {
            go_along(x, 1.0);
            for (std::size_t n = 0; n < x.size(); ++n) x[n] = trial_[n] + increments_[n];
            constraints_move = false;
            forces = evaluate(model, problem, x);
            continue;
        }

        if (!search_line(model, problem, x)) break;
        x = trial_;
        forces = evaluate(model, problem, x);
    }
    elastic_forces = elastic_;
    return report;
}

}  // namespace incise::physics
