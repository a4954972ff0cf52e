// SPDX-License-Identifier: LGPL-3.0-or-later
#include "app/messages.h"

#include <iostream>
#include <utility>

#include "sim/scenario_reader.h"
#include "topology/error.h"

namespace incise::app {

void print_error(std::string_view text) { std::cerr << prefixed("incise: ", text) << '\n'; }

void print_warning(std::string_view text) {
    std::cerr << prefixed("incise: warning: ", text) << '\n';
}

std::string prefixed(std::string_view prefix, std::string_view text) {
    std::string result(prefix);
    for (const char c : text) {
        result += c;
        if (c == '\n') result += prefix;
    }
    return result;
}

std::string joined(std::span<const std::string> lines) {
    std::string text;
    for (const auto& line : lines) text.append(text.empty() ? "" : "\n").append(line);
    return text;
}

sim::Scenario load_scenario(const std::filesystem::path& file,
                            std::span<const std::string> overrides) {
    auto report = sim::read_scenario(file, overrides);
    for (const auto& warning : report.warnings) print_warning(warning);
    if (!report.errors.empty()) throw InputError(joined(report.errors));
    return std::move(report.scenario);
}

}  // namespace incise::app
