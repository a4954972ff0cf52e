// Messages of the program. All messages go to stderr, one a line.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/scenario/body.h"
#include "incise/scenario/scenario.h"

namespace incise::app {

/// Prints "incise: LINE" for each line of the text.
void print_error(std::string_view text);
/// Prints "incise: warning: LINE" for each line of the text.
void print_warning(std::string_view text);

/// Returns the lines as one text, with line feeds between them.
std::string joined(std::span<const std::string> lines);

/// Returns the text with `prefix` before each of its lines.
std::string prefixed(std::string_view prefix, std::string_view text);

/// Appends the errors and warnings about the body of a scenario. If there is too little memory for
/// the body, throws MemoryError or std::bad_alloc, but only if `errors` was empty. Returns all that
/// was found.
scenario::BodyFindings add_body_findings(const scenario::Scenario& scenario,
                                         std::vector<std::string>& errors,
                                         std::vector<std::string>& warnings);

/// Reads a scenario and prints its warnings. If there are errors, throws InputError with these and
/// with the errors of the body, one a line.
scenario::Scenario load_scenario(const std::filesystem::path& file,
                                 std::span<const std::string> overrides = {});

}  // namespace incise::app
