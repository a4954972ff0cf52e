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

std::array<Vec3, 4> corners_at(const Mesh& mesh, CellId e, std::span<const Vec3> positions) {
    std::array<Vec3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = positions[mesh.corners(e)[k].index()];
    return x;
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

Stroke sweep(const Polyline& from, const Polyline& to, int num_steps) {
    const auto at = [&](int i) {
        Polyline edge;
        for (std::size_t k = 0; k < from.size(); ++k)
            edge.push_back(from[k] + i * (to[k] - from[k]) / num_steps);
        return edge;
    };
    Stroke stroke;
    for (int i = 0; i < num_steps; ++i)
        stroke.push_back(std::make_unique<SweptEdge>(at(i), at(i + 1)));
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

Split SplitBody::cut(const CutSurface& surface, CutFront& front, const SplitOptions& options,
                     const std::vector<Vec3>& moved, std::span<SuspendedCut> resting) {
    const Split done =
        split(mesh, {mesh, positions, moved}, surface, front, options, snap_history, resting);
    positions = followed(moved, done.changes);
    fragments.apply(mesh, done.changes);
    first_surface.apply(done.changes);
    EXPECT_EQ(positions.size(), mesh.node_capacity());
    if (!done.changes.is_empty()) {
        EXPECT_EQ(topology::validate(mesh), std::vector<std::string>{});
        EXPECT_EQ(first_surface.faults(mesh), std::vector<FaceId>{});
    }
    return done;
}

Split SplitBody::cut(const CutSurface& surface, const SplitOptions& options) {
    CutFront front;
    return cut(surface, front, options, positions);
}

std::vector<Split> SplitBody::cut(const Stroke& stroke, const SplitOptions& options) {
    CutFront front;
    std::vector<Split> parts;
    for (const auto& surface : stroke) parts.push_back(cut(*surface, front, options, positions));
    return parts;
}

Split SplitBody::finish(const BladeEnd& blade, CutFront& front, const SplitOptions& options) {
    const std::vector<Vec3> here = positions;
    const Split done =
        cutting::finish(mesh, fragments, {mesh, here, here}, blade, front, options, snap_history);
    positions = followed(here, done.changes);
    fragments.apply(mesh, done.changes);
    first_surface.apply(done.changes);
    EXPECT_EQ(topology::validate(mesh), std::vector<std::string>{});
    EXPECT_EQ(first_surface.faults(mesh), std::vector<FaceId>{});
    return done;
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
    const auto x = corners_at(mesh, e, positions);
    return topology::tetrahedron_volume(x[0], x[1], x[2], x[3]);
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
        const auto x = corners_at(mesh, CellId(i), positions);
        std::array<double, 4> heights;
        for (std::size_t k = 0; k < 4; ++k) heights[k] = normal.dot(x[k] - point);
        sum += clipped_volume(x, heights);
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
    std::map<std::array<std::array<double, 3>, 3>, FaceId> seen;
    std::vector<FacePair> pairs;
    for (const FaceId f : topology::boundary_faces(mesh)) {
        std::array<std::array<double, 3>, 3> key;
        for (int p = 0; p < 3; ++p) {
            const Vec3& x = mesh.rest_position(mesh.face_corner(f, p));
            key[static_cast<std::size_t>(p)] = {x.x(), x.y(), x.z()};
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
        for (int p = 0; p < 3; ++p)
            for (int q = 0; q < 3; ++q) {
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
