// What can go wrong outside the program's own control. The type says whose turn it is; the text
// names the thing, its value, the place and the remedy.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace incise {

/// The input is at fault: a file, a scenario, an argument.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The physics went wrong: a step too large, a state that is no longer finite.
struct PhysicsError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A result could not be written.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The machine has less memory than what is asked for takes; known before it is taken, else it is
/// std::bad_alloc.
struct MemoryError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace incise
