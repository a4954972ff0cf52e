// Checked reading of one table of a document: types, ranges, names and unknown keys.
// Each problem is reported with its location and the full path of the key, and reading continues.
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

/// The names that are allowed in one place.
struct Names {
    std::span<const std::string_view> supported;
    /// What is there without being asked for.
    std::span<const std::string_view> given = {};
};

/// Returns a message that `name` is not known, with the most similar supported name. Returns
/// nothing if `name` is supported.
std::optional<std::string> complaint(std::string_view name, const Names& names);

/// The closed interval of allowed integers.
struct IntegerLimits {
    std::int64_t low = std::numeric_limits<std::int64_t>::min();
    std::int64_t high = std::numeric_limits<std::int64_t>::max();
};

/// What happens to repeated numbers in a list.
enum class Repeats { taken_once, refused };

/// A reader of one table that reports what is wrong with it.
///
/// For a key that is missing or wrong, the functions return the fallback. A wrong value is
/// reported; a missing key is reported only by require(). The values are meaningful only if no
/// errors were reported.
class TableReader {
  public:
    /// Reports the keys that are not among `keys`. A key that is likely a misspelt other key is
    /// then read as that key, so that no error follows from its absence. If its value does not suit
    /// that key, the guess is likely wrong, and the problem with the value is not reported.
    /// @lifetime  `table`, `diagnostics` and the names in `keys` must outlive the reader
    TableReader(const Table& table, const SourceLocation& location, std::string path,
                const Names& keys, Diagnostics& diagnostics);

    bool has(std::string_view key) const { return value_of(key) != nullptr; }
    bool is_text(std::string_view key) const;
    bool is_empty_array(std::string_view key) const;
    /// Returns true if the key is present, and otherwise reports it. `remedy` tells the user what
    /// to write.
    bool require(std::string_view key, std::string_view remedy) const;

    double number(std::string_view key, double fallback, const Limits& limits = {}) const;
    std::optional<double> number_if_given(std::string_view key, const Limits& limits = {}) const;
    std::int64_t integer(std::string_view key, std::int64_t fallback,
                         const IntegerLimits& limits = {}) const;
    bool flag(std::string_view key, bool fallback) const;
    std::string text(std::string_view key, const std::string& fallback = {}) const;
    Vec3 vector(std::string_view key, const Vec3& fallback = Vec3::Zero()) const;
    /// Reads a vector and scales it to unit length. Reports a vector of length zero.
    Vec3 direction(std::string_view key, const Vec3& fallback) const;
    std::vector<Vec3> vectors(std::string_view key) const;
    /// Reads one integer, or an array of integers that is not empty. The result is in ascending
    /// order and without repetitions.
    std::vector<std::int64_t> integers(std::string_view key, const IntegerLimits& limits,
                                       Repeats repeats = Repeats::taken_once) const;
    /// Reads a text and returns its index among the supported names.
    std::optional<std::size_t> choice(std::string_view key, const Names& names) const;
    /// Reads an array of names without repetitions and returns their indices.
    std::vector<std::size_t> choices(std::string_view key, const Names& names) const;

    /// Returns the table below `key`, or nothing if the key is missing or no table. An array of
    /// tables is reported, and its first table is returned.
    std::optional<TableReader> table(std::string_view key, const Names& keys) const;
    /// Returns the tables of the array below `key`. Elements that are no tables are reported and
    /// left out. A table in place of the array is reported and returned as an array of one. If this
    /// is the root table, the tables with a misspelt heading follow the others.
    std::vector<TableReader> tables(std::string_view key, const Names& keys) const;

    /// Returns the one of the keys that is present. If none or several are present, reports this
    /// and returns nothing.
    std::optional<std::string_view> one_of(std::initializer_list<std::string_view> keys) const;

    /// Returns the path of a key, such as "material[1].poisson". Without `key`, returns the path of
    /// the table.
    std::string path_of(std::string_view key = {}) const;
    /// Returns the location of the value of the key, or that of the table if the key is missing.
    const SourceLocation& location_of(std::string_view key = {}) const;
    /// Returns location_of() as text for messages: "FILE:line:column".
    std::string location_text(std::string_view key = {}) const;
    const Table& entries() const { return table_; }
    /// True if no error was reported for the key, or, without `key`, for the table. Unknown keys do
    /// not count.
    bool is_sound(std::string_view key = {}) const {
        return !diagnostics_.has_errors_at(path_of(key));
    }

    /// Reports "key 'PATH': TEXT" at the key, or at the table without key.
    void error(std::string_view key, const std::string& text) const;
    /// Reports the text without the path, at the key, or at the table without key.
    void warning(std::string_view key, const std::string& text) const;

  private:
    /// Returns the value of the key, or of a key that is misspelt for it. Null if missing.
    const Value* value_of(std::string_view key) const;
    /// True if the value at this path, or at a path above it, belongs to a misspelt key.
    bool is_guess(std::string_view path) const;
    const Array* array(std::string_view key, std::string_view wanted) const;
    std::optional<double> number_of(const Value& value, const std::string& path,
                                    const Limits& limits) const;
    std::optional<std::int64_t> integer_of(const Value& value, const std::string& path,
                                           const IntegerLimits& limits) const;
    std::optional<Vec3> vector_of(const Value& value, const std::string& path) const;
    /// Reports "key 'PATH': TEXT" for a key of the table or for a value below it.
    void report(const SourceLocation& location, const std::string& path,
                const std::string& text) const;
    void report_type(const Value& value, const std::string& path, std::string_view wanted) const;

    const Table& table_;
    std::vector<std::pair<std::string_view, const Value*>> misspelt_;  // by the likely key
    SourceLocation place_;
    std::string path_;
    Diagnostics& diagnostics_;
};

}  // namespace incise::scenario
