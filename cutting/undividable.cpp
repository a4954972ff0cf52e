// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/undividable.h"

#include <array>
#include <span>
#include <vector>

#include "cutting/edge_list.h"

namespace incise::cutting {

using topology::CellKind;
using topology::ElementId;
using topology::Mesh;
using topology::NodeId;

void refuse_to_divide(const Mesh& mesh, ElementId e) {
    throw UndividableElement("element " + std::to_string(mesh.label(e)) + " is a " +
                             topology::traits(mesh.kind(e)).name +
                             ", and only tetrahedra can be split");
}

std::optional<ElementId> first_undividable(const Mesh& mesh, const CutSurface& surface) {
    std::vector<Crossing> crossings;
    for (const ElementId e : mesh.elements()) {
        if (mesh.kind(e) == CellKind::tetrahedron) continue;
        const auto corners = mesh.corners(e);
        const auto at_rest = [&](NodeId n) {
            return MovingPoint{mesh.rest_position(n), mesh.rest_position(n)};
        };
        std::array<MovingPoint, topology::max_corners> points;
        Box box;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            points[k] = at_rest(corners[k]);
            box.extend(points[k][0]);
        }
        if (!surface.may_meet(box) ||
            !surface.may_meet_hull(std::span(points).first(corners.size())))
            continue;
        const topology::CellTraits& t = topology::traits(mesh.kind(e));
        for (int k = 0; k < t.num_edges; ++k) {
            const auto [p, q] = t.edges[static_cast<std::size_t>(k)];
            // In the direction in which the cut asks, so that ties are decided as there.
            const Edge edge = edge_between(corners[static_cast<std::size_t>(p)],
                                           corners[static_cast<std::size_t>(q)]);
            surface.append_crossings(at_rest(edge.a), at_rest(edge.b), crossings);
            if (!crossings.empty()) return e;
        }
    }
    return std::nullopt;
}

}  // namespace incise::cutting
