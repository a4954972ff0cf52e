// The names of what a run is measured by: the columns of history.csv, the entries of summary.json
// and the keys of [expect]. Writer and scenario reader take them from here.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise::scenario {

/// The first columns of history.csv, in order; the reactions of the constraints follow them.
inline constexpr std::array<std::string_view, 20> history_quantities = {"time",
                                                                        "step",
                                                                        "nodes",
                                                                        "elements",
                                                                        "components",
                                                                        "mass",
                                                                        "volume",
                                                                        "kinetic_energy",
                                                                        "elastic_energy",
                                                                        "external_work",
                                                                        "dissipated_energy",
                                                                        "momentum_x",
                                                                        "momentum_y",
                                                                        "momentum_z",
                                                                        "angular_momentum_x",
                                                                        "angular_momentum_y",
                                                                        "angular_momentum_z",
                                                                        "min_J",
                                                                        "time_step",
                                                                        "stable_step"};

/// What summary.json has besides the columns of history.csv.
inline constexpr std::array<std::string_view, 12> run_quantities = {
    "gravity_energy", "edits",        "elements_removed", "elements_split",
    "elements_added", "faces_opened", "cut_area",         "mass_removed",
    "mass_error",     "energy_error", "volume_change",    "max_displacement"};

/// The columns of a constraint's reaction, along x, y and z, then those of its moment.
std::array<std::string, 6> reaction_quantities(std::string_view constraint);

/// All that an [expect] can name, in the order of summary.json.
/// @param constraints  their names
std::vector<std::string> all_quantities(std::span<const std::string> constraints);

}  // namespace incise::scenario
