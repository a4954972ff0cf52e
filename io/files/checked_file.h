// Files with a checksum, for checkpoints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace incise::io {

/// Writes a line that names the format, the bytes, and a checksum of both. Works and throws as
/// write_file() does.
void write_checked_file(const std::filesystem::path& path, std::string_view bytes);

/// Returns the bytes that write_checked_file() wrote. Throws InputError that names the file and the
/// fault if the file cannot be read, has another format, or has a wrong checksum.
std::string read_checked_file(const std::filesystem::path& path);

}  // namespace incise::io
