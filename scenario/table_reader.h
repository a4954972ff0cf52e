// Checked reading of one table of a document: types, ranges, names and unknown keys.
// Each problem is reported with its location and the key's full path, and reading goes on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/types.h"
#include "incise/scenario/diagnostics.h"
#include "incise/scenario/document.h"
#include "incise/scenario/limits.h"

namespace incise::scenario {

/// Names that are taken.
struct Names {
    std::span<const std::string_view> supported;
};

/// What is wrong with `name`: unknown, and nearest to which; nothing if it is among the supported
/// ones.
std::optional<std::string> complaint(std::string_view name, const Names& names);

struct IntegerLimits {
    std::int64_t low = std::numeric_limits<std::int64_t>::min();
    std::int64_t high = std::numeric_limits<std::int64_t>::max();
};

/// Of numbers in a list.
enum class Repeats { taken_once, refused };

/// Reads of a key that is missing or wrong give the fallback; a wrong one is reported, a missing
/// one only by require(). The result counts only if there are no errors in the end.
class TableReader {
  public:
    /// Reports the keys that are not among `keys`; one that is most likely another one misspelt is
    /// then read as that, so that what follows from it is not missed. If that does not suit its
    /// value, the guess was most likely wrong: then nothing more is told of it. All references must
    /// outlive the reader.
    TableReader(const Table& table, const SourceLocation& location, std::string path,
                const Names& keys, Diagnostics& diagnostics);

    bool has(std::string_view key) const { return value_of(key) != nullptr; }
    bool is_text(std::string_view key) const;
    bool is_empty_array(std::string_view key) const;
    /// Reports that the key is missing; `remedy` says what to write.
    bool require(std::string_view key, std::string_view remedy) const;

    double number(std::string_view key, double fallback, const Limits& limits = {}) const;
    std::optional<double> number_if_given(std::string_view key, const Limits& limits = {}) const;
    std::int64_t integer(std::string_view key, std::int64_t fallback,
                         const IntegerLimits& limits = {}) const;
    bool flag(std::string_view key, bool fallback) const;
    std::string text(std::string_view key, const std::string& fallback = {}) const;
    Vec3 vector(std::string_view key, const Vec3& fallback = Vec3::Zero()) const;
    /// A vector made one of unit length; refused if it is zero.
    Vec3 direction(std::string_view key, const Vec3& fallback) const;
    std::vector<Vec3> vectors(std::string_view key) const;
    /// One integer or an array of them, not empty; made ascending and unique.
    std::vector<std::int64_t> integers(std::string_view key, const IntegerLimits& limits,
                                       Repeats repeats = Repeats::taken_once) const;
    /// The index of the text among the supported names.
    std::optional<std::size_t> choice(std::string_view key, const Names& names) const;
    /// The same for an array of names, each at most once.
    std::vector<std::size_t> choices(std::string_view key, const Names& names) const;

    /// The table below `key`; nothing if it is missing or no table. Of an array of tables, which is
    /// reported, the first.
    std::optional<TableReader> table(std::string_view key, const Names& keys) const;
    /// The tables of the array below `key`; with those elements left out that are none. A table in
    /// location of the array, which is reported, counts as an array of one. Of the document's own
    /// arrays those with misspelt headings follow the others.
    std::vector<TableReader> tables(std::string_view key, const Names& keys) const;

    /// Exactly one of the keys must be there; which. Nothing, and a report, otherwise.
    std::optional<std::string_view> one_of(std::initializer_list<std::string_view> keys) const;

    /// The path of a key, such as "material[1].poisson"; of the table itself without key.
    std::string path_of(std::string_view key = {}) const;
    /// Where the key's value stands, or the table if there is none.
    const SourceLocation& place_of(std::string_view key = {}) const;
    /// The same for messages: "FILE:line:column".
    std::string location_text(std::string_view key = {}) const;
    const Table& entries() const { return table_; }
    /// Whether nothing has been reported of the key, or of the table without key, but keys that are
    /// not known.
    bool is_sound(std::string_view key = {}) const {
        return !diagnostics_.has_errors_at(path_of(key));
    }

    /// Reports "key 'PATH': TEXT" at the key, or at the table without key.
    void error(std::string_view key, const std::string& text) const;
    /// Reports the text alone.
    void warning(std::string_view key, const std::string& text) const;

  private:
    /// Null if it is missing.
    const Value* value_of(std::string_view key) const;
    /// Whether another key has been taken for the one of that path, or for one that it is below.
    bool is_guess(std::string_view path) const;
    const Array* array(std::string_view key, std::string_view wanted) const;
    std::optional<double> number_of(const Value& value, const std::string& path,
                                    const Limits& limits) const;
    std::optional<std::int64_t> integer_of(const Value& value, const std::string& path,
                                           const IntegerLimits& limits) const;
    std::optional<Vec3> vector_of(const Value& value, const std::string& path) const;
    /// Reports "key 'PATH': TEXT" of a key of the table or what is below it.
    void report(const SourceLocation& location, const std::string& path,
                const std::string& text) const;
    void report_type(const Value& value, const std::string& path, std::string_view wanted) const;

    const Table& table_;
    std::vector<std::pair<std::string_view, const Value*>> misspelt_;  // by the key that was meant
    SourceLocation place_;
    std::string path_;
    Diagnostics& diagnostics_;
};

}  // namespace incise::scenario
