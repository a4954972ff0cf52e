// A TOML document as plain values that know where they stand. The TOML library stays in the .cpp.
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

/// Where in the input something stands: in the file, or in an override of the command line.
struct SourceLocation {
    int line = 0;  ///< from 1; 0: the document as a whole
    int column = 0;
    int override_number = -1;  ///< index of the override, or -1: in the file
};

struct Entry;
struct Value;
using Array = std::vector<Value>;
using Table = std::vector<Entry>;  ///< in the order of the source; keys differ

/// A date or time, which no scenario needs.
struct DateOrTime {};

struct Value {
    std::variant<bool, std::int64_t, double, std::string, DateOrTime, Array, Table> data;
    SourceLocation location;

    template <class T>
    const T* get() const {
        return std::get_if<T>(&data);
    }
    /// For messages: `the number 5`, `the text "abc"`, `an array of 3`, `a table`, ...
    std::string description() const;
};

struct Entry {
    std::string key;
    SourceLocation location;
    Value value;
};

const Value* find(const Table& table, std::string_view key);

/// A syntax error or an unusable override.
struct DocumentError {
    SourceLocation location;
    std::string text;
};

/// Reads the file; the result is a table.
/// Throws InputError if it cannot be read, DocumentError if it is not TOML.
Value read_document(const std::filesystem::path& file);

/// Sets one value from text such as `dynamics.end_time=0.2`, `material[0].young=2e3` or
/// `material.0.law=neo-hookean`. Steps are keys, or numbers of array elements from 0. Tables that
/// are not there are made; array elements are not. What is no TOML value but a plain word is text.
/// @param number  for the places of the new values
/// Throws DocumentError; the document is then as before.
void apply_override(Value& document, std::string_view text, int number);

/// 16 hexadecimal digits; equal for equal contents, whatever the order of keys and the layout.
std::string content_hash(const Value& value);

/// What the hash is of, to be read: each value as text with its path, such as
/// ("material[0].young", "2000"), in the order of the paths.
std::vector<std::pair<std::string, std::string>> contents_of(const Value& value);

}  // namespace incise::scenario
