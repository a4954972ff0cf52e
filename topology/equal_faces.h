// Faces of a source with the same points, and which of them are joined.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/topology/mesh_data.h"
#include "incise/topology/source_faces.h"

namespace incise::topology {

/// A face with its points in descending order, for the search of equal faces. Of a face with more
/// corners the fourth number stands for all points but the highest three: see sorted_faces().
struct FaceKey {
    std::array<std::int64_t, 4> points{-1, -1, -1, -1};
    SourceFace face;
    auto operator<=>(const FaceKey&) const = default;
};

/// Returns all faces of usable cells, sorted so that faces with the same points follow each other.
/// Faces with the same points are in the order of their cells.
/// @param usable  by cell, 0 for one that is left out; empty if all are usable
/// Cost: O(n).
std::vector<FaceKey> sorted_faces(const MeshData& data, const SourceFaces& faces,
                                  std::span<const std::uint8_t> usable);

/// The faces with one set of points.
struct EqualFaces {
    std::span<const FaceKey> inner;   ///< those on no cut, in the order of their cells
    std::span<const FaceKey> on_cut;  ///< the others. They stay open, also at the front of a cut,
                                      ///< where both sides have the same points.

    /// True for a face that is joined to none of the same points, and can be to other ones.
    bool is_lone() const { return inner.size() == 1 && on_cut.empty(); }
    /// Returns how many of them meet: two are joined, and more are an error of the source.
    std::size_t num_meeting() const {
        return inner.size() == 1 && on_cut.size() == 1 ? 2 : inner.size();
    }
    /// Returns the two that are joined, in ascending order.
    /// @pre  num_meeting() is 2
    std::array<SourceFace, 2> joined() const {
        const SourceFace a = inner[0].face, b = inner.size() == 1 ? on_cut[0].face : inner[1].face;
        return {std::min(a, b), std::max(a, b)};
    }
};

/// Calls visit(equal_faces) for each set of points.
/// @param faces  the result of sorted_faces(), of which the order changes
template <class Visit>
void for_each_equal_faces(const MeshData& data, std::span<FaceKey> faces, Visit visit) {
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].points == faces[i].points) ++end;
        const auto same = faces.subspan(i, end - i);
        const auto on_cut = std::ranges::stable_partition(same, [&](const FaceKey& key) {
            return !data.is_on_cut(key.face.cell, key.face.face);
        });
        visit(EqualFaces{same.first(same.size() - on_cut.size()), {on_cut.begin(), on_cut.end()}});
        i = end;
    }
}

}  // namespace incise::topology
