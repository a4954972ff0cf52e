// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/spatial/element_boxes.h"

namespace incise::topology {

ElementBoxes::ElementBoxes(const Mesh& mesh, std::span<const Vec3> positions) : epoch_(mesh) {
    build(mesh, positions, 0.0);
}

void ElementBoxes::build(const Mesh& mesh, std::span<const Vec3> positions, double margin) {
    stale_.clear();
    groups_.assign(num_groups(mesh.element_capacity()), Box());
    supergroups_.assign(num_supergroups(groups_.size()), Box());
    double sum = 0.0, largest_coordinate = 0.0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        update_group(mesh, positions, g);
        const Box& box = groups_[g];
        if (box.isEmpty()) continue;
        sum += box.sizes().maxCoeff();
        largest_coordinate = std::max(
            {largest_coordinate, box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()});
    }
    // Far above the rounding of distances and of grown boxes: a tool that only touches an element
    // must find it.
    margin_ = margin + 1e-12 * largest_coordinate;
    // At this margin, a search visits twice to a few times as many elements as with new boxes.
    if (!groups_.empty()) largest_margin_ = 0.4 * sum / static_cast<double>(groups_.size());
}

void ElementBoxes::update_group(const Mesh& mesh, std::span<const Vec3> positions, std::size_t g) {
    Box box;
    const std::size_t end = std::min(mesh.element_capacity(), (g + 1) * group_size);
    for (std::size_t i = g * group_size; i < end; ++i)
        if (const CellId e(i); mesh.is_alive(e))
            for (const VertexId n : mesh.corners(e)) box.extend(positions[n.index()]);
    groups_[g] = box;
    // The box of a supergroup only grows until the next rebuild, even if a group has lost elements.
    supergroups_[g / supergroup_size].extend(box);
}

void ElementBoxes::move(const Mesh& mesh, std::span<const Vec3> positions, double distance) {
    margin_ += distance;
    if (margin_ <= largest_margin_) return refresh(mesh, positions);
    build(mesh, positions, distance);  // the elements before the motion are in them, too
}

bool ElementBoxes::may_meet(const Box& swept) const {
    const auto meets = [&](const Box& box) {
        return !box.isEmpty() && swept.intersects(grown(box));
    };
    return std::any_of(supergroups_.begin(), supergroups_.end(), meets) &&
           std::any_of(groups_.begin(), groups_.end(), meets);
}

void ElementBoxes::apply(const Mesh& mesh, const ChangeSet& changes) {
    epoch_.advance(mesh, changes, "search structure");
    groups_.resize(num_groups(mesh.element_capacity()));
    supergroups_.resize(num_supergroups(groups_.size()));
    for (const auto& record : changes.elements_added)
        stale_.push_back(record.id.index() / group_size);
    for (const auto& record : changes.rewired)
        stale_.push_back(record.element.index() / group_size);
    for (const auto& change : changes.shape_changes)
        stale_.push_back(change.cell.index() / group_size);
    std::sort(stale_.begin(), stale_.end());
    stale_.erase(std::unique(stale_.begin(), stale_.end()), stale_.end());
}

void ElementBoxes::refresh(const Mesh& mesh, std::span<const Vec3> positions) {
    // The boxes contain the present positions; the margin covers the earlier ones.
    for (const std::size_t g : stale_)
        if (g < groups_.size()) update_group(mesh, positions, g);
    stale_.clear();
}

}  // namespace incise::topology
