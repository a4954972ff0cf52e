// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/blade_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "incise/base/error.h"
#include "incise/contact/surface_contact.h"
#include "incise/topology/geometry.h"

namespace incise::contact {

namespace {

// Lengths are parts of the mean length of an element.
constexpr double longest_piece = 0.125;
constexpr double least_motion = 1e-12;  // a blade that moves by less stands still
/// A piece that is nearer to the surface opens nothing: it is in a cut that is there already.
constexpr double surface_layer = 0.03;
/// A smaller face has no area, but for rounding. It is a part of the square of its width.
constexpr double least_area = 1e-10;

/// True if a point is at most so far from a face of its cell that belongs to the surface.
bool is_at_surface(const topology::Mesh& mesh, std::span<const Vec3> positions,
                   const topology::CellPoint& at, const Vec3& x, double distance) {
    for (int f = 0; f < mesh.num_faces(at.cell); ++f) {
        if (mesh.neighbor({at.cell, f}).is_valid()) continue;
        const int size = mesh.face_size({at.cell, f});
        const auto corner = [&](int k) -> const Vec3& {
            return positions[mesh.face_corner({at.cell, f}, k).index()];
        };
        Vec3 middle = Vec3::Zero();
        double width = 0.0;
        for (int k = 0; k < size; ++k) {
            middle += corner(k) / size;
            width = std::max(width, (corner(k) - corner(0)).norm());
        }
        const Vec3 area = topology::area_vector(size, corner);
        if (!(area.norm() > least_area * width * width)) continue;  // it has no plane
        if (std::abs(area.dot(x - middle)) <= distance * area.norm()) return true;
    }
    return false;
}

}  // namespace

std::string fault_of_toughness(const cutting::Blade& blade, const physics::MaterialTable& materials,
                               double size) {
    if (blade.cutting_force == cutting::CuttingForce::report) return "";
    constexpr double largest_dent = 1.5;  // of an element
    double young = std::numeric_limits<double>::infinity();
    for (const physics::Material& material : materials.materials)
        young = std::min(young, physics::young_at_rest(material));
    const double largest = largest_dent * young * size;
    if (blade.toughness <= largest) return "";
    std::ostringstream text;
    text << "a toughness of " << blade.toughness << " J/m2 cannot be applied: up to " << largest
         << " J/m2 the softest material bears it at elements of " << size
         << " m; use larger elements, a lower toughness, or report the force";
    return text.str();
}

BladeContact::BladeContact(cutting::Blade blade, double size)
    : blade_(std::move(blade)), size_(size) {
    for (std::size_t i = 1; i < blade_.edge.size(); ++i) {
        const Vec3 &from = blade_.edge[i - 1], way = blade_.edge[i] - from;
        const double count = std::ceil(way.norm() / (longest_piece * size_));
        for (double k = 0.5; k < count; k += 1.0)
            pieces_.push_back({from + k / count * way, way / count});
    }
    directions_.resize(pieces_.size(), Vec3::Zero());
    impulses_.resize(pieces_.size(), 0.0);
}

void BladeContact::move(const physics::Model& model, const Pose& before, const Pose& after,
                        const TissueAt& tissue_at) {
    before_ = before;
    cutting_.clear();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const Vec3 x = before.to_world(pieces_[i].middle);
        const Vec3 motion = after.to_world(pieces_[i].middle) - x;
        if (const double distance = motion.norm(); distance > least_motion * size_)
            directions_[i] = motion / distance;
        if (directions_[i].isZero(0.0)) continue;
        const auto tissue = tissue_at(x);
        if (!tissue ||
            is_at_surface(model.mesh(), model.mesh_positions(), *tissue, x, surface_layer * size_))
            continue;
        const double width = (before.rotation * pieces_[i].along).cross(directions_[i]).norm();
        cutting_.push_back({i, *tissue, x, motion, width});
    }
}

void BladeContact::add_points(const physics::Model& model, const TissueSurface& /*surface*/,
                              double dt, ContactSolver& solver) {
    reported_ = {};
    first_point_ = solver.size();
    for (const Cutting& cutting : cutting_) {
        const Vec3& direction = directions_[cutting.piece];
        const double force = blade_.toughness * cutting.width;
        if (blade_.cutting_force == cutting::CuttingForce::report) {
            const double distance = cutting.motion.norm();
            if (!(distance > least_motion * size_)) continue;
            const Vec3 impulse = force * dt * direction;
            reported_.force += impulse;
            reported_.torque += (cutting.place - before_.position).cross(impulse);
            reported_.fracture += force * distance;
            continue;
        }
        ContactPoint point;
        point.normal = direction;
        point.velocity = cutting.motion / dt;
        point.impulse = impulses_[cutting.piece] * direction;
        point.largest_force = force;
        solver.begin(point);
        cutting.tissue.for_each([&](VertexId n, double weight) {
            if (weight != 0.0) add_shares(model, n, weight, solver);
        });
    }
}

ToolImpulse BladeContact::take_impulses(const ContactSolver& solver, double dt) {
    ToolImpulse sum;
    if (blade_.cutting_force == cutting::CuttingForce::report) return sum;
    std::ranges::fill(impulses_, 0.0);
    for (std::size_t i = 0; i < cutting_.size(); ++i) {
        const Cutting& cutting = cutting_[i];
        const Vec3& impulse = solver.impulse(first_point_ + i);
        impulses_[cutting.piece] = impulse.dot(directions_[cutting.piece]);
        sum.force += impulse;
        sum.torque += (cutting.place - before_.position).cross(impulse);
        const Vec3 velocity = cutting.motion / dt;
        sum.work += impulse.dot(velocity);
        sum.fracture += impulse.dot(velocity - solver.velocity(first_point_ + i));
    }
    return sum;
}

void BladeContact::restore(ArchiveReader& ar) {
    list(ar, *this);
    const bool fits =
        directions_.size() == pieces_.size() && impulses_.size() == pieces_.size() &&
        std::ranges::all_of(directions_, [](const Vec3& v) { return v.allFinite(); }) &&
        std::ranges::all_of(impulses_, [](double v) { return std::isfinite(v); });
    if (!fits) throw InputError("a blade cuts another body");
}

}  // namespace incise::contact
