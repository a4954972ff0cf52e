// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/suture_contact.h"

#include <algorithm>
#include <cmath>

#include "incise/base/error.h"

namespace incise::contact {

namespace {

/// A thread tears where its tension is this share of the largest one.
constexpr double tears_at = 0.999;
/// A thread between two points is drawn to no less than this part of the size of an element. Where
/// they meet, its direction is not known: it would turn from step to step, and do work each time.
constexpr double shortest = 0.1;

double length_of(std::span<const Vec3> way) {
    double sum = 0.0;
    for (std::size_t i = 1; i < way.size(); ++i) sum += (way[i] - way[i - 1]).norm();
    return sum;
}

}  // namespace

std::vector<Vec3> SutureContact::way(const physics::Model& model) const {
    std::vector<Vec3> points;
    for (const Stitch& stitch : stitches_)
        points.push_back(stitch.at.position(model.mesh(), model.mesh_positions()));
    return points;
}

void SutureContact::tie(const physics::Model& model) {
    const topology::Mesh& mesh = model.mesh();
    stitches_.clear();
    const double reach = suture_.reach > 0.0 ? suture_.reach : size_;
    for (const Vec3& x : suture_.points)
        if (const auto at = topology::find_point(mesh, mesh.rest_positions(), x, reach))
            stitches_.push_back({at->position(mesh, mesh.rest_positions()), *at});
    length_before_ = length_ = length_of(way(model));
    impulse_ = 0.0;
}

void SutureContact::follow(const physics::Model& model) {
    const topology::Mesh& mesh = model.mesh();
    std::erase_if(stitches_, [&](Stitch& stitch) {
        // A cut divides a cell. One of the parts keeps the name of the cell, and the point may be
        // in another one.
        constexpr double rounding = 1e-6;
        const auto rest = mesh.rest_positions();
        if (mesh.is_alive(stitch.at.cell) &&
            (stitch.at.position(mesh, rest) - stitch.rest).norm() <= 1e-9 * size_)
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
    const double length = length_of(points);
    std::vector<Vec3> gradients(points.size(), Vec3::Zero());
    for (std::size_t i = 1; i < points.size(); ++i) {
        const Vec3 step = points[i] - points[i - 1];
        const double distance = step.norm();
        if (!(distance > 0.0)) continue;
        gradients[i] += step / distance;
        gradients[i - 1] -= step / distance;
    }
    is_in_solver_ = true;
    thread_ = solver.num_threads();
    direction_ = -gradients.front();
    const double least = shortest * size_ * static_cast<double>(points.size() - 1);
    const double before = std::max(length_before_, least), now = std::max(length_, least);
    solver.begin_thread({.stretch = length - before,
                         .rest_rate = (now - before) / dt,
                         .stiffness = suture_.stiffness,
                         .largest_force = suture_.max_force,
                         .impulse = impulse_});
    for (std::size_t i = 0; i < points.size(); ++i) {
        const topology::CellPoint& at = stitches_[i].at;
        const auto corners = model.mesh().corners(at.cell);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const topology::Embedding& node = model.embedded_nodes()[corners[k]];
            for (std::size_t j = 0; j < static_cast<std::size_t>(node.count); ++j)
                solver.add_pull(node.nodes[j], at.weights[k] * node.weights[j] * gradients[i]);
        }
    }
    length_before_ = length_;
}

ToolImpulse SutureContact::take_impulses(const ContactSolver& solver, double dt) {
    if (!is_in_solver_) return {};
    impulse_ = solver.thread_impulse(thread_);
    ToolImpulse done;
    done.force = impulse_ * direction_;
    done.work = -impulse_ * solver.lengthening(thread_);
    if (impulse_ >= tears_at * suture_.max_force * dt) stitches_.clear();
    return done;
}

void SutureContact::restore(ArchiveReader& ar, const physics::Model& model) {
    list(ar, *this);
    const auto is_sound = [&](const Stitch& stitch) {
        const ElementId e = stitch.at.cell;
        return stitch.rest.allFinite() && e.is_valid() &&
               e.index() < model.mesh().element_capacity() && model.mesh().is_alive(e) &&
               std::ranges::all_of(stitch.at.weights,
                                   [](double w) { return w >= 0.0 && w <= 1.0; });
    };
    const bool has_lengths = length_ >= 0.0 && length_before_ >= 0.0 && impulse_ >= 0.0 &&
                             std::isfinite(length_ + length_before_ + impulse_);
    if (!std::ranges::all_of(stitches_, is_sound) || !has_lengths)
        throw InputError("a thread passes through another body");
}

}  // namespace incise::contact
