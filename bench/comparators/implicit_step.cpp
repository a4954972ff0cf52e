// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/comparators/implicit_step.h"

#include <algorithm>

namespace incise::bench {

// The entries of the lower half are compressed by columns. The three rows of a node are adjacent.
// So a block of two different nodes, below the diagonal, has three consecutive entries in each of
// three columns. In column c these begin at `place` - c entries after the first entry of the
// column. Blocks on the diagonal are triangles, whose entries come first in their columns.

ImplicitStep::ImplicitStep(const physics::SaintVenantKirchhoff& law, double density,
                           std::span<const Nodes> tetrahedra, std::span<const Vec3> rest_positions,
                           std::span<const std::uint32_t> held)
    : law_(law), masses_(rest_positions.size(), 0.0), row_of_(rest_positions.size(), -1) {
    elements_.reserve(tetrahedra.size());
    for (const Nodes& nodes : tetrahedra) {
        elements_.push_back({nodes, ShapeFunctions(corners_of(nodes, rest_positions)), {}});
        for (const std::uint32_t n : nodes) masses_[n] += density * elements_.back().N.volume / 4.0;
    }
    Eigen::Index num_rows = 0;
    std::vector<bool> is_held(rest_positions.size(), false);
    for (const std::uint32_t n : held) is_held[n] = true;
    for (std::size_t n = 0; n < row_of_.size(); ++n)
        if (masses_[n] > 0.0 && !is_held[n]) {
            row_of_[n] = num_rows;
            num_rows += 3;
        }

    std::vector<Eigen::Triplet<double>> entries;
    for (const Element& e : elements_)
        for (const std::uint32_t a : e.nodes)
            for (const std::uint32_t b : e.nodes) {
                if (row_of_[a] < row_of_[b] || row_of_[b] < 0) continue;
                for (int c = 0; c < 3; ++c)
                    for (int r = a == b ? c : 0; r < 3; ++r)
                        entries.emplace_back(row_of_[a] + r, row_of_[b] + c, 0.0);
            }
    matrix_.resize(num_rows, num_rows);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    right_side_.resize(num_rows);
    for (Element& e : elements_)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j) {
                const Eigen::Index row = row_of_[e.nodes[i]], column = row_of_[e.nodes[j]];
                if (row <= column || column < 0) continue;
                const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
                const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
                e.place[i][j] = std::lower_bound(begin, end, row) - begin;
            }
    solver_.analyzePattern(matrix_);
}

void ImplicitStep::add_block(const Element& e, std::size_t i, std::size_t j,
                             const Matrix<double>& K) {
    const Eigen::Index row = row_of_[e.nodes[i]], column = row_of_[e.nodes[j]];
    if (row < column || column < 0) return;
    for (int c = 0; c < 3; ++c) {
        double* entries = matrix_.valuePtr() + matrix_.outerIndexPtr()[column + c];
        if (row == column)
            for (int r = c; r < 3; ++r) entries[r - c] += K(r, c);
        else  // the triangle on the diagonal has c entries fewer in column c
            for (int r = 0; r < 3; ++r) entries[e.place[i][j] - c + r] += K(r, c);
    }
}

// With g = grad N: f_i = -Vol F S g_i, and
//     -df_i/dx_j = Vol [ (g_i . S g_j) 1 + lambda F g_i (F g_j)^T
//                        + mu F g_j (F g_i)^T + mu (g_i . g_j) F F^T ].
// The first term is the stiffness of the stress, the others are that of the law.
void ImplicitStep::add_element(const Element& e, std::span<const Vec3> positions) {
    const Corners<double> x = corners_of(e.nodes, positions);
    Matrix<double> edges;
    edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
    const Matrix<double> F = edges * e.N.rows;
    const Matrix<double> E = 0.5 * (F.transpose() * F - Matrix<double>::Identity());
    const Matrix<double> S =
        law_.lambda * E.trace() * Matrix<double>::Identity() + 2.0 * law_.mu * E;
    const Matrix<double> FFt = F * F.transpose();
    Eigen::Matrix<double, 3, 4> g;
    g << e.N.gradient(0), e.N.gradient(1), e.N.gradient(2), e.N.gradient(3);
    const Eigen::Matrix<double, 3, 4> Fg = F * g, Sg = S * g, f = -e.N.volume * (F * Sg);
    for (std::size_t i = 0; i < 4; ++i) {
        const auto a = static_cast<Eigen::Index>(i);
        if (const Eigen::Index row = row_of_[e.nodes[i]]; row >= 0)
            right_side_.segment<3>(row) += f.col(a);
        for (std::size_t j = 0; j < 4; ++j) {
            if (row_of_[e.nodes[i]] < row_of_[e.nodes[j]]) continue;  // in the upper half
            const auto b = static_cast<Eigen::Index>(j);
            Matrix<double> K = law_.lambda * Fg.col(a) * Fg.col(b).transpose() +
                               law_.mu * Fg.col(b) * Fg.col(a).transpose() +
                               law_.mu * g.col(a).dot(g.col(b)) * FFt;
            K.diagonal().array() += g.col(a).dot(Sg.col(b));
            add_block(e, i, j, e.N.volume * K);
        }
    }
}

void ImplicitStep::assemble(double dt, std::span<const Vec3> positions,
                            std::span<const Vec3> velocities) {
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
    right_side_.setZero();
    for (const Element& e : elements_) add_element(e, positions);
    for (std::size_t n = 0; n < row_of_.size(); ++n) {
        if (row_of_[n] < 0) continue;
        right_side_.segment<3>(row_of_[n]) += masses_[n] / dt * velocities[n];
        for (int c = 0; c < 3; ++c)  // the diagonal entry is the first of its column
            matrix_.valuePtr()[matrix_.outerIndexPtr()[row_of_[n] + c]] += masses_[n] / (dt * dt);
    }
}

bool ImplicitStep::factorize() {
    solver_.factorize(matrix_);
    return solver_.info() == Eigen::Success && solver_.vectorD().minCoeff() > 0.0;
}

const Eigen::VectorXd& ImplicitStep::solve() {
    move_ = solver_.solve(right_side_);
    return move_;
}

bool ImplicitStep::step(double dt, std::span<Vec3> positions, std::span<Vec3> velocities) {
    assemble(dt, positions, velocities);
    if (!factorize()) return false;
    solve();
    for (std::size_t n = 0; n < row_of_.size(); ++n) {
        if (row_of_[n] < 0) continue;
        const Vec3 d = move_.segment<3>(row_of_[n]);
        positions[n] += d;
        velocities[n] = d / dt;
    }
    return true;
}

}  // namespace incise::bench
