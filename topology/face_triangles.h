// The triangles of a face.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// A polygon that is divided into triangles by cutting off one corner after the other: the one that
/// gives the best triangle, as seen along the mean normal. A face of a mesh is taken at rest.
class Ears {
  public:
    Ears(const Mesh& mesh, FaceId f);
    /// @param positions  of the corners, m
    Ears(std::vector<VertexId> corners, std::vector<Vec3> positions);

    std::size_t size() const { return corners_.size(); }
    /// Returns a corner; positions count round the polygon.
    VertexId corner(std::size_t position) const { return corners_[position % size()]; }
    /// Returns the position of the corner that is cut off next. Leaves out those for which
    /// may_cut(before, corner, after) is false, where these are it and its neighbours; nothing if
    /// there is no other.
    template <class MayCut>
    std::optional<std::size_t> best(MayCut may_cut) const {
        std::optional<std::size_t> best;
        double most = 0.0;
        for (std::size_t p = 0; p < size(); ++p) {
            if (!may_cut(corner(p + size() - 1), corner(p), corner(p + 1))) continue;
            double quality = quality_of(p);
            if (size() == 4) quality = std::min(quality, quality_of((p + 2) % 4));  // the rest
            if (best && quality <= most) continue;
            best = p;
            most = quality;
        }
        return best;
    }
    /// Returns the area of the triangle that is cut off with a corner, over the square of its
    /// longest side. Negative if it is turned round, or has another corner inside.
    double quality_of(std::size_t p) const;
    /// Cuts off a corner.
    void cut(std::size_t position);

  private:
    double doubled_area(const Vec3& a, const Vec3& b, const Vec3& c) const {
        return (b - a).cross(c - a).dot(normal_);
    }

    std::vector<VertexId> corners_;
    std::vector<Vec3> x_;  // m
    Vec3 normal_ = Vec3::Zero();
};

/// Calls visit(a, b, c) for the triangles of a face. A quadrilateral of a cell that is no
/// polyhedron is divided from its first corner. The two sides of a polygon can be divided
/// differently.
template <class Visit>
void for_each_triangle(const Mesh& mesh, FaceId f, Visit visit) {
    const int size = mesh.face_size(f);
    if (size == 3 || !mesh.is_polyhedron(f.cell)) {
        for (int p = 2; p < size; ++p)
            visit(mesh.face_corner(f, 0), mesh.face_corner(f, p - 1), mesh.face_corner(f, p));
        return;
    }
    Ears ears(mesh, f);
    while (ears.size() > 3) {
        const std::size_t p = *ears.best([](VertexId, VertexId, VertexId) { return true; });
        visit(ears.corner(p + ears.size() - 1), ears.corner(p), ears.corner(p + 1));
        ears.cut(p);
    }
    visit(ears.corner(0), ears.corner(1), ears.corner(2));
}

}  // namespace incise::topology
