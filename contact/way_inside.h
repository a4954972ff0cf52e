// Straight ways through a deformed body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::contact {

/// True if the straight way from a triangle of the surface to a point behind it stays within the
/// body, and the point is not on its surface. Faces with more corners count as the triangles into
/// which topology::for_each_triangle() divides them. Cost: O(1) in the elements along the way.
/// @param positions  present ones, by vertex id, m
/// @param face       of the triangle, on the boundary
/// @param triangle   its nodes
/// @param weights    of the corners at the point where the way begins. It is moved a little towards
///                   the middle: along an edge of the mesh, rounding would decide.
bool is_way_inside(const topology::Mesh& mesh, std::span<const Vec3> positions, FaceId face,
                   const std::array<VertexId, 3>& triangle, const Vec3& weights, const Vec3& to);

}  // namespace incise::contact
