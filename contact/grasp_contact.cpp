// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/grasp_contact.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <variant>
#include <vector>

#include "incise/base/error.h"
#include "incise/contact/rigid_touch.h"
#include "incise/contact/surface_contact.h"

namespace incise::contact {

namespace {

/// Tissue that has slipped farther out of the jaws than that is let go, over the size of an
/// element.
constexpr double let_go_at = 0.5;
/// A point slips where its force is this share of the largest one.
constexpr double slips_at = 0.999;

double distance_from(const cutting::CarverShape& jaws, const Vec3& x) {
    if (const auto* ball = std::get_if<cutting::Sphere>(&jaws)) return x.norm() - ball->radius;
    if (const auto* box = std::get_if<cutting::Cuboid>(&jaws))
        return (x.cwiseAbs() - 0.5 * box->size).cwiseMax(0.0).norm();
    const auto& capsule = std::get<cutting::Capsule>(jaws);
    const Vec3 along = capsule.to - capsule.from;
    const double length = along.squaredNorm();
    const double at =
        length > 0.0 ? std::clamp(along.dot(x - capsule.from) / length, 0.0, 1.0) : 0.0;
    return (x - capsule.from - at * along).norm() - capsule.radius;
}

/// Returns the middle of the part of a triangle that is in a box; nothing if there is none.
/// Source: Sutherland and Hodgman 1974.
std::optional<Vec3> middle_within(const cutting::Cuboid& box, const std::array<Vec3, 3>& triangle) {
    std::vector<Vec3> polygon(triangle.begin(), triangle.end()), rest;
    for (const int axis : {0, 1, 2})
        for (const double side : {-1.0, 1.0}) {
            const auto beyond = [&](const Vec3& x) {
                return side * x[axis] - 0.5 * box.size[axis];
            };
            rest.clear();
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Vec3 &x = polygon[i], &next = polygon[(i + 1) % polygon.size()];
                const double here = beyond(x), there = beyond(next);
                if (here <= 0.0) rest.push_back(x);
                if ((here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0))
                    rest.push_back(x + here / (here - there) * (next - x));
            }
            polygon.swap(rest);
        }
    if (polygon.empty()) return std::nullopt;
    Vec3 sum = Vec3::Zero();
    for (const Vec3& x : polygon) sum += x;
    return sum / static_cast<double>(polygon.size());
}

}  // namespace

Vec3 GraspContact::position_of(const Gripped& gripped, std::span<const Vec3> positions) const {
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
        x += gripped.weights[static_cast<int>(k)] * positions[gripped.nodes[k].index()];
    return x;
}

void GraspContact::close(const physics::Model& model, const TissueSurface& surface,
                         const Pose& pose) {
    const std::span<const Vec3> positions = model.mesh_positions();
    gripped_.clear();
    std::map<VertexId, int> nodes;  // with their regions
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (const VertexId n : surface.triangles[t]) {
            const Vec3 x = pose.to_tool(positions[n.index()]);
            if (cutting::meets(grasper_.jaws, x, x))
                nodes.emplace(n, model.mesh().region(surface.faces[t].cell));
        }
    for (const auto& [n, region] : nodes)
        gripped_.push_back({{n, n, n}, Vec3::UnitX(), pose.to_tool(positions[n.index()]), region});
    if (!gripped_.empty()) return;
    // Jaws between nodes hold a point of each triangle that they meet.
    const auto* box = std::get_if<cutting::Cuboid>(&grasper_.jaws);
    const cutting::ProbeShape shape =
        std::visit([](const auto& one) { return cutting::ProbeShape(one); }, grasper_.jaws);
    std::vector<RigidTouch> touches;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Triangle& triangle = surface.triangles[t];
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = pose.to_tool(positions[triangle[k].index()]);
        touches.clear();
        if (!box) append_touches(shape, corners, 0.0, touches);
        if (const auto middle = box ? middle_within(*box, corners) : std::nullopt)
            touches.push_back({closest_weights(corners, *middle), *middle, Vec3::Zero()});
        for (const RigidTouch& touch : touches) {
            // A point on an edge belongs to several triangles. The two sides of a closed cut have
            // points at the same place, and no common nodes.
            const bool is_known = std::ranges::any_of(gripped_, [&](const Gripped& gripped) {
                return (gripped.place - touch.point).norm() < 1e-9 * size_ &&
                       std::ranges::find_first_of(gripped.nodes, triangle) != gripped.nodes.end();
            });
            if (!is_known)
                gripped_.push_back({triangle, touch.weights, touch.point,
                                    model.mesh().region(surface.faces[t].cell)});
        }
    }
}

void GraspContact::follow(const physics::Model& model) {
    std::erase_if(gripped_, [&](const Gripped& gripped) {
        return std::ranges::any_of(gripped.nodes,
                                   [&](VertexId n) { return !model.mesh().is_alive(n); });
    });
}

void GraspContact::add_points(const physics::Model& model, const TissueSurface& /*surface*/,
                              double dt, ContactSolver& solver) {
    const std::span<const Vec3> positions = model.mesh_positions();
    first_point_ = solver.size();
    for (Gripped& gripped : gripped_) {
        const Vec3 x = position_of(gripped, positions), here = before_.to_world(gripped.place);
        ContactPoint point;
        point.is_bilateral = true;
        point.offset = x - here;
        point.velocity = (after_.to_world(gripped.place) - here) / dt;
        point.impulse = gripped.impulse;
        point.largest_force = grasper_.max_force / static_cast<double>(gripped_.size());
        solver.begin(point);
        const auto& [a, b, c] = gripped.nodes;
        const Vec3& weights = gripped.weights;
        add_surface_weights(model, {{a, b, c, {}}, {weights[0], weights[1], weights[2], 0.0}},
                            solver);
    }
}

ToolImpulse GraspContact::take_impulses(const ContactSolver& solver, double dt) {
    ToolImpulse sum;
    points_.clear();
    for (std::size_t i = 0; i < gripped_.size(); ++i) {
        Gripped& gripped = gripped_[i];
        const ContactPoint& point = solver.point(first_point_ + i);
        gripped.impulse = solver.impulse(first_point_ + i);
        sum.force += gripped.impulse;
        sum.torque += (before_.to_world(gripped.place) - before_.position).cross(gripped.impulse);
        sum.work += gripped.impulse.dot(point.velocity);
        if (!gripped.impulse.isZero(0.0))
            points_.push_back({before_.to_world(gripped.place), Vec3::Zero(), 0.0, Vec3::Zero(),
                               -gripped.impulse / dt, gripped.region});
        // A point that slips is held where it has come to.
        if (gripped.impulse.norm() >= slips_at * point.largest_force * dt)
            gripped.place = before_.to_tool(before_.to_world(gripped.place) + point.offset);
    }
    std::erase_if(gripped_, [&](const Gripped& gripped) {
        return distance_from(grasper_.jaws, gripped.place) > let_go_at * size_;
    });
    return sum;
}

void GraspContact::restore(ArchiveReader& ar, const physics::Model& model) {
    list(ar, *this);
    for (const Gripped& gripped : gripped_) {
        const bool fits = gripped.weights.allFinite() && gripped.place.allFinite() &&
                          gripped.impulse.allFinite() &&
                          std::ranges::all_of(gripped.nodes, [&](VertexId n) {
                              return n.is_valid() && n.index() < model.mesh().node_capacity() &&
                                     model.mesh().is_alive(n);
                          });
        if (!fits) throw InputError("a grasper holds another body");
    }
}

}  // namespace incise::contact
