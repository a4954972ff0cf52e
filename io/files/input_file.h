// Input files, read into memory with checks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace incise::io {

/// An input file in memory.
struct InputFile {
    std::filesystem::path path;
    std::string bytes;  ///< without a UTF-8 byte order mark

    /// Returns the name of the file for messages.
    std::string name() const { return path.string(); }
    /// Returns the number, from 1, of the line of the byte at `offset`.
    std::size_t line_of(std::size_t offset) const;
};

/// Reads a file. Throws InputError if the path is not a readable regular file, or if the file is
/// empty or a pointer of Git LFS.
InputFile load_input_file(const std::filesystem::path& path);

/// Returns the text of a file for a message: each character that is not printable ASCII becomes a
/// question mark.
std::string printable(std::string_view text);
/// Returns the printable text in quotes, shortened to 40 characters.
std::string in_quotes(std::string_view text);

}  // namespace incise::io
