// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/tangent_matrix.h"

#include <algorithm>
#include <utility>

namespace incise::physics {

using topology::FragmentMesh;

namespace {

using NodePair = std::pair<std::uint32_t, std::uint32_t>;

/// Returns the pairs (a, b), a <= b, of nodes of one element that both have a free component. Each
/// pair is there once, in ascending order.
std::vector<NodePair> coupled_nodes(const FragmentMesh& fragments,
                                    std::span<const std::array<bool, 3>> is_free) {
    const auto moves = [&](NodeId n) { return is_free[n.index()] != std::array<bool, 3>{}; };
    std::vector<NodePair> pairs;
    for (const ElementId e : fragments.elements()) {
        for (const NodeId a : fragments.corners(e))
            for (const NodeId b : fragments.corners(e))
                if (a <= b && moves(a) && moves(b))
                    pairs.emplace_back(static_cast<std::uint32_t>(a.index()),
                                       static_cast<std::uint32_t>(b.index()));
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// Returns all nodes in an order of elimination for which the factor has few entries.
std::vector<std::int32_t> elimination_order(std::span<const NodePair> pairs,
                                            std::size_t num_nodes) {
    std::vector<Eigen::Triplet<double, std::int32_t>> entries;
    for (const auto& [a, b] : pairs)
        entries.emplace_back(static_cast<std::int32_t>(b), static_cast<std::int32_t>(a), 1.0);
    const auto size = static_cast<Eigen::Index>(num_nodes);
    Eigen::SparseMatrix<double, Eigen::ColMajor, std::int32_t> lower(size, size);
    lower.setFromTriplets(entries.begin(), entries.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, std::int32_t> order;
    Eigen::AMDOrdering<std::int32_t>()(lower.selfadjointView<Eigen::Lower>(), order);
    const auto& nodes = order.indices();
    return {nodes.data(), nodes.data() + nodes.size()};
}

}  // namespace

void TangentMatrix::set_pattern(const FragmentMesh& fragments,
                                std::span<const std::array<bool, 3>> is_free) {
    const auto pairs = coupled_nodes(fragments, is_free);
    rows_.assign(fragments.node_capacity(), {-1, -1, -1});
    std::int32_t num_rows = 0;
    for (const std::int32_t node : elimination_order(pairs, rows_.size())) {
        const auto n = static_cast<std::size_t>(node);
        for (std::size_t c = 0; c < 3; ++c)
            if (fragments.is_alive(NodeId(n)) && is_free[n][c]) rows_[n][c] = num_rows++;
    }

    std::vector<Eigen::Triplet<double, std::int32_t>> entries;
    for (const auto& [a, b] : pairs)
        for (const std::int32_t i : rows_[a])
            for (const std::int32_t j : rows_[b])
                if (i >= 0 && j >= 0 && (a != b || i <= j))
                    entries.emplace_back(std::min(i, j), std::max(i, j), 0.0);
    upper_.resize(num_rows, num_rows);
    upper_.setFromTriplets(entries.begin(), entries.end());
    load_.setZero(num_rows);
    if (num_rows > 0) factor_.analyzePattern(upper_);
}

void TangentMatrix::clear(std::span<const Vec3> increments) {
    std::fill_n(upper_.valuePtr(), upper_.nonZeros(), 0.0);
    increments_ = increments;
    load_.setZero();
}

void TangentMatrix::add(std::span<const std::uint32_t> nodes, std::span<const double> tangent) {
    const std::size_t size = 3 * nodes.size();
    const int* const starts = upper_.outerIndexPtr();
    const int* const inner = upper_.innerIndexPtr();
    for (std::size_t j = 0; j < nodes.size(); ++j)
        for (std::size_t c = 0; c < 3; ++c) {
            const double* const values = tangent.data() + (3 * j + c) * size;
            const std::int32_t column = rows_[nodes[j]][c];
            if (column < 0) {
                if (increments_.empty()) continue;
                const double u = increments_[nodes[j]][static_cast<Eigen::Index>(c)];
                if (u == 0.0) continue;
                for (std::size_t i = 0; i < nodes.size(); ++i)
                    for (std::size_t d = 0; d < 3; ++d)
                        if (const std::int32_t row = rows_[nodes[i]][d]; row >= 0)
                            load_[row] -= values[3 * i + d] * u;
                continue;
            }
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                // The rows of a node are adjacent, so one search finds them all.
                const int* it = nullptr;
                for (std::size_t d = 0; d < 3; ++d) {
                    const std::int32_t row = rows_[nodes[i]][d];
                    if (row < 0 || row > column) continue;
                    if (!it)
                        it = std::lower_bound(inner + starts[column], inner + starts[column + 1],
                                              row);
                    upper_.valuePtr()[it - inner] += values[3 * i + d];
                    ++it;
                }
            }
        }
}

void TangentMatrix::add_diagonal(std::size_t node, double value) {
    for (const std::int32_t row : rows_[node])
        if (row >= 0) upper_.valuePtr()[upper_.outerIndexPtr()[row + 1] - 1] += value;
}

void TangentMatrix::shift(double value) {
    for (int row = 0; row < upper_.cols(); ++row)
        upper_.valuePtr()[upper_.outerIndexPtr()[row + 1] - 1] += value;
}

bool TangentMatrix::factorise() {
    if (num_unknowns() == 0) return true;
    factor_.factorize(upper_);
    // A smaller pivot may be the result of rounding only.
    constexpr double smallest = 1e-14;
    if (factor_.info() != Eigen::Success) return false;
    const Eigen::VectorXd pivots = factor_.vectorD();
    return pivots.minCoeff() > smallest * pivots.maxCoeff();
}

}  // namespace incise::physics
