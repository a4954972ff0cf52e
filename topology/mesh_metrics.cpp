// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_metrics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh_check.h"

namespace incise::topology {

namespace {

/// By corner, the other ends of its edges if three edges meet there; else -1.
using CornerNeighbors = std::array<std::array<int, 3>, max_corners>;

constexpr CornerNeighbors corner_neighbors(const CellTraits& cell) {
    CornerNeighbors neighbors{};
    std::array<std::size_t, max_corners> counts{};
    for (std::size_t e = 0; e < static_cast<std::size_t>(cell.num_edges); ++e)
        for (std::size_t end = 0; end < 2; ++end) {
            const auto corner = static_cast<std::size_t>(cell.edges[e][end]);
            if (counts[corner] < 3) neighbors[corner][counts[corner]] = cell.edges[e][1 - end];
            ++counts[corner];
        }
    for (std::size_t corner = 0; corner < max_corners; ++corner)
        if (counts[corner] != 3) neighbors[corner] = {-1, -1, -1};
    return neighbors;
}

constexpr std::array<CornerNeighbors, num_cell_kinds> neighbors_of_kind = {
    corner_neighbors(cell_traits[0]), corner_neighbors(cell_traits[1]),
    corner_neighbors(cell_traits[2]), corner_neighbors(cell_traits[3])};

/// Updates the metrics by the three edges of a cell that begin at one corner.
void measure_corner(const std::array<Vec3, 3>& edges, MeshMetrics& metrics) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &p = edges[i], &q = edges[(i + 1) % 3], &r = edges[(i + 2) % 3];
        const Vec3 across_pq = p.cross(q), across_pr = p.cross(r), across_qr = q.cross(r);
        const double volume = std::abs(p.dot(across_qr));  // of the parallelepiped
        metrics.min_altitude = std::min(metrics.min_altitude, volume / across_qr.norm());
        metrics.min_dihedral_angle = std::min(
            metrics.min_dihedral_angle, std::atan2(p.norm() * volume, across_pq.dot(across_pr)));
    }
}

/// Updates the metrics by all corners of a cell.
void measure_cell(CellKind kind, std::span<const Vec3> corners, MeshMetrics& metrics) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto& neighbors = neighbors_of_kind[static_cast<std::size_t>(kind)][k];
        if (neighbors[0] < 0) continue;
        std::array<Vec3, 3> edges;
        for (std::size_t i = 0; i < 3; ++i)
            edges[i] = corners[static_cast<std::size_t>(neighbors[i])] - corners[k];
        measure_corner(edges, metrics);
    }
}

/// Returns the area vector of a face of mesh data.
Vec3 area_of(const SourceFaces& faces, SourceFace f) {
    return area_vector(faces.size(f), [&](int p) { return faces.position(f, p); });
}

void measure_cells(const MeshData& data, const SourceFaces& faces, MeshMetrics& metrics) {
    metrics.box_min.setConstant(std::numeric_limits<double>::infinity());
    metrics.box_max = -metrics.box_min;
    metrics.min_altitude = std::numeric_limits<double>::infinity();
    metrics.min_dihedral_angle = std::numbers::pi;
    std::vector<Vec3> points;
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        const CellKind kind = data.kinds[c];
        points.clear();
        for (const std::int64_t p : data.cell(c)) {
            points.push_back(data.points[static_cast<std::size_t>(p)]);
            metrics.box_min = metrics.box_min.cwiseMin(points.back());
            metrics.box_max = metrics.box_max.cwiseMax(points.back());
        }
        ++metrics.num_of_kind[static_cast<std::size_t>(kind)];
        ++metrics.cells_of_region[data.regions[c]];
        const double volume = faces.volume(c);
        metrics.volume += volume;
        if (kind != CellKind::polyhedron) {
            measure_cell(kind, points, metrics);
            continue;
        }
        double largest = 0.0;
        for (int f = 0; f < faces.num_faces(c); ++f)
            largest = std::max(largest, area_of(faces, {c, f}).norm());
        metrics.min_altitude = std::min(metrics.min_altitude, 3.0 * volume / largest);
    }
}

void measure_edges(const MeshData& data, const SourceFaces& faces, MeshMetrics& metrics) {
    std::vector<std::pair<std::int64_t, std::int64_t>> edges;
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        const CellTraits& cell = traits(data.kinds[c]);
        const auto corners = data.cell(c);
        for (std::size_t e = 0; e < static_cast<std::size_t>(cell.num_edges); ++e)
            edges.push_back(std::minmax({corners[static_cast<std::size_t>(cell.edges[e][0])],
                                         corners[static_cast<std::size_t>(cell.edges[e][1])]}));
        if (data.kinds[c] != CellKind::polyhedron) continue;
        for (int f = 0; f < faces.num_faces(c); ++f)
            for (int p = faces.size({c, f}) - 1, q = 0; q < faces.size({c, f}); p = q++)
                edges.push_back(std::minmax({faces.point({c, f}, p), faces.point({c, f}, q)}));
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    metrics.min_edge_length = std::numeric_limits<double>::infinity();
    double sum = 0.0;
    for (const auto& [a, b] : edges) {
        const double length =
            (data.points[static_cast<std::size_t>(b)] - data.points[static_cast<std::size_t>(a)])
                .norm();
        sum += length;
        metrics.min_edge_length = std::min(metrics.min_edge_length, length);
        metrics.max_edge_length = std::max(metrics.max_edge_length, length);
    }
    metrics.mean_edge_length = sum / static_cast<double>(edges.size());
}

double face_area(const SourceFaces& faces, SourceFace face) {
    const int size = faces.size(face);
    if (size > max_face_corners) return area_of(faces, face).norm();
    const auto triangle = [&](int i, int j, int k) {
        const Vec3& first = faces.position(face, i);
        return 0.5 *
               (faces.position(face, j) - first).cross(faces.position(face, k) - first).norm();
    };
    if (size == 3) return triangle(0, 1, 2);
    return 0.5 * (triangle(0, 1, 2) + triangle(0, 2, 3) + triangle(0, 1, 3) + triangle(1, 2, 3));
}

double surface_area(const MeshData& data, const SourceFaces& faces, const MeshCheck& found) {
    std::vector<SourceFace> shared;
    for (const auto& pair : found.shared_faces) shared.insert(shared.end(), {pair.a, pair.b});
    for (const JoinedQuad& joined : found.joined_quads)
        shared.insert(shared.end(), {joined.quad, joined.triangles[0], joined.triangles[1]});
    std::sort(shared.begin(), shared.end());
    double area = 0.0;
    auto next = shared.begin();
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        for (int f = 0; f < faces.num_faces(c); ++f) {
            const SourceFace face{c, f};
            if (next != shared.end() && *next == face)
                ++next;
            else
                area += face_area(faces, face);
        }
    return area;
}

/// Returns by how much cells grow as diagonals divide their quadrilaterals, m3. Between the two
/// halves and the same about the mean of the corners is half a tetrahedron.
double growth_by_diagonals(const MeshData& data, const SourceFaces& faces,
                           const std::vector<JoinedQuad>& joined_quads) {
    double sum = 0.0;
    for (const JoinedQuad& joined : joined_quads) {
        std::array<Vec3, 4> x;
        for (int p = 0; p < 4; ++p)
            x[static_cast<std::size_t>(p)] = data.points[static_cast<std::size_t>(
                faces.point(joined.quad, (joined.first_end + p) % 4))];
        sum -= 0.5 * tetrahedron_volume(x[0], x[1], x[2], x[3]);
    }
    return sum;
}

}  // namespace

double mean_element_length(const Mesh& mesh) {
    double volume = 0.0, num_sixths = 0.0;
    for (const CellId e : mesh.elements()) {
        volume += rest_volume(mesh, e);
        num_sixths += mesh.kind(e) == CellKind::tetrahedron ? 1.0 : 6.0;
    }
    return std::cbrt(6.0 * volume / num_sixths);
}

double min_altitude(CellKind kind, std::span<const Vec3> corners) {
    MeshMetrics metrics;
    metrics.min_altitude = std::numeric_limits<double>::infinity();
    measure_cell(kind, corners, metrics);
    return metrics.min_altitude;
}

double min_altitude(const Mesh& mesh, CellId e) {
    const auto whole = mesh.whole_cell(e);
    if (!whole) {
        double largest = 0.0;
        for (int f = 0; f < mesh.num_faces(e); ++f)
            largest = std::max(largest, rest_area(mesh, {e, f}));
        return 3.0 * rest_volume(mesh, e) / largest;
    }
    std::vector<Vec3> x;
    for (const VertexId n : whole->corners()) x.push_back(mesh.rest_position(n));
    return min_altitude(whole->kind, x);
}

ShapeMetrics measure_shapes(const Mesh& mesh) {
    ShapeMetrics shapes;
    MeshMetrics metrics;
    metrics.min_dihedral_angle = std::numbers::pi;
    std::vector<std::pair<VertexId, VertexId>> edges;
    std::vector<Vec3> x;
    for (const CellId e : mesh.elements()) {
        x.clear();
        const auto whole = mesh.whole_cell(e);
        for (const VertexId n : whole ? whole->corners() : mesh.corners(e)) {
            x.push_back(mesh.rest_position(n));
            shapes.box.extend(x.back());
        }
        if (whole) measure_cell(whole->kind, x, metrics);
        shapes.min_altitude = std::min(shapes.min_altitude, min_altitude(mesh, e));
        for (int f = 0; f < mesh.num_faces(e); ++f)
            for (int p = 0; p < mesh.face_size({e, f}); ++p)
                if (const auto [a, b] =
                        std::pair(mesh.face_corner({e, f}, p),
                                  mesh.face_corner({e, f}, (p + 1) % mesh.face_size({e, f})));
                    a < b)
                    edges.emplace_back(a, b);
    }
    shapes.min_dihedral_angle = metrics.min_dihedral_angle;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    double sum = 0.0;
    for (const auto& [a, b] : edges) sum += (mesh.rest_position(b) - mesh.rest_position(a)).norm();
    shapes.mean_edge_length = sum / static_cast<double>(edges.size());
    return shapes;
}

MeshMetrics measure(const MeshData& data) {
    const MeshCheck found = check(data);
    if (!found.errors.empty()) {
        std::string text = found.errors.front();
        for (std::size_t i = 1; i < found.errors.size(); ++i) text += "\n" + found.errors[i];
        throw InputError(text);
    }
    MeshMetrics metrics;
    const SourceFaces faces(data);
    measure_cells(data, faces, metrics);
    measure_edges(data, faces, metrics);
    metrics.volume += growth_by_diagonals(data, faces, found.joined_quads);
    metrics.surface_area = surface_area(data, faces, found);
    return metrics;
}

}  // namespace incise::topology
