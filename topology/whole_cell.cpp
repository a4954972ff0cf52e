// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/whole_cell.h"

#include <algorithm>

#include "incise/topology/mesh.h"

namespace incise::topology {

CellShape WholeCell::shape(unsigned inside_faces) const {
    CellShape all;
    const CellTraits& t = traits(kind);
    std::array<VertexId, max_face_corners> face;
    const auto corner = [&](int f, int position) {
        return at[static_cast<std::size_t>(t.face(f)[static_cast<std::size_t>(position)])];
    };
    for (int f = 0; f < t.num_faces; ++f) {
        const std::size_t size = t.face(f).size();
        for (std::size_t p = 0; p < size; ++p) face[p] = corner(f, static_cast<int>(p));
        all.add_face(std::span(face).first(size), (inside_faces >> f & 1U) != 0);
    }
    for (int f = 0; f < t.num_faces; ++f)
        if (const int first = diagonals.first_end(f); first >= 0)
            all.divide_face(f, corner(f, first), corner(f, first + 2));
    return all;
}

std::optional<WholeCell> Mesh::whole_cell(CellId e) const {
    WholeCell cell{kind(e), {}, {}};
    if (!is_polyhedron(e)) {
        std::ranges::copy(row(e), cell.at.begin());
        return cell;
    }
    const Polyhedron& of = polyhedron(e);
    cell.kind = of.row_kind;
    cell.diagonals = of.diagonals;
    const auto of_row = row(e);
    if (of_row.empty() || of.corners.size() != of_row.size() || cell.diagonals.is_none())
        return std::nullopt;
    // An edit that opens faces gives the cell copies of nodes, and its row keeps the old ones.
    for (std::size_t k = 0; k < of_row.size(); ++k) {
        const auto it = std::ranges::find_if(
            of.corners, [&](VertexId n) { return rest_position(n) == rest_position(of_row[k]); });
        if (it == of.corners.end()) return std::nullopt;
        cell.at[k] = *it;
    }
    const CellShape shape = cell.shape();
    if (shape.num_faces() != of.shape.num_faces()) return std::nullopt;
    for (int f = 0; f < shape.num_faces(); ++f)
        if (!std::ranges::equal(shape.face(f), of.shape.face(f))) return std::nullopt;
    return cell;
}

}  // namespace incise::topology
