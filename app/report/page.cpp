// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/page.h"

#include <array>
#include <stdexcept>
#include <utility>

#include "incise/app/report/page_parts.h"

namespace incise::report {

std::string html_text(std::string_view text) {
    std::string html;
    for (const char c : text) {
        if (c == '&')
            html += "&amp;";
        else if (c == '<')
            html += "&lt;";
        else if (c == '>')
            html += "&gt;";
        else
            html += c;
    }
    return html;
}

std::string script_text(const Json& data) {
    const std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string text;
    text.reserve(json.size());
    // These characters occur within strings only, where each may be written by its number.
    for (const char c : json) {
        if (c == '<')
            text += "\\u003c";
        else if (c == '>')
            text += "\\u003e";
        else if (c == '&')
            text += "\\u0026";
        else
            text += c;
    }
    return text;
}

std::string page_of(std::string_view title, const Json& data) {
    using namespace page_parts;
    const std::string title_html = html_text(title), data_text = script_text(data);
    const std::array<std::pair<std::string_view, std::string_view>, 10> values = {
        {{"title", title_html},
         {"uplot_css", uplot_css},
         {"page_css", page_css},
         {"data", data_text},
         {"uplot_licence", uplot_licence},
         {"uplot_js", uplot_js},
         {"numbers_js", numbers_js},
         {"plots_js", plots_js},
         {"edits_table_js", edits_table_js},
         {"page_js", page_js}}};
    // One pass: what is put in is not searched for marks again.
    std::string page;
    std::string_view rest = page_html;
    for (auto mark = rest.find("{{"); mark != rest.npos; mark = rest.find("{{")) {
        const auto end = rest.find("}}", mark);
        const auto name = rest.substr(mark + 2, end - mark - 2);
        page += rest.substr(0, mark);
        rest.remove_prefix(end + 2);
        bool is_known = false;
        for (const auto& [key, value] : values)
            if (key == name) {
                page += value;
                is_known = true;
            }
        if (!is_known) throw std::logic_error("page.html: no value for " + std::string(name));
    }
    return page.append(rest);
}

}  // namespace incise::report
