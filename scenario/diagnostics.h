// The problems of a scenario, collected during reading so that all are reported at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/scenario/document.h"

namespace incise::scenario {

/// A collection of errors and warnings with their locations.
class Diagnostics {
  public:
    /// @param file       name of the file, for messages
    /// @param overrides  overrides of the command line, for messages
    Diagnostics(std::string file, std::span<const std::string> overrides)
        : file_(std::move(file)), overrides_(overrides.begin(), overrides.end()) {}

    void error(const SourceLocation& location, std::string text) {
        errors_.push_back({location, std::move(text), {}});
    }
    /// Adds the error "key 'PATH': TEXT".
    void key_error(const SourceLocation& location, std::string_view path, std::string_view text);
    /// Adds the error "key 'PATH': TEXT" for an unknown key. has_errors_at() does not count it.
    void unknown_key_error(const SourceLocation& location, std::string_view path,
                           std::string_view text);
    /// Adds an error that has_errors_at() counts but errors() does not list.
    void note_error(std::string path) { noted_.push_back(std::move(path)); }
    void warning(const SourceLocation& location, std::string text) {
        warnings_.push_back({location, std::move(text), {}});
    }

    /// Returns a location as "FILE:line:column" or "--set OVERRIDE".
    std::string text_of(const SourceLocation& location) const;

    bool has_errors() const { return !errors_.empty(); }
    /// True if an error is about the key `path`, about a key below it, or about one of its
    /// elements.
    bool has_errors_at(std::string_view path) const;

    /// Returns the errors as "FILE:line:column: text", in the order of the file, then in that of
    /// the overrides.
    std::vector<std::string> errors() const { return formatted(errors_); }
    std::vector<std::string> warnings() const { return formatted(warnings_); }

  private:
    struct Finding {
        SourceLocation location;
        std::string text;
        std::string path;  // of the key; empty if the finding is about no key
    };
    std::vector<std::string> formatted(std::vector<Finding> findings) const;

    std::string file_;
    std::vector<std::string> overrides_;
    std::vector<Finding> errors_, warnings_;
    std::vector<std::string> noted_;
};

/// True if `path` is `owner`, a key below it, or one of its elements.
bool is_at_or_below(std::string_view path, std::string_view owner);

/// Returns the candidate that people mean by `name`, such as "blade" by "scalpel", or else that
/// with the smallest edit distance from it. The distance counts
/// insertions, deletions, replacements and swaps of neighbours, and ignores case. Of equal
/// candidates the first one is returned. Without candidates the result is empty.
std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates);

/// True if `name` is likely a misspelling of `candidate`: the edit distance is at most a third of
/// the longer length, or the shorter word has at least three letters and begins the other word.
bool is_misspelt(std::string_view name, std::string_view candidate);

/// Returns the text between single quotes.
std::string in_quotes(std::string_view text);

/// Returns the names as "a, b, c".
std::string list_of(std::span<const std::string_view> names);

}  // namespace incise::scenario
