// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/body.h"

#include <unistd.h>

#include <algorithm>
#include <new>
#include <set>

#include "io/mesh_reader.h"
#include "sim/elastic_constants.h"
#include "sim/selection.h"
#include "topology/box_mesh.h"
#include "topology/error.h"

namespace incise::sim {

namespace {

topology::BuiltMesh build_from_file(const std::filesystem::path& path, const MeshSpec& spec) {
    io::MeshFile file = io::read_mesh(path, {.region_array = spec.region_array});
    for (Vec3& x : file.mesh.points) x *= spec.scale;
    const auto named = [&](const std::string& text) { return path.string() + ": " + text; };
    try {
        topology::BuiltMesh built = topology::Mesh::build(file.mesh);
        file.warnings.insert(file.warnings.end(), built.warnings.begin(), built.warnings.end());
        built.warnings.clear();
        for (const std::string& warning : file.warnings) built.warnings.push_back(named(warning));
        return built;
    } catch (const InputError& error) {
        throw InputError(named(error.what()));
    }
}

/// Throws bad_alloc for a box that this machine cannot hold, before it tries and is killed.
void require_memory_for(const BoxMeshSpec& box) {
    const bool is_tetrahedra = box.element == topology::CellKind::tetrahedron;
    const double bytes_per_brick = is_tetrahedra ? 6 * 1200.0 : 2500.0;  // map, arrays, elements
    const double bytes =
        bytes_per_brick * box.cells[0] * static_cast<double>(box.cells[1]) * box.cells[2];
    const double memory =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    if (bytes > memory) throw std::bad_alloc();
}

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
            material.method = physics::HyperElasticLinks{make_law(spec.law, spec.parameters),
                                                         spec.inversion_threshold, spec.prony};
            break;
    }
    return material;
}

template <class Value>
physics::TimeCurve<Value> curve(const std::vector<TimeKey<Value>>& keys) {
    std::vector<std::pair<double, Value>> pairs;
    for (const TimeKey<Value>& key : keys) pairs.emplace_back(key.time, key.value);
    return physics::TimeCurve<Value>(std::move(pairs));
}

/// What `select` finds, at least one of `things`. Errors begin with `what`, the owner of `where`.
template <class Id>
std::vector<Id> choose(std::vector<Id> (*select)(const topology::Mesh&, const Selection&),
                       const topology::Mesh& mesh, const Selection& where, const std::string& what,
                       const std::string& things) {
    std::vector<Id> found;
    try {
        found = select(mesh, where);
    } catch (const InputError& error) {
        throw InputError(what + ": " + error.what());
    }
    require_selected(found.size(), mesh, what, things);
    return found;
}

physics::Support build_support(const ConstraintSpec& spec, const topology::Mesh& mesh) {
    physics::Support support;
    support.name = spec.name;
    support.nodes = physics::NodeSet(
        choose(select_nodes, mesh, spec.where, "constraint '" + spec.name + "'", "node"));
    support.components = spec.fixed;
    support.displacement = curve(spec.move);
    support.angle = curve(spec.rotate);
    support.point = spec.about_point;
    support.axis = spec.about_axis;
    return support;
}

physics::Load build_load(const LoadSpec& spec, const topology::Mesh& mesh) {
    const std::string what = "load '" + spec.name + "'";
    const auto faces = [&] {
        return choose(select_faces, mesh, spec.where, what, "face of the surface");
    };
    physics::Load load;
    load.name = spec.name;
    load.factor = curve(spec.factor);
    if (const auto* nodal = std::get_if<NodalForce>(&spec.load)) {
        auto nodes = choose(select_nodes, mesh, spec.where, what, "node");
        load.kind = physics::NodalLoad{physics::NodeSet(std::move(nodes)), nodal->force, {}};
    } else if (const auto* traction = std::get_if<Traction>(&spec.load)) {
        load.kind = physics::TractionLoad{faces(), traction->stress};
    } else if (const auto* pressure = std::get_if<Pressure>(&spec.load)) {
        load.kind = physics::PressureLoad{faces(), pressure->pressure};
    } else {
        auto elements = choose(select_elements, mesh, spec.where, what, "element");
        load.kind = physics::BodyLoad{std::move(elements), std::get<BodyForce>(spec.load).density};
    }
    return load;
}

std::string list(const std::set<int>& regions) {
    std::string text;
    for (const int region : regions) text += (text.empty() ? "" : ", ") + std::to_string(region);
    return text;
}

}  // namespace

topology::BuiltMesh build_mesh(const MeshSpec& spec) {
    if (const auto* path = std::get_if<std::filesystem::path>(&spec.source))
        return build_from_file(*path, spec);
    const auto& box = std::get<BoxMeshSpec>(spec.source);
    require_memory_for(box);
    return topology::Mesh::build(
        topology::box_mesh(box.element, spec.scale * box.origin, spec.scale * box.size, box.cells));
}

physics::MaterialTable build_materials(const std::vector<MaterialSpec>& specs,
                                       const topology::Mesh& mesh,
                                       std::vector<std::string>& warnings) {
    std::set<int> present;
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
        if (mesh.is_alive(topology::ElementId(i)))
            present.insert(mesh.region(topology::ElementId(i)));

    physics::MaterialTable table;
    for (const MaterialSpec& spec : specs) {
        table.materials.push_back(build_material(spec));
        if (!spec.regions) continue;
        for (const int region : *spec.regions) {
            table.of_region[region] = table.materials.size() - 1;
            if (!present.contains(region))
                warnings.push_back("material " + std::to_string(table.materials.size()) +
                                   " names region " + std::to_string(region) +
                                   ", which the mesh does not have (it has " + list(present) + ")");
        }
    }
    std::set<int> left;
    for (const int region : present)
        if (!table.of_region.contains(region)) left.insert(region);
    const auto rest = std::find_if(specs.begin(), specs.end(),
                                   [](const MaterialSpec& spec) { return !spec.regions; });
    if (rest == specs.end() && !left.empty())
        throw InputError("no material for region " + list(left) +
                         " of the mesh; add a material for it, or one without 'regions' for all "
                         "that no other names");
    for (const int region : left)
        table.of_region[region] = static_cast<std::size_t>(rest - specs.begin());
    return table;
}

physics::Surroundings build_surroundings(const Scenario& scenario, const topology::Mesh& mesh) {
    physics::Surroundings surroundings;
    surroundings.gravity = scenario.dynamics.gravity;
    surroundings.damping = scenario.dynamics.damping;
    for (const ConstraintSpec& spec : scenario.constraints)
        surroundings.supports.push_back(build_support(spec, mesh));
    for (const LoadSpec& spec : scenario.loads)
        surroundings.loads.push_back(build_load(spec, mesh));
    return surroundings;
}

}  // namespace incise::sim
