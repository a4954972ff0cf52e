// The words of a line of text.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "incise/io/files/number_text.h"

namespace incise::io {

/// Returns the line without its comment, which begins with #.
inline std::string_view without_comment(std::string_view line) {
    return line.substr(0, line.find('#'));
}

/// Appends the words of a line to `words`.
/// @lifetime  the words refer to the text of the line
inline void append_words(std::string_view line, std::vector<std::string_view>& words) {
    std::size_t end = 0;
    while (true) {
        auto begin = end;
        while (begin < line.size() && is_blank(line[begin])) ++begin;
        if (begin == line.size()) return;
        end = begin;
        while (end < line.size() && !is_blank(line[end])) ++end;
        words.push_back(line.substr(begin, end - begin));
    }
}

}  // namespace incise::io
