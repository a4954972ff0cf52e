// The largest stable step of the explicit integrator, kept up to date node by node.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace incise::physics {

/// Bound dt = 2 / sqrt(max_i s_i / m_i) on the step of semi-implicit Euler, where s_i sums over
/// the elements at node i what Gershgorin's theorem makes of their stiffness at rest. Rigorous
/// there: never above 2 / omega_max, in practice 0.5 to 0.85 of it. Large strain changes the
/// stiffness; the safety factor of the step is for that.
class StableStep {
  public:
    /// Sets a node's quotient s/m (N/m, kg); a node without mass, a dead one, has none.
    void set(std::size_t node, double stiffness, double mass);
    /// Drops the nodes from `num_nodes` on.
    void truncate(std::size_t num_nodes);

    /// Seconds; infinite without a node. Cost: proportional to the blocks of nodes set since the
    /// last call. The maximum is exact, so no history shows in it.
    double value() const;

    /// That of a node that has been set, 1/s2.
    double quotient(std::size_t node) const { return quotients_[node]; }

    /// The node that sets it; 0 without a node.
    std::size_t limiting_node() const;

  private:
    static constexpr std::size_t block_size = 256;
    std::vector<double> quotients_;
    mutable std::vector<double> block_max_;  // negative: to be found anew
};

}  // namespace incise::physics
