// The faces of the cells of mesh data, of any kind.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// The faces of all cells. Those of polyhedra are found in MeshData::faces at once.
class SourceFaces {
  public:
    /// @lifetime  the data, which must not change
    /// @pre  the lists of `data` are sound: see check(). Cost: O(#faces of polyhedra), and a number
    ///       a cell if there are any.
    explicit SourceFaces(const MeshData& data);

    int num_faces(std::size_t c) const {
        return is_polyhedron(c) ? static_cast<int>(data_.faces[places_[first_[c]] - 1])
                                : traits(data_.kinds[c]).num_faces;
    }
    /// Returns the number of corners of a face.
    int size(SourceFace f) const {
        return is_polyhedron(f.cell)
                   ? static_cast<int>(data_.faces[place(f)])
                   : traits(data_.kinds[f.cell]).face_sizes[static_cast<std::size_t>(f.face)];
    }
    /// Returns the point at a position in a face, from 0 to before its size.
    std::int64_t point(SourceFace f, int position) const {
        const auto at = static_cast<std::size_t>(position);
        if (is_polyhedron(f.cell)) return data_.faces[place(f) + 1 + at];
        const CellTraits& cell = traits(data_.kinds[f.cell]);
        return data_.cell(
            f.cell)[static_cast<std::size_t>(cell.faces[static_cast<std::size_t>(f.face)][at])];
    }
    const Vec3& position(SourceFace f, int position) const {
        return data_.points[static_cast<std::size_t>(point(f, position))];
    }
    /// Returns the points of a face, in their order.
    std::vector<std::int64_t> points(SourceFace f) const;
    /// Returns the volume of a cell, m3: signed_volume(), or volume_of() of a polyhedron.
    double volume(std::size_t c) const;

  private:
    bool is_polyhedron(std::size_t c) const { return data_.kinds[c] == CellKind::polyhedron; }
    std::size_t place(SourceFace f) const {
        return places_[first_[f.cell] + static_cast<std::size_t>(f.face)];
    }

    const MeshData& data_;
    // By cell, where its faces begin in `places_`; empty if there are no polyhedra.
    std::vector<std::size_t> first_;
    // By face of a polyhedron, where it begins in MeshData::faces. The first face of a cell follows
    // the number of its faces.
    std::vector<std::size_t> places_;
};

}  // namespace incise::topology
