// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/face_triangles.h"

#include <algorithm>

namespace incise::topology {

Ears::Ears(const Mesh& mesh, FaceId f) {
    for (int p = 0; p < mesh.face_size(f); ++p) {
        corners_.push_back(mesh.face_corner(f, p));
        x_.push_back(mesh.rest_position(corners_.back()));
    }
    for (std::size_t p = 1; p + 1 < size(); ++p)
        normal_ += (x_[p] - x_[0]).cross(x_[p + 1] - x_[0]);
    normal_.normalize();
}

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
