// The division of hexahedra, wedges and pyramids into tetrahedra about virtual centres.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/diagonals.h"

namespace incise::fragments {

using topology::Diagonals;

/// The weights of the corners of a quadrilateral in its centre: one for the corners at the
/// positions 0 and 2, and one for those at 1 and 3.
struct QuadWeights {
    double even = 0.25, odd = 0.25;
};
/// Returns the weights of a face. The centre is the mean of the four corners, or the middle of the
/// diagonal that divides the face.
constexpr QuadWeights quad_weights(Diagonals diagonals, int face) {
    const int first = diagonals.first_end(face);
    return first < 0 ? QuadWeights{} : first == 0 ? QuadWeights{0.5, 0.0} : QuadWeights{0.0, 0.5};
}

/// How a kind of cell is divided. Its centre is the mean of its corners. A face of four corners has
/// a centre, too: see quad_weights(). Each edge of such a face makes a tetrahedron with both
/// centres, and each face of three corners one with the centre of the cell. If a diagonal divides a
/// face of four corners, the tetrahedra on either side of it are one: the motion is linear in each
/// of the two triangles, as in cells that have them as faces.
template <topology::CellKind kind>
struct CentreDivision {
    static constexpr topology::CellTraits traits = topology::traits(kind);
    static constexpr std::size_t num_corners = static_cast<std::size_t>(traits.num_corners);
    static constexpr std::size_t count_quads() {
        std::size_t count = 0;
        for (int f = 0; f < traits.num_faces; ++f) count += traits.face(f).size() == 4 ? 1 : 0;
        return count;
    }
    static constexpr std::size_t num_quads = count_quads();
    static constexpr std::size_t num_points = num_corners + num_quads + 1;  ///< the centre is last
    static constexpr std::size_t num_parts =
        4 * num_quads + static_cast<std::size_t>(traits.num_faces) - num_quads;
    /// By tetrahedron, its points: corners, then centres of faces, then the centre of the cell.
    static constexpr std::array<std::array<std::size_t, 4>, num_parts> parts() {
        std::array<std::array<std::size_t, 4>, num_parts> all{};
        std::size_t part = 0, quad = 0;
        for (int f = 0; f < traits.num_faces; ++f) {
            const auto face = traits.face(f);
            const auto corner = [&](std::size_t p) {
                return static_cast<std::size_t>(face[p % face.size()]);
            };
            if (face.size() == 3) {
                all[part++] = {num_points - 1, corner(0), corner(1), corner(2)};
                continue;
            }
            for (std::size_t p = 0; p < 4; ++p)
                all[part++] = {num_points - 1, corner(p), corner(p + 1), num_corners + quad};
            ++quad;
        }
        return all;
    }

    /// Returns the face of the cell that a tetrahedron has a part of, or all of it.
    static constexpr int face_of_part(std::size_t part) {
        int f = 0;
        for (std::size_t end = 0;; ++f)
            if (part < (end += traits.face(f).size() == 4 ? 4 : 1)) return f;
    }

    /// The tetrahedra that three edges at a corner make: one at a corner of three edges, and four
    /// at the apex of a pyramid.
    static constexpr std::size_t num_corner_parts =
        kind == topology::CellKind::pyramid ? 8 : num_corners;
    /// By such a tetrahedron, the corner and the three at the other ends of the edges. They run
    /// anticlockwise as seen from outside the cell.
    static constexpr std::array<std::array<std::size_t, 4>, num_corner_parts> corner_parts() {
        std::array<std::array<std::size_t, 4>, num_corner_parts> all{};
        std::size_t next = 0;
        for (std::size_t c = 0; c < num_corners; ++c) {
            std::array<std::size_t, 4> around{};
            std::size_t count = 0;
            std::size_t n = next_around(c, num_corners);
            do {
                around[count++] = n;
                n = next_around(c, n);
            } while (n != around[0]);
            for (std::size_t first = 0; first < (count == 3 ? 1 : count); ++first)
                all[next++] = {c, around[first], around[(first + 1) % count],
                               around[(first + 2) % count]};
        }
        return all;
    }

    using Corners = std::array<Vec3, num_corners>;
    using Points = std::array<Vec3, num_points>;
    /// Returns the values at all points of a field that is linear in those at the corners.
    static Points points(const Corners& x, Diagonals diagonals = {});
    /// Returns the sums at the corners of what acts at the points, each with its weight.
    static Corners gathered(const Points& f, Diagonals diagonals = {});
    static std::array<double, num_corners> gathered(const std::array<double, num_points>& f,
                                                    Diagonals diagonals = {});

  private:
    /// Returns the neighbour of corner `c` that follows the neighbour `n`, anticlockwise; the first
    /// one if there is no corner `n`.
    static constexpr std::size_t next_around(std::size_t c, std::size_t n) {
        for (int f = 0; f < traits.num_faces; ++f) {
            const auto face = traits.face(f);
            for (std::size_t p = 0; p < face.size(); ++p) {
                const auto before =
                    static_cast<std::size_t>(face[(p + face.size() - 1) % face.size()]);
                if (static_cast<std::size_t>(face[p]) == c && (before == n || n == num_corners))
                    return static_cast<std::size_t>(face[(p + 1) % face.size()]);
            }
        }
        return num_corners;
    }
};

/// Returns visit(CentreDivision<kind>()).
/// @pre  the kind is hexahedron, wedge or pyramid
template <class Visit>
auto with_division(topology::CellKind kind, Visit visit) {
    using topology::CellKind;
    assert(kind != CellKind::tetrahedron);
    if (kind == CellKind::hexahedron) return visit(CentreDivision<CellKind::hexahedron>());
    if (kind == CellKind::wedge) return visit(CentreDivision<CellKind::wedge>());
    return visit(CentreDivision<CellKind::pyramid>());
}

extern template struct CentreDivision<topology::CellKind::hexahedron>;
extern template struct CentreDivision<topology::CellKind::wedge>;
extern template struct CentreDivision<topology::CellKind::pyramid>;

}  // namespace incise::fragments
