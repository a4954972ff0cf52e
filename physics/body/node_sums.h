// What the nodes of a body add up to: for the books.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "incise/base/sum.h"
#include "incise/physics/elements/workers.h"

namespace incise::physics {

/// Where what nodes add up to stands among their sums; of vectors the first of three components.
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

/// By range of nodes, kept until one of the range changes: so another look beside an edit costs
/// what that touched.
class KeptNodeSums {
  public:
    /// A node has another mass, position or velocity.
    void forget(std::size_t node) {
        if (const std::size_t r = node / nodes_per_range; r < ranges_.size()) ranges_[r].reset();
    }
    /// There are so many now; those that are gone count no more.
    void resize(std::size_t num_nodes) {
        forget(num_nodes);  // the range that has lost some, if any has
        ranges_.resize(num_node_ranges(num_nodes));
    }

    /// The sum over all ranges, in order; sums_of(range) of those that are not known.
    /// @param version of the state
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
    std::uint64_t version_ = 0;  // of the state that they are of
};

}  // namespace incise::physics
