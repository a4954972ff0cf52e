// The snap history: where earlier cuts passed by the nodes that counted as on them.
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

/// A record of a node that counted as on a cut, and of where the cut passed by it.
struct CutRecord {
    Vec3 normal;         ///< of the cut surface, of unit length
    Vec3 to_surface;     ///< from the node to where the cut passed through an edge, m
    bool is_exact;       ///< true if the node was made on the cut surface
    std::uint64_t rank;  ///< of the node on that cut: SnapHistory::take_rank
    SurfaceIdentity surface = no_identity;  ///< of the cut
    Vec3 place = Vec3::Zero();              ///< position of the node at that time, m
    /// Returns where the cut passed by the node, m.
    Vec3 passage() const { return place + to_surface; }
    static void archive(auto& ar, auto& self) {
        ar(self.normal, self.to_surface, self.is_exact, self.rank, self.surface, self.place);
    }
};

/// A node and its position, m.
struct PlacedNode {
    VertexId node;
    Vec3 place;
};

/// Holds the records of nodes that counted as on cuts. A cut that passes by such a node at the same
/// place counts the node as on itself, too. So a cut along an earlier one changes nothing, although
/// the nodes of the earlier one are only near it. Other cuts are not drawn to these nodes.
///
/// Records are in the current frame of the time of the cut. A surface with an identity is known by
/// the place where it passed in space, however the tissue has deformed since. Those of blades fit
/// no more once the tissue has deformed or turned.
class SnapHistory {
  public:
    void add(VertexId n, const CutRecord& record);
    /// Returns the record of a node whose normal and distance are those of `record`, or null.
    /// @param n       the node
    /// @param record  where the present cut passes by the node
    /// @param size    of the elements there, m, by which rounding is measured
    /// @lifetime  the pointer is valid until records of the node change
    const CutRecord* find(VertexId n, const CutRecord& record, double size) const;
    bool has(VertexId n, const CutRecord& record, double size) const {
        return find(n, record, size) != nullptr;
    }
    /// Returns all records of a node.
    std::span<const CutRecord> of(VertexId n) const;
    bool is_empty() const { return snap_history_.empty(); }

    /// Returns the next number. Nodes of all cuts are numbered in the order in which they come to a
    /// cut, and cuts have numbers of the same sequence.
    std::uint64_t take_rank() { return next_rank_++; }

    /// Gives `middle`, a new node on the edge from `a` to `b`, its records. A cut passes by the
    /// middle if it passes by one end and through the edge beyond the middle, or if it passes by
    /// both ends.
    /// @param rest_length  of the edge, m
    void follow_division(const PlacedNode& a, const PlacedNode& b, const PlacedNode& middle,
                         double rest_length);
    /// Returns the size at rest of the elements at a node before any cut, m: the longest of their
    /// edges that cuts have divided. It does not shrink as cuts divide the elements further. It is
    /// 0 if no edge there was divided.
    double uncut_size(VertexId n) const {
        const auto it = uncut_sizes_.find(n);
        return it == uncut_sizes_.end() ? 0.0 : it->second;
    }
    /// Cost: proportional to the number of nodes at divided edges.
    double largest_uncut_size() const;
    /// Follows an edit. Copies of a node have its records.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    static void archive(auto& ar, auto& self) {
        ar(self.snap_history_, self.uncut_sizes_, self.next_rank_);
    }

    /// Positions nearer to each other than this share of the size of elements count as the same.
    static constexpr double rounding = 1e-6;

  private:
    void inherit_planes(const PlacedNode& a, const PlacedNode& b, const PlacedNode& middle);
    void inherit(const PlacedNode& from, const PlacedNode& to, const PlacedNode& middle);

    std::unordered_map<VertexId, std::vector<CutRecord>> snap_history_;
    std::unordered_map<VertexId, double> uncut_sizes_;  // m
    std::uint64_t next_rank_ = 1;
};

}  // namespace incise::cutting
