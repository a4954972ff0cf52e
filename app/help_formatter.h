// The layout of help texts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace incise::app {

/// A formatter that breaks the descriptions of options into lines that fit beside the names.
class HelpFormatter final : public CLI::Formatter {
  public:
    std::string make_option_desc(const CLI::Option* option) const override {
        constexpr std::size_t line_length = 100;
        const std::size_t width = line_length - get_column_width();
        std::string text = option->get_description();
        std::size_t line = 0, blank = std::string::npos;
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (text[i] == '\n') line = i + 1;
            if (text[i] == ' ') blank = i;
            if (i - line < width || blank == std::string::npos || blank < line) continue;
            text[blank] = '\n';
            line = blank + 1;
        }
        return text;
    }
};

}  // namespace incise::app
