// Newton's method for the state that implicit steps and statics end in.
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

/// Wanted are positions x, with constraints where they have to be at `time`, at which for every
/// free component of every node
///     elastic and viscous forces + loads and gravity + holding = (inertia) m (x - predicted).
struct StepProblem {
    double time;     ///< s, at the end of the step
    double dt;       ///< s, by which viscosity relaxes; infinite in statics
    double inertia;  ///< 1/s2; 0 in statics
    std::span<const Vec3> predicted_positions =
        {};                              ///< m, by node id; may be empty without inertia
    std::span<const Vec3> holding = {};  ///< N, by node id; may be empty
};

/// How it went.
struct NewtonReport {
    bool has_converged = false;
    int iterations = 0;
    double imbalance = 0.0;  ///< N, root of the sum of squares over free components
    double scale = 0.0;      ///< N, likewise of all forces
};

/// Full Newton on the incremental energy: tangents assembled and factorised in each iteration, and
/// a line search. Where the tangent is not positive definite, that of the elements' positive parts
/// serves. Deterministic.
class NewtonSolver {
  public:
    /// @param pins_free_components statics: pieces that constraints do not hold are held where they
    /// are by as few components as do; see FreeComponent
    explicit NewtonSolver(bool pins_free_components)
        : pins_free_components_(pins_free_components) {}

    /// Prepares for the body as it now is. Costs something only after edits: then the pattern of
    /// the tangent is found anew.
    void follow(const Model& model);
    /// What follow() made of positions that are gone: the pins of free pieces.
    void save(ArchiveWriter& ar) const;
    void restore(ArchiveReader& ar, const Model& model);

    /// @param x  m, by node id: start and result. Without convergence, where it got to
    /// @param elastic_forces  N, by node id: those at the result, of the end of the step
    NewtonReport solve(const Model& model, const StepProblem& problem, std::vector<Vec3>& x,
                       std::vector<Vec3>& elastic_forces);

    const std::vector<FreeComponent>& free_components() const { return free_components_; }
    /// By node id.
    bool is_free(std::size_t node, int component) const {
        return is_free_[node][static_cast<std::size_t>(component)];
    }

  private:
    struct Forces;
    void prepare(const Model& model);
    /// Sets net_ to what is out of balance at x, and elastic_ and outer_ to the forces there.
    Forces evaluate(const Model& model, const StepProblem& problem, const std::vector<Vec3>& x);
    /// Sets increments_ to where constraints go from x; whether one does.
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
