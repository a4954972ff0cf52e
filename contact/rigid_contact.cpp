// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/rigid_contact.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "incise/base/error.h"
#include "incise/contact/way_inside.h"
#include "incise/cutting/tools/probe_shape.h"
#include "incise/cutting/tools/solid.h"

namespace incise::contact {

namespace {

// Lengths are parts of the mean length of an element.
constexpr double probe_reach =
    0.3;  // at which a point counts: farther than anything moves in a step
constexpr double probe_skin =
    0.5;  // by which triangles are found that are not within probe_reach yet
constexpr double deep_overlap = 0.02;  // below which one is looked at twice

}  // namespace

RigidContact::RigidContact(cutting::Probe probe, double size)
    : probe_(std::move(probe)), size_(size), reach_(cutting::reach_of(probe_.shape)) {
    if (const auto* solid = std::get_if<cutting::Solid>(&probe_.shape))
        solid_ = std::make_shared<const RigidSolid>(*solid);
    if (const auto* box = std::get_if<cutting::Cuboid>(&probe_.shape))
        solid_ = std::make_shared<const RigidSolid>(cutting::solid_of(*box));
}

RigidContact::Feature RigidContact::feature_of(const Triangle& triangle, const RigidTouch& touch) {
    constexpr double rounding = 1e-9;
    Feature feature{{}, touch.tool_feature};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k)
        if (touch.weights[static_cast<int>(k)] > rounding) feature.corners[count++] = triangle[k];
    std::ranges::sort(feature.corners);
    return feature;
}

/// Returns the largest distance by which a point of the tool moves in the step, m, at most.
double RigidContact::largest_move() const {
    return (after_.position - before_.position).norm() +
           reach_ * before_.rotation.angularDistance(after_.rotation);
}

void RigidContact::find_triangles(std::span<const Vec3> positions, const TissueSurface& surface) {
    const Box of_shape = cutting::box_of(probe_.shape);
    const double margin = (probe_reach + probe_skin) * size_;
    triangles_.clear();
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        Box box;
        for (const VertexId n : surface.triangles[t])
            box.extend(before_.to_tool(positions[n.index()]));
        const Vec3 more = Vec3::Constant(margin);
        if (Box(box.min() - more, box.max() + more).intersects(of_shape)) triangles_.push_back(t);
    }
    room_ = probe_skin * size_;
}

/// True if a point or an edge of the tool is behind a triangle, but not in the tissue: that ends
/// before.
bool RigidContact::is_beyond_tissue(const RigidTouch& touch, std::uint32_t t,
                                    const physics::Model& model,
                                    const TissueSurface& surface) const {
    if (touch.tool_feature < 0 || touch.gap >= -deep_overlap * size_) return false;
    return !is_way_inside(model.mesh(), model.mesh_positions(), surface.faces[t],
                          surface.triangles[t], touch.weights, before_.to_world(touch.point));
}

void RigidContact::add_points(const physics::Model& model, const TissueSurface& surface, double dt,
                              ContactSolver& solver) {
    const std::span<const Vec3> positions = model.mesh_positions();
    // What has moved since the last step: the tissue in it, and the tool in this one at most.
    room_ -= model.largest_mesh_move() + largest_move();
    if (room_ < 0.0) find_triangles(positions, surface);
    max_penetration_ = 0.0;
    first_point_ = solver.size();
    places_.clear();
    features_.clear();
    regions_.clear();
    std::map<Feature, std::pair<RigidTouch, std::uint32_t>> touches;
    for (const std::uint32_t t : triangles_) {
        const Triangle& triangle = surface.triangles[t];
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = before_.to_tool(positions[triangle[k].index()]);
        found_.clear();
        if (solid_)
            solid_->append_touches(corners, probe_reach * size_, found_);
        else
            append_touches(probe_.shape, corners, probe_reach * size_, found_);
        for (const RigidTouch& touch : found_) {
            if (is_beyond_tissue(touch, t, model, surface)) continue;
            const auto [it, is_new] = touches.try_emplace(feature_of(triangle, touch), touch, t);
            if (!is_new && touch.gap < it->second.first.gap) it->second = {touch, t};
        }
    }
    for (const auto& [feature, found] : touches) {
        const auto& [touch, t] = found;
        ContactPoint point;
        point.normal = before_.rotation * touch.normal;
        point.gap = touch.gap;
        point.friction = probe_.friction;
        const Vec3 here = before_.to_world(touch.point);
        point.velocity = (after_.to_world(touch.point) - here) / dt;
        max_penetration_ = std::max(max_penetration_, -touch.gap);
        point.impulse = last_impulse_at(feature);
        places_.push_back(here);
        features_.push_back(feature);
        regions_.push_back(model.mesh().region(surface.faces[t].cell));
        solver.begin(point);
        const auto& [a, b, c] = surface.triangles[t];
        const Vec3& weights = touch.weights;
        add_surface_weights(model, {{a, b, c, {}}, {weights[0], weights[1], weights[2], 0.0}},
                            solver);
    }
}

/// Returns the impulse of a point in the step before, N s; zero if it was not there.
Vec3 RigidContact::last_impulse_at(const Feature& feature) const {
    const auto it = std::ranges::lower_bound(last_features_, feature);
    if (it == last_features_.end() || *it != feature) return Vec3::Zero();
    return last_impulses_[static_cast<std::size_t>(it - last_features_.begin())];
}

ToolImpulse RigidContact::take_impulses(const ContactSolver& solver, double dt) {
    ToolImpulse sum;
    points_.clear();
    last_features_.clear();
    last_impulses_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const Vec3& impulse = solver.impulse(first_point_ + i);
        if (impulse.isZero(0.0)) continue;
        last_features_.push_back(features_[i]);
        last_impulses_.push_back(impulse);
        sum.force += impulse;
        sum.torque += (places_[i] - before_.position).cross(impulse);
        const ContactPoint& point = solver.point(first_point_ + i);
        sum.work += impulse.dot(point.velocity);
        const Vec3 force = -impulse / dt, along = force.dot(point.normal) * point.normal;
        points_.push_back(
            {places_[i], -point.normal, -point.gap, along, force - along, regions_[i]});
    }
    return sum;
}

void RigidContact::restore(ArchiveReader& ar, const TissueSurface& surface) {
    const std::size_t num_triangles = surface.triangles.size();
    list(ar, *this);
    const bool fits =
        std::ranges::all_of(triangles_, [&](std::uint32_t t) { return t < num_triangles; }) &&
        std::isfinite(room_) && last_features_.size() == last_impulses_.size() &&
        std::ranges::is_sorted(last_features_) &&
        std::ranges::all_of(last_impulses_, [](const Vec3& v) { return v.allFinite(); });
    if (!fits) throw InputError("its tools touch another body");
}

}  // namespace incise::contact
