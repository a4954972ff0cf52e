// Numbers from text: complete words only. Ignores the locale.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace incise::io {

constexpr bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

/// Returns the number in the text. Returns nothing if a character is left over, or if the value
/// does not fit in T. A real may be "nan" or "inf". A real with a negative exponent that is too
/// small for T is zero.
template <class T>
requires std::integral<T> || std::floating_point<T> std::optional<T> parse_number(
    std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || end != text.data() + text.size()) return std::nullopt;
    if (error == std::errc()) return value;
    if constexpr (std::floating_point<T>) {
        const bool is_underflow = text.find("e-") != text.npos || text.find("E-") != text.npos;
        if (error == std::errc::result_out_of_range && is_underflow) return T{0};
    }
    return std::nullopt;
}

/// Returns the shortest text that parses to the same value.
inline std::string shown(double value) {
    std::array<char, 32> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end};
}

/// Returns the end of a message about a text that parse_number() refused. If the text is a number
/// outside the range of T, the result states the range; else it is empty.
template <class T>
requires std::integral<T> || std::floating_point<T> std::string range_remark(
    std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc::result_out_of_range || end != text.data() + text.size()) return {};
    using Limits = std::numeric_limits<T>;
    const auto in_words = [](T limit) {
        if constexpr (std::integral<T>)
            return std::to_string(limit);
        else
            return shown(limit);
    };
    return ", which is out of range: " + in_words(Limits::lowest()) + " to " +
           in_words(Limits::max()) + " are allowed";
}

/// Returns the value if it is a whole number of 32 bits.
inline std::optional<int> whole_number(double value) {
    constexpr double lowest = std::numeric_limits<int>::min();
    constexpr double highest = std::numeric_limits<int>::max();
    if (!(value >= lowest && value <= highest) || value != std::floor(value)) return std::nullopt;
    return static_cast<int>(value);
}

}  // namespace incise::io
