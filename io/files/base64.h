// Base64 (RFC 4648), as VTK's XML files use it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace incise::io {

/// The first `count` bytes that `text` encodes; fewer if it ends before. White space is skipped.
/// Several encodings one behind the other, each with its own padding, count as one. Text behind
/// the last byte that is wanted is not looked at. Nothing if a character or the padding is wrong.
/// Cost: linear in `count`.
std::optional<std::string> decode_base64(std::string_view text, std::size_t count);

/// Appends what encodes the bytes to the text: whole groups of four digits, the last one padded.
void append_base64(std::string_view bytes, std::string& text);

}  // namespace incise::io
