// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tool_path.h"

#include <algorithm>

namespace incise::scenario {

Pose ToolPath::pose(double time) const {
    const auto after =
        std::upper_bound(keys_.begin(), keys_.end(), time,
                         [](double t, const TimeKey<Pose>& key) { return t < key.time; });
    if (after == keys_.begin()) return keys_.front().value;
    if (after == keys_.end()) return keys_.back().value;
    const auto before = after - 1;
    const double s = (time - before->time) / (after->time - before->time);
    return interpolate(before->value, after->value, s);
}

bool ToolPath::is_present(double from, double to) const {
    if (is_endless_) return true;
    const double first = first_time(), last = last_time();
    if (first == last) return first <= to && (from < first || (from == 0.0 && first == 0.0));
    return to > first && from < last;
}

std::optional<Pose> ToolPath::pose_before_end() const {
    // The tool may be at rest before the end. With rotation, the path between two keys is curved,
    // so that only a short part before its end has the direction of the end.
    constexpr double part = 1e-3;
    for (std::size_t key = keys_.size() - 1; key > 0; --key) {
        const auto &before = keys_[key - 1], &after = keys_[key];
        const Pose &a = before.value, &b = after.value;
        if (a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs()) continue;
        return pose(after.time - part * (after.time - before.time));
    }
    return std::nullopt;
}

}  // namespace incise::scenario
