// The tangent of a body, assembled from those of its elements and factorised.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/elements/element_block.h"
#include "incise/physics/solve/sparse_factor.h"

namespace incise::physics {

/// The tangent as a symmetric sparse matrix over the free components of positions. Sums are in the
/// order of elements, so the same body gives the same bits. Rows are in the order of elimination.
///
/// Memory: about 1 kB a node of tetrahedra, and ten to thirty times that for the factor and its
/// making.
class TangentMatrix final : public TangentSink {
  public:
    /// Sets the pattern: entries are between free components of nodes of one element. Then finds
    /// the order of elimination of the nodes, by dissect(). The components of a node are next to
    /// each other, since they have the same neighbours.
    /// `is_free` is by node id, and is read for living nodes.
    void set_pattern(const fragments::FragmentMesh& fragments,
                     std::span<const std::array<bool, 3>> is_free);

    std::size_t num_unknowns() const { return static_cast<std::size_t>(lower_.rows()); }
    /// Returns the row of a component, or -1 if it is not free.
    std::int32_t row_of(std::size_t node, int component) const {
        return rows_[node][static_cast<std::size_t>(component)];
    }

    /// Sets all entries and load() to zero. `increments` (m, by node id; may be empty) are the
    /// displacements of components that are not free. add() then sums their effect on the free
    /// components in load().
    /// @lifetime `increments` must live until the last add().
    void clear(std::span<const Vec3> increments);
    void add(std::span<const std::uint32_t> nodes, std::span<const double> tangent) override;
    /// Adds `value` (N/m) for each free component of the node.
    void add_diagonal(std::size_t node, double value);
    /// Returns minus the tangent times the increments, N, by row.
    const Eigen::VectorXd& load() const { return load_; }

    /// Factorises the matrix. Returns false, without a factor, if it is not positive definite.
    bool factorise(const Workers& workers) { return factor_.factorise(lower_, workers); }
    /// Replaces the right side by the solution.
    /// @pre factorise() returned true
    void solve(Eigen::VectorXd& side) const { factor_.solve(side); }
    double largest_diagonal() const { return lower_.diagonal().maxCoeff(); }
    /// Adds `value` to the whole diagonal, N/m.
    void shift(double value);

  private:
    std::vector<std::array<std::int32_t, 3>> rows_;  // by node id
    SparseFactor::Matrix lower_;
    SparseFactor factor_;
    std::span<const Vec3> increments_;
    Eigen::VectorXd load_;
};

}  // namespace incise::physics
