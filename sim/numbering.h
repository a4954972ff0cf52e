// Numbers for things in a list, which stay when others are removed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "incise/base/error.h"

namespace incise::sim {

/// Where the things are in a list that have been given numbers: those that are removed leave it.
class Numbering {
  public:
    explicit Numbering(const char* noun, std::size_t count = 0) : noun_(noun) {
        for (std::size_t i = 0; i < count; ++i) add();
    }
    std::size_t add() {
        places_.push_back(count_++);
        return places_.size() - 1;
    }
    /// Throws InputError for a number that was never given, or whose thing is gone.
    std::size_t place(std::size_t number) const {
        if (number >= places_.size())
            throw InputError(std::string("there is no ") + noun_ + " " + std::to_string(number) +
                             ": the world has had " + std::to_string(places_.size()));
        if (!places_[number])
            throw InputError(std::string(noun_) + " " + std::to_string(number) +
                             " has been removed");
        return *places_[number];
    }
    void remove(std::size_t number) {
        const std::size_t gone = place(number);
        places_[number].reset();
        --count_;
        for (auto& place : places_)
            if (place && *place > gone) --*place;
    }
    bool fits(std::size_t count) const {
        return count_ == count && std::ranges::all_of(places_, [&](const auto& place) {
                   return !place || *place < count;
               });
    }
    static void archive(auto& ar, auto& self) { ar(self.places_, self.count_); }

  private:
    const char* noun_;
    std::vector<std::optional<std::size_t>> places_;  // by number
    std::size_t count_ = 0;
};

}  // namespace incise::sim
