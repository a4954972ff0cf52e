// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/scars.h"

#include <algorithm>
#include <cmath>

namespace incise::cutting {

namespace {

constexpr double rounding = 1e-6;

bool is_same(const NearPlane& a, const NearPlane& b, double size) {
    const double turn = a.normal.dot(b.normal);  // a surface may be given from either side
    return a.normal.cross(b.normal).norm() <= rounding &&
           std::abs(a.height - std::copysign(1.0, turn) * b.height) <= rounding * size;
}

}  // namespace

void Scars::add(topology::NodeId n, const NearPlane& plane) {
    if (!has(n, plane, std::abs(plane.height))) planes_[n.value].push_back(plane);
}

bool Scars::has(topology::NodeId n, const NearPlane& plane, double size) const {
    const auto place = planes_.find(n.value);
    return place != planes_.end() &&
           std::any_of(place->second.begin(), place->second.end(),
                       [&](const NearPlane& known) { return is_same(known, plane, size); });
}

void Scars::follow(const topology::ChangeSet& changes) {
    if (planes_.empty()) return;
    for (const topology::NodeRecord& record : changes.nodes_added) {
        if (record.num_sources != 1) continue;
        const auto place = planes_.find(record.sources[0].node.value);
        if (place != planes_.end())
            planes_.insert_or_assign(record.id.value, std::vector<NearPlane>(place->second));
    }
}

}  // namespace incise::cutting
