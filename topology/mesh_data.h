// A mesh as plain arrays, as used by readers, generators and writers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// The carriers of a body that was cut before: the tetrahedra as they were before any cut, of those
/// cells that are only parts of one. See FragmentMesh.
struct Carriers {
    /// The row of a cell that is whole: it is its own carrier.
    static constexpr std::int64_t whole = -1;
    /// By cell, the row of its carrier in `corners`, or `whole`. Empty if all cells are whole.
    std::vector<std::int64_t> of_cell;
    /// By row, the rest positions of the four corners, m, in the order of cell_kind.h. Two carriers
    /// share a corner if its positions are equal. The same holds for a carrier and a whole cell.
    std::vector<std::array<Vec3, 4>> corners;
    bool is_empty() const { return of_cell.empty(); }
    bool operator==(const Carriers&) const = default;
};

/// The number of faces that have a bit in MeshData::cut_faces.
inline constexpr int max_cut_faces = 31;

/// A face of a cell of the source.
struct SourceFace {
    std::size_t cell = 0;
    int face = 0;
    auto operator<=>(const SourceFace&) const = default;
};

/// Cells over points, numbered from 0 in the order of the source. The contents may be invalid:
/// Mesh::build checks them.
struct MeshData {
    std::vector<Vec3> points;     ///< rest positions
    std::vector<CellKind> kinds;  ///< one a cell
    std::vector<std::size_t> offsets{
        0};  ///< number of cells + 1; cell c has corners [offsets[c], offsets[c+1])
    std::vector<std::int64_t> corners;  ///< point numbers, VTK order within a cell
    std::vector<int> regions;           ///< one a cell
    /// The faces of polyhedra, one cell after the other: the number of faces, then for each face
    /// the number of its corners and its corners, anticlockwise as seen from outside. Mesh::build()
    /// takes no polyhedra.
    std::vector<std::int64_t> faces;
    Carriers carriers;  ///< empty for a body that was never cut
    /// By cell, bit f for each face f, in the order of cell_kind.h, that is on a cut. Empty if no
    /// face is. See Mesh::is_on_cut(). Of a polyhedron, the first max_cut_faces have a bit.
    std::vector<std::int32_t> cut_faces;
    /// For messages: the number of each cell and of each point in the source. Empty where these are
    /// the numbers used here.
    std::vector<std::int64_t> source_cells, source_points;
    /// By point, the point that replaced it in weld(): itself, or one with a lower number. Empty if
    /// no point was welded to another.
    std::vector<std::int64_t> welded_to;
    /// True if points at one position are meant to be separate, such as those on two cut faces.
    bool points_may_coincide = false;

    std::size_t num_cells() const { return kinds.size(); }

    /// Returns the corners of cell `c`.
    std::span<const std::int64_t> cell(std::size_t c) const {
        return std::span(corners).subspan(offsets[c], offsets[c + 1] - offsets[c]);
    }

    /// Returns the point at a position in a face, in the order of cell_kind.h.
    std::int64_t face_point(SourceFace f, int position) const {
        const auto face = traits(kinds[f.cell]).face(f.face);
        return cell(f.cell)[static_cast<std::size_t>(face[static_cast<std::size_t>(position)])];
    }

    /// Calls visit(cell, first) for each polyhedron, with the place of its number of faces in
    /// `faces`.
    template <class Visit>
    void for_each_polyhedron(Visit visit) const {
        std::size_t at = 0;
        for (std::size_t c = 0; c < num_cells(); ++c) {
            if (kinds[c] != CellKind::polyhedron) continue;
            visit(c, at);
            const std::int64_t count = faces[at++];
            for (std::int64_t f = 0; f < count; ++f) at += static_cast<std::size_t>(faces[at]) + 1;
        }
    }

    /// Appends a cell.
    void add_cell(CellKind kind, std::span<const std::int64_t> cell_corners, int region = 0) {
        kinds.push_back(kind);
        corners.insert(corners.end(), cell_corners.begin(), cell_corners.end());
        offsets.push_back(corners.size());
        regions.push_back(region);
        if (!cut_faces.empty()) cut_faces.push_back(0);
    }

    /// Multiplies all lengths, of points and of carriers.
    void scale(double factor) {
        for (Vec3& x : points) x *= factor;
        for (std::array<Vec3, 4>& corners_of_carrier : carriers.corners)
            for (Vec3& x : corners_of_carrier) x *= factor;
    }

    /// True if point `p` was welded to another one.
    bool is_welded(std::size_t p) const {
        return !welded_to.empty() && welded_to[p] != static_cast<std::int64_t>(p);
    }

    /// Returns a name for messages, such as "cell 3 (tetrahedron)", with its number in the source.
    std::string cell_name(std::size_t c) const {
        std::string name = "cell " + std::to_string(c) + " (" + traits(kinds[c]).name;
        if (c < source_cells.size())
            name += ", number " + std::to_string(source_cells[c]) + " in the file";
        return name + ")";
    }

    /// Returns a name for messages, such as "point 3", with its number in the source.
    std::string point_name(std::size_t p) const {
        std::string name = "point " + std::to_string(p);
        if (p >= source_points.size()) return name;
        return name + " (number " + std::to_string(source_points[p]) + " in the file)";
    }
};

/// What messages about points that are not joined tell the user to do. The defaults are for
/// programs that use the library.
struct WeldAdvice {
    std::string join = "join them with topology::weld()";
    std::string keep = "set MeshData::points_may_coincide";  ///< if the gap is meant
};

}  // namespace incise::topology
