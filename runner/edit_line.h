// The record of an edit as a line of edits.jsonl.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/sim/ledger.h"

namespace incise::runner {

/// Returns the record as one line of JSON, without a line feed. Bytes of names that are not UTF-8
/// are replaced, and numbers that are not finite are null.
std::string edit_line(const sim::EditRecord& edit);

}  // namespace incise::runner
