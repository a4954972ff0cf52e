// The files of the page, as the build puts them into the program.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "incise/live/server/server.h"

namespace incise::live {

namespace page_parts {
extern const std::string_view index_html;
extern const std::string_view app_js;
extern const std::string_view style_css;
extern const std::string_view favicon_svg;
}  // namespace page_parts

/// Returns the files to serve.
inline std::vector<PageFile> page_files() {
    return {{"/", "text/html; charset=utf-8", page_parts::index_html},
            {"/app.js", "text/javascript; charset=utf-8", page_parts::app_js},
            {"/style.css", "text/css; charset=utf-8", page_parts::style_css},
            {"/favicon.svg", "image/svg+xml", page_parts::favicon_svg}};
}

}  // namespace incise::live
