// The operations of MeshEdit that divide cells of any kind.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <utility>

#include "incise/base/error.h"
#include "incise/topology/mesh_edit.h"

namespace incise::topology {

/// Refuses a cell that bisect() has made in this edit: its row has corners, which the record of a
/// new polyhedron does not tell.
void MeshEdit::require_no_new_row(CellId e) const {
    if (!mesh_.is_polyhedron(e)) require_older(e, "given other faces");
}

void MeshEdit::require_dividable(FaceId f) const {
    require_alive(f.cell);
    require_no_new_row(f.cell);
    if (const FaceId other = mesh_.neighbor(f); other.is_valid()) require_no_new_row(other.cell);
}

/// Makes the cell a polyhedron, and returns its shape.
CellShape& MeshEdit::shape_of(CellId e) {
    save(e);
    if (!mesh_.is_polyhedron(e)) mesh_.set_shape(e, CellKind::polyhedron, mesh_.shape(e));
    return mesh_.polyhedra_.at(e).shape;
}

/// Brings the corners of a polyhedron up to date with its shape.
void MeshEdit::update(CellId e) {
    Mesh::Polyhedron& cell = mesh_.polyhedra_.at(e);
    cell.corners.clear();
    cell.shape.append_corners(cell.corners);
    cell.neighbors.resize(static_cast<std::size_t>(cell.shape.num_faces()));
}

VertexId MeshEdit::divide_edge(const Dart& d, double t) {
    require_alive(d.face.cell);
    const VertexId a = from(mesh_, d), b = to(mesh_, d);
    std::vector<CellId> cells;
    append_cells_at_edge(mesh_, d.face.cell, a, b, cells);
    return divide_edge(cells, a, b, t);
}

VertexId MeshEdit::divide_edge(std::span<const CellId> cells, VertexId a, VertexId b, double t) {
    if (!(t > 0.0 && t < 1.0))
        throw InputError("edit: the place " + std::to_string(t) + " is not between 0 and 1");
    for (const CellId e : cells) require_no_new_row(e);
    const VertexId middle = add_node_between(a, b, t);
    mesh_.incident_elements_[middle.index()] = cells.front();
    for (const CellId e : cells) {
        CellShape& shape = shape_of(e);
        for (const auto& [first, second] : {std::pair(a, b), std::pair(b, a)}) {
            const Dart side = find_dart(mesh_, e, first, second);
            shape.insert_corner(side.face.face, side.position + 1, middle);
        }
        update(e);
        touched_.push_back({middle, e});
    }
    return middle;
}

/// Divides one side of a face, and returns its parts.
std::pair<FaceId, FaceId> MeshEdit::divide_side(FaceId f, VertexId a, VertexId b, VertexId middle) {
    CellShape& shape = shape_of(f.cell);
    shape.divide_face(f.face, a, b, middle);
    update(f.cell);
    if (middle.is_valid()) touched_.push_back({middle, f.cell});
    return {f, {f.cell, shape.num_faces() - 1}};
}

FaceId MeshEdit::divide_face_by(FaceId f, VertexId a, VertexId b, VertexId middle) {
    const FaceId other = mesh_.neighbor(f);
    if (other.is_valid()) {
        save(f.cell);
        save(other.cell);
        mesh_.unglue(f);
    }
    const auto [first, second] = divide_side(f, a, b, middle);
    if (!other.is_valid()) return second;
    const auto [first_there, second_there] = divide_side(other, b, a, middle);
    mesh_.glue(first, first_there);
    mesh_.glue(second, second_there);
    return second;
}

FaceId MeshEdit::divide_face(FaceId f, VertexId a, VertexId b) {
    require_dividable(f);
    return divide_face_by(f, a, b, {});
}

VertexId MeshEdit::divide_face_beside(FaceId f, VertexId a, VertexId b, VertexId apex,
                                      double share) {
    require_dividable(f);
    VertexRecord record{VertexId(mesh_.node_capacity()), Vec3::Zero(), {}, 3};
    record.sources[0] = {a, 0.5 * (1.0 - share)};
    record.sources[1] = {b, 0.5 * (1.0 - share)};
    record.sources[2] = {apex, share};
    for (std::size_t k = 0; k < 3; ++k)
        record.rest_position +=
            record.sources[k].weight * mesh_.rest_position(record.sources[k].node);
    const VertexId middle = add_node(record);
    mesh_.incident_elements_[middle.index()] = f.cell;
    divide_face_by(f, a, b, middle);
    return middle;
}

VertexId MeshEdit::divide_face_at_centre(FaceId f) {
    require_dividable(f);
    const int size = mesh_.face_size(f);
    assert(size <= max_corners);
    VertexRecord record{VertexId(mesh_.node_capacity()), Vec3::Zero(), {}, size};
    for (int p = 0; p < size; ++p) {
        const VertexId n = mesh_.face_corner(f, p);
        record.sources[static_cast<std::size_t>(p)] = {n, 1.0 / size};
        record.rest_position += mesh_.rest_position(n);
    }
    record.rest_position /= size;
    const VertexId centre = add_node(record);
    mesh_.incident_elements_[centre.index()] = f.cell;
    const FaceId other = mesh_.neighbor(f);
    if (other.is_valid()) {
        save(f.cell);
        save(other.cell);
        mesh_.unglue(f);
    }
    const auto divide_side_there = [&](FaceId side) {
        shape_of(side.cell).divide_face_by(side.face, centre);
        update(side.cell);
        touched_.push_back({centre, side.cell});
    };
    divide_side_there(f);
    if (!other.is_valid()) return centre;
    divide_side_there(other);
    for (int i = 0; i < size; ++i) {
        const FaceId part{f.cell, i == 0 ? f.face : mesh_.num_faces(f.cell) - size + i};
        const VertexId a = mesh_.face_corner(part, 0), b = mesh_.face_corner(part, 1);
        mesh_.glue(part, find_dart(mesh_, other.cell, b, a).face);
    }
    return centre;
}

CellId MeshEdit::divide_cell(CellId e, std::span<const VertexId> path) {
    require_alive(e);
    require_no_new_row(e);
    CellShape shape = shape_of(e);
    const std::vector<FaceId> neighbors = mesh_.polyhedron(e).neighbors;
    const int count = shape.num_faces();
    struct Side {
        VertexId from, to;
        int face;
        auto operator<=>(const Side&) const = default;
    };
    std::vector<Side> sides;
    for (int f = 0; f < count; ++f) {
        const auto face = shape.face(f);
        for (std::size_t p = 0; p < face.size(); ++p)
            sides.push_back({face[p], face[(p + 1) % face.size()], f});
    }
    std::ranges::sort(sides);
    const auto face_with = [&](VertexId a, VertexId b) {
        const auto it = std::ranges::lower_bound(sides, Side{a, b, -1});
        assert(it != sides.end() && it->from == a && it->to == b);
        return it->face;
    };
    std::vector<std::pair<VertexId, VertexId>> on_path;
    for (std::size_t i = 0; i < path.size(); ++i)
        on_path.emplace_back(path[i], path[(i + 1) % path.size()]);
    std::ranges::sort(on_path);
    const auto is_on_path = [&](VertexId a, VertexId b) {
        return std::ranges::binary_search(on_path, std::pair(a, b)) ||
               std::ranges::binary_search(on_path, std::pair(b, a));
    };
    // The faces to the left of the path, and all that are joined to them across other edges.
    std::vector<std::uint8_t> is_left(static_cast<std::size_t>(count), 0);
    std::vector<int> reached;
    const auto reach = [&](int f) {
        if (std::exchange(is_left[static_cast<std::size_t>(f)], 1) == 0) reached.push_back(f);
    };
    for (const auto& [a, b] : on_path) reach(face_with(a, b));
    // NOLINTNEXTLINE(modernize-loop-convert): the list grows in the loop
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const auto face = shape.face(reached[i]);
        for (std::size_t p = 0; p < face.size(); ++p) {
            const VertexId a = face[p], b = face[(p + 1) % face.size()];
            if (!is_on_path(a, b)) reach(face_with(b, a));
        }
    }
    assert(static_cast<int>(reached.size()) < count);

    const CellId added(mesh_.element_capacity());
    mesh_.append_element_row(CellKind::polyhedron, mesh_.region(e), {});
    parents_.push_back(e);
    Mesh::Polyhedron& right = mesh_.polyhedra_[added];
    Mesh::Polyhedron& left = mesh_.polyhedra_.at(e);
    left.shape = {};
    left.neighbors.clear();
    for (int f = 0; f < count; ++f) {
        const auto i = static_cast<std::size_t>(f);
        const bool stays = is_left[i] != 0;
        Mesh::Polyhedron& part = stays ? left : right;
        const FaceId here{stays ? e : added, part.shape.num_faces()};
        part.shape.add_face(shape.face(f), shape.is_inside(f));
        part.neighbors.push_back(neighbors[i]);
        if (!neighbors[i].is_valid()) continue;
        save(neighbors[i].cell);
        mesh_.set_neighbor(neighbors[i], here);
    }
    left.shape.add_face(std::vector(path.rbegin(), path.rend()), true);
    right.shape.add_face(path, true);
    update(e);
    update(added);
    mesh_.glue({e, left.shape.num_faces() - 1}, {added, right.shape.num_faces() - 1});
    for (const VertexId n : right.corners)
        if (mesh_.corner_of(e, n) < 0) {
            touched_.push_back({n, added});
            if (mesh_.incident_element(n) == e) mesh_.incident_elements_[n.index()] = added;
        }
    return added;
}

}  // namespace incise::topology
