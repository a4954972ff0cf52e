// Where earlier cuts passed by the nodes that counted as lying on them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// A node that counted as lying on a cut, and where that passed by it.
struct CutRecord {
    Vec3 normal;         ///< of the cut, of unit length
    Vec3 to_surface;     ///< from the node to where the cut passed through an edge, m
    bool is_exact;       ///< the node was made there
    std::uint64_t rank;  ///< of the node on that cut: SnapHistory::take_rank
    SurfaceIdentity surface = no_identity;  ///< of the cut
    Vec3 place = Vec3::Zero();              ///< where the node was then, m
    static void archive(auto& ar, auto& self) {
        ar(self.normal, self.to_surface, self.is_exact, self.rank, self.surface, self.place);
    }
};

/// A node, and where it is, m.
struct PlacedNode {
    NodeId node;
    Vec3 place;
};

/// Nodes that counted as lying on a cut, and where it really was. A cut that passes by at the same
/// place counts them as on itself too: so a cut along an earlier one changes nothing, though that
/// one's nodes are only near it, and no other cut is drawn to them. Positions are the current ones:
/// once the body has moved, nothing is at the same place.
class SnapHistory {
  public:
    void add(NodeId n, const CutRecord& record);
    /// The record that a cut left that passed by the node as `record` says; null if none did.
    /// @param size  of the elements there, m, which rounding is measured by
    const CutRecord* find(NodeId n, const CutRecord& record, double size) const;
    bool has(NodeId n, const CutRecord& record, double size) const {
        return find(n, record, size) != nullptr;
    }
    std::span<const CutRecord> of(NodeId n) const;
    bool is_empty() const { return snap_history_.empty(); }

    /// Nodes of all cuts are numbered in the order in which they come to count as on one.
    std::uint64_t take_rank() { return next_rank_++; }

    /// The element stayed with the other side of the cut of this number (CutFront::number), as
    /// there was too little of it.
    void add_sliver(ElementId e, std::uint64_t cut) {
        auto& first = slivers_.emplace(e, cut).first->second;
        first = std::min(first, cut);
    }
    /// Whether it did so at a cut that began before the one of this number.
    bool is_earlier_sliver(ElementId e, std::uint64_t cut) const {
        const auto place = slivers_.find(e);
        return place != slivers_.end() && place->second < cut;
    }
    bool is_sliver(ElementId e) const { return slivers_.contains(e); }

    /// The middle has been made on the edge between two nodes: a cut that passes by one of them and
    /// goes through the edge beyond the middle, or passes by both, passes by the middle.
    void follow_division(const PlacedNode& a, const PlacedNode& b, const PlacedNode& middle);
    /// Copies of a node, and parts of an element, are what it is.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    static void archive(auto& ar, auto& self) {
        ar(self.snap_history_, self.slivers_, self.next_rank_);
    }

    /// In units of the size of elements: nearer than this is the same place.
    static constexpr double rounding = 1e-6;

  private:
    void inherit(const PlacedNode& from, const PlacedNode& to, const PlacedNode& middle);

    std::unordered_map<NodeId, std::vector<CutRecord>> snap_history_;
    std::unordered_map<ElementId, std::uint64_t> slivers_;
    std::uint64_t next_rank_ = 1;
};

}  // namespace incise::cutting
