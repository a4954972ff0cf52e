// The compressions of VTK's XML files: one block at a time, bounded by what the caller expects.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace incise::io {

enum class Compressor : std::uint8_t { none, zlib, lz4, lzma };

/// The compressor that VTK calls by this class name; an empty name means none.
std::optional<Compressor> compressor_of(std::string_view vtk_class_name);

/// A bound on how many bytes one compressed byte can unpack to.
std::size_t max_expansion(Compressor compressor);

/// Unpacks one block. True if it is sound and fills `unpacked` exactly; writes nowhere else.
/// Throws std::bad_alloc.
/// @pre compressor is not none
bool decompress(Compressor compressor, std::string_view packed, std::span<char> unpacked);

}  // namespace incise::io
