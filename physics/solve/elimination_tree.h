// An order of elimination for which a factor has few entries, by nested dissection.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::physics {

/// A graph without loops: `neighbours` of vertex v are from starts[v] to before starts[v + 1].
struct Graph {
    std::vector<std::size_t> starts;
    std::vector<std::uint32_t> neighbours;

    std::size_t num_vertices() const { return starts.size() - 1; }
    std::span<const std::uint32_t> neighbours_of(std::uint32_t v) const {
        return std::span(neighbours).subspan(starts[v], starts[v + 1] - starts[v]);
    }
};

/// Groups of vertices that are eliminated together. No edge joins two groups unless one is an
/// ancestor of the other.
struct EliminationTree {
    static constexpr std::size_t no_parent = std::numeric_limits<std::size_t>::max();
    struct Group {
        std::size_t begin, end;  ///< places in `order`
        std::size_t parent;      ///< no_parent for the last group
    };
    std::vector<std::uint32_t> order;  ///< vertices
    /// Each one is behind its children. A group may be empty, where a part of the graph is not
    /// joined to the rest.
    std::vector<Group> groups;
};

/// Halves the graph at planes through `points` (by vertex), again and again. The vertices of one
/// half that have neighbours in the other one separate the halves, and are eliminated after them.
/// Source: A. George, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10
/// (1973). Planes suit bodies, and need no search. Cost: O(n log2 n).
EliminationTree dissect(const Graph& graph, std::span<const Vec3> points);

}  // namespace incise::physics
