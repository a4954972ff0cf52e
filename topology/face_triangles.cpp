// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/face_triangles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace incise::topology {

namespace {
constexpr double rounding = 1e-10;  // of an area
}

Ears::Ears(std::vector<VertexId> corners, std::vector<Vec3> positions)
    : corners_(std::move(corners)), x_(std::move(positions)) {
    for (std::size_t p = 1; p + 1 < size(); ++p)
        normal_ += (x_[p] - x_[0]).cross(x_[p + 1] - x_[0]);
    normal_.normalize();
}

Ears::Ears(const Mesh& mesh, FaceId f)
    : Ears(
          [&] {
              std::vector<VertexId> corners;
              for (int p = 0; p < mesh.face_size(f); ++p) corners.push_back(mesh.face_corner(f, p));
              return corners;
          }(),
          [&] {
              std::vector<Vec3> x;
              for (int p = 0; p < mesh.face_size(f); ++p)
                  x.push_back(mesh.rest_position(mesh.face_corner(f, p)));
              return x;
          }()) {}

void Ears::cut(std::size_t position) {
    corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(position));
    x_.erase(x_.begin() + static_cast<std::ptrdiff_t>(position));
}

double Ears::quality_of(std::size_t p) const {
    const std::size_t before = (p + size() - 1) % size(), after = (p + 1) % size();
    const Vec3 &a = x_[before], &b = x_[p], &c = x_[after];
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if (!(longest > 0.0)) return 0.0;
    const double area = doubled_area(a, b, c);
    // A triangle that leaves nothing but corners on a straight line would make the last one flat.
    double rest = -area;
    for (std::size_t q = 2; q < size(); ++q) rest += doubled_area(x_[0], x_[q - 1], x_[q]);
    if (size() > 3 && area > 0.0 && std::abs(rest) <= rounding * area) return 0.0;
    if (area > 0.0)
        for (std::size_t q = 0; q < size(); ++q) {
            if (q == before || q == p || q == after) continue;
            if (doubled_area(a, b, x_[q]) > 0.0 && doubled_area(b, c, x_[q]) > 0.0 &&
                doubled_area(c, a, x_[q]) > 0.0)
                return -1.0;
        }
    return area / longest;
}

}  // namespace incise::topology
