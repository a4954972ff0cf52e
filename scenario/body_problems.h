// What is at fault with the body that a scenario describes, collected so that all is told at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/base/error.h"

namespace incise::scenario {

/// `prefix` before each line of the text, whose indents are left out.
std::vector<std::string> prefixed_lines(const std::string& prefix, const std::string& text);

/// The same as one text. Without prefix the text itself.
std::string located(const std::string& location, const std::string& text);

/// A line for each problem, complete in itself: "FILE:line:column: text".
struct BodyError : InputError {
    using InputError::InputError;
    /// @param location  "FILE:line:column", or empty for a scenario that comes from no file
    BodyError(const std::string& location, const std::string& text)
        : InputError(located(location, text)) {}

    std::vector<std::string> warnings;  ///< what was found odd besides
};

class BodyProblems {
  public:
    /// Returns build(). If it throws InputError, notes that what stands at `location` is at fault,
    /// and returns an empty value; a BodyError and a PhysicsError know their own location.
    template <class Build>
    auto try_to(const std::string& location, Build build) -> decltype(build()) {
        try {
            return build();
        } catch (const BodyError& error) {
            add("", error.what());
        } catch (const InputError& error) {
            add(location, error.what());
        } catch (const PhysicsError& error) {
            add("", error.what());
        }
        return decltype(build())();
    }

    void add(const std::string& location, const std::string& text);

    bool are_there() const { return !lines_.empty(); }
    const std::vector<std::string>& lines() const { return lines_; }

    /// Throws BodyError if there are any.
    void throw_if_any(std::vector<std::string> warnings = {}) const;

  private:
    std::vector<std::string> lines_;
};

}  // namespace incise::scenario
