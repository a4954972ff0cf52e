// Problems found while reading a scenario: collected, so that all are told at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/scenario/document.h"

namespace incise::scenario {

class Diagnostics {
  public:
    /// @param overrides  those of the command line, which messages about them quote; copied
    Diagnostics(std::string file, std::span<const std::string> overrides)
        : file_(std::move(file)), overrides_(overrides.begin(), overrides.end()) {}

    void error(const SourceLocation& location, std::string text) {
        errors_.push_back({location, std::move(text), {}});
    }
    /// "key 'PATH': TEXT"
    void key_error(const SourceLocation& location, std::string_view path, std::string_view text);
    /// The same of a key that is not known, and so says nothing of the rest: has_errors_at() does
    /// not count it.
    void unknown_key_error(const SourceLocation& location, std::string_view path,
                           std::string_view text);
    /// Tells nothing, but has_errors_at() counts it.
    void untold_error(std::string path) { untold_.push_back(std::move(path)); }
    void warning(const SourceLocation& location, std::string text) {
        warnings_.push_back({location, std::move(text), {}});
    }

    /// "FILE:line:column", or "--set OVERRIDE".
    std::string text_of(const SourceLocation& location) const;

    bool has_errors() const { return !errors_.empty(); }
    /// Whether the key of any error is `path` or below it, or is of an element of it.
    bool has_errors_at(std::string_view path) const;

    /// In the order of the file, then of the overrides, each as "FILE:line:column: text".
    std::vector<std::string> errors() const { return formatted(errors_); }
    std::vector<std::string> warnings() const { return formatted(warnings_); }

  private:
    struct Finding {
        SourceLocation location;
        std::string text;
        std::string path;  // of the key, if it is about one
    };
    std::vector<std::string> formatted(std::vector<Finding> findings) const;

    std::string file_;
    std::vector<std::string> overrides_;
    std::vector<Finding> errors_, warnings_;
    std::vector<std::string> untold_;
};

/// Whether the path of a key is `owner` or below it, or is of an element of it.
bool is_at_or_below(std::string_view path, std::string_view owner);

/// The candidate that takes the fewest insertions, deletions, replacements and swaps of
/// neighbours to make of `name`; the first of equals. Empty without candidates.
std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates);

/// Whether `name` is most likely the candidate misspelt: by one slip in three letters at most, or
/// one of the two is the beginning of the other, of three letters at least.
bool is_misspelt(std::string_view name, std::string_view candidate);

/// The text between single quotes.
std::string in_quotes(std::string_view text);

/// "a, b, c".
std::string list_of(std::span<const std::string_view> names);

}  // namespace incise::scenario
