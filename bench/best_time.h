// The time of a piece of work.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

namespace incise::bench {

/// Returns the shortest time of a call, s. Calls are repeated for `seconds` in all, at least once.
template <class Work>
double best_time(double seconds, Work work) {
    using Clock = std::chrono::steady_clock;
    double best = std::numeric_limits<double>::infinity();
    const auto start = Clock::now();
    do {
        const auto before = Clock::now();
        work();
        best = std::min(best, std::chrono::duration<double>(Clock::now() - before).count());
    } while (std::chrono::duration<double>(Clock::now() - start).count() < seconds);
    return best;
}

}  // namespace incise::bench
