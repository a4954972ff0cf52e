// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/world_checks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>
#include <utility>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/physics/elements/workers.h"

namespace incise::sim {

using topology::Mesh;

namespace {

bool is_finite(const Vec3& x) { return x.allFinite(); }

/// Throws InputError unless the times are finite and strictly ascending and the values are finite.
template <class Value>
void require_curve(const physics::TimeCurve<Value>& curve, const std::string& what) {
    const auto is_sound = [](const Value& value) {
        if constexpr (std::is_same_v<Value, double>)
            return std::isfinite(value);
        else if constexpr (std::is_same_v<Value, Pose>)
            return value.is_sound();
        else
            return value.allFinite();
    };
    const std::pair<double, Value>* before = nullptr;
    for (const auto& key : curve.keys()) {
        if (!std::isfinite(key.first) || !is_sound(key.second))
            throw InputError(what + " has a key that is not finite");
        if (before && !(before->first < key.first))
            throw InputError(what + " has keys whose times do not ascend, at " +
                             format_number(key.first) + " s");
        before = &key;
    }
}

void require_nodes(const Mesh& mesh, const std::string& what, const physics::VertexSet& nodes) {
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
        if (!load.shares.empty())
            throw InputError(what + ": its shares must be empty, since the body finds them");
        require(load.force.allFinite());
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
        for (const CellId e : load.elements.members()) require_element(e);
        if (load.elements.members().empty()) throw InputError(what + ": it has no element");
        require(load.force.allFinite());
    }

  private:
    void require(bool is_sound) const {
        if (!is_sound) throw InputError(what + ": its value is not finite");
    }
    void require_element(CellId e) const {
        if (!e.is_valid() || e.index() >= mesh.element_capacity() || !mesh.is_alive(e))
            throw InputError(what + ": there is no element " + std::to_string(e.value));
    }
    void require_faces(const physics::FaceSet& faces) const {
        if (faces.members().empty()) throw InputError(what + ": it has no face");
        for (const auto& member : faces.members()) {
            const FaceId f = member.face;
            require_element(f.cell);
            if (f.face < 0 || f.face >= mesh.num_faces(f.cell) || mesh.neighbor(f).is_valid())
                throw InputError(what + ": face " + std::to_string(f.face) + " of element " +
                                 std::to_string(f.cell.value) + " is not on the surface");
        }
    }
};

}  // namespace

void require_sound(const physics::Constraint& constraint, const Mesh& mesh) {
    const std::string what = "constraint '" + constraint.name + "'";
    require_nodes(mesh, what, constraint.nodes);
    constraint.require_fit(mesh);
    if (std::ranges::none_of(constraint.components, std::identity()))
        throw InputError(what + ": it prescribes no component");
    require_curve(constraint.displacement, what + ": its displacement");
    require_curve(constraint.angle, what + ": its angle");
    require_curve(constraint.grip, what + ": its grip");
    if (!constraint.gripped.empty())
        throw InputError(what +
                         ": its positions in a grip must be empty, since the body finds them");
    if (!is_finite(constraint.point)) throw InputError(what + ": its point is not finite");
    if (!(std::abs(constraint.axis.norm() - 1.0) < 1e-6))
        throw InputError(what + ": its axis has a length of " +
                         format_number(constraint.axis.norm()) + ": it must be 1");
}

void require_sound(const physics::Load& load, const Mesh& mesh) {
    const std::string what = "load '" + load.name + "'";
    std::visit(LoadRequirement{mesh, what}, load.kind);
    require_curve(load.factor, what + ": its factor");
}

namespace {

/// Returns why a material is invalid; empty if it is valid.
struct FaultOfMethod {
    std::string operator()(const physics::HyperElasticLinks& links) const {
        const double mu = physics::rest_mu(links.law), lambda = physics::rest_lambda(links.law);
        if (!(mu > 0.0 && std::isfinite(mu)))
            return "its shear modulus at rest is " + format_number(mu) + " Pa: it must be above 0";
        if (const double bulk = lambda + 2.0 / 3.0 * mu; !(bulk > 0.0 && std::isfinite(bulk)))
            return "its bulk modulus at rest is " + format_number(bulk) + " Pa: it must be above 0";
        if (!(links.inversion_threshold > 0.0 && links.inversion_threshold < 1.0))
            return "its inversion threshold is " + format_number(links.inversion_threshold) +
                   ": it must be between 0 and 1";
        if (links.prony_rule != physics::PronyRule::stress &&
            links.prony_rule != physics::PronyRule::nodal)
            return "there is no such rule of its Prony series";
        double sum = 0.0;
        for (const physics::PronyTerm& term : links.prony) {
            if (!(term.alpha > 0.0 && term.tau > 0.0 && std::isfinite(term.tau)))
                return "a term of its Prony series has alpha " + format_number(term.alpha) +
                       " and tau " + format_number(term.tau) + " s: both must be above 0";
            sum += term.alpha;
        }
        if (!(sum < 1.0))
            return "the alphas of its Prony series add up to " + format_number(sum) +
                   ": they must stay below 1";
        return "";
    }
    std::string operator()(const physics::MassSprings& springs) const {
        if (springs.young > 0.0 && std::isfinite(springs.young)) return "";
        return "its Young's modulus is " + format_number(springs.young) + " Pa: it must be above 0";
    }
    std::string operator()(const physics::HybridSprings& springs) const {
        if (!(springs.shear_modulus > 0.0 && std::isfinite(springs.shear_modulus)))
            return "its shear modulus is " + format_number(springs.shear_modulus) +
                   " Pa: it must be above 0";
        if (!std::isfinite(springs.volume_modulus)) return "its volume modulus is not finite";
        if (!(springs.stiffness_ratio >= 0.0)) return "its stiffness ratio must be 0 or more";
        return "";
    }
};

}  // namespace

void require_sound(const physics::Material& material, const std::string& what) {
    std::string fault;
    if (!(material.density > 0.0 && std::isfinite(material.density)))
        fault = "its density is " + format_number(material.density) + " kg/m3: it must be above 0";
    else
        fault = std::visit(FaultOfMethod{}, material.method);
    if (!fault.empty()) throw InputError(what + ": " + fault);
}

void require_sound_gravity(const Vec3& gravity) {
    if (!is_finite(gravity)) throw InputError("gravity is not finite");
}

void require_sound_damping(double damping) {
    if (!(damping >= 0.0 && std::isfinite(damping)))
        throw InputError("damping is " + format_number(damping) + " 1/s: it must be 0 or more");
}

void require_sound(const WorldDef& def, const Mesh& mesh) {
    if (def.materials.empty()) throw InputError("the definition of a world has no material");
    for (std::size_t i = 0; i < def.materials.size(); ++i)
        require_sound(def.materials[i], "material " + std::to_string(i));
    for (const auto& [region, material] : def.material_of_region)
        if (material >= def.materials.size())
            throw InputError("region " + std::to_string(region) + " has material " +
                             std::to_string(material) + ", and there are " +
                             std::to_string(def.materials.size()));
    if (!def.fibres.empty() && (def.fibres.size() != mesh.element_capacity() ||
                                !std::ranges::all_of(def.fibres, is_finite)))
        throw InputError("fibres must have one finite direction for each element");
    if (def.precision != physics::Precision::double_precision &&
        def.precision != physics::Precision::single_precision)
        throw InputError("there is no such precision");
    require_sound_gravity(def.gravity);
    require_sound_damping(def.damping);
    if (def.solver != Solver::semi_implicit_euler && def.solver != Solver::implicit_euler &&
        def.solver != Solver::statics)
        throw InputError("there is no such solver");
    require_sound_num_threads(def.num_threads);
    if (!(def.contact.friction >= 0.0 && std::isfinite(def.contact.friction)))
        throw InputError("the friction of contact is " + format_number(def.contact.friction) +
                         ": it must be 0 or more");
    for (const physics::Constraint& constraint : def.constraints) require_sound(constraint, mesh);
    for (const physics::Load& load : def.loads) require_sound(load, mesh);
}

void require_sound_num_threads(int n) {
    if (n < 1 || n > physics::Workers::max_threads)
        throw InputError("the number of threads is " + std::to_string(n) +
                         ": it must be from 1 to " + std::to_string(physics::Workers::max_threads));
}

}  // namespace incise::sim
