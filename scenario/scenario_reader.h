// Reads a scenario from its TOML file and checks all of it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "incise/scenario/scenario.h"

namespace incise::scenario {

struct ScenarioReport {
    /// If there are errors, only what of it check_body can still judge, not to be simulated: of
    /// constraints, loads, tools and dynamics what is sound; the mesh and the materials as a whole
    /// or not at all.
    Scenario scenario;
    /// Each complete in itself: "FILE:line:column: key 'material[1].poisson': 0.6 is not allowed:
    /// must be above -1 and below 0.5". In the order of the file.
    std::vector<std::string> errors, warnings;
};

/// Finds every problem at once; a syntax error is the only one found. What can only be told with
/// the mesh at hand is not checked: whether selections are empty, regions exist, steps are stable.
/// The mesh file is only looked for, not read.
/// @param overrides  such as "dynamics.end_time=0.2" or "material[0].young=2000" (see
///                   apply_override), applied in order before anything is checked
ScenarioReport read_scenario(const std::filesystem::path& file,
                             std::span<const std::string> overrides = {});

}  // namespace incise::scenario
