// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/separator.h"

#include "cutting/space_time.h"

namespace incise::cutting {

using topology::ElementId;
using topology::FaceId;
using topology::Mesh;

namespace {

Vec3 face_centre(const Mesh& mesh, FaceId f, std::span<const Vec3> positions) {
    Vec3 sum = Vec3::Zero();
    const int size = mesh.face_size(f);
    for (int p = 0; p < size; ++p) sum += positions[mesh.face_corner(f, p).index()];
    return sum / static_cast<double>(size);
}

/// A point of the tissue before and after the step.
using MovingPoint = std::array<Vec3, 2>;

/// How often, modulo two, the blade's edge passes through the segment between two points.
bool is_crossed(const MovingPoint& p, const MovingPoint& q, std::span<const Vec3> before,
                std::span<const Vec3> after) {
    Box path(p[0]);
    path.extend(p[1]).extend(q[0]).extend(q[1]);
    bool is_odd = false;
    for (std::size_t s = 0; s + 1 < before.size(); ++s) {
        Box swept(before[s]);
        swept.extend(before[s + 1]).extend(after[s]).extend(after[s + 1]);
        if (!swept.intersects(path)) continue;
        is_odd ^= cross({p, q}, {{before[s], after[s]}, {before[s + 1], after[s + 1]}});
    }
    return is_odd;
}

}  // namespace

std::vector<FaceId> faces_to_open(const TissueMotion& tissue, std::span<const Vec3> before,
                                  std::span<const Vec3> after) {
    const Mesh& mesh = tissue.mesh;
    Box swept;
    for (const Vec3& x : before) swept.extend(x);
    for (const Vec3& x : after) swept.extend(x);

    const auto centre = [&](ElementId e) {
        return MovingPoint{TissueMotion::centre(mesh, e, tissue.before),
                           TissueMotion::centre(mesh, e, tissue.after)};
    };
    std::vector<FaceId> faces;
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
        const ElementId e(i);
        // A crossed path has a crossed half, which lies in one of its two elements.
        if (!mesh.is_alive(e) || !swept.intersects(tissue.box(e))) continue;
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh.neighbor(face);
            if (!other.is_valid()) continue;
            // Both sides may be near the blade: the lower one asks.
            if (other < face && swept.intersects(tissue.box(other.element))) continue;
            const FaceId lower = std::min(face, other), higher = std::max(face, other);
            // From the lower side, so that the centre is summed in the same order every time.
            const MovingPoint middle = {face_centre(mesh, lower, tissue.before),
                                        face_centre(mesh, lower, tissue.after)};
            const bool is_odd = is_crossed(centre(lower.element), middle, before, after) !=
                                is_crossed(middle, centre(higher.element), before, after);
            if (is_odd) faces.push_back(lower);
        }
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

}  // namespace incise::cutting
