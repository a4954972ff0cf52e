// What the [expect] of a scenario asks for, and what the run came to.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "incise/app/report/run_record.h"

namespace incise::report {

/// A line of [expect] with the value of the run.
struct ExpectationResult {
    std::string quantity;
    std::optional<double> min, max;
    double value = unknown;
    bool is_met = false;
};

/// Returns the lines of [expect] of the scenario in the folder. Returns none if the run is not
/// finished, or if the scenario is not, or no longer, the one that was run.
std::vector<ExpectationResult> expectations_of(const RunRecord& run);

}  // namespace incise::report
