// What a fragment mesh is, whatever its ids: for tests that compare two of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "incise/fragments/fragment_mesh.h"

namespace incise::test {

/// True if a fragment has less or more material than its cell.
inline bool is_divided(const fragments::FragmentMesh& fragments, ElementId e) {
    return !fragments.part_shares(e).empty() || fragments.volume_share(e) != 1.0;
}

/// By cell, the cells of its fragment, and its share; and which corners of fragments are the same
/// node.
struct FragmentShape {
    std::map<std::int64_t, std::pair<std::vector<std::int64_t>, double>> of_cell;
    std::set<std::vector<std::pair<std::int64_t, int>>> nodes;  // by lowest cell, and corner
    bool operator==(const FragmentShape&) const = default;
};

/// @param name  a number for each cell; numbers ascend with ids
inline FragmentShape shape_of(
    const fragments::FragmentMesh& fragments,
    const std::function<std::int64_t(CellId)>& name = [](CellId e) { return e.value; }) {
    FragmentShape shape;
    std::map<NodeId, std::vector<std::pair<std::int64_t, int>>> corners;
    for (const ElementId e : fragments.elements()) {
        std::vector<std::int64_t> cells;
        for (const CellId cell : fragments.cells_of(e)) cells.push_back(name(cell));
        std::sort(cells.begin(), cells.end());
        for (const std::int64_t cell : cells)
            shape.of_cell[cell] = {cells, fragments.volume_share(e)};
        const auto nodes = fragments.corners(e);
        for (std::size_t k = 0; k < nodes.size(); ++k)
            corners[nodes[k]].emplace_back(cells.front(), static_cast<int>(k));
    }
    for (auto& [n, list] : corners) {
        std::sort(list.begin(), list.end());
        shape.nodes.insert(std::move(list));
    }
    return shape;
}

}  // namespace incise::test
