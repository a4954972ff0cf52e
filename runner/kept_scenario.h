// The scenario that a run keeps among its results.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "incise/scenario/scenario.h"

namespace incise::runner {

/// Writes the scenario, with overrides, to FOLDER/NAME.toml. It can be run as it is. If that is the
/// file that the scenario was read from, the file stays. Throws OutputError.
void keep_scenario(const std::filesystem::path& folder, const scenario::Scenario& scenario);

/// True if the folder has results of a run, and they are not those of this scenario.
bool holds_another_run(const std::filesystem::path& folder, const scenario::Scenario& scenario);

}  // namespace incise::runner
