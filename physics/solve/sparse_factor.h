// The Cholesky factor of a sparse symmetric matrix.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "incise/physics/elements/workers.h"
#include "incise/physics/solve/dense_front.h"
#include "incise/physics/solve/number_buffers.h"

namespace incise::physics {

/// The factor L of A = L L^T, by the multifrontal method: the rows of a group are eliminated in a
/// small dense matrix, its front, and what that does to later rows is passed on to the front of the
/// next group. The products are in FrontKernels.
/// Source: I. Duff, J. Reid, The multifrontal solution of indefinite sparse symmetric linear
/// equations, ACM Trans. Math. Softw. 9 (1983).
///
/// The same matrix gives the same bits on every processor and with any number of threads.
class SparseFactor {
  public:
    using Matrix = Eigen::SparseMatrix<double>;

    /// Rows that are eliminated together: those from `begin` to before `end`.
    struct Group {
        std::int32_t begin, end;
        std::size_t parent;  ///< a later group; EliminationTree::no_parent for none
    };

    /// Finds where the factor has entries. `lower` is the lower half of the matrix; its values do
    /// not matter. The groups are those of an EliminationTree, and have all rows in order.
    void analyse(const Matrix& lower, std::vector<Group> groups);
    /// Factorises a matrix with the pattern that analyse() was given. Returns false, without a
    /// factor, if it is not positive definite, as far as rounding lets see.
    /// @param processor  chooses the kernels, not the result
    bool factorise(const Matrix& lower, const Workers& workers,
                   Processor processor = physics::processor());
    /// Replaces the right side by the solution.
    /// @pre factorise() returned true
    void solve(Eigen::VectorXd& side) const;

    /// Returns the number of entries of the factor, with the zeros that it stores.
    std::size_t num_entries() const { return num_values_; }

  private:
    struct Front {
        std::int32_t begin, end;  // rows of the group
        std::size_t parent;
        std::size_t first_row, num_later;  // rows behind the group that it affects, in later_rows_
        std::size_t values;                // first entry in values_
        std::size_t num_own() const { return static_cast<std::size_t>(end - begin); }
        std::size_t size() const { return num_own() + num_later; }
    };
    std::span<const std::int32_t> later_rows(const Front& front) const {
        return std::span(later_rows_).subspan(front.first_row, front.num_later);
    }
    /// Sums the entries of the matrix and what the children pass on.
    void assemble(const Matrix& lower, std::size_t f, const DenseFront& front);
    /// Eliminates the rows of a front, with several threads if there are workers.
    bool eliminate(const Matrix& lower, std::size_t f, const Workers* workers,
                   const FrontKernels& kernels, PivotRange& pivots);
    void find_subtrees();

    std::vector<Front> fronts_;
    std::vector<std::vector<std::size_t>> children_;  // by front
    std::vector<std::int32_t> later_rows_;
    NumberBuffer values_;  // by front: own columns, with all rows of the front
    std::size_t num_values_ = 0;
    std::vector<NumberBuffer> updates_;  // by front: what it passes on, lower half
    NumberBuffers buffers_;
    std::vector<PivotRange> pivots_;  // by subtree, then that of the rest
    // Fronts of which each has a subtree to itself, which one thread eliminates; then the rest.
    std::vector<std::pair<std::size_t, std::size_t>> subtrees_;
    std::vector<std::size_t> rest_;
};

}  // namespace incise::physics
