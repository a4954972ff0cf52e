// Which of many numbers belong together, as that is found out.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace incise {

/// The numbers from 0 to size - 1, each in a group of its own until groups are joined. The lowest
/// of a group stands for it (disjoint sets, with paths halved).
class DisjointSet {
  public:
    explicit DisjointSet(std::size_t size) : lower_(size) {
        std::iota(lower_.begin(), lower_.end(), 0);
    }

    /// The lowest of the group of `i`.
    std::int32_t find(std::int32_t i) {
        while (at(i) != i) i = at(i) = at(at(i));
        return i;
    }
    /// Returns the lowest of the two groups, which are one from now on.
    std::int32_t join(std::int32_t i, std::int32_t j) {
        i = find(i), j = find(j);
        return at(std::max(i, j)) = std::min(i, j);
    }

  private:
    std::int32_t& at(std::int32_t i) { return lower_[static_cast<std::size_t>(i)]; }

    std::vector<std::int32_t> lower_;
};

}  // namespace incise
