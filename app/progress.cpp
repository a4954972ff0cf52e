// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace incise::app {

namespace {

using namespace std::chrono_literals;

constexpr auto redraw_interval = 100ms;
constexpr auto line_interval = 10s;
constexpr double line_step = 0.1;
constexpr int bar_columns = 24;
constexpr double least_fraction_for_estimate = 1e-3;  // below it, the remaining time is not shown

int terminal_columns() {
    winsize size{};
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return size.ws_col;
}

}  // namespace

std::string duration_text(double seconds) {
    const auto total = static_cast<long long>(std::clamp(std::round(seconds), 0.0, 1e12));
    std::string text;
    const auto append = [&text](long long count, bool with_two_digits) {
        if (with_two_digits && count < 10) text += '0';
        text += std::to_string(count);
    };
    const bool has_hours = total >= 3600;
    if (has_hours) {
        append(total / 3600, false);
        text += ':';
    }
    append(total / 60 % 60, has_hours);
    text += ':';
    append(total % 60, true);
    return text;
}

std::string progress_line(std::string_view label, double fraction, double elapsed_seconds,
                          std::string_view note, int width) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    std::string line(label);
    if (width > 0) {
        const auto full = static_cast<std::size_t>(fraction * bar_columns);
        line.append(" [").append(std::string(full, '#'));
        line.append(std::string(bar_columns - full, '.')).append("]");
    }
    line.append(" ").append(std::to_string(static_cast<int>(fraction * 100.0))).append(" %");
    if (fraction >= 1.0)
        line.append(", took ").append(duration_text(elapsed_seconds));
    else if (fraction >= least_fraction_for_estimate)
        line.append(", ")
            .append(duration_text(elapsed_seconds * (1.0 - fraction) / fraction))
            .append(" left");
    if (!note.empty()) line.append(", ").append(note);
    if (width > 0 && line.size() >= static_cast<std::size_t>(width))
        line.resize(static_cast<std::size_t>(width) - 1);
    return line;
}

Progress::Progress(double total, std::string label, bool quiet)
    : total_(total),
      label_(std::move(label)),
      quiet_(quiet),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
    if (is_line_open_) std::fputc('\n', stderr);
}

void Progress::update(double done, std::string_view note) {
    if (quiet_) return;
    done_ = done;
    note_.assign(note);
    const auto now = Clock::now();
    const bool is_due =
        is_terminal_ ? now - last_ >= redraw_interval
                     : now - last_ >= line_interval || done_ / total_ >= last_fraction_ + line_step;
    if (is_due) draw(now);
}

void Progress::finish() {
    if (quiet_) return;
    if (is_terminal_ || done_ / total_ > last_fraction_) draw(Clock::now());
    if (is_line_open_) std::fputc('\n', stderr);
    is_line_open_ = false;
    quiet_ = true;
}

void Progress::draw(Clock::time_point now) {
    const double fraction = done_ / total_;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const auto line =
        progress_line(label_, fraction, elapsed, note_, is_terminal_ ? terminal_columns() : 0);
    if (is_terminal_)
        std::fprintf(stderr, "\r%s\033[K", line.c_str());
    else
        std::fprintf(stderr, "%s\n", line.c_str());
    std::fflush(stderr);
    is_line_open_ = is_terminal_;
    last_ = now;
    // Rounded down to tenths, so that rounding of `done` does not shift later lines.
    last_fraction_ = std::max(last_fraction_, std::floor(fraction / line_step + 1e-9) * line_step);
}

}  // namespace incise::app
