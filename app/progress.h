// How far long work has come: a bar with the time left on a terminal, plain lines now and then
// elsewhere.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace incise::app {

/// Writes to stderr. On a terminal one line is drawn anew, at most ten times a second; elsewhere a
/// line comes every tenth of the work or every ten seconds, whichever is first.
class Progress {
  public:
    /// @param total  amount of work, above 0, in any unit
    /// @param quiet  say nothing
    Progress(double total, std::string label, bool quiet);
    /// Leaves the line, so that what is written next begins on a fresh one.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// @param done  how much of `total`; never less than before
    /// @param note  shown behind, such as "12034 elements"
    void update(double done, std::string_view note = {});
    /// Shows the last state once more and leaves the line.
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

/// "0:42", "12:05", "3:04:05".
std::string duration_text(double seconds);

/// The line without its end: "LABEL [####....] 42 %, 0:12 left, NOTE"; without bar if `width` is 0.
/// @param width  columns of the whole line, at which it is cut
std::string progress_line(std::string_view label, double fraction, double elapsed_seconds,
                          std::string_view note, int width);

}  // namespace incise::app
