// Straight ways through a deformed body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::contact {

/// True if the straight way from a point of a face to a point behind it stays within the body.
/// Faces with four corners count as two triangles. Cost: O(1) in the elements along the way.
/// @param face       on the boundary
/// @param from       a point of the face, m
/// @param positions  present ones, by node id, m
bool is_way_inside(const topology::Mesh& mesh, std::span<const Vec3> positions, FaceId face,
                   const Vec3& from, const Vec3& to);

}  // namespace incise::contact
