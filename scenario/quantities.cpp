// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/quantities.h"

namespace incise::scenario {

std::array<std::string, 6> reaction_quantities(std::string_view constraint) {
    const std::string reaction = "reaction_" + std::string(constraint);
    const std::string torque = "torque_" + std::string(constraint);
    return {reaction + "_x", reaction + "_y", reaction + "_z",
            torque + "_x",   torque + "_y",   torque + "_z"};
}

std::vector<std::string> all_quantities(std::span<const std::string> constraints) {
    std::vector<std::string> names(history_quantities.begin(), history_quantities.end());
    for (const std::string& constraint : constraints)
        for (std::string& name : reaction_quantities(constraint)) names.push_back(std::move(name));
    names.insert(names.end(), run_quantities.begin(), run_quantities.end());
    return names;
}

}  // namespace incise::scenario
