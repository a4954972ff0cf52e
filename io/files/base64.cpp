// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "incise/io/files/number_text.h"

namespace incise::io {

namespace {

constexpr std::uint8_t not_a_digit = 255;

constexpr std::string_view digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::uint8_t, 256> digit_values = [] {
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

void append_base64(std::string_view bytes, std::string& text) {
    const std::size_t begin = text.size();
    text.resize(begin + (bytes.size() + 2) / 3 * 4, '=');
    char* digit = text.data() + begin;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k <= count; ++k) digit[k] = digits[group >> (18 - 6 * k) & 63];
        digit += 4;
    }
}

}  // namespace incise::io
