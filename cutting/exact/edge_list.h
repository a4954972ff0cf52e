// Edges of the mesh, and lists of the edges of several elements.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "incise/base/types.h"

namespace incise::cutting {

/// An edge of the mesh, with the lower node id first.
struct Edge {
    VertexId a, b;
    std::uint64_t key() const { return (static_cast<std::uint64_t>(a.index()) << 32) | b.index(); }
    bool operator==(const Edge& other) const { return key() == other.key(); }
    auto operator<=>(const Edge& other) const { return key() <=> other.key(); }
    static void archive(auto& ar, auto& self) { ar(self.a, self.b); }
};

inline Edge edge_between(VertexId a, VertexId b) { return a < b ? Edge{a, b} : Edge{b, a}; }

struct EdgeHash {
    std::size_t operator()(const Edge& e) const {
        return static_cast<std::size_t>((e.key() * 0x9E3779B97F4A7C15u) >> 20);
    }
};

/// A list that numbers the edges of elements, each edge once. The table has room for at least twice
/// as many edges; an edge is at the first free place from that of its hash on. As an edge belongs
/// to about five elements, this is faster than sorting the edges of all elements.
class EdgeList {
  public:
    struct Entry {
        Edge edge;
        CellId element;  ///< the first that came with the edge
        bool operator<(const Entry& other) const { return edge < other.edge; }
    };

    /// Returns the number of an edge, from 0. Adds the edge if it is new.
    std::size_t add(const Edge& edge, CellId element) {
        if (2 * entries_.size() >= table_.size()) grow();
        std::uint32_t& place = table_[place_of(edge)];
        if (place == none) {
            place = static_cast<std::uint32_t>(entries_.size());
            entries_.push_back({edge, element});
        }
        return place;
    }
    const std::vector<Entry>& entries() const { return entries_; }

  private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// Returns the place of an edge in the table, or the free place for it.
    std::size_t place_of(const Edge& edge) const {
        std::size_t i = EdgeHash()(edge) & (table_.size() - 1);
        while (table_[i] != none && entries_[table_[i]].edge != edge)
            i = (i + 1) & (table_.size() - 1);
        return i;
    }
    void grow() {
        table_.assign(std::max<std::size_t>(64, 2 * table_.size()), none);
        for (std::size_t i = 0; i < entries_.size(); ++i)
            table_[place_of(entries_[i].edge)] = static_cast<std::uint32_t>(i);
    }

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> table_;  // a power of two in size
};

}  // namespace incise::cutting
