// An exact cut along a plane, made of divisions and opened faces only: for tests of what follows.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::test {

/// Divides all tetrahedra that the plane through `point` crosses, and opens the faces on it.
/// @param open  whether a face on the plane, given by its centre at rest, is to be opened
topology::ChangeSet cut_along_plane(
    topology::Mesh& mesh, const Vec3& point, const Vec3& normal,
    const std::function<bool(const Vec3&)>& open = [](const Vec3&) { return true; });

}  // namespace incise::test
