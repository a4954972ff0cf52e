// Numbers to text: the shortest text that reads back as the same number. Ignores the locale.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace incise {

/// Appends a number, of at most 17 significant digits for a double. Makes no temporary string.
template <class T>
void append_number(std::string& text, T value) {
    std::array<char, 32> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    text.append(buffer.data(), end);
}

/// Returns a number as text.
template <class T>
std::string format_number(T value) {
    std::string text;
    append_number(text, value);
    return text;
}

}  // namespace incise
