// A mesh as plain arrays, as used by readers, generators and writers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/diagonals.h"

namespace incise::topology {

/// A cell as it was before any cut: its kind, and the rest positions of its corners, m, in the
/// order of cell_kind.h.
class CarrierCorners {
  public:
    CarrierCorners() = default;
    /// @pre  the kind is not polyhedron, and there are as many corners as it has
    CarrierCorners(CellKind kind, std::span<const Vec3> corners) : kind_(kind) {
        for (std::size_t k = 0; k < size(); ++k) corners_[k] = corners[k];
    }

    CellKind kind() const { return kind_; }
    /// Its quadrilaterals that are divided, because they met triangles.
    Diagonals diagonals = {};
    std::size_t size() const { return static_cast<std::size_t>(traits(kind_).num_corners); }
    Vec3* begin() { return corners_.data(); }
    Vec3* end() { return corners_.data() + size(); }
    const Vec3* begin() const { return corners_.data(); }
    const Vec3* end() const { return corners_.data() + size(); }
    Vec3& operator[](std::size_t k) { return corners_[k]; }
    const Vec3& operator[](std::size_t k) const { return corners_[k]; }
    bool operator==(const CarrierCorners& other) const {
        return kind_ == other.kind_ && diagonals == other.diagonals &&
               std::equal(begin(), end(), other.begin());
    }

  private:
    CellKind kind_ = CellKind::tetrahedron;
    std::array<Vec3, max_corners> corners_ = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                              Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                              Vec3::Zero(), Vec3::Zero()};
};

/// The carriers of a body that was cut before: the cells as they were before any cut, of those
/// cells that are only parts of one. See FragmentMesh.
struct Carriers {
    /// The row of a cell that is whole: it is its own carrier.
    static constexpr std::int64_t whole = -1;
    /// By cell, the row of its carrier in `corners`, or `whole`. Empty if all cells are whole.
    std::vector<std::int64_t> of_cell;
    /// By row. Two carriers share a corner if its positions are equal. The same holds for a carrier
    /// and a whole cell.
    std::vector<CarrierCorners> corners;
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

/// What messages call the source of mesh data, and what they tell the user to do there.
struct SourceWords {
    const char* name = "file";
    /// If lists are at fault: of the faces of polyhedra.
    const char* mend_faces = "write the file again";
    /// If the faces of a polyhedron bound no ball.
    const char* mend_polyhedron = "write the file again, or remove the cell";
    const char* mend_carriers =
        "write the file again, or leave out its cell array 'carrier' to take each cell as an "
        "element of its own";
    /// If a polyhedron has no carrier.
    const char* name_carriers =
        "only .vtu files of Incise name it; use such a file, or divide the polyhedra into "
        "tetrahedra in the program that made the file";
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
    /// the number of its corners and its corners, anticlockwise as seen from outside. The corners
    /// of a polyhedron are those of its faces, each once.
    std::vector<std::int64_t> faces;
    Carriers carriers;  ///< empty for a body that was never cut; each polyhedron has one
    /// By cell, bit f for each face f, in the order of cell_kind.h, that is on a cut. Empty if no
    /// face is. See Mesh::is_on_cut(). Two faces with the same corners are joined unless both are
    /// on a cut.
    std::vector<std::int32_t> cut_faces;
    /// The same for the faces of polyhedra that have no bit there: list k begins with the face
    /// (k + 1) * max_cut_faces. Empty if none of these is on a cut.
    std::vector<std::vector<std::int32_t>> further_cut_faces;
    /// For messages: the number of each cell and of each point in the source. Empty where these are
    /// the numbers used here.
    std::vector<std::int64_t> source_cells, source_points;
    SourceWords words = {};  ///< for messages, too
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

    /// Calls visit(number) for the number of each point in `faces`, which it may change.
    template <class Visit>
    void for_each_point_of_faces(Visit visit) {
        for_each_polyhedron([&](std::size_t, std::size_t at) {
            const std::int64_t count = faces[at++];
            for (std::int64_t f = 0; f < count; ++f)
                for (std::int64_t left = faces[at++]; left > 0; --left) visit(faces[at++]);
        });
    }

    /// Appends a cell.
    void add_cell(CellKind kind, std::span<const std::int64_t> cell_corners, int region = 0) {
        kinds.push_back(kind);
        corners.insert(corners.end(), cell_corners.begin(), cell_corners.end());
        offsets.push_back(corners.size());
        regions.push_back(region);
        if (!cut_faces.empty()) cut_faces.push_back(0);
        for (auto& further : further_cut_faces) further.push_back(0);
    }

    /// Appends a polyhedron.
    /// @param cell_faces  as in `faces`, with the number of faces first
    void add_polyhedron(std::span<const std::int64_t> cell_faces, int region = 0) {
        std::vector<std::int64_t> named;
        for (std::size_t at = 1; at < cell_faces.size();
             at += static_cast<std::size_t>(cell_faces[at]) + 1)
            for (const std::int64_t p :
                 cell_faces.subspan(at + 1, static_cast<std::size_t>(cell_faces[at])))
                if (std::ranges::find(named, p) == named.end()) named.push_back(p);
        add_cell(CellKind::polyhedron, named, region);
        faces.insert(faces.end(), cell_faces.begin(), cell_faces.end());
    }

    /// True if face `f` of cell `c` is on a cut.
    bool is_on_cut(std::size_t c, int f) const {
        const auto list = static_cast<std::size_t>(f / max_cut_faces);
        if (list > further_cut_faces.size()) return false;
        const auto& bits = list == 0 ? cut_faces : further_cut_faces[list - 1];
        return !bits.empty() && (bits[c] >> f % max_cut_faces & 1) != 0;
    }
    /// Says whether face `f` of cell `c` is on a cut.
    void set_on_cut(std::size_t c, int f, bool is_on_cut = true) {
        const auto list = static_cast<std::size_t>(f / max_cut_faces);
        if (is_on_cut) {
            cut_faces.resize(num_cells());
            if (list > further_cut_faces.size()) further_cut_faces.resize(list);
            for (auto& further : further_cut_faces) further.resize(num_cells());
        } else if (!this->is_on_cut(c, f)) {
            return;
        }
        std::int32_t& bits = (list == 0 ? cut_faces : further_cut_faces[list - 1])[c];
        const std::int32_t bit = 1 << f % max_cut_faces;
        bits = is_on_cut ? bits | bit : bits & ~bit;
    }

    /// Multiplies all lengths, of points and of carriers.
    void scale(double factor) {
        for (Vec3& x : points) x *= factor;
        for (CarrierCorners& corners_of_carrier : carriers.corners)
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
            name += ", number " + std::to_string(source_cells[c]) + " in the " + words.name;
        return name + ")";
    }

    /// Returns a name for messages, such as "point 3", with its number in the source.
    std::string point_name(std::size_t p) const {
        std::string name = "point " + std::to_string(p);
        if (p >= source_points.size()) return name;
        return name + " (number " + std::to_string(source_points[p]) + " in the " + words.name +
               ")";
    }
};

/// What messages about points that are not joined tell the user to do. The defaults are for
/// programs that use the library.
struct WeldAdvice {
    std::string join = "join them with topology::weld()";
    std::string keep = "set MeshData::points_may_coincide";  ///< if the gap is meant
};

}  // namespace incise::topology
