// Permanent numbers for the things in a list.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "incise/base/error.h"

namespace incise::sim {

/// Map from permanent numbers to positions in a list. When a thing is removed, the things behind it
/// move up in the list and keep their numbers.
class Numbering {
  public:
    /// @param noun   what the things are called in messages
    /// @param count  how many things the list has at first
    explicit Numbering(const char* noun, std::size_t count = 0) : noun_(noun) {
        for (std::size_t i = 0; i < count; ++i) add();
    }
    /// Appends a thing to the list and returns its number.
    std::size_t add() {
        positions_.push_back(count_++);
        return positions_.size() - 1;
    }
    /// Returns the position in the list of the thing with this number.
    /// Throws InputError if the number was never assigned, or if the thing has been removed.
    std::size_t position_of(std::size_t number) const {
        if (number >= positions_.size())
            throw InputError(std::string("there is no ") + noun_ + " " + std::to_string(number) +
                             ": the world has had " + std::to_string(positions_.size()));
        if (!positions_[number])
            throw InputError(std::string(noun_) + " " + std::to_string(number) +
                             " has been removed");
        return *positions_[number];
    }
    /// Removes the thing from the list. Throws InputError as position_of() does.
    void remove(std::size_t number) {
        const std::size_t gone = position_of(number);
        positions_[number].reset();
        --count_;
        for (auto& position : positions_)
            if (position && *position > gone) --*position;
    }
    /// True if the list has `count` things and all positions lie in it.
    bool fits(std::size_t count) const {
        return count_ == count && std::ranges::all_of(positions_, [&](const auto& position) {
                   return !position || *position < count;
               });
    }
    static void archive(auto& ar, auto& self) { ar(self.positions_, self.count_); }

  private:
    const char* noun_;
    std::vector<std::optional<std::size_t>> positions_;  // by number
    std::size_t count_ = 0;
};

}  // namespace incise::sim
