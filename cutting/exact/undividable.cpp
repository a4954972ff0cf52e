// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/undividable.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "incise/cutting/exact/edge_list.h"

namespace incise::cutting {

using topology::CellKind;
using topology::Mesh;

CutMode usual_mode(const Mesh& mesh) {
    for (const CellId e : mesh.elements())
        if (mesh.kind(e) != CellKind::tetrahedron) return CutMode::separate;
    return CutMode::split;
}

void refuse_to_divide(const Mesh& mesh, CellId e) {
    throw UndividableElement("element " + std::to_string(mesh.label(e)) + " is a " +
                                 topology::traits(mesh.kind(e)).name +
                                 ", and only tetrahedra can be split",
                             e);
}

namespace {

/// An element at rest that is no tetrahedron.
class RestingElement {
  public:
    RestingElement(const Mesh& mesh, CellId e)
        : traits_(topology::traits(mesh.kind(e))), corners_(mesh.corners(e)) {
        for (std::size_t k = 0; k < corners_.size(); ++k)
            points_[k] = mesh.rest_position(corners_[k]);
        outwards_.fill(Vec3::Zero());
        for (int k = 0; k < traits_.num_edges; ++k) {
            const auto [p, q] = ends_of_edge(k);
            const Vec3 edge = points_[q] - points_[p];
            const double length = edge.norm();
            mean_edge_ += length / traits_.num_edges;
            if (length == 0.0) continue;
            outwards_[p] -= edge / length;
            outwards_[q] += edge / length;
        }
    }

    double mean_edge() const { return mean_edge_; }

    /// True if the surface passes through an edge of the element after its faces were moved
    /// outwards by `distance`, m. If its angles are not right ones, the distance is approximate.
    bool is_crossed_by(const CutSurface& surface, double distance) const {
        std::array<MovingPoint, topology::max_corners> points;
        Box box;
        for (std::size_t k = 0; k < corners_.size(); ++k) {
            const Vec3 x = points_[k] + distance * outwards_[k];
            points[k] = {x, x};
            box.extend(x);
        }
        if (!surface.may_meet(box) ||
            !surface.may_meet_hull(std::span(points).first(corners_.size())))
            return false;
        std::vector<Crossing> crossings;
        for (int k = 0; k < traits_.num_edges; ++k) {
            const auto [p, q] = ends_of_edge(k);
            // The direction is that in which the cut looks for intersections, so that zeros are
            // decided alike.
            const bool is_forward = corners_[p] < corners_[q];
            surface.append_crossings(points[is_forward ? p : q], points[is_forward ? q : p],
                                     crossings);
            if (!crossings.empty()) return true;
        }
        return false;
    }

  private:
    std::pair<std::size_t, std::size_t> ends_of_edge(int k) const {
        const auto [p, q] = traits_.edges[static_cast<std::size_t>(k)];
        return {static_cast<std::size_t>(p), static_cast<std::size_t>(q)};
    }

    const topology::CellTraits& traits_;
    std::span<const VertexId> corners_;
    std::array<Vec3, topology::max_corners> points_;
    std::array<Vec3, topology::max_corners> outwards_;  // by corner, for faces moved by 1
    double mean_edge_ = 0.0;
};

/// Returns how far the faces of the element must be moved outwards until the surface crosses it, m.
/// @pre  the surface crosses it at `limit`, and not at 0
double distance_to(const RestingElement& element, const CutSurface& surface, double limit) {
    double low = 0.0, high = limit;
    constexpr int num_halvings = 20;  // to a millionth of the limit
    for (int i = 0; i < num_halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (element.is_crossed_by(surface, middle) ? high : low) = middle;
    }
    return low;
}

}  // namespace

std::optional<CellId> first_undividable(const Mesh& mesh, const CutSurface& surface) {
    for (const CellId e : mesh.elements())
        if (mesh.kind(e) != CellKind::tetrahedron &&
            RestingElement(mesh, e).is_crossed_by(surface, 0.0))
            return e;
    return std::nullopt;
}

void add_near_misses(const Mesh& mesh, const CutSurface& surface, double margin,
                     NearMisses& found) {
    for (const CellId e : mesh.elements()) {
        if (mesh.kind(e) == CellKind::tetrahedron) continue;
        const RestingElement element(mesh, e);
        const double limit = margin * element.mean_edge();
        if (!element.is_crossed_by(surface, limit)) continue;
        found.elements.insert(e);
        // If it is as near as the nearest to rounding, no exact distance is needed.
        const double nearer = std::min(limit, 0.999 * found.distance);
        if (nearer < limit && (nearer == 0.0 || !element.is_crossed_by(surface, nearer))) continue;
        found.distance = distance_to(element, surface, nearer);
        found.nearest = e;
    }
}

}  // namespace incise::cutting
