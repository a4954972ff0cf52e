// SIGINT and SIGTERM to a run.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

namespace incise::app {

/// What the two signals do while it is there: at first they end the process, and are only noted
/// once the run has begun to write, so that it can close its files properly. One at a time.
class StopSignals {
  public:
    /// Until note_only(), they end the process at once, with `farewell` as an error message and the
    /// exit status 128 + signal: reading a large mesh can take long.
    explicit StopSignals(const std::string& farewell);
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    void note_only() const;
    /// The last that was noted, or 0.
    int noted() const;
};

}  // namespace incise::app
