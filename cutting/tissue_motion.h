// What a tool sees of the body during one step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "topology/mesh.h"
#include "topology/types.h"

namespace incise::cutting {

using Box = Eigen::AlignedBox3d;

/// The body over one step: nodes move straight from `before` to `after` (m, by node id).
struct TissueMotion {
    const topology::Mesh& mesh;
    std::span<const Vec3> before, after;

    /// Mean of an element's corners.
    static Vec3 centre(const topology::Mesh& mesh, topology::ElementId e,
                       std::span<const Vec3> positions) {
        Vec3 sum = Vec3::Zero();
        const auto corners = mesh.corners(e);
        for (const auto n : corners) sum += positions[n.index()];
        return sum / static_cast<double>(corners.size());
    }

    /// Holds the element throughout the step.
    Box box(topology::ElementId e) const {
        Box box;
        for (const auto n : mesh.corners(e)) {
            box.extend(before[n.index()]);
            box.extend(after[n.index()]);
        }
        return box;
    }
};

}  // namespace incise::cutting
