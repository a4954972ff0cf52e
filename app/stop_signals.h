// Handling of SIGINT and SIGTERM during a run.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

namespace incise::app {

/// A handler of SIGINT and SIGTERM during its lifetime. At first a signal ends the process. After
/// note_only() a signal is only recorded, so that the run can close its files properly.
/// @pre  there is only one object at a time
class StopSignals {
  public:
    /// Until note_only() is called, a signal ends the process at once, because reading a large mesh
    /// can take long. The exit status is 128 + signal.
    /// @param farewell  error message at the end of the process
    explicit StopSignals(const std::string& farewell);
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// From now on, signals are recorded and have no other effect.
    void note_only() const;
    /// Returns the last recorded signal, or 0.
    int noted() const;
};

}  // namespace incise::app
