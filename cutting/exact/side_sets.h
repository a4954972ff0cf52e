// Which of some things are on the same side of a surface.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace incise::cutting {

/// Sets of things that are known to be on the same side of a surface, or on different sides.
class SideSets {
  public:
    explicit SideSets(std::size_t count = 0) {
        for (std::size_t i = 0; i < count; ++i) add();
    }
    void add() {
        parents_.push_back(parents_.size());
        is_other_.push_back(false);
    }
    /// Notes that two of them are on the same side, or not. Returns false, and changes nothing, if
    /// what is known already says the contrary.
    bool relate(std::size_t i, std::size_t j, bool is_other_side) {
        const auto [a, other_a] = find(i);
        const auto [b, other_b] = find(j);
        if (a == b) return is_other_side == (other_a != other_b);
        parents_[std::max(a, b)] = std::min(a, b);
        is_other_[std::max(a, b)] = is_other_side != (other_a != other_b);
        return true;
    }
    /// True if it is not on the side of the first one that it is related to.
    bool is_other(std::size_t i) const { return find(i).second; }
    /// True if the two are known to be on different sides.
    bool are_parted(std::size_t i, std::size_t j) const {
        const auto [a, other_a] = find(i);
        const auto [b, other_b] = find(j);
        return a == b && other_a != other_b;
    }

  private:
    /// Returns the first of its set, and true if it is on the other side of that.
    std::pair<std::size_t, bool> find(std::size_t i) const {
        bool is_other = false;
        for (; parents_[i] != i; i = parents_[i]) is_other ^= is_other_[i];
        return {i, is_other};
    }

    std::vector<std::size_t> parents_;
    std::vector<bool> is_other_;  // than that of the parent
};

}  // namespace incise::cutting
