// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/quantities.h"

namespace incise::scenario {

std::array<std::string, 6> reaction_quantities(std::string_view constraint) {
    const std::string reaction = "reaction_" + std::string(constraint);
    const std::string torque = "torque_" + std::string(constraint);
    return {reaction + "_x", reaction + "_y", reaction + "_z",
            torque + "_x",   torque + "_y",   torque + "_z"};
}

std::array<std::string, 6> force_quantities(std::string_view probe) {
    const std::string force = "force_" + std::string(probe);
    const std::string torque = "torque_" + std::string(probe);
    return {force + "_x", force + "_y", force + "_z", torque + "_x", torque + "_y", torque + "_z"};
}

std::vector<std::string> all_quantities(std::span<const std::string> constraints,
                                        std::span<const std::string> probes) {
    std::vector<std::string> names(history_quantities.begin(), history_quantities.end());
    for (const std::string& constraint : constraints)
        for (std::string& name : reaction_quantities(constraint)) names.push_back(std::move(name));
    for (const std::string& probe : probes)
        for (std::string& name : force_quantities(probe)) names.push_back(std::move(name));
    names.insert(names.end(), run_quantities.begin(), run_quantities.end());
    return names;
}

}  // namespace incise::scenario
