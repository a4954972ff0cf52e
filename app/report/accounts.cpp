// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/accounts.h"

#include <cmath>
#include <utility>

namespace incise::report {

namespace {

/// The first and the last value of a column.
struct Ends {
    double first, last;
};

Ends ends_of(const HistoryTable& history, const std::string& column) {
    return {history.value(column, 0), history.value(column, history.num_rows() - 1)};
}

std::vector<double> list_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Account mass_account(const RunRecord& run) {
    const auto [first, last] = ends_of(run.history, "mass");
    double removed = 0.0;
    for (const Edit& edit : run.edits) removed += edit.mass_removed;
    const double lacking = first - removed - last;
    return {"Mass",
            "kg",
            "",
            {{"at the start", {first}, false, ""},
             {"− taken away by tools", {removed}, false, ""},
             {"− at the end", {last}, false, ""},
             {"lacking", {lacking}, true, ""},
             {"lacking, of the mass at the start", {100.0 * lacking / first}, true, "%"}}};
}

Account energy_account(const RunRecord& run, const EnergyBalance& balance) {
    const auto kinetic = ends_of(run.history, "kinetic_energy");
    const auto elastic = ends_of(run.history, "elastic_energy");
    const double lacking = balance.lacking.back();
    Account account = {
        "Energy",
        "J",
        "With explicit steps, what is lacking is of the order of the time step.",
        {{"at the start", {kinetic.first + elastic.first}, false, ""},
         {"+ work of gravity, loads, constraints and tools",
          {ends_of(run.history, "external_work").last},
          false,
          ""},
         {"− dissipated by damping, viscosity and contact",
          {ends_of(run.history, "dissipated_energy").last},
          false,
          ""},
         {"− taken away by edits", {balance.removed.back()}, false, ""},
         {"− kinetic energy at the end", {kinetic.last}, false, ""},
         {"− elastic energy at the end", {elastic.last}, false, ""},
         {"lacking", {lacking}, true, ""},
         {"lacking, of the sum of the lines above",
          {std::max(balance.turnover.back(), balance.floor) > 0.0
               ? 100.0 * std::abs(lacking) / std::max(balance.turnover.back(), balance.floor)
               : 0.0},
          true,
          "%"}}};
    return account;
}

/// The account of momentum or angular momentum. Gravity, loads and constraints change it too, so it
/// tells what edits did, and comes to no rest.
Account momentum_account(const RunRecord& run, const std::string& title, const std::string& unit,
                         const std::string& column, Vec3 BodyState::*state) {
    Vec3 first, last;
    for (int i = 0; i < 3; ++i) {
        const auto ends = ends_of(run.history, column + "_" + "xyz"[i]);
        first[i] = ends.first;
        last[i] = ends.last;
    }
    Vec3 by_edits = Vec3::Zero(), largest = Vec3::Zero();
    for (const Edit& edit : run.edits) {
        const Vec3 change = edit.after.*state - edit.before.*state;
        by_edits += change;
        if (change.norm() > largest.norm()) largest = change;
    }
    return {title,
            unit,
            "",
            {{"at the start", list_of(first), false, ""},
             {"changed by all edits", list_of(by_edits), false, ""},
             {"largest change by one edit", list_of(largest), false, ""},
             {"at the end", list_of(last), true, ""}}};
}

}  // namespace

std::vector<Account> accounts_of(const RunRecord& run, const EnergyBalance& balance) {
    std::vector<Account> accounts;
    if (run.history.num_rows() == 0) return accounts;
    if (run.history.find("mass")) accounts.push_back(mass_account(run));
    if (!balance.lacking.empty()) accounts.push_back(energy_account(run, balance));
    if (run.history.find("momentum_x"))
        accounts.push_back(
            momentum_account(run, "Momentum", "kg m/s", "momentum", &BodyState::momentum));
    if (run.history.find("angular_momentum_x"))
        accounts.push_back(momentum_account(run, "Angular momentum about the origin", "kg m²/s",
                                            "angular_momentum", &BodyState::angular_momentum));
    return accounts;
}

}  // namespace incise::report
