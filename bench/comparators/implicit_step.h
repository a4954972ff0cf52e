// The step of an implicit finite element code, which shares no code with HEML: linear tetrahedra,
// an assembled tangent and a sparse Cholesky factorization.
// Source: D. Baraff, A. Witkin, Large steps in cloth simulation, SIGGRAPH 1998: backward Euler,
// linearised once a step. Elements: J. Bonet, R. Wood, Nonlinear continuum mechanics for finite
// element analysis, 1997.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "bench/comparators/element_loop.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// Implicit steps of Saint Venant-Kirchhoff tissue with lumped masses. Nodes may be fixed.
class ImplicitStep {
  public:
    using SparseMatrix = Eigen::SparseMatrix<double>;

    /// Finds the pattern of the matrix and a fill-reducing order for it. `held` are nodes that do
    /// not move. Nodes without an element do not move either. `density` is in kg/m3.
    ImplicitStep(const physics::SaintVenantKirchhoff& law, double density,
                 std::span<const Nodes> tetrahedra, std::span<const Vec3> rest_positions,
                 std::span<const std::uint32_t> held = {});

    /// Solves (M/dt^2 + K(x)) d = f(x) + M v/dt, and sets the positions to x + d and the velocities
    /// to d/dt. Returns false, and moves nothing, if the factorization has a pivot that is not
    /// positive.
    bool step(double dt, std::span<Vec3> positions, std::span<Vec3> velocities);

    /// The parts of a step, to be timed one by one: assemble() fills the matrix and the right side.
    void assemble(double dt, std::span<const Vec3> positions, std::span<const Vec3> velocities);
    bool factorize();
    const Eigen::VectorXd& solve();

    /// Returns the lower half of M/dt^2 + K of the last assemble(), with three rows for each node
    /// that moves.
    const SparseMatrix& matrix() const { return matrix_; }
    /// Returns f + M v/dt of the last assemble(), N, with the same rows.
    const Eigen::VectorXd& right_side() const { return right_side_; }
    /// Returns the first row of a node; negative if the node does not move.
    Eigen::Index row_of(std::size_t node) const { return row_of_[node]; }
    /// Returns the number of entries of the factor, after factorize().
    Eigen::Index num_factor_entries() const {
        return solver_.matrixL().nestedExpression().nonZeros();
    }

  private:
    struct Element {
        Nodes nodes;
        ShapeFunctions N;
        std::array<std::array<Eigen::Index, 4>, 4> place;  ///< of blocks in matrix_; see the .cpp
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
