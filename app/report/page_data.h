// The data of the page of a report. The scripts of the page show them and compute nothing.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/app/report/pictures.h"
#include "incise/app/report/run_record.h"

namespace incise::report {

/// How the page was made.
struct Origin {
    std::string command;  ///< the command of the report
    std::string date;     ///< ISO 8601, UTC
    std::string rerun;    ///< a command for the same run, if the run has not recorded its own
};

/// The page holds no more rows of the history and no more edits than these. More would be slow to
/// open, and no screen shows more points.
inline constexpr std::size_t most_history_rows = 10'000;
inline constexpr std::size_t most_edits = 20'000;

/// Returns the data as one JSON object. Numbers have seven digits.
Json page_data(const RunRecord& run, const Pictures& pictures, const Origin& origin);

}  // namespace incise::report
