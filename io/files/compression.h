// Decompression of the blocks of VTK's XML files. The caller gives the size of the result.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace incise::io {

enum class Compressor : std::uint8_t { none, zlib, lz4, lzma };

/// Returns the compressor with this class name in VTK; an empty name means none. Returns nothing
/// for an unknown name.
std::optional<Compressor> compressor_of(std::string_view vtk_class_name);

/// Returns an upper bound on the number of bytes that one compressed byte can unpack to.
std::size_t max_expansion(Compressor compressor);

/// Unpacks one block. Returns true if the block is sound and fills `unpacked` exactly. Writes
/// nowhere else. Throws std::bad_alloc.
/// @pre  the compressor is not none
bool decompress(Compressor compressor, std::string_view packed, std::span<char> unpacked);

}  // namespace incise::io
