// The step of an assembled, implicit finite element code: linear tetrahedra, a tangent stiffness
// matrix, a sparse Cholesky factorization. It shares nothing with links.
// Source: D. Baraff, A. Witkin, Large steps in cloth simulation, SIGGRAPH 1998: backward Euler,
// linearised once a step; for the elements J. Bonet, R. Wood, Nonlinear continuum mechanics for
// finite element analysis, 1997.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "bench/comparators/element_loop.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// Saint Venant-Kirchhoff tissue with lumped masses. Nodes may be held where they are.
class ImplicitStep {
  public:
    using SparseMatrix = Eigen::SparseMatrix<double>;

    /// Finds the sparsity of the matrix and a fill-reducing order for it, once.
    /// @param held nodes that do not move; nodes without an element do not either
    ImplicitStep(const physics::SaintVenantKirchhoff& law, double density,
                 std::span<const Nodes> tetrahedra, std::span<const Vec3> rest_positions,
                 std::span<const std::uint32_t> held = {});

    /// Solves (M/dt^2 + K(x)) d = f(x) + M v/dt and goes to x + d with the velocity d/dt.
    /// Returns whether the matrix had a factorization with positive pivots; if not, nothing moves.
    bool step(double dt, std::span<Vec3> positions, std::span<Vec3> velocities);

    /// The parts of a step, to be timed: fills matrix and right side, factorizes, solves.
    void assemble(double dt, std::span<const Vec3> positions, std::span<const Vec3> velocities);
    bool factorize();
    const Eigen::VectorXd& solve();

    /// M/dt^2 + K of the last assemble(), lower half; and f + M v/dt. Three rows for each free
    /// node.
    const SparseMatrix& matrix() const { return matrix_; }
    const Eigen::VectorXd& right_side() const { return right_side_; }
    /// The first of a node's rows; negative if it does not move.
    Eigen::Index row_of(std::size_t node) const { return row_of_[node]; }
    /// Entries of the factor, after factorize().
    Eigen::Index num_factor_entries() const {
        return solver_.matrixL().nestedExpression().nonZeros();
    }

  private:
    struct Element {
        Nodes nodes;
        ShapeFunctions N;
        std::array<std::array<Eigen::Index, 4>, 4> place;  ///< in matrix_, of blocks; see .cpp
    };

    void add_block(const Element& e, std::size_t i, std::size_t j, const Matrix<double>& K);
    void add_element(const Element& e, std::span<const Vec3> positions);

    physics::SaintVenantKirchhoff law_;
    std::vector<Element> elements_;
    std::vector<double> masses_;        // by node, kg
    std::vector<Eigen::Index> row_of_;  // by node
    SparseMatrix matrix_;
    Eigen::VectorXd right_side_, move_;
    Eigen::SimplicialLDLT<SparseMatrix> solver_;
};

}  // namespace incise::bench
