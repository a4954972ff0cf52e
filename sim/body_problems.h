// What is at fault with the body that a scenario describes, collected so that all is told at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "topology/error.h"

namespace incise::sim {

/// A line for each problem, complete in itself: "FILE:line:column: text".
struct BodyError : InputError {
    using InputError::InputError;
};

class BodyProblems {
  public:
    /// Returns build(); if it throws InputError, notes that what stands at `place` is at fault, and
    /// returns an empty value.
    template <class Build>
    auto try_to(const std::string& place, Build build) -> decltype(build()) {
        try {
            return build();
        } catch (const InputError& error) {
            text_ +=
                (text_.empty() ? "" : "\n") + (place.empty() ? "" : place + ": ") + error.what();
            return decltype(build())();
        }
    }

    bool are_there() const { return !text_.empty(); }
    /// Throws BodyError if there are any.
    void throw_if_any() const {
        if (are_there()) throw BodyError(text_);
    }

  private:
    std::string text_;
};

}  // namespace incise::sim
