// Dates as text.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <ctime>
#include <string>

namespace incise::app {

/// Returns a time as text in the form of ISO 8601, such as "2026-11-28T01:10:00Z".
inline std::string utc_text(std::time_t time) {
    std::tm parts{};
    std::array<char, 32> text{};
    if (!::gmtime_r(&time, &parts)) return {};
    return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace incise::app
