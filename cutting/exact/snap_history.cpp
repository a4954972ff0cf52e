// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/snap_history.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::cutting {

namespace {

bool are_parallel(const CutRecord& a, const CutRecord& b) {
    return a.normal.cross(b.normal).norm() <= SnapHistory::rounding;
}

bool is_same(const CutRecord& a, const CutRecord& b, double size) {
    const double turn = a.normal.dot(b.normal);  // normals of one surface may be opposite
    const double height_a = a.normal.dot(a.to_surface), height_b = b.normal.dot(b.to_surface);
    return are_parallel(a, b) &&
           std::abs(height_a - std::copysign(1.0, turn) * height_b) <= SnapHistory::rounding * size;
}

/// True if the records of two nodes are of one plane part of one surface, as it was in space. That
/// does not depend on how the nodes have moved since.
bool are_of_one_plane(const CutRecord& a, const CutRecord& b, double size) {
    return a.surface != no_identity && a.surface == b.surface && are_parallel(a, b) &&
           std::abs(a.normal.dot(a.passage() - b.passage())) <= SnapHistory::rounding * size;
}

}  // namespace

void SnapHistory::add(VertexId n, const CutRecord& record) {
    if (!has(n, record, record.to_surface.norm())) snap_history_[n].push_back(record);
}

const CutRecord* SnapHistory::find(VertexId n, const CutRecord& record, double size) const {
    const auto known = of(n);
    const auto place = std::find_if(known.begin(), known.end(), [&](const CutRecord& other) {
        return is_same(other, record, size);
    });
    return place == known.end() ? nullptr : &*place;
}

std::span<const CutRecord> SnapHistory::of(VertexId n) const {
    const auto place = snap_history_.find(n);
    return place == snap_history_.end() ? std::span<const CutRecord>{}
                                        : std::span<const CutRecord>(place->second);
}

double SnapHistory::largest_uncut_size() const {
    double largest = 0.0;
    for (const auto& [n, size] : uncut_sizes_) largest = std::max(largest, size);
    return largest;
}

void SnapHistory::follow_division(const PlacedNode& a, const PlacedNode& b,
                                  const PlacedNode& middle, double rest_length) {
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId end : {a.node, b.node}) {
        double& size = uncut_sizes_[end];
        size = std::max(size, rest_length);
        least = std::min(least, size);
    }
    uncut_sizes_[middle.node] = least;
    inherit_planes(a, b, middle);
    inherit(a, b, middle);
    inherit(b, a, middle);
}

/// Gives the middle the records of planes that both ends are on. It lay between the ends when the
/// plane passed by them, too.
void SnapHistory::inherit_planes(const PlacedNode& a, const PlacedNode& b,
                                 const PlacedNode& middle) {
    const Vec3 edge = b.place - a.place;
    const double t = (middle.place - a.place).norm() / edge.norm();
    for (const CutRecord& at_a : of(a.node))
        for (const CutRecord& at_b : of(b.node)) {
            if (!are_of_one_plane(at_a, at_b, edge.norm())) continue;
            CutRecord record{at_a.normal, Vec3::Zero(), false, at_a.rank, at_a.surface};
            record.place = (1.0 - t) * at_a.place + t * at_b.place;
            record.to_surface = (1.0 - t) * at_a.to_surface + t * at_b.to_surface;
            add(middle.node, record);
            break;
        }
}

void SnapHistory::inherit(const PlacedNode& from, const PlacedNode& to, const PlacedNode& middle) {
    const auto known = of(from.node);
    if (known.empty()) return;
    const Vec3 edge = to.place - from.place, half = middle.place - from.place;
    for (CutRecord record : std::vector<CutRecord>(known.begin(), known.end())) {
        const auto is_of_its_plane = [&](const CutRecord& other) {
            return are_of_one_plane(record, other, edge.norm());
        };
        if (std::ranges::any_of(of(to.node), is_of_its_plane)) continue;
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
    for (const topology::VertexRecord& record : changes.nodes_added) {
        if (record.num_sources != 1) continue;
        const VertexId source = record.sources[0].node;
        if (const double size = uncut_size(source); size > 0.0) uncut_sizes_[record.id] = size;
        const auto place = snap_history_.find(source);
        if (place != snap_history_.end())
            snap_history_.insert_or_assign(record.id, std::vector<CutRecord>(place->second));
    }
}

}  // namespace incise::cutting
