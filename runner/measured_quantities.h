// Values of the quantities in scenario/quantities.h, and the check of expectations against them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "incise/runner/simulation.h"
#include "incise/scenario/scenario.h"
#include "incise/sim/world.h"

namespace incise::runner {

/// Names and values of quantities.
using Quantities = std::vector<std::pair<std::string, double>>;

/// Returns the values of a row of history.csv, with the names of its columns.
/// @param world        the world
/// @param time_step    the last step, s
/// @param body_totals  the body totals at the time of the row
/// @param forces       what tissue exerted on the tools since the last row
Quantities history_row(const sim::World& world, double time_step,
                       const sim::BodyTotals& body_totals, const sim::ToolForces& forces);
/// Returns the row of a run.
/// @param simulation   the simulation
/// @param body_totals  the body totals at the time of the row
inline Quantities history_row(const Simulation& simulation, const sim::BodyTotals& body_totals) {
    return history_row(simulation.world(), simulation.time_step(), body_totals,
                       simulation.tool_forces());
}
inline Quantities history_row(const Simulation& simulation) {
    return history_row(simulation, simulation.ledger().body_totals());
}

/// Returns the quantities of summary.json that [expect] can name: the present history row, and
/// totals over the run.
/// @param world      the world
/// @param time_step  the last step, s
/// @param forces     what tissue exerted on the tools, see history_row()
/// @param edits      the records of all edits of the world
Quantities summary_quantities(const sim::World& world, double time_step,
                              const sim::ToolForces& forces,
                              std::span<const sim::EditRecord> edits);
/// Returns the quantities of a run.
inline Quantities summary_quantities(const Simulation& simulation) {
    return summary_quantities(simulation.world(), simulation.time_step(), simulation.tool_forces(),
                              simulation.edits());
}

/// Returns a sentence for each expectation of the scenario that is not met.
/// @pre  `quantities` has all quantities of [expect], which the scenario reader checks
std::vector<std::string> failed_expectations(const scenario::Scenario& scenario,
                                             const Quantities& quantities);

/// Returns the quantities of summary.json if the run of this scenario in `folder` is finished,
/// otherwise nothing. Throws InputError with file, entry and remedy if summary.json is not the
/// summary of a run.
std::optional<Quantities> finished_quantities(const std::filesystem::path& folder,
                                              const scenario::Scenario& scenario);

}  // namespace incise::runner
