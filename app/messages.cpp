// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/messages.h"

#include <iostream>
#include <new>
#include <utility>

#include "incise/base/error.h"
#include "incise/scenario/body.h"
#include "incise/scenario/scenario_reader.h"

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

scenario::BodyFindings add_body_findings(const scenario::Scenario& scenario,
                                         std::vector<std::string>& errors,
                                         std::vector<std::string>& warnings) {
    try {
        scenario::BodyFindings body = scenario::check_body(scenario);
        errors.insert(errors.end(), body.errors.begin(), body.errors.end());
        warnings.insert(warnings.end(), body.warnings.begin(), body.warnings.end());
        return body;
    } catch (const MemoryError& error) {
        if (errors.empty()) throw;
        errors.emplace_back(error.what());
    } catch (const std::bad_alloc&) {
        if (errors.empty()) throw;
    }
    return {};
}

scenario::Scenario load_scenario(const std::filesystem::path& file,
                                 std::span<const std::string> overrides) {
    auto report = scenario::read_scenario(file, overrides);
    if (!report.errors.empty()) add_body_findings(report.scenario, report.errors, report.warnings);
    for (const auto& warning : report.warnings) print_warning(warning);
    if (!report.errors.empty()) throw InputError(joined(report.errors));
    return std::move(report.scenario);
}

}  // namespace incise::app
