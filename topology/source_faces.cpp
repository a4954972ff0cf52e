// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/source_faces.h"

#include "incise/topology/geometry.h"

namespace incise::topology {

SourceFaces::SourceFaces(const MeshData& data) : data_(data) {
    if (data.faces.empty()) return;
    first_.resize(data.num_cells());
    data.for_each_polyhedron([&](std::size_t c, std::size_t at) {
        first_[c] = places_.size();
        const std::int64_t count = data.faces[at++];
        for (std::int64_t f = 0; f < count; ++f) {
            places_.push_back(at);
            at += static_cast<std::size_t>(data.faces[at]) + 1;
        }
    });
}

std::vector<std::int64_t> SourceFaces::points(SourceFace f) const {
    std::vector<std::int64_t> points;
    for (int p = 0; p < size(f); ++p) points.push_back(point(f, p));
    return points;
}

// The same sum as volume_of() of a CellShape, so that a mesh has the same bits as its source.
double SourceFaces::volume(std::size_t c) const {
    if (!is_polyhedron(c)) {
        std::array<Vec3, max_corners> x;
        const auto corners = data_.cell(c);
        for (std::size_t k = 0; k < corners.size(); ++k)
            x[k] = data_.points[static_cast<std::size_t>(corners[k])];
        return signed_volume(data_.kinds[c], {x.data(), corners.size()});
    }
    const Vec3& o = position({c, 0}, 0);
    double volume = 0.0;
    for (int f = 0; f < num_faces(c); ++f)
        volume += flux_of_face(size({c, f}), [&](int p) -> Vec3 {
            return position({c, f}, p) - o;
        });
    return volume;
}

}  // namespace incise::topology
