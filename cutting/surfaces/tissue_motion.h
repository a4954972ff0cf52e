// What a tool sees of the body during one step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"
#include "incise/topology/spatial/element_boxes.h"

namespace incise::cutting {

/// The body over one step: nodes move straight from `before` to `after` (m, by node id).
struct TissueMotion {
    const topology::Mesh& mesh;
    std::span<const Vec3> before, after;
    /// Find what is near without looking at the whole body; none: look at all of it.
    const topology::ElementBoxes* boxes = nullptr;

    /// Calls visit(element), in ascending order, for the living elements for whose box, and for
    /// every box round it, may_meet(box) holds.
    template <class MayMeet, class Visit>
    void for_each_near(MayMeet may_meet, Visit visit) const {
        const auto look_at = [&](ElementId e) {
            if (may_meet(box(e))) visit(e);
        };
        if (boxes) {
            boxes->for_each_near(mesh, may_meet, look_at);
            return;
        }
        for (const ElementId e : mesh.elements()) look_at(e);
    }

    /// False only if no element comes into what is swept in the step. Without boxes: true.
    bool may_meet(const Box& swept) const { return !boxes || boxes->may_meet(swept); }

    /// Mean of an element's corners.
    static Vec3 centre(const topology::Mesh& mesh, ElementId e, std::span<const Vec3> positions) {
        Vec3 sum = Vec3::Zero();
        const auto corners = mesh.corners(e);
        for (const auto n : corners) sum += positions[n.index()];
        return sum / static_cast<double>(corners.size());
    }

    /// Holds the element throughout the step.
    Box box(ElementId e) const {
        Box box;
        for (const auto n : mesh.corners(e)) {
            box.extend(before[n.index()]);
            box.extend(after[n.index()]);
        }
        return box;
    }
};

}  // namespace incise::cutting
