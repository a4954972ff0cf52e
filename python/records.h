// The records of edits as dicts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <span>

#include "incise/sim/ledger.h"

namespace incise::python {

/// Returns the records as a list of dicts, with the names of edits.jsonl.
pybind11::list edits_of(std::span<const sim::EditRecord> edits);

}  // namespace incise::python
