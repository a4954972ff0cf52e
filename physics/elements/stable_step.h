// The stable step of the explicit integrator, updated node by node.
// Source: docs/theory.md, Stable step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace incise::physics {

/// The bound dt = 2 / sqrt(max_i s_i / m_i) on the step of symplectic (semi-implicit) Euler.
///
/// m_i is the mass of node i. s_i is a bound of the stiffness at the node: a sum over its elements,
/// by Gershgorin's theorem. At rest the bound is never above 2 / omega_max, and in practice 0.5 to
/// 0.85 of it. Model::stable_step() is the bound with the present stiffness.
/// @thread One thread at a time.
class StableStep {
  public:
    /// Sets the quotient s/m of a node from its stiffness s, N/m, and its mass m, kg. A node
    /// without mass, which is dead, does not count.
    void set(std::size_t node, double stiffness, double mass);
    /// Removes the nodes from `num_nodes` on.
    void truncate(std::size_t num_nodes);

    /// Returns the bound, s; infinite without nodes. It does not depend on the order of the calls
    /// of set(). Cost: proportional to the number of nodes / 256, and to the blocks of 256 nodes
    /// that have changed since the last call.
    double value() const { return step_of(highest()); }
    /// Returns the largest quotient, 1/s2; 0 without nodes. Cost as for value().
    double highest() const;
    /// Returns the bound for a largest quotient.
    static double step_of(double highest);

    /// Returns the quotient s/m of a node, 1/s2.
    /// @pre  it was set
    double quotient(std::size_t node) const { return quotients_[node]; }

    /// Returns the node with the largest quotient; 0 without nodes. Cost: O(n).
    std::size_t limiting_node() const;

  private:
    static constexpr std::size_t block_size = 256;
    std::vector<double> quotients_;          // by node, 1/s2; 0 for a dead node
    mutable std::vector<double> block_max_;  // by block; negative: not known
};

}  // namespace incise::physics
