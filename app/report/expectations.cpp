// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/expectations.h"

#include "incise/base/error.h"
#include "incise/runner/kept_scenario.h"
#include "incise/scenario/scenario_reader.h"

namespace incise::report {

std::vector<ExpectationResult> expectations_of(const RunRecord& run) {
    std::vector<ExpectationResult> results;
    if (run.text("status") != "finished" || !run.scenario_text) return results;
    const auto scenario = [&]() -> std::optional<scenario::Scenario> {
        try {
            const auto report = scenario::read_scenario(run.folder / (run.name + ".toml"));
            if (!report.errors.empty()) return std::nullopt;
            return report.scenario;
        } catch (const InputError&) {
            return std::nullopt;  // the page shows its text all the same
        }
    }();
    if (!scenario) return results;
    // One that the run did not write itself may have been edited since.
    if (!runner::is_kept_scenario(*run.scenario_text) &&
        scenario->hash != run.text("scenario_hash"))
        return results;
    for (const scenario::Expectation& expected : scenario->expect) {
        const double value = run.number(expected.quantity.c_str());
        // A value that is not a number meets nothing.
        const bool is_met =
            (!expected.min || value >= *expected.min) && (!expected.max || value <= *expected.max);
        results.push_back({expected.quantity, expected.min, expected.max, value, is_met});
    }
    return results;
}

}  // namespace incise::report
