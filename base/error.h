// Errors with causes outside the program. The type tells who can correct the error; the text names
// the thing, its value, its location and the remedy.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace incise {

/// An error in the input: a file, a scenario or an argument.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A failure of the simulation, such as a step that is too large or a state that is not finite.
struct PhysicsError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A failure to write a result.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A request that needs more memory than the machine has. It is thrown before the memory is
/// allocated; a failure of the allocation itself throws std::bad_alloc.
struct MemoryError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace incise
