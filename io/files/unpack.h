// Unpacking of zlib and gzip streams, bounded by what the caller expects.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace incise::io {

bool begins_as_gzip(std::string_view bytes);

/// The first `most` bytes of a stream, or as many as can be unpacked.
std::string unpacked_prefix(std::string_view packed, std::size_t most);

/// A bound on what so many packed bytes can unpack to.
std::size_t max_unpacked(std::size_t num_packed);

/// The first `size` bytes of a stream; nothing if it has fewer or is damaged anywhere. Gzip may
/// have several members.
/// @pre size <= max_unpacked(packed.size()), so that memory stays in proportion to the file
std::optional<std::string> unpacked(std::string_view packed, std::size_t size);

}  // namespace incise::io
