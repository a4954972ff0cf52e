// The tetrahedra of a mesh as plain arrays, and one loop over them, which the comparators share. So
// all methods are timed with the same layout and the same access to nodes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::bench {

template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, 3, 3>;
/// One vector for each corner of a tetrahedron: positions, m, or forces, N.
template <class Scalar>
using Corners = std::array<Vector<Scalar>, 4>;

using Nodes = std::array<std::uint32_t, 4>;

/// Returns the nodes of the living tetrahedra, as node ids, in ascending order of element ids.
/// @pre all elements are tetrahedra
inline std::vector<Nodes> tetrahedra_of(const topology::Mesh& mesh) {
    std::vector<Nodes> tetrahedra;
    for (const CellId e : mesh.elements()) {
        Nodes nodes;
        for (std::size_t k = 0; k < 4; ++k)
            nodes[k] = static_cast<std::uint32_t>(mesh.corners(e)[k].index());
        tetrahedra.push_back(nodes);
    }
    return tetrahedra;
}

template <class Scalar>
Corners<Scalar> corners_of(const Nodes& nodes, std::span<const Vector<Scalar>> positions) {
    return {positions[nodes[0]], positions[nodes[1]], positions[nodes[2]], positions[nodes[3]]};
}

/// The linear shape functions N_0 to N_3 of one tetrahedron. The gradient of N_0 is minus the sum
/// of the others.
struct ShapeFunctions {
    double volume;                                      ///< at rest, m3
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows;  ///< gradients of N_1, N_2, N_3, 1/m

    explicit ShapeFunctions(const Corners<double>& X) {
        Matrix<double> edges;
        edges << X[1] - X[0], X[2] - X[0], X[3] - X[0];
        volume = edges.determinant() / 6.0;
        rows = edges.inverse();
    }
    Vector<double> gradient(std::size_t i) const {
        if (i == 0) return -rows.colwise().sum().transpose();
        return rows.row(static_cast<Eigen::Index>(i) - 1).transpose();
    }
};

/// The forces of a mesh by a kernel that has `Element`, `precompute(rest corners)` and
/// `forces(element, corners)`, such as those of this folder and physics::HemlKernel.
template <class Kernel, class Scalar = double>
class ElementLoop {
  public:
    ElementLoop(const Kernel& kernel, std::span<const Nodes> tetrahedra,
                std::span<const Vec3> rest_positions)
        : kernel_(kernel) {
        rows_.reserve(tetrahedra.size());
        for (const Nodes& nodes : tetrahedra)
            rows_.push_back({nodes, kernel.precompute(corners_of(nodes, rest_positions))});
    }

    /// Adds the forces at `positions` (m) to `forces` (N), both by node id.
    void add_forces(std::span<const Vector<Scalar>> positions,
                    std::span<Vector<Scalar>> forces) const {
        for (const Row& row : rows_) {
            const Corners<Scalar> f = kernel_.forces(row.rest, corners_of(row.nodes, positions));
            for (std::size_t k = 0; k < 4; ++k) forces[row.nodes[k]] += f[k];
        }
    }

  private:
    struct Row {
        Nodes nodes;
        typename Kernel::Element rest;
    };
    Kernel kernel_;
    std::vector<Row> rows_;
};

}  // namespace incise::bench
