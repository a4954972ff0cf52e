// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "incise/base/disjoint_set.h"
#include "incise/topology/geometry.h"

namespace incise::topology {

namespace {

/// By corner, a bit for each face that contains the corner.
using CornerFaces = std::array<std::uint8_t, max_corners>;

constexpr CornerFaces corner_faces(const CellTraits& t) {
    CornerFaces faces{};
    for (int f = 0; f < t.num_faces; ++f)
        for (const int corner : t.face(f))
            faces[static_cast<std::size_t>(corner)] |= static_cast<std::uint8_t>(1 << f);
    return faces;
}

constexpr std::array<CornerFaces, num_cell_kinds> faces_of_corner = {
    corner_faces(cell_traits[0]), corner_faces(cell_traits[1]), corner_faces(cell_traits[2]),
    corner_faces(cell_traits[3])};

/// Calls visit(face) for each face of `e` that has the node `n` among its corners.
template <class Visit>
void for_faces_at(const Mesh& mesh, CellId e, VertexId n, Visit visit) {
    const int corner = mesh.corner_of(e, n);
    if (corner < 0) return;
    if (mesh.is_polyhedron(e)) {
        for (int f = 0; f < mesh.num_faces(e); ++f)
            for (int p = 0; p < mesh.face_size({e, f}); ++p)
                if (mesh.face_corner({e, f}, p) == n) visit(FaceId{e, f});
        return;
    }
    unsigned faces =
        faces_of_corner[static_cast<std::size_t>(mesh.kind(e))][static_cast<std::size_t>(corner)];
    for (; faces != 0; faces &= faces - 1) visit(FaceId{e, std::countr_zero(faces)});
}

/// True if `e` is among the elements from `begin` on. The lists are short. A search of the whole
/// list without an early exit is faster than marking elements, and several threads may do it.
bool is_known(const std::vector<CellId>& elements, std::size_t begin, CellId e) {
    int count = 0;
    for (std::size_t i = begin; i < elements.size(); ++i) count += elements[i] == e ? 1 : 0;
    return count != 0;
}

}  // namespace

void collect_star(const Mesh& mesh, VertexId n, CellId start, std::vector<CellId>& elements) {
    const std::size_t begin = elements.size();
    // One bit for each remainder of ids: a bit that is not set shows that an element is not known.
    const auto bit = [](CellId e) { return std::uint64_t{1} << (e.index() % 64); };
    std::uint64_t known_bits = bit(start);
    elements.push_back(start);
    for (std::size_t next = begin; next < elements.size(); ++next)
        for_faces_at(mesh, elements[next], n, [&](FaceId f) {
            const CellId other = mesh.neighbor(f).cell;
            if (!other.is_valid()) return;
            if ((known_bits & bit(other)) != 0 && is_known(elements, begin, other)) return;
            known_bits |= bit(other);
            elements.push_back(other);
        });
    std::sort(elements.begin() + static_cast<std::ptrdiff_t>(begin), elements.end());
}

void Mesh::star(VertexId n, std::vector<CellId>& elements) const {
    elements.clear();
    if (is_alive(n)) collect_star(*this, n, incident_element(n), elements);
}

int Mesh::corner_of(CellId e, VertexId n) const {
    const auto nodes = corners(e);
    const auto it = std::find(nodes.begin(), nodes.end(), n);
    return it == nodes.end() ? -1 : static_cast<int>(it - nodes.begin());
}

CellShape Mesh::shape(CellId e) const {
    return is_polyhedron(e) ? polyhedron(e).shape : shape_of_row(e, kind(e));
}

CellShape Mesh::shape_of_row(CellId e, CellKind kind) const {
    WholeCell cell{kind, {}, {}};
    std::ranges::copy(row(e), cell.at.begin());
    return cell.shape(inside_faces_[e.index()]);
}

double Mesh::rest_volume_of_polyhedron(CellId e) const {
    return volume_of(polyhedron(e).shape, rest_positions_);
}

void Mesh::set_shape(CellId e, CellKind kind, CellShape shape) {
    const auto row_of = [&](CellKind of) {  // the neighbours in it
        return std::span(neighbors_)
            .subspan(face_begin_[e.index()], static_cast<std::size_t>(traits(of).num_faces));
    };
    if (kind == CellKind::polyhedron) {
        Polyhedron& to = polyhedra_[e];
        if (!is_polyhedron(e)) {
            const auto from = row_of(kinds_[e.index()]);
            to.neighbors.assign(from.begin(), from.end());
            std::ranges::fill(from, FaceId{});
            to.row_kind = kinds_[e.index()];
        }
        to.neighbors.resize(static_cast<std::size_t>(shape.num_faces()));
        to.corners.clear();
        shape.append_corners(to.corners);
        to.shape = std::move(shape);
    } else if (is_polyhedron(e)) {
        const auto& from = polyhedra_.at(e).neighbors;
        const auto to = row_of(kind);
        for (std::size_t f = 0; f < to.size(); ++f) to[f] = f < from.size() ? from[f] : FaceId{};
        polyhedra_.erase(e);
    }
    kinds_[e.index()] = kind;
}

std::int64_t Mesh::label(VertexId n) const {
    return n.index() < node_labels_.size() ? node_labels_[n.index()] : n.value;
}

std::int64_t Mesh::label(CellId e) const {
    return e.index() < element_labels_.size() ? element_labels_[e.index()] : e.value;
}

std::vector<VertexId> Mesh::nodes_with_label(std::int64_t label) const {
    std::vector<VertexId> nodes;
    if (label < 0) return nodes;
    if (static_cast<std::size_t>(label) >= label_nodes_.size()) {
        if (static_cast<std::size_t>(label) < node_capacity())
            nodes.emplace_back(static_cast<std::size_t>(label));
        return nodes;
    }
    nodes.push_back(label_nodes_[static_cast<std::size_t>(label)]);
    // A lower label if the point was welded to another one.
    const std::int64_t own_label = node_labels_[nodes.front().index()];
    for (const auto& [of, node] : pinched_)
        if (of == own_label) nodes.push_back(node);
    return nodes;
}

void Mesh::append_element_row(CellKind kind, int region, std::span<const VertexId> corners) {
    kinds_.push_back(kind);
    regions_.push_back(region);
    alive_.push_back(1);
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    corner_begin_.push_back(static_cast<std::uint32_t>(corners_.size()));
    neighbors_.resize(neighbors_.size() + static_cast<std::size_t>(traits(kind).num_faces));
    face_begin_.push_back(static_cast<std::uint32_t>(neighbors_.size()));
    inside_faces_.push_back(0);
    ++num_elements_;
}

void Mesh::truncate(std::size_t node_capacity, std::size_t element_capacity) {
    for (std::size_t e = element_capacity; e < kinds_.size(); ++e) polyhedra_.erase(CellId(e));
    rest_positions_.resize(node_capacity);
    incident_elements_.resize(node_capacity);
    kinds_.resize(element_capacity);
    regions_.resize(element_capacity);
    alive_.resize(element_capacity);
    corner_begin_.resize(element_capacity + 1);
    face_begin_.resize(element_capacity + 1);
    corners_.resize(corner_begin_.back());
    neighbors_.resize(face_begin_.back());
    inside_faces_.resize(element_capacity);
}

void Mesh::glue(FaceId a, FaceId b) {
    assert(!neighbor(a).is_valid() && !neighbor(b).is_valid());
    set_neighbor(a, b);
    set_neighbor(b, a);
    set_inside(a);
    set_inside(b);
}

void Mesh::set_inside(FaceId f) {
    if (is_polyhedron(f.cell))
        polyhedra_.at(f.cell).shape.set_inside(f.face, true);
    else
        inside_faces_[f.cell.index()] |= static_cast<std::uint8_t>(1 << f.face);
}

void Mesh::unglue(FaceId a) {
    const FaceId b = neighbor(a);
    assert(b.is_valid());
    set_neighbor(a, {});
    set_neighbor(b, {});
}

int matching_shift(const Mesh& mesh, FaceId a, FaceId b) {
    const int size = mesh.face_size(a);
    if (mesh.face_size(b) != size) return -1;
    for (int shift = 0; shift < size; ++shift) {
        bool fits = true;
        for (int p = 0; p < size && fits; ++p)
            fits = mesh.face_corner(a, p) == mesh.face_corner(b, (shift - p + size) % size);
        if (fits) return shift;
    }
    return -1;
}

double rest_area(const Mesh& mesh, FaceId f) {
    const auto at = [&](int p) -> const Vec3& {
        return mesh.rest_position(mesh.face_corner(f, p));
    };
    if (mesh.face_size(f) == 3) return 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    if (mesh.face_size(f) == 4) return 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).norm();
    Vec3 sum = Vec3::Zero();
    for (int p = 2; p < mesh.face_size(f); ++p) sum += (at(p - 1) - at(0)).cross(at(p) - at(0));
    return 0.5 * sum.norm();
}

// The loop runs in ascending order of ids, in which neighbours are near each other in memory.
double rest_volume(const Mesh& mesh, CellId e) {
    if (mesh.is_polyhedron(e)) return mesh.rest_volume_of_polyhedron(e);
    std::array<Vec3, max_corners> x;
    const auto corners = mesh.corners(e);
    for (std::size_t k = 0; k < corners.size(); ++k) x[k] = mesh.rest_position(corners[k]);
    return signed_volume(mesh.kind(e), {x.data(), corners.size()});
}

namespace {

/// Returns the sets of elements that are joined through faces.
DisjointSet joined_elements(const Mesh& mesh) {
    DisjointSet groups(mesh.element_capacity());
    for (const CellId e : mesh.elements()) {
        std::int32_t own = e.value;
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const CellId other = mesh.neighbor({e, f}).cell;
            if (other.is_valid() && other < e) own = groups.join(own, other.value);
        }
    }
    return groups;
}

}  // namespace

int num_components(const Mesh& mesh) {
    DisjointSet groups = joined_elements(mesh);
    return static_cast<int>(std::ranges::count_if(
        mesh.elements(), [&](CellId e) { return groups.find(e.value) == e.value; }));
}

Components components(const Mesh& mesh) {
    DisjointSet groups = joined_elements(mesh);
    Components result;
    result.of_element.assign(mesh.element_capacity(), -1);
    for (const CellId e : mesh.elements()) {
        const std::int32_t first = groups.find(e.value);
        result.of_element[e.index()] =
            first == e.value ? result.count++ : result.of_element[static_cast<std::size_t>(first)];
    }
    return result;
}

std::vector<FaceId> boundary_faces(const Mesh& mesh) {
    std::vector<FaceId> faces;
    for (const CellId e : mesh.elements())
        for (int f = 0; f < mesh.num_faces(e); ++f)
            if (!mesh.neighbor({e, f}).is_valid()) faces.push_back({e, f});
    return faces;
}

namespace {}  // namespace

std::optional<WholeCell> cell_of_source(const Mesh& mesh, CellId e) {
    const auto whole = mesh.whole_cell(e);
    if (!whole || whole->diagonals.is_none()) return whole;
    const int num_faces = traits(whole->kind).num_faces;
    int other = num_faces;  // the second half of the next quadrilateral
    for (int f = 0; f < num_faces; ++f)
        if (whole->diagonals.divides(f) &&
            mesh.neighbor({e, f}).is_valid() != mesh.neighbor({e, other++}).is_valid())
            return std::nullopt;
    return whole;
}

MeshData to_mesh_data(const Mesh& mesh, std::span<const Vec3> positions,
                      std::vector<VertexId>* nodes, std::vector<CellId>* elements) {
    MeshData data;
    data.points.reserve(mesh.num_nodes());
    if (nodes) {
        nodes->clear();
        nodes->reserve(mesh.num_nodes());
    }
    std::vector<std::int64_t> row_of_node(mesh.node_capacity(), -1);
    for (const VertexId n : mesh.nodes()) {
        row_of_node[n.index()] = static_cast<std::int64_t>(data.points.size());
        data.points.push_back(positions[n.index()]);
        if (nodes) nodes->push_back(n);
    }

    std::size_t num_corners = 0;
    for (const CellId e : mesh.elements()) num_corners += mesh.corners(e).size();
    data.kinds.reserve(mesh.num_elements());
    data.offsets.reserve(mesh.num_elements() + 1);
    data.regions.reserve(mesh.num_elements());
    data.corners.reserve(num_corners);
    if (elements) {
        elements->clear();
        elements->reserve(mesh.num_elements());
    }
    for (const CellId e : mesh.elements()) {
        const auto whole = cell_of_source(mesh, e);
        if (!whole) {
            data.faces.push_back(mesh.num_faces(e));
            for (int f = 0; f < mesh.num_faces(e); ++f) {
                data.faces.push_back(mesh.face_size({e, f}));
                for (int p = 0; p < mesh.face_size({e, f}); ++p)
                    data.faces.push_back(row_of_node[mesh.face_corner({e, f}, p).index()]);
            }
        }
        for (const VertexId n : whole ? whole->corners() : mesh.corners(e))
            data.corners.push_back(row_of_node[n.index()]);
        data.kinds.push_back(whole ? whole->kind : mesh.kind(e));
        data.offsets.push_back(data.corners.size());
        data.regions.push_back(mesh.region(e));
        if (elements) elements->push_back(e);
        const int num_faces = whole ? traits(whole->kind).num_faces : mesh.num_faces(e);
        for (int f = 0; f < num_faces; ++f)
            if (mesh.is_on_cut({e, f})) data.set_on_cut(data.num_cells() - 1, f);
    }
    if (!data.cut_faces.empty() || !data.further_cut_faces.empty())
        data.cut_faces.resize(data.num_cells());
    for (auto& further : data.further_cut_faces) further.resize(data.num_cells());
    return data;
}

}  // namespace incise::topology
