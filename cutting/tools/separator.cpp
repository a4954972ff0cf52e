// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/separator.h"

#include <algorithm>
#include <map>

#include "incise/cutting/surfaces/space_time.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// Returns the weights of the corners of a triangle for the point where paths pass through it. At
/// rest this point is on the straight line between the centres of the two elements. The path then
/// is nearly straight, and a blade seldom passes through it twice. If the line misses the face, the
/// point is the centre of the face.
Vec3 intersection(const Mesh& mesh, FaceId f) {
    const Vec3 centre = Vec3::Constant(1.0 / 3.0);
    const auto at = [&](int p) -> const Vec3& {
        return mesh.rest_position(mesh.face_corner(f, p));
    };
    const Vec3 from = TissueMotion::centre(mesh, f.cell, mesh.rest_positions());
    const Vec3 to = TissueMotion::centre(mesh, mesh.neighbor(f).cell, mesh.rest_positions());
    // The weight of a corner is proportional to the volume that the line spans with the opposite
    // edge.
    const auto volume = [&](int i, int j) {
        return (to - from).dot((at(i) - from).cross(at(j) - from));
    };
    const Vec3 volumes(volume(1, 2), volume(2, 0), volume(0, 1));
    const bool is_inside = (volumes.array() > 0.0).all() || (volumes.array() < 0.0).all();
    if (!is_inside) return centre;
    return volumes / volumes.sum();
}

/// Returns where paths pass through a face. If it has more than three corners, this is the mean of
/// all: it may have any number of them.
MovingPoint on_face(const TissueMotion& tissue, FaceId f) {
    const Mesh& mesh = tissue.mesh;
    const int size = mesh.face_size(f);
    const Vec3 weights = size == 3 ? intersection(mesh, f) : Vec3::Constant(1.0 / size);
    MovingPoint point{Vec3::Zero(), Vec3::Zero()};
    for (int p = 0; p < size; ++p) {
        const std::size_t n = mesh.face_corner(f, p).index();
        const double weight = weights[size == 3 ? p : 0];
        point[0] += weight * tissue.before[n];
        point[1] += weight * tissue.after[n];
    }
    return point;
}

/// True if the blade's edge passes through the segment between two points an odd number of times.
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

/// Takes out the faces that would separate a single element from several others. Such an element is
/// at the boundary of the cut, with its centre on one side and those of its neighbours on the
/// other. It would come off as a sliver. If it stays joined by one face, no path from side to side
/// leads through it. An element that had one neighbour only in the input mesh is no sliver, and may
/// be separated.
void leave_no_slivers(const Mesh& mesh, std::vector<FaceId>& faces) {
    std::map<CellId, int> num_joined;
    const auto joined = [&](CellId e) -> int& {
        const auto [place, is_new] = num_joined.try_emplace(e, 0);
        if (is_new)
            for (int f = 0; f < mesh.num_faces(e); ++f)
                place->second += mesh.neighbor({e, f}).is_valid();
        return place->second;
    };
    const auto is_sliver = [&](CellId e) {
        int num_inside = 0;
        for (int f = 0; f < mesh.num_faces(e); ++f) num_inside += mesh.was_inside({e, f});
        return joined(e) == 1 && num_inside > 1;
    };
    std::vector<FaceId> kept;
    for (const FaceId f : faces) {
        const CellId here = f.cell, there = mesh.neighbor(f).cell;
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

    const auto centre = [&](CellId e) {
        return MovingPoint{TissueMotion::centre(mesh, e, tissue.before),
                           TissueMotion::centre(mesh, e, tissue.after)};
    };
    std::vector<FaceId> faces;
    // If a path is crossed, one of its halves is, and each half is in one of the two elements.
    const auto may_meet = [&](const Box& box) { return swept.intersects(box); };
    tissue.for_each_near(may_meet, [&](CellId e) {
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh.neighbor(face);
            if (!other.is_valid()) continue;
            // If both elements are near the blade, the face is examined from its lower side only.
            if (other < face && swept.intersects(tissue.box(other.cell))) continue;
            const FaceId lower = std::min(face, other), higher = std::max(face, other);
            // From the lower side, so that sums always have the same order.
            const MovingPoint middle = on_face(tissue, lower);
            const bool is_odd = is_crossed(centre(lower.cell), middle, before, after) !=
                                is_crossed(middle, centre(higher.cell), before, after);
            if (is_odd) faces.push_back(lower);
        }
    });
    std::sort(faces.begin(), faces.end());
    leave_no_slivers(mesh, faces);
    return faces;
}

}  // namespace incise::cutting
