// Sums over the nodes of a body, for the body totals.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "incise/base/sum.h"
#include "incise/physics/elements/workers.h"

namespace incise::physics {

/// The index of each quantity in NodeSums; of a vector, that of the first of its three components.
struct NodeSum {
    enum Index : std::size_t {
        mass,                                   ///< kg
        kinetic_energy,                         ///< J
        gravity_energy,                         ///< J, zero at the origin
        momentum,                               ///< kg m/s
        angular_momentum = momentum + 3,        ///< kg m2/s, about the origin
        moment_of_mass = angular_momentum + 3,  ///< mass times position, kg m
        count = moment_of_mass + 3
    };
};
using NodeSums = Sums<NodeSum::count>;

/// A cache of the sums by range of nodes. After an edit, only the touched ranges are summed again.
class KeptNodeSums {
  public:
    /// Discards the sum with a node whose mass, position or velocity has changed.
    void forget(std::size_t node) {
        if (const std::size_t r = node / nodes_per_range; r < ranges_.size()) ranges_[r].reset();
    }
    /// Sets the number of nodes.
    void resize(std::size_t num_nodes) {
        forget(num_nodes);  // if nodes were removed, the last range has fewer nodes than before
        ranges_.resize(num_node_ranges(num_nodes));
    }

    /// Returns the sum over all ranges, in ascending order. Calls sums_of(range) for each range
    /// whose sum is not in the cache. The cache is cleared if `version`, the version of the state,
    /// is not that of the last call.
    template <class SumsOf>
    NodeSums value(std::uint64_t version, std::size_t num_nodes, const Workers& workers,
                   SumsOf sums_of) {
        if (version_ != version) ranges_.clear();
        version_ = version;
        ranges_.resize(num_node_ranges(num_nodes));
        workers.for_each_range(num_nodes, [&](NodeRange range) {
            if (!ranges_[range.number]) ranges_[range.number] = sums_of(range);
        });
        NodeSums sums;
        for (const auto& range : ranges_) sums += *range;
        return sums;
    }

  private:
    std::vector<std::optional<NodeSums>> ranges_;
    std::uint64_t version_ = 0;  // of the state to which the sums belong
};

}  // namespace incise::physics
