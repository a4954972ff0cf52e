// Values of the quantities that quantities.h names: of a simulation, of a run that is finished; and
// what a scenario expects of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "incise/runner/simulation.h"
#include "incise/scenario/scenario.h"

namespace incise::runner {

/// Values by their names.
using Quantities = std::vector<std::pair<std::string, double>>;

/// The quantities of a moment by their names in history.csv, in its order.
/// @param body_totals  of this moment
Quantities history_row(const Simulation& simulation, const sim::BodyTotals& body_totals);
inline Quantities history_row(const Simulation& simulation) {
    return history_row(simulation, simulation.ledger().body_totals());
}

/// The quantities of summary.json that an [expect] can name: the last history row and totals over
/// the run.
Quantities summary_quantities(const Simulation& simulation);

/// What is not as the scenario's [expect] says; each a sentence. Its quantities must exist, which
/// the scenario reader sees to.
std::vector<std::string> failed_expectations(const scenario::Scenario& scenario,
                                             const Quantities& quantities);

/// The quantities of summary.json, if the run of this scenario in `folder` is finished.
/// Throws InputError, naming file, entry and remedy, if there is a summary that no run has written.
std::optional<Quantities> finished_quantities(const std::filesystem::path& folder,
                                              const scenario::Scenario& scenario);

}  // namespace incise::runner
