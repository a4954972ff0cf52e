// The accounts of mass, energy and momentum over a run, as tables for people.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/app/report/energy_balance.h"
#include "incise/app/report/run_record.h"

namespace incise::report {

/// A line of an account.
struct AccountRow {
    std::string label;
    std::vector<double> values;  ///< one, or one along each axis
    bool is_result = false;      ///< true for what the account comes to
    std::string unit;            ///< if empty, that of the account
};

/// An account: what was there, what came and went, what is there, and the difference.
struct Account {
    std::string title;
    std::string unit;
    std::string note;
    std::vector<AccountRow> rows;
};

/// Returns the accounts as far as the files of the run have the numbers. They go up to the last row
/// of the history.
std::vector<Account> accounts_of(const RunRecord& run, const EnergyBalance& balance);

}  // namespace incise::report
