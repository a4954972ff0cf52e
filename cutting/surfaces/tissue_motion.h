// The positions of the tissue during one step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"
#include "incise/topology/spatial/element_boxes.h"

namespace incise::cutting {

/// The body during one step. Nodes move straight from `before` to `after`, m, by vertex id.
/// @lifetime  the mesh, the positions and the boxes must outlive the object; rest_positions() of a
/// mesh
///            that is cut do not, as it takes more memory for its nodes
struct TissueMotion {
    const topology::Mesh& mesh;
    std::span<const Vec3> before, after;
    /// Boxes for the search of elements; if null, a search visits all elements.
    const topology::ElementBoxes* boxes = nullptr;
    /// True if no node of the body moves in the step, to rounding, though some may count as
    /// elsewhere than before.
    bool is_at_rest = false;

    /// Calls visit(element) in ascending order for living elements. Visits those for which
    /// may_meet(box) is true, both for their own box and for every box round it.
    template <class MayMeet, class Visit>
    void for_each_near(MayMeet may_meet, Visit visit) const {
        const auto look_at = [&](CellId e) {
            if (may_meet(box(e))) visit(e);
        };
        if (boxes) {
            boxes->for_each_near(mesh, may_meet, look_at);
            return;
        }
        for (const CellId e : mesh.elements()) look_at(e);
    }

    /// Returns false only if no element is in the box `swept` at any time of the step. Without
    /// boxes it returns true.
    bool may_meet(const Box& swept) const { return !boxes || boxes->may_meet(swept); }

    /// Returns the mean of the corners of an element.
    static Vec3 centre(const topology::Mesh& mesh, CellId e, std::span<const Vec3> positions) {
        Vec3 sum = Vec3::Zero();
        const auto corners = mesh.corners(e);
        for (const auto n : corners) sum += positions[n.index()];
        return sum / static_cast<double>(corners.size());
    }

    /// Returns a box that contains the element throughout the step.
    Box box(CellId e) const {
        Box box;
        for (const auto n : mesh.corners(e)) {
            box.extend(before[n.index()]);
            box.extend(after[n.index()]);
        }
        return box;
    }
};

}  // namespace incise::cutting
