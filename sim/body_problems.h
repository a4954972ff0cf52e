// What is at fault with the body that a scenario describes, collected so that all is told at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "topology/error.h"

namespace incise::sim {

/// A line for each problem, complete in itself: "FILE:line:column: text".
struct BodyError : InputError {
    using InputError::InputError;
    /// @param place  "FILE:line:column", or empty for a scenario that comes from no file
    BodyError(const std::string& place, const std::string& text)
        : InputError(joined(place, place.empty() ? "" : ": ", text)) {}

    static std::string joined(std::string first, const char* between, const std::string& second) {
        return first.append(between).append(second);
    }
};

class BodyProblems {
  public:
    /// Returns build(). If it throws InputError, notes that what stands at `place` is at fault, and
    /// returns an empty value; a BodyError knows its own place.
    template <class Build>
    auto try_to(const std::string& place, Build build) -> decltype(build()) {
        try {
            return build();
        } catch (const BodyError& error) {
            add(error);
        } catch (const InputError& error) {
            add(BodyError(place, error.what()));
        }
        return decltype(build())();
    }

    bool are_there() const { return !text_.empty(); }
    /// Throws BodyError if there are any.
    void throw_if_any() const {
        if (are_there()) throw BodyError(text_);
    }

  private:
    void add(const BodyError& error) {
        text_ = BodyError::joined(text_, text_.empty() ? "" : "\n", error.what());
    }

    std::string text_;
};

}  // namespace incise::sim
