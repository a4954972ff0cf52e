// The page of a report: one file of HTML with all that it needs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "incise/app/report/run_record.h"

namespace incise::report {

/// Returns the page. It needs no other file and no network.
/// @param title  any text; it is escaped
/// @param data   see page_data(); whatever texts it has, none becomes HTML or a script
std::string page_of(std::string_view title, const Json& data);

/// Returns a text for the inside of an element of HTML.
std::string html_text(std::string_view text);
/// Returns JSON for the inside of a <script>: a text in it cannot end the element. Bytes that are
/// not UTF-8 are replaced.
std::string script_text(const Json& data);

}  // namespace incise::report
