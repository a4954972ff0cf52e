// Base64 (RFC 4648), as in VTK's XML files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace incise::io {

/// Returns the first `count` bytes that the text encodes, or fewer if the text ends before. White
/// space is skipped. Several encodings in sequence, each with its own padding, count as one. Text
/// after the last byte is not read. Returns nothing if a character or the padding is wrong.
/// Cost: linear in `count`.
std::optional<std::string> decode_base64(std::string_view text, std::size_t count);

/// Appends the encoded bytes to the text: groups of four digits, of which the last one is padded.
void append_base64(std::string_view bytes, std::string& text);

}  // namespace incise::io
