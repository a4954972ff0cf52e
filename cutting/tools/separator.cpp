// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/separator.h"

#include <algorithm>
#include <array>
#include <map>

#include "incise/cutting/surfaces/space_time.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// Weights of a face's corners for its intersection: where, at rest, the straight line between the
/// centres of its elements pierces it, so that the path is nearly straight and a blade seldom
/// passes it twice; the face's centre if the line misses the face, and on quadrilaterals.
std::array<double, topology::max_face_corners> intersection(const Mesh& mesh, FaceId f) {
    const int size = mesh.face_size(f);
    std::array<double, topology::max_face_corners> centre{};
    centre.fill(1.0 / size);
    if (size != 3) return centre;
    const auto at = [&](int p) -> const Vec3& {
        return mesh.rest_position(mesh.face_corner(f, p));
    };
    const Vec3 from = TissueMotion::centre(mesh, f.element, mesh.rest_positions());
    const Vec3 to = TissueMotion::centre(mesh, mesh.neighbor(f).element, mesh.rest_positions());
    // Volumes that the line spans with the edges are in proportion to the weights of the corners
    // opposite to them.
    const auto volume = [&](int i, int j) {
        return (to - from).dot((at(i) - from).cross(at(j) - from));
    };
    const Vec3 volumes(volume(1, 2), volume(2, 0), volume(0, 1));
    const bool is_inside = (volumes.array() > 0.0).all() || (volumes.array() < 0.0).all();
    if (!is_inside) return centre;
    const Vec3 weights = volumes / volumes.sum();
    return {weights[0], weights[1], weights[2], 0.0};
}

Vec3 on_face(const Mesh& mesh, FaceId f, std::span<const double> weights,
             std::span<const Vec3> positions) {
    Vec3 sum = Vec3::Zero();
    for (int p = 0; p < mesh.face_size(f); ++p)
        sum += weights[static_cast<std::size_t>(p)] * positions[mesh.face_corner(f, p).index()];
    return sum;
}

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

/// Takes out the faces that would cut a single element off from several others. Such an element
/// at the boundary of the cut, its centre on one side and its neighbours' on the other, would fall
/// off as a sliver; hanging by one face it is a leaf, over which nothing passes from side to side.
/// An element that the source joins to one other only is no sliver but an end, and may be cut off.
void leave_no_slivers(const Mesh& mesh, std::vector<FaceId>& faces) {
    std::map<ElementId, int> num_joined;
    const auto joined = [&](ElementId e) -> int& {
        const auto [place, is_new] = num_joined.try_emplace(e, 0);
        if (is_new)
            for (int f = 0; f < mesh.num_faces(e); ++f)
                place->second += mesh.neighbor({e, f}).is_valid();
        return place->second;
    };
    const auto is_sliver = [&](ElementId e) {
        int num_inside = 0;
        for (int f = 0; f < mesh.num_faces(e); ++f) num_inside += mesh.was_inside({e, f});
        return joined(e) == 1 && num_inside > 1;
    };
    std::vector<FaceId> kept;
    for (const FaceId f : faces) {
        const ElementId here = f.element, there = mesh.neighbor(f).element;
        if (is_sliver(here) != is_sliver(there)) continue;
        --joined(here);
        --joined(there);
        kept.push_back(f);
    }
    faces = std::move(kept);
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
    // A crossed path has a crossed half, which lies in one of its two elements.
    const auto may_meet = [&](const Box& box) { return swept.intersects(box); };
    tissue.for_each_near(may_meet, [&](ElementId e) {
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh.neighbor(face);
            if (!other.is_valid()) continue;
            // Both sides may be near the blade: the lower one asks.
            if (other < face && swept.intersects(tissue.box(other.element))) continue;
            const FaceId lower = std::min(face, other), higher = std::max(face, other);
            // From the lower side, so that sums are in the same order every time.
            const auto weights = intersection(mesh, lower);
            const MovingPoint middle = {on_face(mesh, lower, weights, tissue.before),
                                        on_face(mesh, lower, weights, tissue.after)};
            const bool is_odd = is_crossed(centre(lower.element), middle, before, after) !=
                                is_crossed(middle, centre(higher.element), before, after);
            if (is_odd) faces.push_back(lower);
        }
    });
    std::sort(faces.begin(), faces.end());
    leave_no_slivers(mesh, faces);
    return faces;
}

}  // namespace incise::cutting
