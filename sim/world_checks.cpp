// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/world_checks.h"

#include <algorithm>
#include <cmath>

#include "incise/io/number_format.h"
#include "incise/topology/error.h"

namespace incise::sim {

using cutting::Blade;
using cutting::Carver;
using topology::Mesh;
using topology::NodeId;

namespace {

void require_nodes(const Mesh& mesh, const std::string& what, const physics::NodeSet& nodes) {
    if (nodes.members().empty()) throw InputError(what + ": it has no node");
    for (const auto& [n, origin] : nodes.members())
        if (!n.is_valid() || n.index() >= mesh.node_capacity() || !mesh.is_alive(n))
            throw InputError(what + ": there is no node " + std::to_string(n.value));
}

struct LoadRequirement {
    const Mesh& mesh;
    const std::string what;

    void operator()(const physics::NodalLoad& load) const {
        require_nodes(mesh, what, load.nodes);
        require(load.shares.empty() && load.force.allFinite());
    }
    void operator()(const physics::TractionLoad& load) const {
        require_faces(load.faces);
        require(load.traction.allFinite());
    }
    void operator()(const physics::PressureLoad& load) const {
        require_faces(load.faces);
        require(std::isfinite(load.pressure));
    }
    void operator()(const physics::BodyLoad& load) const {
        for (const topology::ElementId e : load.elements.members()) require_element(e);
        if (load.elements.members().empty()) throw InputError(what + ": it has no element");
        require(load.force.allFinite());
    }

  private:
    void require(bool is_sound) const {
        if (!is_sound) throw InputError(what + ": its value is not finite");
    }
    void require_element(topology::ElementId e) const {
        if (!e.is_valid() || e.index() >= mesh.element_capacity() || !mesh.is_alive(e))
            throw InputError(what + ": there is no element " + std::to_string(e.value));
    }
    void require_faces(const physics::FaceSet& faces) const {
        if (faces.members().empty()) throw InputError(what + ": it has no face");
        for (const auto& member : faces.members()) {
            const topology::FaceId f = member.face;
            require_element(f.element);
            if (f.face < 0 || f.face >= mesh.num_faces(f.element) || mesh.neighbor(f).is_valid())
                throw InputError(what + ": face " + std::to_string(f.face) + " of element " +
                                 std::to_string(f.element.value) + " is not on the surface");
        }
    }
};

}  // namespace

void require_sound(const ToolDef& def) {
    const auto refuse = [&](const std::string& why) {
        throw InputError("tool '" + def.name + "': " + why);
    };
    const auto require_above_zero = [&](double length, const char* what) {
        if (!(length > 0.0 && std::isfinite(length)))
            refuse(std::string(what) + " of " + io::format_number(length) +
                   " m: it must be above 0");
    };
    if (const auto* blade = std::get_if<Blade>(&def.shape)) {
        if (blade->edge.size() < 2)
            refuse("the edge of a blade needs at least 2 points, and has " +
                   std::to_string(blade->edge.size()));
        if (!std::ranges::all_of(blade->edge, [](const Vec3& x) { return x.allFinite(); }))
            refuse("a point of its edge is not finite");
    }
    if (const auto* carver = std::get_if<Carver>(&def.shape)) {
        if (const auto* sphere = std::get_if<cutting::Sphere>(&carver->shape))
            require_above_zero(sphere->radius, "it has a radius");
        if (const auto* capsule = std::get_if<cutting::Capsule>(&carver->shape))
            require_above_zero(capsule->radius, "it has a radius");
        if (const auto* cuboid = std::get_if<cutting::Cuboid>(&carver->shape))
            require_above_zero(cuboid->size.minCoeff(), "it has an edge");
    }
    if (const auto* plane = std::get_if<cutting::PlaneCut>(&def.shape))
        if (!(plane->normal.squaredNorm() > 0.0)) refuse("the normal of its plane is zero");
}

void require_sound(const physics::Support& constraint, const Mesh& mesh) {
    require_nodes(mesh, "constraint '" + constraint.name + "'", constraint.nodes);
    constraint.require_fit(mesh);
}

void require_sound(const physics::Load& load, const Mesh& mesh) {
    std::visit(LoadRequirement{mesh, "load '" + load.name + "'"}, load.kind);
}

}  // namespace incise::sim
