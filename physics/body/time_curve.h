// Values given at times, linear between them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace incise::physics {

/// Between a (s = 0) and b (s = 1). Poses have one of their own: topology/pose.h.
template <class Value>
Value interpolate(const Value& a, const Value& b, double s) {
    return a + s * (b - a);
}

/// Piecewise linear in time (see interpolate), constant before the first key and after the last.
template <class Value>
class TimeCurve {
  public:
    TimeCurve() = default;
    /// @param keys times (s) in strictly ascending order with their values
    explicit TimeCurve(std::vector<std::pair<double, Value>> keys) : keys_(std::move(keys)) {}

    bool is_empty() const { return keys_.empty(); }
    const std::vector<std::pair<double, Value>>& keys() const { return keys_; }

    /// @pre not empty
    Value at(double time) const {
        const auto after = std::upper_bound(
            keys_.begin(), keys_.end(), time,
            [](double t, const std::pair<double, Value>& key) { return t < key.first; });
        if (after == keys_.begin()) return keys_.front().second;
        if (after == keys_.end()) return keys_.back().second;
        const auto& [t0, v0] = *(after - 1);
        const auto& [t1, v1] = *after;
        return interpolate(v0, v1, (time - t0) / (t1 - t0));
    }

    static void archive(auto& ar, auto& self) { ar(self.keys_); }

  private:
    std::vector<std::pair<double, Value>> keys_;
};

}  // namespace incise::physics
