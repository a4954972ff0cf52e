// The energy of a run over time: what has come in, what has gone, and what the account lacks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/app/report/run_record.h"

namespace incise::report {

/// The balance of energy at each row of history.csv, as sim::Ledger::energy_error() has it at the
/// end of the run: energy at the start + external work - dissipated energy - energy that edits
/// removed - energy now = the energy that the account lacks.
struct EnergyBalance {
    std::vector<double> removed;  ///< by edits up to the row, J
    std::vector<double> lacking;  ///< J
    /// The sum of the absolute values of the five terms at the row, J.
    std::vector<double> turnover;
    /// The energy of a small strain, J, below which energies are rounding; 0 if it is not known.
    double floor = 0.0;

    /// Returns the largest absolute value of `lacking` over the largest turnover. Compared with the
    /// turnover of its own row, the rounding of a body at rest would be an error of 100 %.
    /// Returns NaN if there are no rows, or if nothing was turned over.
    double largest_error() const;
};

/// Returns the balance. It is empty if the history lacks one of the columns of energies.
EnergyBalance energy_balance(const RunRecord& run);

}  // namespace incise::report
