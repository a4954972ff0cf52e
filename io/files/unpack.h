// Unpacking of zlib and gzip streams. The caller bounds the size of the result.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace incise::io {

bool begins_as_gzip(std::string_view bytes);

/// Returns the first `most` bytes of a stream, or as many as can be unpacked.
std::string unpacked_prefix(std::string_view packed, std::size_t most);

/// Returns an upper bound on the number of bytes that `num_packed` bytes can unpack to.
std::size_t max_unpacked(std::size_t num_packed);

/// A part of a stream.
struct Unpacked {
    std::string bytes;
    std::size_t num_behind = 0;  ///< bytes of the stream behind the part
};

/// Returns `size` bytes of a stream, from byte `begin` of what it unpacks to. Returns nothing if
/// the stream has fewer, or if any part of it is damaged. A gzip stream may have several members.
/// @pre  size <= max_unpacked(packed.size()), so that the memory is bounded by the size of the file
std::optional<Unpacked> unpacked(std::string_view packed, std::size_t begin, std::size_t size);

}  // namespace incise::io
