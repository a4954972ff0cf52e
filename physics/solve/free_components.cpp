// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/free_components.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "incise/physics/body/motion_failure.h"
#include "incise/physics/elements/spectrum.h"

namespace incise::physics {

using fragments::FragmentMesh;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

/// Returns a number for each node, the same for all nodes of a connected component.
std::vector<std::size_t> pieces_of_nodes(const FragmentMesh& fragments) {
    std::vector<std::size_t> parent(fragments.node_capacity());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t n) {
        while (parent[n] != n) n = parent[n] = parent[parent[n]];
        return n;
    };
    for (const ElementId e : fragments.elements()) {
        const auto corners = fragments.corners(e);
        for (const NodeId n : corners) {
            const std::size_t a = root(n.index()), b = root(corners[0].index());
            parent[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::size_t n = 0; n < parent.size(); ++n) parent[n] = root(n);
    return parent;
}

/// Returns the motion of component `component` of a node at x, per unit of each of the six rigid
/// motions. These are in the order of the rows of FreeComponent::modes.
Vector6 row_of(const FreeComponent& piece, const Vec3& x, int component) {
    Vector6 row;
    const Vec3 axis = Vec3::Unit(component);
    row << axis, piece.turns.transpose() * (x - piece.centre).cross(axis);
    return row;
}

/// Sets `centre` and `turns`.
void find_frame(FreeComponent& piece, std::span<const Vec3> positions) {
    const auto num_nodes = static_cast<double>(piece.nodes.size());
    for (const NodeId n : piece.nodes) piece.centre += positions[n.index()];
    piece.centre /= num_nodes;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const NodeId n : piece.nodes) {
        const Vec3 arm = positions[n.index()] - piece.centre;
        spread += arm * arm.transpose();
    }
    piece.turns = spectrum(spread).vectors;
    Vec3 squared_ways = Vec3::Zero();
    for (const NodeId n : piece.nodes)
        for (int k = 0; k < 3; ++k)
            squared_ways[k] +=
                piece.turns.col(k).cross(positions[n.index()] - piece.centre).squaredNorm();
    for (int k = 0; k < 3; ++k) piece.turns.col(k) /= std::sqrt(squared_ways[k] / num_nodes);
}

}  // namespace

std::vector<FreeComponent> find_free_components(const FragmentMesh& fragments,
                                                std::span<const Vec3> positions,
                                                const Constraints& constraints) {
    // A motion is free if constraints hold less than this share of it. The share is the square of
    // what the rounding of positions in single precision can leave.
    constexpr double hold = 1e-13;
    const std::vector<std::size_t> piece_of = pieces_of_nodes(fragments);
    std::vector<std::size_t> num_elements(fragments.node_capacity(), 0);
    for (const ElementId e : fragments.elements())
        ++num_elements[piece_of[fragments.corners(e)[0].index()]];
    std::vector<FreeComponent> pieces(fragments.node_capacity());
    for (const NodeId n : fragments.nodes()) pieces[piece_of[n.index()]].nodes.push_back(n);

    std::vector<FreeComponent> free;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        FreeComponent& piece = pieces[p];
        if (piece.nodes.empty()) continue;
        piece.num_elements = num_elements[p];
        find_frame(piece, positions);
        Eigen::Matrix<double, 6, 6> held = Eigen::Matrix<double, 6, 6>::Zero();
        for (const NodeId n : piece.nodes)
            if (const auto* constraint_of = constraints.of_node(n.index()))
                for (int c = 0; c < 3; ++c)
                    if ((*constraint_of)[static_cast<std::size_t>(c)] >= 0) {
                        const Vector6 row = row_of(piece, positions[n.index()], c);
                        held += row * row.transpose();
                    }
        const Spectrum modes = spectrum(held);
        const auto num_free = (modes.values.array() <= hold * std::max(1.0, held.trace())).count();
        if (num_free == 0) continue;
        piece.modes = modes.vectors.leftCols(num_free);

        // Repeatedly pin the component that prevents most of the remaining motions.
        Eigen::Matrix<double, 6, Eigen::Dynamic> left = piece.modes;
        for (Eigen::Index k = 0; k < num_free; ++k) {
            double most = -1.0;
            Eigen::VectorXd direction;
            std::pair<NodeId, int> pin;
            for (const NodeId n : piece.nodes)
                for (int c = 0; c < 3; ++c) {
                    const auto* constraint_of = constraints.of_node(n.index());
                    if (constraint_of && (*constraint_of)[static_cast<std::size_t>(c)] >= 0)
                        continue;
                    const Eigen::VectorXd hindered =
                        left.transpose() * row_of(piece, positions[n.index()], c);
                    if (hindered.squaredNorm() <= most) continue;
                    most = hindered.squaredNorm();
                    direction = hindered;
                    pin = {n, c};
                }
            piece.pins.push_back(pin);
            direction.normalize();
            left -= left * direction * direction.transpose();
        }
        free.push_back(std::move(piece));
    }
    return free;
}

void require_equilibrium(const FragmentMesh& fragments, const topology::Mesh& mesh,
                         const FreeComponent& piece, std::span<const Vec3> positions,
                         std::span<const Vec3> forces) {
    constexpr double tolerance = 1e-7;  // of the sum of the norms of all forces
    Vector6 total = Vector6::Zero();
    double all = 0.0;
    for (const NodeId n : piece.nodes) {
        const Vec3& f = forces[n.index()];
        total.head<3>() += f;
        total.tail<3>() += piece.turns.transpose() * (positions[n.index()] - piece.centre).cross(f);
        all += f.norm();
    }
    const Vector6 moving = piece.modes * (piece.modes.transpose() * total);
    if (!(moving.norm() > tolerance * all)) return;
    const CellId cell = fragments.cells_of(fragments.incident_element(piece.nodes.front())).front();
    const bool is_turned = moving.tail<3>().norm() > moving.head<3>().norm();
    std::ostringstream text;
    text << "no equilibrium: a piece of " << piece.num_elements
         << (piece.num_elements == 1 ? " element" : " elements") << " (one of them is element "
         << mesh.label(cell) << ", its middle is now at " << piece.centre.transpose()
         << ") is not held, and loads ";
    if (is_turned) {
        const Vec3 moment = piece.turns.transpose().inverse() * moving.tail<3>();
        text << "turn it with " << moment.norm() << " N m about the axis "
             << moment.normalized().transpose();
    } else
        text << "push it with " << moving.head<3>().norm() << " N along "
             << moving.head<3>().normalized().transpose();
    MotionFailure failure(FailureCause::free_component_loaded, text.str());
    failure.cell = cell;
    throw failure;
}

}  // namespace incise::physics
