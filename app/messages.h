// How the command speaks: everything about the work goes to stderr, one message a line.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/scenario/scenario.h"

namespace incise::app {

/// "incise: TEXT", each line of the text for itself.
void print_error(std::string_view text);
/// "incise: warning: TEXT".
void print_warning(std::string_view text);

/// One line each.
std::string joined(std::span<const std::string> lines);

/// The text with `prefix` before each of its lines.
std::string prefixed(std::string_view prefix, std::string_view text);

/// Appends what is at fault or odd with the body that the scenario describes. If memory
/// does not suffice for it, throws MemoryError or std::bad_alloc where there are no errors before.
void add_body_findings(const scenario::Scenario& scenario, std::vector<std::string>& errors,
                       std::vector<std::string>& warnings);

/// The scenario, its warnings printed. If there are errors, throws InputError with them and those
/// of the body that it describes, one a line.
scenario::Scenario load_scenario(const std::filesystem::path& file,
                                 std::span<const std::string> overrides = {});

}  // namespace incise::app
