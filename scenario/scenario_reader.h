// Reads a scenario from a TOML file and checks it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "incise/scenario/document.h"
#include "incise/scenario/scenario.h"

namespace incise::scenario {

/// The result of read_scenario().
struct ScenarioReport {
    /// If there are errors, the scenario has only the parts that check_body() can check, and must
    /// not be simulated. It then has the sound parts of constraints, loads, tools and dynamics.
    /// Mesh and materials are complete or empty.
    Scenario scenario;
    /// In the order of the file. Each message is complete in itself: "FILE:line:column: key
    /// 'material[1].poisson': 0.6 is not allowed: must be above -1 and below 0.5".
    std::vector<std::string> errors, warnings;
};

/// Reads a scenario and finds all its problems at once. After a syntax error nothing else is
/// checked. The mesh file must be readable, but is not read. Problems that depend on the mesh are
/// found by check_body(): empty selections, missing regions, unstable steps.
/// @param file       the TOML file
/// @param overrides  values to change before the checks, in this order; see apply_override(), such
///                   as "dynamics.end_time=0.2" or "material[0].young=2000"
ScenarioReport read_scenario(const std::filesystem::path& file,
                             std::span<const std::string> overrides = {});
/// A world that a program steps: what the program gives beside the document. The document may leave
/// out [dynamics] and its end time, and has no frames without [output].
struct ForProgram {
    /// In the place of the section [mesh], which is then left out.
    std::shared_ptr<const topology::MeshData> mesh = nullptr;
};

/// The same for a document that is no file.
/// @param document   the values, changed as the overrides say
/// @param file       FOLDER/NAME: the folder to which paths are relative, and a name for messages
///                   and results. The file need not exist
/// @param overrides  see above
/// @param program    null for a document that must be complete
/// @pre  the document is a table
ScenarioReport read_scenario(Value document, const std::filesystem::path& file,
                             std::span<const std::string> overrides = {},
                             const ForProgram* program = nullptr);

}  // namespace incise::scenario
