// The darts of a mesh: the steps from which every walk over its cells is made.
// Source: Damiand, Lienhardt 2014, Combinatorial Maps, chapter 4.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// An edge of a face of a cell, with a direction: from the corner at a position of the face to the
/// one behind it, anticlockwise as seen from outside the cell.
///
/// The rows of a mesh are a combinatorial map, whatever the kinds of its cells: next() is beta 1,
/// opposite() is beta 2, and across() is beta 3.
struct Dart {
    FaceId face;
    int position = 0;
    bool is_valid() const { return face.is_valid(); }
    bool operator==(const Dart&) const = default;
};

/// Returns the corner from which the dart starts.
inline VertexId from(const Mesh& mesh, Dart d) { return mesh.face_corner(d.face, d.position); }
/// Returns the next dart of the face.
inline Dart next(const Mesh& mesh, Dart d) {
    return {d.face, d.position + 1 == mesh.face_size(d.face) ? 0 : d.position + 1};
}
/// Returns the dart of the face before this one.
inline Dart previous(const Mesh& mesh, Dart d) {
    return {d.face, (d.position == 0 ? mesh.face_size(d.face) : d.position) - 1};
}
/// Returns the corner to which the dart goes.
inline VertexId to(const Mesh& mesh, Dart d) { return from(mesh, next(mesh, d)); }
/// Returns the dart of a cell from one corner to another; an invalid one if they have no edge.
/// Cost: proportional to the faces of the cell.
Dart find_dart(const Mesh& mesh, CellId e, VertexId from, VertexId to);
/// Returns the dart of a face from one corner to another; an invalid one if they have no edge.
Dart find_dart(const Mesh& mesh, FaceId f, VertexId from, VertexId to);
/// Returns the dart of the other face of the cell at the edge, which goes the other way.
inline Dart opposite(const Mesh& mesh, Dart d) {
    return find_dart(mesh, d.face.cell, to(mesh, d), from(mesh, d));
}
/// Returns the dart on the other side of the face, which goes the other way; an invalid one on the
/// boundary.
inline Dart across(const Mesh& mesh, Dart d) {
    const FaceId other = mesh.neighbor(d.face);
    return other.is_valid() ? find_dart(mesh, other, to(mesh, d), from(mesh, d)) : Dart{};
}

/// Appends the cells that have an edge between two vertices, in ascending order: those that are
/// connected with cell `e` through faces at `a`.
void append_cells_at_edge(const Mesh& mesh, CellId e, VertexId a, VertexId b,
                          std::vector<CellId>& cells);

}  // namespace incise::topology
