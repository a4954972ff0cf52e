// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/suture_contact.h"

#include <algorithm>
#include <cmath>

#include "incise/base/error.h"

namespace incise::contact {

namespace {

/// A thread tears where its tension is this share of the largest one.
constexpr double tears_at = 0.999;
double length_of(std::span<const Vec3> way) {
    double sum = 0.0;
    for (std::size_t i = 1; i < way.size(); ++i) sum += (way[i] - way[i - 1]).norm();
    return sum;
}

}  // namespace

std::vector<Vec3> SutureContact::way(const physics::Model& model) const {
    std::vector<Vec3> points;
    for (const Stitch& stitch : stitches_)
        points.push_back(stitch.at.position(model.mesh_positions()));
    return points;
}

void SutureContact::tie(const physics::Model& model) {
    const topology::Mesh& mesh = model.mesh();
    stitches_.clear();
    const double reach = suture_.reach > 0.0 ? suture_.reach : size_;
    for (const Vec3& x : suture_.points)
        if (const auto at = topology::find_point(mesh, mesh.rest_positions(), x, reach))
            stitches_.push_back({at->position(mesh.rest_positions()), *at});
    length_ = length_of(way(model));
    tension_ = 0.0;
}

namespace {

/// Names the present corners of the cell: an edit can have replaced some by copies. Returns false
/// if the cell has lost one.
bool follow_corners(const topology::Mesh& mesh, topology::CellPoint& at) {
    const auto corners = mesh.corners(at.cell);
    for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k) {
        if (std::ranges::find(corners, at.corners[k]) != corners.end()) continue;
        const auto copy = std::ranges::find_if(corners, [&](VertexId n) {
            return mesh.rest_position(n) == mesh.rest_position(at.corners[k]);
        });
        if (copy == corners.end()) return false;
        at.corners[k] = *copy;
    }
    return true;
}

}  // namespace

void SutureContact::follow(const physics::Model& model) {
    const topology::Mesh& mesh = model.mesh();
    std::erase_if(stitches_, [&](Stitch& stitch) {
        // A cut divides a cell. One of the parts keeps the name of the cell, and the point may be
        // in another one.
        constexpr double rounding = 1e-6;
        const auto rest = mesh.rest_positions();
        if (mesh.is_alive(stitch.at.cell) && follow_corners(mesh, stitch.at) &&
            (stitch.at.position(rest) - stitch.rest).norm() <= 1e-9 * size_)
            return false;
        const auto at = topology::find_point(mesh, rest, stitch.rest, rounding * size_);
        if (at) stitch.at = *at;
        return !at;
    });
}

void SutureContact::add_points(const physics::Model& model, const TissueSurface& /*surface*/,
                               double dt, ContactSolver& solver) {
    is_in_solver_ = false;
    if (stitches_.size() < 2) return;
    const std::vector<Vec3> points = way(model);
    is_in_solver_ = true;
    thread_ = solver.num_threads();
    first_segment_ = solver.size();
    solver.begin_thread({length_, suture_.stiffness, suture_.max_force, tension_ * dt});
    const auto add_end = [&](const topology::CellPoint& at, double sign) {
        model.structure().embedding().for_each(
            at, [&](NodeId node, double weight) { solver.add_weight(node, sign * weight); });
    };
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        solver.begin_segment(points[i + 1] - points[i], stitches_[i].force * dt);
        add_end(stitches_[i].at, -1.0);
        add_end(stitches_[i + 1].at, 1.0);
    }
}

ToolImpulse SutureContact::take_impulses(const ContactSolver& solver, double dt) {
    if (!is_in_solver_) return {};
    tension_ = solver.thread_impulse(thread_) / dt;
    ToolImpulse done;
    for (std::size_t i = 0; i + 1 < stitches_.size(); ++i) {
        const Vec3& impulse = solver.impulse(first_segment_ + i);
        done.work += impulse.dot(solver.velocity(first_segment_ + i));
        stitches_[i].force = impulse / dt;
    }
    done.force = -solver.impulse(first_segment_);
    if (tension_ >= tears_at * suture_.max_force) stitches_.clear();
    return done;
}

void SutureContact::restore(ArchiveReader& ar, const physics::Model& model) {
    list(ar, *this);
    const auto is_sound = [&](const Stitch& stitch) {
        const CellId e = stitch.at.cell;
        return stitch.rest.allFinite() && stitch.force.allFinite() && e.is_valid() &&
               e.index() < model.mesh().element_capacity() && model.mesh().is_alive(e) &&
               std::ranges::all_of(stitch.at.weights,
                                   [](double w) { return w >= 0.0 && w <= 1.0; });
    };
    const bool has_lengths = length_ >= 0.0 && tension_ >= 0.0 && std::isfinite(length_ + tension_);
    if (!std::ranges::all_of(stitches_, is_sound) || !has_lengths)
        throw InputError("a thread passes through another body");
}

}  // namespace incise::contact
