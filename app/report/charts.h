// Which columns of history.csv make up which plot.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/app/report/history_table.h"

namespace incise::report {

/// A line of a plot.
struct Series {
    std::string column;  ///< of the history
    std::string label;
};

/// A plot over time.
struct Chart {
    std::string title;
    std::string unit;         ///< empty for counts
    bool is_stepped = false;  ///< values that jump, such as counts
    std::string note;         ///< what the reader has to know; may be empty
    std::vector<Series> series;
};

/// The plots of a run.
struct Charts {
    std::vector<Chart> charts;
    std::vector<std::string> left_out;  ///< titles of plots whose values are zero throughout
};

/// The column that read_run() does not have: EnergyBalance::lacking.
inline constexpr const char* lacking_energy = "lacking_energy";

/// Returns the plots of a history. Each column is in one of them, or in one that is left out, but
/// for the time and the number of the step.
Charts charts_of(const HistoryTable& history);

}  // namespace incise::report
