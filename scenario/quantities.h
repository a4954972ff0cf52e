// The names of the quantities of a run: columns of history.csv, entries of summary.json and keys of
// [expect]. The writer of runs and the reader of scenarios both use this list.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise::scenario {

/// The first columns of history.csv, in order. The reactions of the constraints follow them.
inline constexpr std::array<std::string_view, 24> history_quantities = {"time",
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
                                                                        "stable_step",
                                                                        "contacts",
                                                                        "max_penetration",
                                                                        "contact_dissipation",
                                                                        "fracture_energy"};

/// The quantities of summary.json that are not columns of history.csv.
inline constexpr std::array<std::string_view, 12> run_quantities = {
    "gravity_energy", "edits",        "elements_removed", "elements_split",
    "elements_added", "faces_opened", "cut_area",         "mass_removed",
    "mass_error",     "energy_error", "volume_change",    "max_displacement"};

/// Returns the names of the columns for the reaction of a constraint: force along x, y and z, then
/// moment about x, y and z.
std::array<std::string, 6> reaction_quantities(std::string_view constraint);

/// Returns the names of the columns for what the tissue exerts on a tool: force along x, y and z,
/// then torque about x, y and z.
std::array<std::string, 6> force_quantities(std::string_view probe);

/// Returns all quantities that [expect] can name: those of history.csv, the reactions of the
/// constraints, the forces on the probes, and those of the run, in this order.
/// @param constraints  the names of the constraints
/// @param probes       the names of the probes and obstacles
std::vector<std::string> all_quantities(std::span<const std::string> constraints,
                                        std::span<const std::string> probes);

}  // namespace incise::scenario
