// The tangent stiffness of a body, assembled from those of its elements and factorised.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/physics/elements/element_block.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// Symmetric and sparse, over the components of positions that are free. Memory: about 1 kB a node
/// of tetrahedra, and some times that for the factor. Sums run in the order of elements: the same
/// bits for the same body. Rows stand in the order of elimination, so that the factor is made of
/// the matrix as it is, without a copy of it.
class TangentMatrix final : public TangentSink {
  public:
    /// Where it has entries: between free components of nodes of one element. The order of
    /// elimination follows: that of nodes by approximate minimum degree, and the components of a
    /// node stand together, as they have the same neighbours.
    /// @param is_free by node id; of living nodes
    void set_pattern(const topology::Mesh& mesh, std::span<const std::array<bool, 3>> is_free);

    std::size_t num_unknowns() const { return static_cast<std::size_t>(upper_.rows()); }
    /// The row of a component; -1 if it is not free.
    std::int32_t row_of(std::size_t node, int component) const {
        return rows_[node][static_cast<std::size_t>(component)];
    }

    /// Sets all entries to zero. `increments` (m, by node id; may be empty) of components that are
    /// not free: what these bring to the free ones is summed beside the entries, as load().
    void clear(std::span<const Vec3> increments);
    void add(std::span<const std::uint32_t> nodes, std::span<const double> tangent) override;
    /// Adds `value` (N/m) for each free component of the node.
    void add_diagonal(std::size_t node, double value);
    /// Minus the tangent times the increments, N, by row.
    const Eigen::VectorXd& load() const { return load_; }

    /// False, and no factor, if it is not positive definite. Takes memory for no longer than it
    /// runs: 12 bytes an unknown, and up to 16 more in bodies of more than some 16,000 unknowns.
    bool factorise();
    /// Puts the solution in the place of the right side.
    /// @pre factorise() was true
    void solve(Eigen::VectorXd& side) const {
        if (num_unknowns() > 0) side = factor_.solve(side);
    }
    double largest_diagonal() const { return upper_.diagonal().maxCoeff(); }
    /// Adds `value` to the whole diagonal, N/m.
    void shift(double value);

  private:
    using Sparse = Eigen::SparseMatrix<double>;

    std::vector<std::array<std::int32_t, 3>> rows_;  // by node id
    Sparse upper_;
    Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<std::int32_t>> factor_;
    std::span<const Vec3> increments_;
    Eigen::VectorXd load_;
};

}  // namespace incise::physics
