// The pace of a live session: when the next tick is due, and how fast the session really is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <utility>

namespace incise::live {

/// Time that was lost is not made up for: a session that is too slow for real time stays behind.
class Pace {
  public:
    using Clock = std::chrono::steady_clock;

    explicit Pace(double tick) : tick_(tick) {}

    /// Sets how many seconds of the session one second shall take.
    void set_speed(double speed) { speed_ = speed; }
    double speed() const { return speed_; }

    /// Begins anew, after a pause.
    void rest(Clock::time_point now) {
        due_ = now;
        ticks_.clear();
    }
    /// Notes the end of a tick. Returns when the next one is due.
    Clock::time_point note_tick(Clock::time_point now) {
        const std::chrono::duration<double> length(tick_ / speed_);
        due_ = std::max(due_ + std::chrono::duration_cast<Clock::duration>(length), now);
        ticks_.push_back(now);
        constexpr auto window = std::chrono::seconds(1);
        while (ticks_.size() > 2 && now - ticks_.front() > window) ticks_.pop_front();
        return due_;
    }
    /// Returns how many seconds of the session one second has taken lately.
    double factor() const {
        if (ticks_.size() < 2) return speed_;
        const std::chrono::duration<double> time = ticks_.back() - ticks_.front();
        return static_cast<double>(ticks_.size() - 1) * tick_ / time.count();
    }

  private:
    double tick_;  // s
    double speed_ = 1.0;
    Clock::time_point due_ = Clock::now();
    std::deque<Clock::time_point> ticks_;  // of the last second
};

}  // namespace incise::live
