// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/energy_balance.h"

#include <algorithm>
#include <cmath>

namespace incise::report {

double EnergyBalance::largest_error() const {
    double error = 0.0, scale = 0.0;
    for (const double x : lacking) error = std::max(error, std::abs(x));
    for (const double x : turnover) scale = std::max(scale, x);
    scale = std::max(scale, floor);
    return scale > 0.0 ? error / scale : unknown;
}

EnergyBalance energy_balance(const RunRecord& run) {
    const auto* step = run.history.find("step");
    const auto* kinetic = run.history.find("kinetic_energy");
    const auto* elastic = run.history.find("elastic_energy");
    const auto* work = run.history.find("external_work");
    const auto* dissipated = run.history.find("dissipated_energy");
    EnergyBalance balance;
    if (!step || !kinetic || !elastic || !work || !dissipated) return balance;
    double removed = 0.0;
    auto edit = run.edits.begin();
    for (std::size_t i = 0; i < step->size(); ++i) {
        // A step writes a row for each of its edits, in their order, and then that of its frame.
        if (edit != run.edits.end() && edit->step == (*step)[i]) {
            removed += edit->before.energy() - edit->after.energy();
            ++edit;
        }
        const double at_start = kinetic->front() + elastic->front();
        const double now = (*kinetic)[i] + (*elastic)[i];
        balance.removed.push_back(removed);
        balance.lacking.push_back(at_start + (*work)[i] - (*dissipated)[i] - removed - now);
        balance.turnover.push_back(std::abs(at_start) + std::abs(now) + std::abs((*work)[i]) +
                                   std::abs((*dissipated)[i]) + std::abs(removed));
    }
    // Near rest, the error of the run is over the floor of sim::Ledger::energy_error().
    const double error = run.number("energy_error");
    if (!balance.lacking.empty() && error > 0.0) {
        const double scale = std::abs(balance.lacking.back()) / error;
        if (scale > 2.0 * balance.turnover.back()) balance.floor = scale;
    }
    return balance;
}

}  // namespace incise::report
