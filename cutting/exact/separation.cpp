// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/separation.h"

namespace incise::cutting {

namespace {

/// True if the face is between frozen nodes: an earlier cut along the same surface has left it
/// joined.
bool is_frozen(const topology::Mesh& mesh, const CutFront& front, FaceId f) {
    for (int p = 0; p < mesh.face_size(f); ++p)
        if (!front.is_frozen(mesh.face_corner(f, p))) return false;
    return true;
}

}  // namespace

std::vector<FaceId> faces_to_separate(const topology::Mesh& mesh, const CutFront& front,
                                      const std::vector<CellId>& touched,
                                      const PlaceOnCut& place_on_cut) {
    std::vector<FaceId> faces = Sides(mesh, front, touched, place_on_cut).separated_faces();
    std::erase_if(faces, [&](FaceId f) { return is_frozen(mesh, front, f); });
    return faces;
}

}  // namespace incise::cutting
