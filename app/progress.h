// Display of the progress of long tasks: a bar with the remaining time on a terminal, and single
// lines elsewhere.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace incise::app {

/// A display of progress on stderr. On a terminal it redraws one line, at most ten times a second.
/// Elsewhere it prints a line after every tenth of the work or after ten seconds, whichever is
/// first.
class Progress {
  public:
    /// @param total  amount of work, above 0, in any unit
    /// @param label  text at the beginning of the line
    /// @param quiet  if true, nothing is written
    Progress(double total, std::string label, bool quiet);
    /// Ends the line, so that later output begins on a new line.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Sets the progress and redraws the display if due.
    /// @param done  the completed part of `total`; not below the last value
    /// @param note  text at the end of the line, such as "12034 elements"
    void update(double done, std::string_view note = {});
    /// Shows the last state and ends the line.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;

    void draw(Clock::time_point now);

    double total_;
    std::string label_;
    bool quiet_;
    bool is_terminal_;
    bool is_line_open_ = false;
    double done_ = 0.0;
    std::string note_;
    double last_fraction_ = 0.0;
    Clock::time_point start_, last_;
};

/// Returns a duration in s as text, such as "0:42", "12:05" or "3:04:05".
std::string duration_text(double seconds);

/// Returns the line without line feed: "LABEL [####....] 42 %, 0:12 left, NOTE".
/// @param label            text at the beginning
/// @param fraction         completed part, from 0 to 1
/// @param elapsed_seconds  time since the start, s
/// @param note             text at the end; may be empty
/// @param width            columns, at which the line is cut off; if 0, the line has no bar and no
///                         limit
std::string progress_line(std::string_view label, double fraction, double elapsed_seconds,
                          std::string_view note, int width);

}  // namespace incise::app
