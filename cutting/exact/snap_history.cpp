// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/snap_history.h"

#include <algorithm>
#include <cmath>

namespace incise::cutting {

namespace {

bool is_same(const CutRecord& a, const CutRecord& b, double size) {
    const double turn = a.normal.dot(b.normal);  // normals of one surface may be opposite
    const double height_a = a.normal.dot(a.to_surface), height_b = b.normal.dot(b.to_surface);
    return a.normal.cross(b.normal).norm() <= SnapHistory::rounding &&
           std::abs(height_a - std::copysign(1.0, turn) * height_b) <= SnapHistory::rounding * size;
}

}  // namespace

void SnapHistory::add(NodeId n, const CutRecord& record) {
    if (!has(n, record, record.to_surface.norm())) snap_history_[n].push_back(record);
}

const CutRecord* SnapHistory::find(NodeId n, const CutRecord& record, double size) const {
    const auto known = of(n);
    const auto place = std::find_if(known.begin(), known.end(), [&](const CutRecord& other) {
        return is_same(other, record, size);
    });
    return place == known.end() ? nullptr : &*place;
}

std::span<const CutRecord> SnapHistory::of(NodeId n) const {
    const auto place = snap_history_.find(n);
    return place == snap_history_.end() ? std::span<const CutRecord>{}
                                        : std::span<const CutRecord>(place->second);
}

void SnapHistory::follow_division(const PlacedNode& a, const PlacedNode& b,
                                  const PlacedNode& middle) {
    inherit(a, b, middle);
    inherit(b, a, middle);
}

void SnapHistory::inherit(const PlacedNode& from, const PlacedNode& to, const PlacedNode& middle) {
    const auto known = of(from.node);
    if (known.empty()) return;
    const Vec3 edge = to.place - from.place, half = middle.place - from.place;
    for (CutRecord record : std::vector<CutRecord>(known.begin(), known.end())) {
        const double place = record.normal.dot(record.to_surface) / record.normal.dot(edge);
        if (place < 1.0 && place * edge.norm() > half.norm()) {
            add(middle.node, {record.normal, place * edge - half, false, record.rank,
                              record.surface, record.place + half});
            continue;
        }
        const CutRecord at_end{record.normal, record.to_surface - edge, false, record.rank};
        const CutRecord* other = find(to.node, at_end, edge.norm());
        if (other == nullptr) continue;
        if (other->surface != record.surface) record.surface = no_identity;
        record.place += half;
        record.to_surface = record.normal.dot(record.to_surface - half) * record.normal;
        add(middle.node, record);
    }
}

void SnapHistory::apply(const topology::Mesh&, const topology::ChangeSet& changes) {
    for (const topology::NodeRecord& record : changes.nodes_added) {
        if (record.num_sources != 1 || snap_history_.empty()) continue;
        const auto place = snap_history_.find(record.sources[0].node);
        if (place != snap_history_.end())
            snap_history_.insert_or_assign(record.id, std::vector<CutRecord>(place->second));
    }
}

}  // namespace incise::cutting
