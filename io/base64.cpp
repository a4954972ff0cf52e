// Decoding of base64 (RFC 4648), as VTK's XML files use it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "io/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "io/number_text.h"

namespace incise::io {

namespace {

constexpr std::uint8_t not_a_digit = 255;

constexpr std::array<std::uint8_t, 256> digit_values = [] {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> values{};
    values.fill(not_a_digit);
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[static_cast<unsigned char>(digits[i])] = static_cast<std::uint8_t>(i);
    return values;
}();

}  // namespace

std::optional<std::string> decode_base64(std::string_view text, std::size_t count) {
    std::string bytes;
    bytes.reserve(std::min(count, text.size() / 4 * 3) + 3);
    std::uint32_t group = 0;  // up to four digits of six bits
    int num_digits = 0;
    int num_padding = 0;
    for (const char c : text) {
        if (bytes.size() >= count) break;
        if (is_blank(c)) continue;
        const auto value = digit_values[static_cast<unsigned char>(c)];
        if (c == '=') {
            if (num_digits < 2) return std::nullopt;
            ++num_padding;
        } else if (value == not_a_digit || num_padding > 0) {
            return std::nullopt;
        }
        group = group << 6 | (c == '=' ? 0u : value);
        if (++num_digits < 4) continue;
        for (int i = 0; i < 3 - num_padding; ++i)
            bytes += static_cast<char>(group >> (16 - 8 * i) & 0xFF);
        group = 0;
        num_digits = num_padding = 0;
    }
    if (bytes.size() < count && num_digits != 0) return std::nullopt;
    bytes.resize(std::min(count, bytes.size()));
    return bytes;
}

}  // namespace incise::io
