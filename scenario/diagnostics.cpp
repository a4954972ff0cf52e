// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/diagnostics.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace incise::scenario {

namespace {

/// Returns the edit distance of two names. A swap of neighbours counts as one edit; case is
/// ignored.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const auto same = [](char x, char y) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
        return lower(x) == lower(y);
    };
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min(
                {last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0u : 1u)});
            if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

/// Without a path the text is about the whole table.
std::string about_key(std::string_view path, std::string_view text) {
    if (path.empty()) return std::string(text);
    return std::string("key ").append(in_quotes(path)).append(": ").append(text);
}

}  // namespace

void Diagnostics::key_error(const SourceLocation& location, std::string_view path,
                            std::string_view text) {
    errors_.push_back({location, about_key(path, text), std::string(path)});
}

void Diagnostics::unknown_key_error(const SourceLocation& location, std::string_view path,
                                    std::string_view text) {
    errors_.push_back({location, about_key(path, text), {}});
}

bool Diagnostics::has_errors_at(std::string_view path) const {
    const auto is_there = [&](const std::string& at) { return is_at_or_below(at, path); };
    return std::ranges::any_of(errors_, is_there, &Finding::path) ||
           std::ranges::any_of(noted_, is_there);
}

std::vector<std::string> Diagnostics::formatted(std::vector<Finding> findings) const {
    std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
        const auto key = [](const SourceLocation& p) {
            return std::tuple(p.override_number, p.line, p.column);
        };
        return key(a.location) < key(b.location);
    });
    std::vector<std::string> texts;
    texts.reserve(findings.size());
    for (const auto& [location, text, path] : findings)
        texts.push_back(text_of(location) + ": " + text);
    return texts;
}

std::string Diagnostics::text_of(const SourceLocation& location) const {
    // A value that was read elsewhere has a number without an override here.
    const auto number = static_cast<std::size_t>(location.override_number);
    if (location.override_number >= 0 && number < overrides_.size())
        return "--set " + overrides_[number];
    if (location.line == 0) return file_;
    return file_ + ":" + std::to_string(location.line) + ":" + std::to_string(location.column);
}

bool is_at_or_below(std::string_view path, std::string_view owner) {
    return path.starts_with(owner) &&
           (path.size() == owner.size() || path[owner.size()] == '.' || path[owner.size()] == '[');
}

namespace {

struct Synonym {
    std::string_view said, meant;
};

/// What people call things, where it is not what the program calls them.
constexpr Synonym synonyms[] = {
    // tools
    {"scalpel", "blade"},
    {"knife", "blade"},
    {"shears", "scissors"},
    {"wire", "blade"},
    {"stitch", "suture"},
    {"thread", "suture"},
    {"seam", "suture"},
    {"forceps", "grasper"},
    {"gripper", "grasper"},
    {"clamp", "grasper"},
    {"jaws", "grasper"},
    {"burr", "carver"},
    {"drill", "carver"},
    {"cautery", "carver"},
    {"eraser", "carver"},
    {"indenter", "probe"},
    {"finger", "probe"},
    {"needle", "probe"},
    {"plane", "cut"},
    // verbs
    {"simulate", "run"},
    {"start", "run"},
    {"solve", "run"},
    {"resume", "run"},
    {"plot", "render"},
    {"draw", "render"},
    {"view", "render"},
    {"picture", "render"},
    {"validate", "check"},
    {"verify", "check"},
    {"lint", "check"},
    {"describe", "info"},
    {"export", "convert"},
    {"tetrahedralize", "mesh"},
    {"benchmark", "bench"},
    // keys and names of laws
    {"youngs_modulus", "young"},
    {"E", "young"},
    {"nu", "poisson"},
    {"poisson_ratio", "poisson"},
    {"rho", "density"},
    {"mu", "friction"},
    {"duration", "end_time"},
    {"dt", "time_step"},
    {"svk", "saint-venant-kirchhoff"},
    {"stvk", "saint-venant-kirchhoff"},
};

}  // namespace

std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates) {
    for (const auto& [said, meant] : synonyms)
        if (name == said && std::ranges::find(candidates, meant) != candidates.end()) return meant;
    std::string_view best;
    auto least = std::numeric_limits<std::size_t>::max();
    for (const auto candidate : candidates)
        if (const auto distance = edit_distance(name, candidate); distance < least) {
            least = distance;
            best = candidate;
        }
    return best;
}

bool is_misspelt(std::string_view name, std::string_view candidate) {
    constexpr std::size_t shortest = 3;
    const std::size_t common = std::min(name.size(), candidate.size());
    if (common >= shortest && name.substr(0, common) == candidate.substr(0, common)) return true;
    return 3 * edit_distance(name, candidate) <= std::max(name.size(), candidate.size());
}

std::string in_quotes(std::string_view text) {
    std::string result = "'";
    result.append(text).push_back('\'');
    return result;
}

std::string list_of(std::span<const std::string_view> names) {
    std::string text;
    for (const auto name : names) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
}

}  // namespace incise::scenario
