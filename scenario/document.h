// A TOML document as plain values with their locations in the source.
// Only document.cpp includes the TOML library.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace incise::scenario {

/// A location in the input: in the file, or in an override of the command line.
struct SourceLocation {
    int line = 0;  ///< from 1; 0 for the document as a whole
    int column = 0;
    int override_number = -1;  ///< index of the override; -1 for the file
};

struct Entry;
struct Value;
using Array = std::vector<Value>;
using Table = std::vector<Entry>;  ///< in the order of the source, with unique keys

/// A date or time. No key of a scenario takes one.
struct DateOrTime {};

/// A value of the document with its location.
struct Value {
    std::variant<bool, std::int64_t, double, std::string, DateOrTime, Array, Table> data;
    SourceLocation location;

    template <class T>
    const T* get() const {
        return std::get_if<T>(&data);
    }
    /// Describes the value for messages: `the number 5`, `the text "abc"`, `an array of 3`.
    std::string description() const;
};

struct Entry {
    std::string key;
    SourceLocation location;
    Value value;
};

/// Returns the value of a key, or null.
const Value* find(const Table& table, std::string_view key);

/// A syntax error, or an override that cannot be applied.
struct DocumentError {
    SourceLocation location;
    std::string text;
};

/// Reads a file. The result is a table.
/// Throws InputError if the file cannot be read, DocumentError if it is not TOML.
Value read_document(const std::filesystem::path& file);

/// Sets one value from text such as `dynamics.end_time=0.2`, `material[0].young=2e3` or
/// `material.0.law=neo-hookean`. The path consists of keys and of indices of array elements, from
/// 0. Missing tables are added, but missing array elements are not. A plain word that is no TOML
/// value becomes text.
/// @param document  the document to change
/// @param text      PATH=VALUE
/// @param number    index of the override, for the locations of the new values
/// Throws DocumentError if the override cannot be applied. The document is then unchanged.
void apply_override(Value& document, std::string_view text, int number);

/// Returns a hash of the contents as 16 hexadecimal digits. The hash does not depend on the order
/// of keys or on the layout.
std::string content_hash(const Value& value);

/// Returns the values from which content_hash() is computed as pairs of path and text, such as
/// ("material[0].young", "2000"), in the order of the paths.
std::vector<std::pair<std::string, std::string>> contents_of(const Value& value);

}  // namespace incise::scenario
