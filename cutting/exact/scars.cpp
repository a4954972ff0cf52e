// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/scars.h"

#include <algorithm>
#include <cmath>

namespace incise::cutting {

namespace {

bool is_same(const Scar& a, const Scar& b, double size) {
    const double turn = a.normal.dot(b.normal);  // a surface may be given from either side
    const double height_a = a.normal.dot(a.to_surface), height_b = b.normal.dot(b.to_surface);
    return a.normal.cross(b.normal).norm() <= Scars::rounding &&
           std::abs(height_a - std::copysign(1.0, turn) * height_b) <= Scars::rounding * size;
}

}  // namespace

void Scars::add(NodeId n, const Scar& scar) {
    if (!has(n, scar, scar.to_surface.norm())) scars_[n].push_back(scar);
}

const Scar* Scars::find(NodeId n, const Scar& scar, double size) const {
    const auto known = of(n);
    const auto place = std::find_if(known.begin(), known.end(),
                                    [&](const Scar& other) { return is_same(other, scar, size); });
    return place == known.end() ? nullptr : &*place;
}

std::span<const Scar> Scars::of(NodeId n) const {
    const auto place = scars_.find(n);
    return place == scars_.end() ? std::span<const Scar>{} : std::span<const Scar>(place->second);
}

void Scars::follow_division(const PlacedNode& a, const PlacedNode& b, const PlacedNode& middle) {
    inherit(a, b, middle);
    inherit(b, a, middle);
}

void Scars::inherit(const PlacedNode& from, const PlacedNode& to, const PlacedNode& middle) {
    const auto known = of(from.node);
    if (known.empty()) return;
    const Vec3 edge = to.place - from.place, half = middle.place - from.place;
    for (Scar scar : std::vector<Scar>(known.begin(), known.end())) {
        const double place = scar.normal.dot(scar.to_surface) / scar.normal.dot(edge);
        if (place < 1.0 && place * edge.norm() > half.norm()) {
            add(middle.node, {scar.normal, place * edge - half, false, scar.rank, scar.surface,
                              scar.place + half});
            continue;
        }
        const Scar at_end{scar.normal, scar.to_surface - edge, false, scar.rank};
        const Scar* other = find(to.node, at_end, edge.norm());
        if (other == nullptr) continue;
        if (other->surface != scar.surface) scar.surface = no_identity;
        scar.place += half;
        scar.to_surface = scar.normal.dot(scar.to_surface - half) * scar.normal;
        add(middle.node, scar);
    }
}

void Scars::apply(const topology::Mesh&, const topology::ChangeSet& changes) {
    for (const topology::NodeRecord& record : changes.nodes_added) {
        if (record.num_sources != 1 || scars_.empty()) continue;
        const auto place = scars_.find(record.sources[0].node);
        if (place != scars_.end())
            scars_.insert_or_assign(record.id, std::vector<Scar>(place->second));
    }
    for (const topology::ElementRecord& record : changes.elements_added)
        if (const auto place = crumbs_.find(record.parent); place != crumbs_.end())
            add_crumb(record.id, place->second);
}

}  // namespace incise::cutting
