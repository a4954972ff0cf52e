// The scenario that a run keeps among its results.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

#include "incise/scenario/scenario.h"

namespace incise::runner {

/// Writes the scenario, with overrides, to FOLDER/NAME.toml. It can be run as it is. If that is the
/// file that the scenario was read from, the file stays. Throws OutputError.
void keep_scenario(const std::filesystem::path& folder, const scenario::Scenario& scenario);

/// True if a text is what keep_scenario() has written. Its hash is not that of the scenario that
/// was run, since names of files are absolute in it.
bool is_kept_scenario(std::string_view text);

/// True if the folder has results of a run, and they are not those of this scenario.
bool holds_another_run(const std::filesystem::path& folder, const scenario::Scenario& scenario);

}  // namespace incise::runner
