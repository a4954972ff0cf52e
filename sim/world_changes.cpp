// What a world gets, changes and loses between two steps: constraints, loads, force terms, gravity,
// damping and materials.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "incise/base/number_format.h"
#include "incise/sim/world_checks.h"
#include "incise/sim/world_parts.h"

namespace incise::sim {

namespace {

/// Returns a table in which regions have another material, without materials that no region has. It
/// stands where that stood which it replaces, so that a material that comes back gives the table of
/// before.
/// @param regions  empty: all
physics::MaterialTable with_material(physics::MaterialTable table,
                                     const fragments::FragmentMesh& fragments,
                                     const physics::Material& material,
                                     std::span<const int> regions,
                                     const std::optional<Vec3>& fibre) {
    const auto is_meant = [&](int region) {
        return regions.empty() || std::ranges::find(regions, region) != regions.end();
    };
    for (const int region : regions) {
        if (table.of_region.contains(region)) continue;
        std::string known;
        for (const auto& [one, index] : table.of_region)
            known += (known.empty() ? "" : ", ") + std::to_string(one);
        throw InputError("the body has no region " + std::to_string(region) + ": it has " + known);
    }
    // That of the first region with a material that no other region has; else it is a new one.
    std::size_t place = table.materials.size();
    for (const auto& entry : table.of_region)
        if (place == table.materials.size() && is_meant(entry.first) &&
            std::ranges::none_of(table.of_region, [&](const auto& other) {
                return other.second == entry.second && !is_meant(other.first);
            }))
            place = entry.second;
    if (place == table.materials.size()) table.materials.emplace_back();
    table.materials[place] = material;
    for (auto& [region, index] : table.of_region)
        if (is_meant(region)) index = place;
    for (std::size_t i = table.materials.size(); i-- > 0;) {
        const auto has_it = [&](const auto& entry) { return entry.second == i; };
        if (std::ranges::any_of(table.of_region, has_it)) continue;
        table.materials.erase(table.materials.begin() + static_cast<std::ptrdiff_t>(i));
        for (auto& [region, index] : table.of_region) index -= index > i ? 1 : 0;
    }
    if (std::ranges::none_of(table.materials, &physics::Material::has_fibres)) {
        table.fibres.clear();
    } else if (fibre) {
        table.fibres.resize(fragments.element_capacity(), Vec3::Zero());
        for (const ElementId e : fragments.elements())
            if (is_meant(fragments.region(e))) table.fibres[e.index()] = fibre->normalized();
    }
    return table;
}

}  // namespace

ConstraintId World::add_constraint(physics::Constraint constraint) {
    Parts& p = *parts_;
    require_sound(constraint, p.mesh);
    p.model.boundary().add_constraint(std::move(constraint));
    p.grasps.emplace_back();
    return p.constraints.add();
}

std::span<const ConstraintId> World::constraints() const { return parts_->constraints.all(); }

ConstraintId World::grasp(std::string name, std::vector<VertexId> nodes, const Pose& pose) {
    Parts& p = *parts_;
    for (const VertexId n : nodes)
        if (!n.is_valid() || n.index() >= p.mesh.node_capacity())
            throw InputError("grasp '" + name + "': there is no node " + std::to_string(n.value));
    if (!pose.is_sound()) throw InputError("grasp '" + name + "': its pose is none");
    const ConstraintId id =
        add_constraint(physics::make_grip(std::move(name), std::move(nodes), pose));
    p.grasps.back().emplace(pose);
    return id;
}

std::optional<Pose> World::grasp_pose(ConstraintId constraint) const {
    const auto& grasp = parts_->grasps[parts_->constraints.position_of(constraint)];
    return grasp ? std::optional(grasp->pose) : std::nullopt;
}

void World::set_constraint(ConstraintId id, physics::Constraint constraint) {
    Parts& p = *parts_;
    const std::size_t index = p.constraints.position_of(id);
    const std::string name = "constraint '" + p.model.boundary().constraints().name(index) + "'";
    if (p.grasps[index])
        throw InputError(name + " is a grasp: it goes with its pose; release it, and grasp anew");
    if (!constraint.grip.is_empty()) throw InputError(name + ": a grasp is made by grasp()");
    require_sound(constraint, p.mesh);
    p.model.boundary().set_constraint(index, std::move(constraint));
}

void World::release(ConstraintId constraint) {
    Parts& p = *parts_;
    const std::size_t index = p.constraints.position_of(constraint);
    p.model.boundary().remove_constraint(index);
    p.constraints.remove(constraint);
    p.grasps.erase(p.grasps.begin() + static_cast<std::ptrdiff_t>(index));
}

const physics::Reaction& World::reaction(ConstraintId constraint) const {
    return parts_->model.boundary().reactions()[parts_->constraints.position_of(constraint)];
}

void World::add_force_term(std::unique_ptr<physics::ForceTerm> term) {
    if (!term) throw InputError("a force term is given as null");
    parts_->model.boundary().add_force_term(std::move(term));
    parts_->loads_have_changed = true;
    parts_->renew_stable_step();
}

void World::remove_force_term(const physics::ForceTerm* term) {
    if (!parts_->model.boundary().remove_force_term(term))
        throw InputError("the world does not have this force term");
    parts_->loads_have_changed = true;
    parts_->renew_stable_step();
}

LoadId World::add_load(physics::Load load) {
    Parts& p = *parts_;
    require_sound(load, p.mesh);
    p.model.boundary().add_load(std::move(load));
    p.loads_have_changed = true;
    return p.loads.add();
}

std::span<const LoadId> World::loads() const { return parts_->loads.all(); }

void World::set_load(LoadId id, physics::Load load) {
    Parts& p = *parts_;
    const std::size_t index = p.loads.position_of(id);
    require_sound(load, p.mesh);
    p.model.boundary().set_load(index, std::move(load));
    p.loads_have_changed = true;
}

void World::set_load_factor(LoadId load, double factor) {
    Parts& p = *parts_;
    const std::size_t index = p.loads.position_of(load);
    if (!std::isfinite(factor))
        throw InputError("load '" + p.model.boundary().loads().all()[index].name +
                         "': its factor is not finite");
    p.model.boundary().set_load_factor(index, physics::TimeCurve<double>({{p.time, factor}}));
    p.loads_have_changed = true;
}

void World::remove_load(LoadId load) {
    Parts& p = *parts_;
    p.model.boundary().remove_load(p.loads.position_of(load));
    p.loads.remove(load);
    p.loads_have_changed = true;
}

void World::set_gravity(const Vec3& gravity) {
    require_sound_gravity(gravity);
    parts_->model.boundary().set_gravity(gravity);
    parts_->loads_have_changed = true;
}

void World::set_damping(double damping) {
    require_sound_damping(damping);
    parts_->model.boundary().set_damping(damping);
}

void World::set_material(const physics::Material& material, std::span<const int> regions,
                         const std::optional<Vec3>& fibre) {
    Parts& p = *parts_;
    require_sound(material, "the material");
    if (fibre && !(std::abs(fibre->norm() - 1.0) < 1e-6))
        throw InputError("the direction of the fibres has a length of " +
                         format_number(fibre->norm()) + ": it must be 1");
    physics::MaterialTable before = p.materials_with_fibres();
    const physics::MaterialTable table =
        with_material(before, p.model.fragments(), material, regions, fibre);
    for (const auto& tool : p.tools) tool->require_fit(p.tissue(), table);
    p.model.set_materials(table, p.time);
    p.renew_stable_step();
    // Moments that can be gone back to have the materials of then.
    p.materials->table = std::move(before);
    p.materials = std::make_shared<FormerMaterials>();
}

physics::MaterialTable World::Parts::materials_with_fibres() const {
    physics::MaterialTable table = model.structure().elements().materials();
    table.fibres.assign(model.structure().fibres().begin(), model.structure().fibres().end());
    return table;
}

}  // namespace incise::sim
