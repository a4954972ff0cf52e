// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/body.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <set>

#include "io/mesh_reader.h"
#include "io/number_format.h"
#include "sim/body_problems.h"
#include "sim/elastic_constants.h"
#include "sim/selection.h"
#include "sim/tool.h"
#include "topology/box_mesh.h"
#include "topology/error.h"

namespace incise::sim {

namespace {

std::vector<std::string> arrays_of(const std::vector<MaterialSpec>& materials) {
    std::set<std::string> names;
    for (const MaterialSpec& material : materials)
        if (const auto* name = std::get_if<std::string>(&material.fibre)) names.insert(*name);
    return {names.begin(), names.end()};
}

SourceMesh build_from_file(const std::filesystem::path& path, const MeshSpec& spec,
                           const std::vector<MaterialSpec>& materials) {
    io::MeshFile file = io::read_mesh(
        path, {.region_array = spec.region_array, .vector_arrays = arrays_of(materials)});
    for (Vec3& x : file.mesh.points) x *= spec.scale;
    const auto named = [&](const std::string& text) { return path.string() + ": " + text; };
    try {
        topology::BuiltMesh built = topology::Mesh::build(file.mesh);
        file.warnings.insert(file.warnings.end(), built.warnings.begin(), built.warnings.end());
        for (std::string& warning : file.warnings) warning = named(warning);
        return {std::move(built.mesh),
                std::move(file.warnings),
                {path.string(), std::move(file.cell_vectors)}};
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
            material.method =
                physics::HyperElasticLinks{make_law(spec.law, spec.parameters),
                                           spec.inversion_threshold, spec.prony, spec.prony_rule};
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

/// Of unit length; one that is so to rounding keeps its bits, so that a frame read back as a mesh
/// goes on alike. Zero if it has no direction.
Vec3 unit(const Vec3& v) {
    constexpr double rounding = 1e-15;
    const double norm = v.stableNorm();
    if (!std::isfinite(norm) || norm == 0.0) return Vec3::Zero();
    return std::abs(norm - 1.0) <= rounding ? v : Vec3(v / norm);
}

std::string text_of(const Vec3& v) {
    return "[" + io::format_number(v.x()) + ", " + io::format_number(v.y()) + ", " +
           io::format_number(v.z()) + "]";
}

/// Directions by element id; none if no material has fibres.
std::vector<Vec3> build_fibres(const std::vector<MaterialSpec>& specs,
                               const physics::MaterialTable& table, const topology::Mesh& mesh,
                               const CellVectors& cell_vectors) {
    const auto& materials = table.materials;
    if (std::none_of(materials.begin(), materials.end(),
                     [](const physics::Material& m) { return m.has_fibres(); }))
        return {};
    std::vector<Vec3> fibres(mesh.element_capacity(), Vec3::Zero());
    for (std::size_t i = 0; i < fibres.size(); ++i) {
        const topology::ElementId e(i);
        if (!mesh.is_alive(e)) continue;
        const std::size_t material = table.of_region.at(mesh.region(e));
        if (!materials[material].has_fibres()) continue;
        const auto& given = specs[material].fibre;
        if (const auto* direction = std::get_if<Vec3>(&given)) fibres[i] = *direction;
        const auto* array = std::get_if<std::string>(&given);
        if (!array) continue;
        const auto label = static_cast<std::size_t>(mesh.label(e));
        const Vec3& vector = cell_vectors.by_name.at(*array).at(label);
        fibres[i] = unit(vector);
        if (fibres[i].isZero(0.0))
            throw BodyError(
                specs[material].place,
                cell_vectors.file + ": element " + std::to_string(label) + ", of region " +
                    std::to_string(mesh.region(e)) + ", has " + text_of(vector) +
                    " in the cell array '" + *array +
                    "', which is no direction of fibres: its material needs one in each "
                    "element; correct the array, or give the region a law without fibres");
    }
    return fibres;
}

/// The first few by number.
std::string list(const std::set<int>& regions) {
    constexpr std::size_t max_listed = 20;
    std::string text;
    std::size_t num_listed = 0;
    for (const int region : regions) {
        if (num_listed++ == max_listed)
            return text + " and " + std::to_string(regions.size() - max_listed) + " more";
        text += (text.empty() ? "" : ", ") + std::to_string(region);
    }
    return text;
}

}  // namespace

SourceMesh build_mesh(const MeshSpec& spec, const std::vector<MaterialSpec>& materials) {
    if (const auto* path = std::get_if<std::filesystem::path>(&spec.source))
        return build_from_file(*path, spec, materials);
    const auto& box = std::get<BoxMeshSpec>(spec.source);
    require_memory_for(box);
    topology::BuiltMesh built = topology::Mesh::build(
        topology::box_mesh(box.element, spec.scale * box.origin, spec.scale * box.size, box.cells));
    return {std::move(built.mesh), std::move(built.warnings), {}};
}

physics::MaterialTable build_materials(const Scenario& scenario, const topology::Mesh& mesh,
                                       const CellVectors& cell_vectors,
                                       std::vector<std::string>& warnings) {
    const std::vector<MaterialSpec>& specs = scenario.materials;
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
    table.fibres = build_fibres(specs, table, mesh, cell_vectors);
    table.precision = scenario.dynamics.precision;
    return table;
}

namespace {

physics::Surroundings build_surroundings(const Scenario& scenario, const topology::Mesh& mesh,
                                         BodyProblems& problems) {
    physics::Surroundings surroundings;
    surroundings.gravity = scenario.dynamics.gravity;
    surroundings.damping = scenario.dynamics.damping;
    for (const ConstraintSpec& spec : scenario.constraints)
        surroundings.supports.push_back(
            problems.try_to(spec.place, [&] { return build_support(spec, mesh); }));
    for (const LoadSpec& spec : scenario.loads)
        surroundings.loads.push_back(
            problems.try_to(spec.place, [&] { return build_load(spec, mesh); }));
    return surroundings;
}

}  // namespace

physics::Surroundings build_surroundings(const Scenario& scenario, const topology::Mesh& mesh) {
    BodyProblems problems;
    physics::Surroundings surroundings = build_surroundings(scenario, mesh, problems);
    problems.throw_if_any();
    return surroundings;
}

Body build_body(const Scenario& scenario) {
    SourceMesh source = build_mesh(scenario.mesh, scenario.materials);
    BodyProblems problems;
    const std::string place = scenario.materials.empty() ? "" : scenario.materials.front().place;
    physics::MaterialTable materials = problems.try_to(place, [&] {
        return build_materials(scenario, source.mesh, source.cell_vectors, source.warnings);
    });
    physics::Surroundings surroundings = build_surroundings(scenario, source.mesh, problems);
    if (problems.are_there())  // else tools are made for good, and tell what is theirs
        for (const ToolSpec& spec : scenario.tools)
            problems.try_to(spec.place,
                            [&] { Tool(with_mode(spec, source.mesh), {}, source.warnings); });
    problems.throw_if_any();
    return {std::move(source.mesh), std::move(materials), std::move(surroundings),
            std::move(source.warnings)};
}

}  // namespace incise::sim
