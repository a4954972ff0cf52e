// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/body_parts.h"

#include <utility>

#include "incise/base/error.h"
#include "incise/scenario/elastic_constants.h"
#include "incise/sim/selection.h"

namespace incise::scenario {

physics::Material build_material(const MaterialSpec& spec) {
    const ElasticConstants constants = resolve(spec.method, spec.law, spec.parameters);
    physics::Material material;
    material.density = spec.density;
    switch (spec.method) {
        case Method::mass_spring:
            material.method = physics::MassSprings{constants.young()};
            break;
        case Method::hybmss:
            material.method = physics::HybridSprings{
                constants.mu, spec.correction_forces ? constants.lambda - constants.mu : 0.0,
                spec.stiffness_ratio};
            break;
        case Method::heml:
            material.method =
                physics::HyperElasticLinks{make_law(spec.law, spec.parameters),
                                           spec.inversion_threshold, spec.prony, spec.prony_rule};
            break;
    }
    return material;
}

namespace {

template <class Value>
physics::TimeCurve<Value> curve(const std::vector<TimeKey<Value>>& keys) {
    std::vector<std::pair<double, Value>> pairs;
    pairs.reserve(keys.size());
    for (const TimeKey<Value>& key : keys) pairs.emplace_back(key.time, key.value);
    return physics::TimeCurve<Value>(std::move(pairs));
}

/// Returns what `select` finds, at least one of `things`. Messages of errors begin with `what`, the
/// owner of `where`.
template <class Id>
std::vector<Id> choose(std::vector<Id> (*select)(const topology::Mesh&, const sim::Selection&),
                       const topology::Mesh& mesh, const sim::Selection& where,
                       const std::string& what, const std::string& things) {
    std::vector<Id> found;
    try {
        found = select(mesh, where);
    } catch (const InputError& error) {
        throw InputError(what + ": " + error.what());
    }
    sim::require_selected(found.size(), mesh, what, things);
    return found;
}

}  // namespace

physics::Constraint build_constraint(const ConstraintSpec& spec, const topology::Mesh& mesh) {
    physics::Constraint constraint;
    constraint.name = spec.name;
    constraint.nodes = physics::VertexSet(
        choose(sim::select_nodes, mesh, spec.where, "constraint '" + spec.name + "'", "node"));
    constraint.components = spec.fixed;
    constraint.displacement = curve(spec.move);
    constraint.angle = curve(spec.rotate);
    constraint.point = spec.about_point;
    constraint.axis = spec.about_axis;
    return constraint;
}

physics::Load build_load(const LoadSpec& spec, const topology::Mesh& mesh) {
    const std::string what = "load '" + spec.name + "'";
    const auto faces = [&] {
        return choose(sim::select_faces, mesh, spec.where, what, "face of the surface");
    };
    physics::Load load;
    load.name = spec.name;
    load.factor = curve(spec.factor);
    if (const auto* nodal = std::get_if<NodalForce>(&spec.load)) {
        auto nodes = choose(sim::select_nodes, mesh, spec.where, what, "node");
        load.kind = physics::NodalLoad{physics::VertexSet(std::move(nodes)), nodal->force, {}};
    } else if (const auto* traction = std::get_if<Traction>(&spec.load)) {
        load.kind = physics::TractionLoad{faces(), traction->stress};
    } else if (const auto* pressure = std::get_if<Pressure>(&spec.load)) {
        load.kind = physics::PressureLoad{faces(), pressure->pressure};
    } else {
        auto elements = choose(sim::select_elements, mesh, spec.where, what, "element");
        load.kind = physics::BodyLoad{std::move(elements), std::get<BodyForce>(spec.load).density};
    }
    return load;
}

}  // namespace incise::scenario
