// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/scars.h"

#include <algorithm>

namespace incise::cutting {

void Scars::add(topology::NodeId n, double distance) {
    double& known = distances_.try_emplace(n.value, 0.0).first->second;
    known = std::max(known, distance);
}

bool Scars::may_hold(topology::NodeId n, double distance) const {
    const auto place = distances_.find(n.value);
    constexpr double slack = 1.0 + 1e-6;  // for rounding
    return place != distances_.end() && distance <= slack * place->second;
}

void Scars::follow(const topology::ChangeSet& changes) {
    if (distances_.empty()) return;
    for (const topology::NodeRecord& record : changes.nodes_added) {
        if (record.num_sources != 1) continue;
        const auto place = distances_.find(record.sources[0].node.value);
        if (place != distances_.end()) add(record.id, double(place->second));
    }
}

}  // namespace incise::cutting
