// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cell_advice.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "incise/topology/corner_check.h"
#include "incise/topology/flat_cell.h"
#include "incise/topology/geometry.h"

namespace incise::topology {

namespace {

/// Returns the orders of corners that other programs use, without those that CellTraits::mirrored
/// makes of them.
std::vector<CornerOrder> usual_orders(CellKind kind) {
    switch (kind) {
        case CellKind::tetrahedron:
            return {{0, 1, 2, 3}};
        case CellKind::hexahedron:
            return {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 3, 2, 4, 5, 7, 6},  // of a voxel: by rows
                    {0, 1, 2, 3, 4, 7, 6, 5},                            // one face backwards
                    {0, 1, 2, 3, 7, 6, 5, 4}, {0, 1, 2, 3, 6, 5, 4, 7}, {0, 1, 2, 3, 5, 4, 7, 6}};
        case CellKind::wedge:
            return {{0, 1, 2, 3, 4, 5},
                    {0, 1, 2, 3, 5, 4},  // one face backwards
                    {0, 1, 2, 5, 4, 3},
                    {0, 1, 2, 4, 3, 5}};
        case CellKind::pyramid:
            return {{0, 1, 2, 3, 4}, {0, 1, 3, 2, 4}};  // the base by rows
        case CellKind::polyhedron:
            break;
    }
    return {};
}

/// Returns the volume of a cell, or 0 if the cell is not sound.
double sound_volume(CellKind kind, std::span<const Vec3> corners) {
    const double volume = signed_volume(kind, corners);
    const bool is_sound = volume > 0.0 && !is_flat_to_rounding(kind, corners, volume) &&
                          (kind == CellKind::tetrahedron || !first_inverted_corner(kind, corners));
    return is_sound ? volume : 0.0;
}

/// A face as it runs from its lowest point on.
using Ring = std::vector<std::int64_t>;

Ring from_lowest(Ring ring) {
    std::ranges::rotate(ring, std::ranges::min_element(ring));
    return ring;
}

/// Returns the faces of a cell that have an area, each from its lowest point on. Two faces that
/// have become one, seen from both sides, are left out. Returns nothing if a face touches itself.
std::optional<std::vector<Ring>> faces_with_area(CellKind kind,
                                                 std::span<const std::int64_t> corners) {
    std::vector<Ring> faces;
    const CellTraits& t = traits(kind);
    for (int f = 0; f < t.num_faces; ++f) {
        Ring ring;
        for (const int k : t.face(f)) {
            const std::int64_t point = corners[static_cast<std::size_t>(k)];
            if (ring.empty() || ring.back() != point) ring.push_back(point);
        }
        while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
        if (ring.size() < 3) continue;
        Ring sorted = ring;
        std::ranges::sort(sorted);
        if (std::ranges::adjacent_find(sorted) != sorted.end()) return std::nullopt;
        const Ring backwards = from_lowest({ring.rbegin(), ring.rend()});
        if (const auto it = std::ranges::find(faces, backwards); it != faces.end())
            faces.erase(it);
        else
            faces.push_back(from_lowest(ring));
    }
    return faces;
}

}  // namespace

// A hexahedron or wedge with one of its faces turned by a corner is twisted, but no corner of it is
// turned inside out. It has a smaller volume than the one that is meant.
std::optional<CornerOrder> sound_order(CellKind kind, std::span<const Vec3> corners) {
    constexpr double rounding = 1e-9;  // of equal volumes, of which the first order is taken
    const auto num_corners = corners.size();
    std::array<Vec3, max_corners> x;
    std::optional<CornerOrder> best;
    double largest = 0.0;
    for (const CornerOrder& usual : usual_orders(kind))
        for (const bool is_mirrored : {true, false}) {
            CornerOrder order = usual;
            if (is_mirrored)
                for (std::size_t k = 0; k < num_corners; ++k)
                    order[k] = usual[static_cast<std::size_t>(traits(kind).mirrored[k])];
            for (std::size_t k = 0; k < num_corners; ++k)
                x[k] = corners[static_cast<std::size_t>(order[k])];
            const double volume = sound_volume(kind, {x.data(), num_corners});
            if (!(volume > (1.0 + rounding) * largest)) continue;
            largest = volume;
            best = order;
        }
    return best;
}

// No kind has more than 6! orders of the corners of a smaller one, so all of them are tried.
std::optional<CellByCorners> collapsed_cell(CellKind kind, std::span<const std::int64_t> corners) {
    std::vector<std::int64_t> points;  // each once
    for (const std::int64_t p : corners)
        if (std::ranges::find(points, p) == points.end()) points.push_back(p);
    auto faces = faces_with_area(kind, corners);
    if (!faces || points.size() == corners.size()) return std::nullopt;
    std::ranges::sort(*faces);
    for (const CellKind other : {CellKind::wedge, CellKind::pyramid, CellKind::tetrahedron}) {
        const CellTraits& t = traits(other);
        if (static_cast<std::size_t>(t.num_corners) != points.size() ||
            static_cast<std::size_t>(t.num_faces) != faces->size())
            continue;
        std::vector<std::size_t> order(points.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        do {
            CellByCorners cell{other, {}};
            for (const std::size_t k : order) cell.corners.push_back(points[k]);
            auto found = faces_with_area(other, cell.corners);
            std::ranges::sort(*found);
            if (*found == *faces) return cell;
        } while (std::ranges::next_permutation(order).found);
    }
    return std::nullopt;
}

}  // namespace incise::topology
