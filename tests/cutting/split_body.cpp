// SPDX-License-Identifier: LGPL-3.0-or-later
#include "split_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/topology/geometry.h"
#include "incise/topology/validate.h"

namespace incise::cutting {

using topology::FacePair;
using topology::Mesh;
using topology::SurfaceData;

namespace {

/// Calls visit(x0, x1, x2, x3) for tetrahedra between the first corner of a cell and the triangles
/// of its faces. The sum of their volumes, some of which are negative, is that of the cell.
template <class Visit>
void for_tetrahedra(const Mesh& mesh, CellId e, std::span<const Vec3> positions, Visit visit) {
    const auto at = [&](VertexId n) -> const Vec3& { return positions[n.index()]; };
    for (int f = 0; f < mesh.num_faces(e); ++f)
        for (int p = 2; p < mesh.face_size({e, f}); ++p)
            visit(at(mesh.corners(e)[0]), at(mesh.face_corner({e, f}, 0)),
                  at(mesh.face_corner({e, f}, p - 1)), at(mesh.face_corner({e, f}, p)));
}

double volume_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return std::abs(topology::tetrahedron_volume(a, b, c, d));
}

/// Of the part of a tetrahedron where the heights, given at its corners, are positive.
double clipped_volume(std::array<Vec3, 4> x, std::array<double, 4> heights) {
    std::array<std::size_t, 4> order = {0, 1, 2, 3};
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return heights[i] > heights[j]; });
    const auto num_above =
        std::count_if(heights.begin(), heights.end(), [](double h) { return h > 0.0; });
    const auto corner = [&](std::size_t i) -> const Vec3& { return x[order[i]]; };
    const auto between = [&](std::size_t i, std::size_t j) -> Vec3 {
        const double from = heights[order[i]], to = heights[order[j]];
        return corner(i) + from / (from - to) * (corner(j) - corner(i));
    };
    const double whole = volume_of(x[0], x[1], x[2], x[3]);
    switch (num_above) {
        case 0:
            return 0.0;
        case 1:
            return volume_of(corner(0), between(0, 1), between(0, 2), between(0, 3));
        case 3:
            return whole - volume_of(corner(3), between(0, 3), between(1, 3), between(2, 3));
        case 4:
            return whole;
    }
    // A prism with a corner of the tetrahedron and two points of the plane at either end.
    const std::array<Vec3, 3> p = {corner(0), between(0, 2), between(0, 3)};
    const std::array<Vec3, 3> q = {corner(1), between(1, 2), between(1, 3)};
    return volume_of(p[0], p[1], p[2], q[2]) + volume_of(p[0], p[1], q[1], q[2]) +
           volume_of(p[0], q[0], q[1], q[2]);
}

}  // namespace

StrokePart::StrokePart(const Polyline& before, const Polyline& after)
    : surface(std::make_unique<SweptEdge>(before, after)), from(before), to(after) {}

Stroke sweep(const Polyline& from, const Polyline& to, int num_steps) {
    const auto at = [&](int i) {
        Polyline edge;
        for (std::size_t k = 0; k < from.size(); ++k)
            edge.emplace_back(from[k] + i * (to[k] - from[k]) / num_steps);
        return edge;
    };
    Stroke stroke;
    for (int i = 0; i < num_steps; ++i) stroke.emplace_back(at(i), at(i + 1));
    return stroke;
}

SplitReport sum(const std::vector<Split>& parts) {
    SplitReport sum;
    for (const auto& [changes, report] : parts) {
        sum.elements_crossed += report.elements_crossed;
        sum.nodes_snapped += report.nodes_snapped;
        sum.edges_divided += report.edges_divided;
        sum.faces_opened += report.faces_opened;
        sum.cut_area += report.cut_area;
    }
    return sum;
}

SplitBody::SplitBody(const topology::MeshData& data)
    : mesh(Mesh::build(data).mesh),
      fragments(mesh),
      positions(mesh.rest_positions().begin(), mesh.rest_positions().end()),
      first_surface(mesh) {}

Cutter& SplitBody::cutter() {
    if (!cutter_) cutter_.emplace(mesh, positions);
    return *cutter_;
}

Split SplitBody::follow(Split done) {
    positions = followed(std::move(positions), done.changes);
    cutter().apply(mesh, done.changes);
    fragments.apply(mesh, done.changes);
    first_surface.apply(done.changes);
    EXPECT_EQ(positions.size(), mesh.node_capacity());
    if (!done.changes.is_empty()) {
        EXPECT_EQ(topology::validate(mesh), std::vector<std::string>{});
        EXPECT_EQ(first_surface.faults(mesh), std::vector<FaceId>{});
    }
    return done;
}

Split SplitBody::cut(const StrokePart& part, std::optional<CutId>& blade,
                     const SplitOptions& options, const std::vector<Vec3>& moved) {
    cutter();
    positions = moved;
    cutter().follow_motion(mesh, moved);
    if (part.from.empty()) return follow(cutter().split(mesh, *part.surface, options.snap));
    if (!blade) blade = cutter().begin_cut(options.snap);
    return follow(cutter().split(*blade, mesh, part.from, part.to));
}

Split SplitBody::cut(const CutSurface& surface, const SplitOptions& options) {
    cutter().follow_motion(mesh, positions);
    return follow(cutter().split(mesh, surface, options.snap));
}

std::vector<Split> SplitBody::cut(const Stroke& stroke, const SplitOptions& options) {
    std::optional<CutId> blade;
    std::vector<Split> parts;
    for (const StrokePart& part : stroke) parts.push_back(cut(part, blade, options));
    if (blade) cutter().remove_cut(*blade);
    return parts;
}

Split SplitBody::finish(const BladeEnd& end, std::optional<CutId>& blade) {
    if (!blade) blade = cutter().begin_cut(default_snap);
    cutter().follow_motion(mesh, positions);
    return follow(cutter().end_cut(*blade, mesh, fragments, end));
}

Box SplitBody::box() const {
    Box box;
    for (const Vec3& x : positions) box.extend(x);
    return box;
}

std::vector<Vec3> followed(std::vector<Vec3> positions, const topology::ChangeSet& changes) {
    for (const auto& record : changes.nodes_added) {
        Vec3 x = Vec3::Zero();
        for (std::size_t s = 0; s < static_cast<std::size_t>(record.num_sources); ++s)
            x += record.sources[s].weight * positions[record.sources[s].node.index()];
        positions.push_back(x);
    }
    return positions;
}

double element_volume(const Mesh& mesh, CellId e, std::span<const Vec3> positions) {
    double sum = 0.0;
    for_tetrahedra(mesh, e, positions,
                   [&](const auto&... x) { sum += topology::tetrahedron_volume(x...); });
    return sum;
}

std::vector<double> piece_volumes(const Mesh& mesh) {
    const auto pieces = topology::components(mesh);
    std::vector<double> volumes(static_cast<std::size_t>(pieces.count), 0.0);
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
        if (!mesh.is_alive(CellId(i))) continue;
        volumes[static_cast<std::size_t>(pieces.of_element[i])] +=
            element_volume(mesh, CellId(i), mesh.rest_positions());
    }
    std::sort(volumes.rbegin(), volumes.rend());
    return volumes;
}

double rest_volume(const Mesh& mesh) {
    double sum = 0.0;
    for (const double volume : piece_volumes(mesh)) sum += volume;
    return sum;
}

double volume_above(const Mesh& mesh, std::span<const Vec3> positions, const Vec3& point,
                    const Vec3& normal) {
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
        if (!mesh.is_alive(CellId(i))) continue;
        for_tetrahedra(mesh, CellId(i), positions, [&](const auto&... corners) {
            const std::array<Vec3, 4> x{corners...};
            std::array<double, 4> heights;
            for (std::size_t k = 0; k < 4; ++k) heights[k] = normal.dot(x[k] - point);
            const double part = clipped_volume(x, heights);
            sum += topology::tetrahedron_volume(corners...) < 0.0 ? -part : part;
        });
    }
    return sum;
}

double longest_edge(const Mesh& mesh, std::span<const Vec3> positions) {
    double longest = 0.0;
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
        for (const VertexId a : mesh.corners(CellId(i)))
            for (const VertexId b : mesh.corners(CellId(i)))
                longest = std::max(longest, (positions[a.index()] - positions[b.index()]).norm());
    return longest;
}

std::vector<FacePair> cut_faces(const Mesh& mesh) {
    std::map<std::vector<std::array<double, 3>>, FaceId> seen;
    std::vector<FacePair> pairs;
    for (const FaceId f : topology::boundary_faces(mesh)) {
        std::vector<std::array<double, 3>> key;
        for (int p = 0; p < mesh.face_size(f); ++p) {
            const Vec3& x = mesh.rest_position(mesh.face_corner(f, p));
            key.push_back({x.x(), x.y(), x.z()});
        }
        std::sort(key.begin(), key.end());
        const auto [place, is_new] = seen.try_emplace(key, f);
        if (!is_new) pairs.push_back({place->second, f});
    }
    return pairs;
}

NodesOfCut nodes_of_cut(const Mesh& mesh) {
    std::set<VertexId> parted, joined;
    for (const auto& [a, b] : cut_faces(mesh))
        for (int p = 0; p < mesh.face_size(a); ++p)
            for (int q = 0; q < mesh.face_size(b); ++q) {
                const VertexId m = mesh.face_corner(a, p), n = mesh.face_corner(b, q);
                if (mesh.rest_position(m) != mesh.rest_position(n)) continue;
                if (m == n) {
                    joined.insert(m);
                } else {
                    parted.insert(m);
                    parted.insert(n);
                }
            }
    return {{parted.begin(), parted.end()}, {joined.begin(), joined.end()}};
}

SurfaceData sheet(const Vec3& centre, const Vec3& u, const Vec3& v, int n,
                  const std::function<Vec3(double, double)>& height) {
    SurfaceData surface;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double s = 2.0 * i / n - 1.0, t = 2.0 * j / n - 1.0;
            surface.points.push_back(centre + s * u + t * v + height(s, t));
        }
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) {
            const std::int64_t a = i + j * (n + 1), b = a + 1, c = a + n + 1, d = c + 1;
            surface.triangles.push_back({a, b, d});
            surface.triangles.push_back({a, d, c});
        }
    return surface;
}

double enclosed_volume(const SurfaceData& surface) {
    double volume = 0.0;
    for (const auto& [a, b, c] : surface.triangles) {
        const auto at = [&](std::int64_t i) -> const Vec3& {
            return surface.points[static_cast<std::size_t>(i)];
        };
        volume += at(a).dot(at(b).cross(at(c))) / 6.0;
    }
    return std::abs(volume);
}

void expect_parted(const Mesh& mesh, std::span<const Vec3> positions, const PlaneOfCut& plane,
                   double off) {
    const auto pieces = topology::components(mesh);
    const auto num_pieces = static_cast<std::size_t>(pieces.count);
    std::vector<double> highest(num_pieces, 0.0), lowest(num_pieces, 0.0);
    for (std::size_t e = 0; e < mesh.element_capacity(); ++e) {
        if (!mesh.is_alive(CellId(e))) continue;
        const auto piece = static_cast<std::size_t>(pieces.of_element[e]);
        for (const VertexId n : mesh.corners(CellId(e))) {
            const Vec3 from = positions[n.index()] - plane.point;
            const double height = from.dot(plane.normal.normalized());
            highest[piece] = std::max(highest[piece], height);
            lowest[piece] = std::min(lowest[piece], height);
        }
    }
    for (std::size_t piece = 0; piece < num_pieces; ++piece)
        EXPECT_LE(std::min(highest[piece], -lowest[piece]), off);
}

}  // namespace incise::cutting
