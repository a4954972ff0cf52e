// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/body_problems.h"

#include <sstream>
#include <utility>

namespace incise::scenario {

namespace {

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text.append(text.empty() ? "" : "\n").append(line);
    return text;
}

}  // namespace

std::vector<std::string> prefixed_lines(const std::string& prefix, const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream >> std::ws, line);) lines.push_back(prefix + line);
    return lines;
}

std::string located(const std::string& location, const std::string& text) {
    return location.empty() ? text : joined(prefixed_lines(location + ": ", text));
}

void BodyProblems::add(const std::string& location, const std::string& text) {
    for (std::string& line : prefixed_lines("", located(location, text)))
        lines_.push_back(std::move(line));
}

void BodyProblems::throw_if_any(std::vector<std::string> warnings) const {
    if (lines_.empty()) return;
    BodyError error(joined(lines_));
    error.warnings = std::move(warnings);
    throw error;
}

}  // namespace incise::scenario
