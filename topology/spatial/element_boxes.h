// Search for the elements near a tool by a hierarchy of bounding boxes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/follower.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Bounding boxes of groups of elements and of groups of groups. A group has elements with
/// consecutive ids, which lie near each other. The boxes remain valid while the body moves, since
/// they grow by the largest distance that any node has moved. When they have grown too large, they
/// are rebuilt.
class ElementBoxes {
  public:
    /// Builds the boxes for the current positions (m, by node id). Cost: O(n).
    ElementBoxes(const topology::Mesh& mesh, std::span<const Vec3> positions);

    /// Follows a motion of the body.
    /// @param mesh       the mesh of the body
    /// @param positions  by node id, after the motion, m
    /// @param distance   at least the largest distance that a node has moved, m
    /// Cost: O(n) when the boxes are rebuilt, else O(1).
    void move(const topology::Mesh& mesh, std::span<const Vec3> positions, double distance);
    /// Follows an edit. refresh() or move() must be called before the next search.
    /// Throws InputError, and changes nothing, for an edit out of turn.
    /// Cost: proportional to the edit.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);
    /// Updates the boxes that edits have changed.
    /// @param mesh       the mesh of the body
    /// @param positions  by node id, at present, m
    /// Cost: proportional to the edits since the last call.
    void refresh(const topology::Mesh& mesh, std::span<const Vec3> positions);

    /// True if there are as many boxes as the mesh needs.
    bool cover(const topology::Mesh& mesh) const {
        return groups_.size() == num_groups(mesh.element_capacity()) &&
               supergroups_.size() == num_supergroups(groups_.size());
    }

    /// Calls visit(element) for the living elements of all groups for which may_meet(box) is true,
    /// in ascending order. The boxes contain the elements throughout the last motion.
    template <class MayMeet, class Visit>
    void for_each_near(const topology::Mesh& mesh, MayMeet may_meet, Visit visit) const;

    /// True if an element may have had a point in the box `swept` during the last motion. If false,
    /// no element had one. Cost: O(number of boxes).
    bool may_meet(const Box& swept) const;

    static void archive(auto& ar, auto& self) {
        ar(self.groups_, self.supergroups_, self.stale_, self.margin_, self.largest_margin_);
    }

  private:
    static constexpr std::size_t group_size = 16, supergroup_size = 64;
    static std::size_t num_groups(std::size_t n) { return (n + group_size - 1) / group_size; }
    static std::size_t num_supergroups(std::size_t n) {
        return (n + supergroup_size - 1) / supergroup_size;
    }

    /// @param margin  of the new boxes, m
    void build(const topology::Mesh& mesh, std::span<const Vec3> positions, double margin);
    void update_group(const topology::Mesh& mesh, std::span<const Vec3> positions, std::size_t g);
    Box grown(const Box& box) const {
        const Vec3 margin = Vec3::Constant(margin_);
        return {box.min() - margin, box.max() + margin};
    }

    std::vector<Box> groups_;         // of elements
    std::vector<Box> supergroups_;    // of groups
    std::vector<std::size_t> stale_;  // groups whose boxes edits have changed, in ascending order
    // How far nodes may have moved since the boxes were built, and the rounding of that.
    double margin_ = 0.0;
    double largest_margin_ = 0.0;  // above it, the boxes are rebuilt
    FollowedEpoch epoch_;
};

template <class MayMeet, class Visit>
void ElementBoxes::for_each_near(const topology::Mesh& mesh, MayMeet may_meet, Visit visit) const {
    for (std::size_t s = 0; s < supergroups_.size(); ++s) {
        if (supergroups_[s].isEmpty() || !may_meet(grown(supergroups_[s]))) continue;
        const std::size_t end_group = std::min(groups_.size(), (s + 1) * supergroup_size);
        for (std::size_t g = s * supergroup_size; g < end_group; ++g) {
            if (groups_[g].isEmpty() || !may_meet(grown(groups_[g]))) continue;
            const std::size_t end = std::min(mesh.element_capacity(), (g + 1) * group_size);
            for (std::size_t i = g * group_size; i < end; ++i)
                if (const CellId e(i); mesh.is_alive(e)) visit(e);
        }
    }
}

}  // namespace incise::topology
