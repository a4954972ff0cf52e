// The parts of the page of a report, as embed.cmake puts them into the program: page.html and what
// it takes in.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>

namespace incise::report::page_parts {

extern const std::string_view page_html;
extern const std::string_view page_css;
extern const std::string_view numbers_js;
extern const std::string_view plots_js;
extern const std::string_view edits_table_js;
extern const std::string_view page_js;
extern const std::string_view uplot_js;
extern const std::string_view uplot_css;
extern const std::string_view uplot_licence;

}  // namespace incise::report::page_parts
