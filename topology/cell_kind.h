// The local numbering of corners, edges and faces, which is defined only here.
// Corners are in VTK's order; faces are listed so that their corners run anticlockwise as seen
// from outside the cell.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace incise::topology {

/// The kind of a cell. A polyhedron is a cell that a cut has divided, or one beside it: its corners
/// and faces are its own, see CellShape. All others have those of their kind.
enum class CellKind : std::uint8_t { tetrahedron, hexahedron, wedge, pyramid, polyhedron };

/// The number of kinds with a numbering of their own: all but polyhedron.
inline constexpr int num_cell_kinds = 4;
inline constexpr int max_corners = 8;
inline constexpr int max_faces = 6;
inline constexpr int max_face_corners = 4;

/// Local numbering of one kind of cell.
struct CellTraits {
    const char* name;
    const char* plural;
    int num_corners;
    int num_edges;
    int num_faces;
    std::array<std::array<int, 2>, 12> edges;
    std::array<int, max_faces> face_sizes;
    std::array<std::array<int, max_face_corners>, max_faces> faces;
    /// If the order of corners is reversed so that the volume changes its sign, corner i of the new
    /// cell is corner mirrored[i] of the old one. Faces keep their corners, but may get other
    /// numbers.
    std::array<int, max_corners> mirrored;

    /// Returns the corners of face `f`, anticlockwise as seen from outside.
    constexpr std::span<const int> face(int f) const {
        const auto i = static_cast<std::size_t>(f);
        return {faces[i].data(), static_cast<std::size_t>(face_sizes[i])};
    }
    /// Returns the number of corners of all faces together.
    constexpr int num_face_corners() const {
        int sum = 0;
        for (int f = 0; f < num_faces; ++f) sum += face_sizes[static_cast<std::size_t>(f)];
        return sum;
    }
};

inline constexpr std::array<CellTraits, num_cell_kinds + 1> cell_traits = {{
    {"tetrahedron",
     "tetrahedra",
     4,
     6,
     4,
     {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}, {3, 1}}},
     {3, 3, 3, 3},
     {{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}},
     {0, 2, 1, 3}},
    {"hexahedron",
     "hexahedra",
     8,
     12,
     6,
     {{{0, 1},
       {1, 2},
       {3, 2},
       {0, 3},
       {4, 5},
       {5, 6},
       {7, 6},
       {4, 7},
       {0, 4},
       {1, 5},
       {2, 6},
       {3, 7}}},
     {4, 4, 4, 4, 4, 4},
     {{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}},
     {0, 3, 2, 1, 4, 7, 6, 5}},
    {"wedge",
     "wedges",
     6,
     9,
     5,
     {{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
     {3, 3, 4, 4, 4},
     {{{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}},
     {0, 2, 1, 3, 5, 4}},
    {"pyramid",
     "pyramids",
     5,
     8,
     5,
     {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
     {4, 3, 3, 3, 3},
     {{{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}},
     {0, 3, 2, 1, 4}},
    {"polyhedron", "polyhedra", 0, 0, 0, {}, {}, {}, {}},
}};

constexpr const CellTraits& traits(CellKind kind) {
    return cell_traits[static_cast<std::size_t>(kind)];
}

}  // namespace incise::topology
