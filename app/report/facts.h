// The figures at the head of a report, and how the run ended.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/app/report/energy_balance.h"
#include "incise/app/report/run_record.h"

namespace incise::report {

/// A figure with its name.
struct Fact {
    std::string label;
    double value = unknown;
    std::string unit;
    double from = unknown;  ///< the value at the start, if it is to be shown
    std::string note;
};

/// Returns the figures, most important first. Those that the files do not have are left out.
std::vector<Fact> facts_of(const RunRecord& run, const EnergyBalance& balance);

/// How a run ended.
struct Ending {
    std::string kind;      ///< finished, failed, interrupted or unfinished
    std::string headline;  ///< in a few words
    std::string text;      ///< what happened and what to do; empty if the run is finished
};
Ending ending_of(const RunRecord& run);

}  // namespace incise::report
