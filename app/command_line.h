// From the words of the command line to a call of a verb.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::app {

/// Runs the verb and returns its status. Help and version go to stdout.
/// Throws InputError for a usage that is not known, and what the verb throws.
int dispatch(int argc, const char* const* argv);

}  // namespace incise::app
