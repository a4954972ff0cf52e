// Newton's method for the end of an implicit step or a step of statics. Equations: docs/theory.md,
// Implicit steps and statics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/physics/solve/free_components.h"
#include "incise/physics/solve/tangent_matrix.h"

namespace incise::physics {

/// The equations of the end of a step. The unknowns are positions x that satisfy the constraints at
/// `time`. For every free component of every node:
///     elastic and viscous forces + outer forces + holding = (inertia) m (x - predicted).
/// Outer forces are loads, gravity and added terms.
struct StepProblem {
    double time;     ///< s, at the end of the step
    double dt;       ///< s, the time for which viscosity relaxes; infinite in statics
    double inertia;  ///< 1/s2; 0 in statics
    std::span<const Vec3> predicted_positions =
        {};                              ///< m, by node id; may be empty without inertia
    std::span<const Vec3> holding = {};  ///< N, by node id; may be empty
};

/// The outcome of NewtonSolver::solve().
struct NewtonReport {
    bool has_converged = false;
    int iterations = 0;
    double imbalance = 0.0;  ///< N, root of the sum of squares over free components
    double scale = 0.0;      ///< N, sum of the norms of elastic, outer and inertial forces
};

/// Newton's method on the incremental energy. Each iteration assembles and factorises the tangent,
/// and searches along the direction. If the tangent is not positive definite, the sum of the
/// positive parts of the element tangents replaces it. The results are deterministic.
class NewtonSolver {
  public:
    /// @param pins_free_components  true in statics: free components are held where they are, by
    ///                              their pins; see FreeComponent
    explicit NewtonSolver(bool pins_free_components)
        : pins_free_components_(pins_free_components) {}

    /// Prepares for the present structure of the body: finds free components and the pattern of the
    /// tangent. Does nothing if the structure has not changed since the last call.
    void follow(const Model& model);
    /// Saves the pins of free components, which follow() has found at earlier positions.
    void save(ArchiveWriter& ar) const;
    void restore(ArchiveReader& ar, const Model& model);

    /// Solves the equations from the start `x` (m, by node id). `x` becomes the solution, or the
    /// last iterate if the method does not converge. `elastic_forces` (N, by node id) become those
    /// at the new `x`, at the end of the step.
    /// @pre follow() was called since the structure last changed
    NewtonReport solve(const Model& model, const StepProblem& problem, std::vector<Vec3>& x,
                       std::vector<Vec3>& elastic_forces);

    const std::vector<FreeComponent>& free_components() const { return free_components_; }
    /// True if neither a constraint nor a pin holds this component of the node.
    bool is_free(std::size_t node, int component) const {
        return is_free_[node][static_cast<std::size_t>(component)];
    }

  private:
    struct Forces;
    void prepare(const Model& model);
    /// Sets net_ to the imbalance at x, and elastic_ and outer_ to the forces there.
    Forces evaluate(const Model& model, const StepProblem& problem, const std::vector<Vec3>& x);
    /// Sets increments_ to the displacements that constraints prescribe from x. Returns true if a
    /// constraint prescribes one that is not zero.
    bool find_increments(const Model& model, double time, const std::vector<Vec3>& x);
    void assemble(const Model& model, const StepProblem& problem, const std::vector<Vec3>& x,
                  TangentKind kind, std::span<const Vec3> increments);
    void factorise(const Model& model, const StepProblem& problem, const std::vector<Vec3>& x,
                   std::span<const Vec3> increments);
    double potential(const Model& model, const StepProblem& problem,
                     const std::vector<Vec3>& x) const;
    double work_of_loads(const Model& model, const StepProblem& problem,
                         const std::vector<Vec3>& from, const std::vector<Vec3>& to);

    /// Sets trial_ to the positions at `share` of the way from x along direction_.
    void go_along(const std::vector<Vec3>& x, double share);
    /// Sets trial_ to positions from x along direction_ at which the energy has fallen enough, as
    /// far as rounding lets see. The whole way nearly always is.
    /// @returns false if there are none
    bool search_line(const Model& model, const StepProblem& problem, const std::vector<Vec3>& x);

    bool pins_free_components_;
    std::optional<std::uint64_t> structure_version_;  // of the model, when the pattern was found
    std::vector<std::array<bool, 3>> is_free_;
    std::vector<FreeComponent> free_components_;
    TangentMatrix tangent_;
    Eigen::VectorXd net_, direction_;  // scratch, by row of the tangent
    std::vector<Vec3> elastic_, outer_, middle_, trial_, increments_;  // scratch, by node id
};

}  // namespace incise::physics
