// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/triangulation.h"

#include <algorithm>
#include <vector>

#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// The polygon of a face as seen along its mean normal.
class Polygon {
  public:
    Polygon(const Mesh& mesh, FaceId f) {
        const auto size = static_cast<std::size_t>(mesh.face_size(f));
        for (std::size_t p = 0; p < size; ++p) {
            corners_.push_back(mesh.face_corner(f, static_cast<int>(p)));
            x_.push_back(mesh.rest_position(corners_.back()));
        }
        for (std::size_t p = 1; p + 1 < size; ++p)
            normal_ += (x_[p] - x_[0]).cross(x_[p + 1] - x_[0]);
        normal_.normalize();
    }

    std::size_t size() const { return corners_.size(); }
    VertexId corner(std::size_t p) const { return corners_[p % size()]; }

    /// Returns how good the triangle is that an edge past a corner cuts off: its area over the
    /// square of its longest side. Negative if it is turned round, or has another corner inside.
    double quality(std::size_t p) const {
        const std::size_t before = (p + size() - 1) % size(), after = (p + 1) % size();
        const Vec3 &a = x_[before], &b = x_[p], &c = x_[after];
        const double longest =
            std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        if (!(longest > 0.0)) return 0.0;
        const double area = doubled_area(a, b, c);
        if (area > 0.0)
            for (std::size_t q = 0; q < size(); ++q) {
                if (q == before || q == p || q == after) continue;
                if (doubled_area(a, b, x_[q]) > 0.0 && doubled_area(b, c, x_[q]) > 0.0 &&
                    doubled_area(c, a, x_[q]) > 0.0)
                    return -1.0;
            }
        return area / longest;
    }

  private:
    double doubled_area(const Vec3& a, const Vec3& b, const Vec3& c) const {
        return (b - a).cross(c - a).dot(normal_);
    }

    std::vector<VertexId> corners_;
    std::vector<Vec3> x_;
    Vec3 normal_ = Vec3::Zero();
};

/// True if a cell at the face has an edge between two corners.
bool have_edge(const Mesh& mesh, FaceId f, VertexId a, VertexId b) {
    const FaceId other = mesh.neighbor(f);
    return find_dart(mesh, f.cell, a, b).is_valid() ||
           (other.is_valid() && find_dart(mesh, other.cell, a, b).is_valid());
}

}  // namespace

void triangulate(
    const Mesh& mesh, topology::MeshEdit& edit, FaceId face,
    const std::function<void(VertexId, VertexId)>& on_edge,
    const std::function<void(VertexId, std::span<const std::pair<VertexId, double>>)>& on_node) {
    while (mesh.face_size(face) > 3) {
        const Polygon polygon(mesh, face);
        std::size_t best = polygon.size();
        double most = 0.0;
        for (std::size_t p = 0; p < polygon.size(); ++p) {
            const VertexId before = polygon.corner(p + polygon.size() - 1),
                           after = polygon.corner(p + 1);
            if (have_edge(mesh, face, before, after)) continue;
            const double quality = polygon.quality(p);
            if (best < polygon.size() && quality <= most) continue;
            best = p;
            most = quality;
        }
        if (best < polygon.size()) {
            const VertexId before = polygon.corner(best + polygon.size() - 1),
                           after = polygon.corner(best + 1);
            edit.divide_face(face, after, before);  // the rest keeps the number
            on_edge(before, after);
            continue;
        }
        if (polygon.size() > topology::max_corners) return;
        std::vector<std::pair<VertexId, double>> sources;
        for (std::size_t p = 0; p < polygon.size(); ++p)
            sources.emplace_back(polygon.corner(p), 1.0 / static_cast<double>(polygon.size()));
        const VertexId centre = edit.divide_face_at_centre(face);
        on_node(centre, sources);
        for (const auto& [corner, weight] : sources) on_edge(corner, centre);
    }
}

}  // namespace incise::cutting
