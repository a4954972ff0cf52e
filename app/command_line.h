// Parses the command line and calls a verb.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::app {

/// Runs the verb of the command line and returns its exit status. Help and version go to stdout.
/// Throws InputError for wrong usage, and whatever the verb throws.
int dispatch(int argc, const char* const* argv);

}  // namespace incise::app
