// Connected components that constraints do not hold in every direction. Statics has no unique
// equilibrium for these.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/body/constraints.h"

namespace incise::physics {

/// A connected component that can move as a rigid body, and its free rigid motions.
struct FreeComponent {
    std::vector<NodeId> nodes;
    std::size_t num_elements = 0;
    Vec3 centre = Vec3::Zero();  ///< mean position of the nodes, m
    /// Rotations about the centre, 1/m. Column k is a rotation vector along principal axis k that
    /// displaces the nodes by 1 m, as root mean square. In this measure the rotation of a needle
    /// about its length counts as much as any other.
    Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
    /// The free motions, as orthonormal columns: translation of the centre, then the amounts of the
    /// columns of `turns`.
    Eigen::Matrix<double, 6, Eigen::Dynamic> modes;
    /// The fewest position components, as node and axis, that prevent these motions if held
    /// (statically determinate). Their reactions are zero as long as the loads on this connected
    /// component are in equilibrium.
    std::vector<std::pair<NodeId, int>> pins;

    /// Holds nodes and pins only. The other members serve messages, at the time of the search.
    static void archive(auto& ar, auto& self) { ar(self.nodes, self.pins); }
};

/// Returns the free components at the given positions (m, by node id).
/// Cost: O(#nodes + #elements).
std::vector<FreeComponent> find_free_components(const fragments::FragmentMesh& fragments,
                                                std::span<const Vec3> positions,
                                                const Constraints& constraints);

/// Throws MotionFailure if the forces (N, by node id) would move the free component. The failure
/// names one of its elements, by its label in the mesh.
void require_equilibrium(const fragments::FragmentMesh& fragments, const topology::Mesh& mesh,
                         const FreeComponent& piece, std::span<const Vec3> positions,
                         std::span<const Vec3> forces);

}  // namespace incise::physics
