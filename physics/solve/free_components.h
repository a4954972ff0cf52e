// Connected components that constraints do not hold in every direction: statics has no unique
// answer for these. SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "incise/physics/body/constraints.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// A piece that can move as a rigid body, and the ways in which it can.
struct FreeComponent {
    std::vector<NodeId> nodes;
    std::size_t num_elements = 0;
    Vec3 centre = Vec3::Zero();  ///< of its nodes, m
    /// Turns about the centre: a unit in column k turns the piece about its principal axis k, by so
    /// much that the root mean square of its nodes' ways is 1 m. In this measure a needle that
    /// turns about its length moves as much as one that turns over. 1/m
    Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
    /// Ways it can move, orthonormal in the columns: velocity at the centre, then that of `turns`.
    Eigen::Matrix<double, 6, Eigen::Dynamic> modes;
    /// As few components as take these ways from it (statically determinate): held there, it
    /// stays where it is, and the reactions are zero as long as its loads are in equilibrium.
    std::vector<std::pair<NodeId, int>> pins;

    /// What holds it; the rest serves messages about a piece just found.
    static void archive(auto& ar, auto& self) { ar(self.nodes, self.pins); }
};

/// Of the present positions (m, by node id). Cost: O(#nodes + #elements).
std::vector<FreeComponent> find_free_components(const topology::Mesh& mesh,
                                                std::span<const Vec3> positions,
                                                const Constraints& constraints);

/// Throws PhysicsError, naming the piece and the remedy, if forces (N, by node id) would move it.
void require_equilibrium(const topology::Mesh& mesh, const FreeComponent& piece,
                         std::span<const Vec3> positions, std::span<const Vec3> forces);

}  // namespace incise::physics
