// Piecewise linear functions of time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace incise::physics {

/// Returns the linear interpolation between a (s = 0) and b (s = 1). topology/pose.h has an
/// overload for poses.
template <class Value>
Value interpolate(const Value& a, const Value& b, double s) {
    return a + s * (b - a);
}

/// A function of time that interpolates between keys; see interpolate(). It is constant before the
/// first key and after the last one.
template <class Value>
class TimeCurve {
  public:
    TimeCurve() = default;
    /// Takes the keys: times, s, in strictly ascending order, with their values.
    explicit TimeCurve(std::vector<std::pair<double, Value>> keys) : keys_(std::move(keys)) {}

    bool is_empty() const { return keys_.empty(); }
    const std::vector<std::pair<double, Value>>& keys() const { return keys_; }

    /// Returns the value at `time`, s.
    /// @pre  the curve is not empty
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
