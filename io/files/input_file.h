// A user's file as bytes in memory, read with checks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace incise::io {

struct InputFile {
    std::filesystem::path path;
    std::string bytes;  ///< without a UTF-8 byte order mark

    /// The file as messages call it.
    std::string name() const { return path.string(); }
    /// The number, from 1, of the line on which `offset` lies.
    std::size_t line_of(std::size_t offset) const;
};

/// Throws InputError if the path is not a readable regular file with something in it.
InputFile load_input_file(const std::filesystem::path& path);

/// Text of a file made fit for a message: without control characters.
std::string printable(std::string_view text);
/// Besides quoted, and shortened.
std::string in_quotes(std::string_view text);

}  // namespace incise::io
