// Disjoint sets of numbers, which can be joined.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace incise {

/// Disjoint sets of the numbers from 0 to size - 1 (union-find with path halving). At first each
/// number is in a set of its own. The lowest number of a set represents it.
class DisjointSet {
  public:
    explicit DisjointSet(std::size_t size) : lower_(size) {
        std::iota(lower_.begin(), lower_.end(), 0);
    }

    /// Returns the lowest number in the set of `i`.
    std::int32_t find(std::int32_t i) {
        while (at(i) != i) i = at(i) = at(at(i));
        return i;
    }
    /// Joins the sets of `i` and `j`. Returns the lowest number in the joined set.
    std::int32_t join(std::int32_t i, std::int32_t j) {
        i = find(i), j = find(j);
        return at(std::max(i, j)) = std::min(i, j);
    }

  private:
    std::int32_t& at(std::int32_t i) { return lower_[static_cast<std::size_t>(i)]; }

    std::vector<std::int32_t> lower_;
};

}  // namespace incise
