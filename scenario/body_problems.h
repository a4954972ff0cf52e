// The problems of the body that a scenario describes, collected so that all are reported at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/base/error.h"

namespace incise::scenario {

/// Returns the lines of the text without indentation, each with `prefix` before it.
std::vector<std::string> prefixed_lines(const std::string& prefix, const std::string& text);

/// Returns the text with "LOCATION: " before each line. Without location returns the text itself.
std::string located(const std::string& location, const std::string& text);

/// Problems of a body, one a line. Each line is complete in itself: "FILE:line:column: text".
struct BodyError : InputError {
    using InputError::InputError;
    /// @param location  "FILE:line:column", or empty for a scenario without file
    /// @param text      the problems, one a line
    BodyError(const std::string& location, const std::string& text)
        : InputError(located(location, text)) {}

    std::vector<std::string> warnings;  ///< warnings found beside the problems
};

/// A collection of the problems of a body.
class BodyProblems {
  public:
    /// Returns build(). If build() throws InputError, adds the problem with `location` and returns
    /// an empty value. A BodyError or PhysicsError is added as it is: its text has the location.
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

    /// Throws BodyError if there are problems.
    void throw_if_any(std::vector<std::string> warnings = {}) const;

  private:
    std::vector<std::string> lines_;
};

}  // namespace incise::scenario
