// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/mesh_smoothing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "incise/topology/cell_kind.h"
#include "tetmesh/region_faces.h"

namespace incise::tetmesh {

namespace {

using Corners = std::array<Vec3, 4>;

/// Aims at altitudes of this times the local edge length. A regular tetrahedron has 0.82.
constexpr double altitude_aim = 0.3;

struct Quality {
    double altitude;  ///< the least one; negative if the tetrahedron is inside out
    double cosine;    ///< of the least dihedral angle
};

Quality quality_of(const Corners& x) {
    const Vec3 u = x[1] - x[0], v = x[2] - x[0], w = x[3] - x[0];
    // Twice the area of the face opposite to each corner, outwards.
    std::array<Vec3, 4> areas = {Vec3::Zero(), w.cross(v), u.cross(w), v.cross(u)};
    areas[0] = -(areas[1] + areas[2] + areas[3]);
    const double six_volumes = -areas[3].dot(w);
    if (!(six_volumes > 0.0)) return {-1.0, 1.0};
    std::array<double, 4> sizes;
    for (std::size_t k = 0; k < 4; ++k) sizes[k] = areas[k].norm();
    double largest_cosine = -1.0;
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < k; ++l)
            largest_cosine =
                std::max(largest_cosine, -areas[k].dot(areas[l]) / (sizes[k] * sizes[l]));
    return {six_volumes / std::ranges::max(sizes), largest_cosine};
}

/// Unit vectors in all directions.
std::vector<Vec3> directions_in_space() {
    std::vector<Vec3> directions;
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k)
                if (i != 0 || j != 0 || k != 0) directions.push_back(Vec3(i, j, k).normalized());
    return directions;
}

/// Unit vectors in all directions across a normal.
std::vector<Vec3> directions_across(const Vec3& normal) {
    constexpr int num_directions = 8;
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    std::vector<Vec3> directions;
    for (int i = 0; i < num_directions; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / num_directions;
        directions.emplace_back(std::cos(angle) * u + std::sin(angle) * v);
    }
    return directions;
}

class Smoothing {
  public:
    Smoothing(topology::MeshData& mesh, const std::vector<bool>& is_fixed, const BodyShape& body,
              const SizeField& sizes, double angle_aim, double distance)
        : mesh_(mesh),
          body_(body),
          is_fixed_(is_fixed),
          cosine_aim_(std::cos(angle_aim)),
          distance_(distance),
          cells_(mesh.points.size()),
          faces_(region_faces(mesh)),
          faces_of_node_(mesh.points.size()) {
        for (std::size_t c = 0; c < mesh.num_cells(); ++c)
            for (const auto p : mesh.cell(c)) cells_[static_cast<std::size_t>(p)].push_back(c);
        for (std::size_t f = 0; f < faces_.size(); ++f)
            for (const auto p : faces_[f].nodes)
                faces_of_node_[static_cast<std::size_t>(p)].push_back(f);
        // Where the body is thin or pointed, edges are shorter than what was asked for, and cannot
        // grow by much.
        constexpr double most_growth = 1.3;
        for (std::size_t p = 0; p < mesh.points.size(); ++p)
            lengths_.push_back(std::min(sizes.at(mesh.points[p]), most_growth * mean_edge_at(p)));
        for (std::size_t p = 0; p < mesh.points.size(); ++p) {
            const auto& own = faces_of_node_[p];
            for (const std::size_t f : own)
                if (!faces_[f].has_regions_of(faces_[own[0]])) is_fixed_[p] = true;
        }
    }

    void run() {
        constexpr int max_sweeps = 10;
        std::vector<bool> is_waiting(mesh_.points.size(), true);
        bool has_moved = true;
        for (int sweep = 0; sweep < max_sweeps && has_moved; ++sweep) {
            has_moved = false;
            for (std::size_t p = 0; p < mesh_.points.size(); ++p) {
                if (is_fixed_[p] || !is_waiting[p]) continue;
                is_waiting[p] = false;
                if (!improve(p)) continue;
                has_moved = true;
                for (const std::size_t c : cells_[p])
                    for (const auto q : mesh_.cell(c))
                        is_waiting[static_cast<std::size_t>(q)] = true;
            }
        }
    }

  private:
    double mean_edge_at(std::size_t node) const {
        double sum = 0.0;
        for (const std::size_t c : cells_[node])
            for (const auto p : mesh_.cell(c))
                sum += (mesh_.points[static_cast<std::size_t>(p)] - mesh_.points[node]).norm();
        return sum / (3.0 * static_cast<double>(cells_[node].size()));
    }

    /// Returns the quality of the worst tetrahedra round a node. Altitudes are over the length to
    /// aim at. Ends at the first one that is not better than a bound.
    Quality quality_at(std::size_t node, const Vec3& x, const Quality& bound) const {
        Quality star{std::numeric_limits<double>::infinity(), -1.0};
        for (const std::size_t c : cells_[node]) {
            Corners corners;
            double length = 0.0;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto p = static_cast<std::size_t>(mesh_.cell(c)[k]);
                corners[k] = p == node ? x : mesh_.points[p];
                length += 0.25 * lengths_[p];
            }
            const auto [altitude, cosine] = quality_of(corners);
            star.altitude = std::min(star.altitude, altitude / (altitude_aim * length));
            star.cosine = std::max(star.cosine, cosine);
            if (!is_better(star, bound)) break;
        }
        return star;
    }

    static bool is_better(const Quality& a, const Quality& bound) {
        return a.altitude > bound.altitude && a.cosine <= bound.cosine;
    }

    Vec3 area_of(const RegionFace& face, std::size_t node, const Vec3& x) const {
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto p = static_cast<std::size_t>(face.nodes[k]);
            corners[k] = p == node ? x : mesh_.points[p];
        }
        return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    }

    /// Returns the normal of a surface at a node of it, outwards.
    Vec3 normal_at(std::size_t node) const {
        Vec3 sum = Vec3::Zero();
        for (const std::size_t f : faces_of_node_[node])
            sum += area_of(faces_[f], node, mesh_.points[node]);
        return sum.normalized();
    }

    /// The number of faces at a node on a surface that are too far from it, or more than the number
    /// of faces if one of them would be folded.
    std::size_t num_far_faces(std::size_t node, const Vec3& x) const {
        constexpr double least_turn = 0.8;  // cosine of the angle between old and new normal
        std::size_t count = 0;
        for (const std::size_t f : faces_of_node_[node]) {
            const RegionFace& face = faces_[f];
            const Vec3 normal = area_of(face, node, x).normalized();
            const Vec3 old = area_of(face, node, mesh_.points[node]).normalized();
            if (normal.dot(old) < least_turn) return faces_of_node_[node].size() + 1;
            Vec3 centre = Vec3::Zero();
            for (const auto p : face.nodes)
                centre += (static_cast<std::size_t>(p) == node
                               ? x
                               : mesh_.points[static_cast<std::size_t>(p)]) /
                          3.0;
            if (body_.region_at(centre - distance_ * normal) != face.inner ||
                body_.region_at(centre + distance_ * normal) != face.outer)
                ++count;
        }
        return count;
    }

    /// Returns the point of the surface near x, in the direction of the normal.
    std::optional<Vec3> projected(const RegionFace& face, const Vec3& normal, const Vec3& x,
                                  double length) const {
        Vec3 in = x - 0.3 * length * normal, out = x + 0.3 * length * normal;
        if (body_.region_at(in) != face.inner || body_.region_at(out) != face.outer)
            return std::nullopt;
        constexpr int num_halvings = 12;  // to less than a thousandth of the length
        for (int i = 0; i < num_halvings; ++i) {
            const Vec3 middle = 0.5 * (in + out);
            const int region = body_.region_at(middle);
            if (region == face.inner)
                in = middle;
            else if (region == face.outer)
                out = middle;
            else
                return std::nullopt;
        }
        return out;
    }

    /// Moves a node if that raises the least altitude round it by more than a little.
    bool improve(std::size_t node) {
        constexpr double first_step = 0.1, last_step = 0.005;  // of the length
        constexpr double least_gain = 0.01;                    // of the altitude
        constexpr Quality any{-1.0, 1.0};
        const Quality first = quality_at(node, mesh_.points[node], any);
        Quality best{first.altitude, std::max(first.cosine, cosine_aim_)};
        const double length = lengths_[node];
        const auto& own = faces_of_node_[node];
        for (double step = first_step; step > last_step && best.altitude < 1.0;) {
            const Vec3 start = mesh_.points[node];
            const double worth_while = (1.0 + least_gain) * best.altitude;
            const Vec3 normal = normal_at(node);
            const std::size_t num_far = num_far_faces(node, start);
            for (const Vec3& direction : own.empty() ? in_space_ : directions_across(normal)) {
                Vec3 trial = start + step * length * direction;
                if (!own.empty()) {
                    const auto on_surface = projected(faces_[own[0]], normal, trial, length);
                    if (!on_surface) continue;
                    trial = *on_surface;
                }
                const auto quality = quality_at(node, trial, best);
                if (!is_better(quality, best) || num_far_faces(node, trial) > num_far) continue;
                best.altitude = quality.altitude;
                mesh_.points[node] = trial;
            }
            if (!(best.altitude > worth_while)) step *= 0.5;
        }
        return best.altitude > (1.0 + least_gain) * first.altitude;
    }

    const std::vector<Vec3> in_space_ = directions_in_space();
    topology::MeshData& mesh_;
    const BodyShape& body_;
    std::vector<bool> is_fixed_;
    double cosine_aim_, distance_;
    std::vector<std::vector<std::size_t>> cells_;  // by node
    std::vector<RegionFace> faces_;
    std::vector<std::vector<std::size_t>> faces_of_node_;
    std::vector<double> lengths_;  // by node, of edges to aim at
};

}  // namespace

void raise_altitudes(topology::MeshData& mesh, const std::vector<bool>& is_fixed,
                     const BodyShape& body, const SizeField& sizes, double angle_aim,
                     double distance) {
    Smoothing(mesh, is_fixed, body, sizes, angle_aim, distance).run();
}

}  // namespace incise::tetmesh
