// SPDX-License-Identifier: LGPL-3.0-or-later
#include "data/organs/mesh_smoothing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "incise/topology/geometry.h"

namespace incise::organs {

namespace {

using topology::MeshData;

constexpr int tetrahedron_corners = 4;

/// Smallest altitude of a tetrahedron; negative if it is turned inside out.
double smallest_altitude(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const double twice_largest_face = std::max(
        {(c - b).cross(d - b).norm(),  //
         (c - a).cross(d - a).norm(), (b - a).cross(d - a).norm(), (b - a).cross(c - a).norm()});
    return 6.0 * topology::tetrahedron_volume(a, b, c, d) / twice_largest_face;
}

Vec3 gradient(const Organ::Shape& shape, const Vec3& p) {
    constexpr double h = 1e-6;  // metres: small beside any shape, large beside rounding
    Vec3 g;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * Vec3::Unit(axis);
        g[axis] = (shape(p + step) - shape(p - step)) / (2.0 * h);
    }
    return g;
}

/// The point of the surface of `shape` that Newton's method finds from `p`.
Vec3 projected(const Organ::Shape& shape, Vec3 p) {
    constexpr int iterations = 4;  // the shapes are nearly distances: two or three suffice
    for (int i = 0; i < iterations; ++i) {
        const Vec3 g = gradient(shape, p);
        p -= shape(p) / g.squaredNorm() * g;
    }
    return p;
}

/// Which surface each node lies on, if any: a face of one cell is on the body's, a face between
/// cells of different regions on the inner one.
std::vector<const Organ::Shape*> surfaces_of_nodes(const MeshData& mesh, const Organ& organ) {
    using Face = std::array<std::int64_t, 3>;
    std::map<Face, std::vector<int>> regions_at;
    const auto& tetrahedron = topology::traits(topology::CellKind::tetrahedron);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        for (int f = 0; f < tetrahedron.num_faces; ++f) {
            Face face;
            std::ranges::transform(tetrahedron.face(f), face.begin(), [&](int corner) {
                return mesh.cell(c)[static_cast<std::size_t>(corner)];
            });
            std::ranges::sort(face);
            regions_at[face].push_back(mesh.regions[c]);
        }

    std::vector<const Organ::Shape*> surfaces(mesh.points.size(), nullptr);
    for (const auto& [face, regions] : regions_at) {
        const bool is_outer = regions.size() == 1;
        if (!is_outer && regions[0] == regions[1]) continue;
        for (const auto node : face) {
            auto& surface = surfaces[static_cast<std::size_t>(node)];
            if (is_outer || !surface) surface = is_outer ? &organ.body : &organ.inner;
        }
    }
    return surfaces;
}

std::vector<std::vector<std::size_t>> stars_of_nodes(const MeshData& mesh) {
    std::vector<std::vector<std::size_t>> stars(mesh.points.size());
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        for (const auto node : mesh.cell(c)) stars[static_cast<std::size_t>(node)].push_back(c);
    return stars;
}

/// The smallest altitude among `cells` if `node` were at `position`.
double smallest_altitude(const MeshData& mesh, std::span<const std::size_t> cells, std::size_t node,
                         const Vec3& position) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto c : cells) {
        std::array<const Vec3*, tetrahedron_corners> x;
        std::ranges::transform(mesh.cell(c), x.begin(), [&](std::int64_t corner) {
            const auto i = static_cast<std::size_t>(corner);
            return i == node ? &position : &mesh.points[i];
        });
        smallest = std::min(smallest, smallest_altitude(*x[0], *x[1], *x[2], *x[3]));
    }
    return smallest;
}

std::vector<Vec3> search_directions() {
    std::vector<Vec3> directions;
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k)
                if (i || j || k) directions.push_back(Vec3(i, j, k).normalized());
    return directions;
}

}  // namespace

void raise_altitudes(MeshData& mesh, const Organ& organ, double target) {
    constexpr int max_sweeps = 40;
    constexpr double first_step = 0.2, last_step = 0.005;  // of the target
    const auto surfaces = surfaces_of_nodes(mesh, organ);
    const auto stars = stars_of_nodes(mesh);
    const auto directions = search_directions();

    bool has_moved = true;
    for (int sweep = 0; sweep < max_sweeps && has_moved; ++sweep) {
        has_moved = false;
        for (std::size_t node = 0; node < mesh.points.size(); ++node) {
            double height = smallest_altitude(mesh, stars[node], node, mesh.points[node]);
            for (double step = first_step; step > last_step && height < target;) {
                const Vec3 start = mesh.points[node];
                const double start_height = height;
                for (const Vec3& direction : directions) {
                    Vec3 trial = start + step * target * direction;
                    if (surfaces[node]) trial = projected(*surfaces[node], trial);
                    const double trial_height = smallest_altitude(mesh, stars[node], node, trial);
                    if (!(trial_height > height)) continue;
                    height = trial_height;
                    mesh.points[node] = trial;
                }
                if (height > start_height)
                    has_moved = true;
                else
                    step *= 0.5;
            }
        }
    }
}

}  // namespace incise::organs
