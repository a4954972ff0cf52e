// Bytes in a file that knows whether it is whole: checkpoints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace incise::io {

/// CRC-64 (ECMA-182, as xz has it) of all bytes so far: of `before`, if that is not 0, and these.
/// Cost: about a nanosecond a byte.
std::uint64_t checksum(std::string_view bytes, std::uint64_t before = 0);

/// Writes the bytes between a line that names the format and a checksum; all of it or nothing, see
/// write_file. Throws OutputError.
void write_checked_file(const std::filesystem::path& path, std::string_view bytes);

/// The bytes again. Throws InputError, naming file and fault, if it cannot be read, is no such
/// file, or is not what was written, to the bit.
std::string read_checked_file(const std::filesystem::path& path);

}  // namespace incise::io
