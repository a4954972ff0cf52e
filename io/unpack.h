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

/// The first `size` bytes of a stream; nothing if it has fewer or if it is damaged anywhere. Allocates
/// nothing if so few packed bytes cannot unpack to so many. Gzip may have several members.
std::optional<std::string> unpacked(std::string_view packed, std::size_t size);

}  // namespace incise::io
