// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/body.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <sstream>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/contact/blade_contact.h"
#include "incise/scenario/body_parts.h"
#include "incise/scenario/body_problems.h"
#include "incise/scenario/plausibility.h"
#include "incise/scenario/remedies.h"
#include "incise/scenario/single_precision.h"
#include "incise/scenario/step_limit.h"
#include "incise/scenario/tools/tool_kind.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::scenario {

namespace {

/// Returns the vector scaled to unit length, or zero if it has no direction. A vector of unit
/// length to rounding keeps its bits, so that a frame read as a mesh gives the same results.
Vec3 unit(const Vec3& v) {
    constexpr double rounding = 1e-15;
    const double norm = v.stableNorm();
    if (!std::isfinite(norm) || norm == 0.0) return Vec3::Zero();
    return std::abs(norm - 1.0) <= rounding ? v : Vec3(v / norm);
}

/// Returns the directions of fibres by element id. Empty if no material has fibres.
std::vector<Vec3> build_fibres(const std::vector<MaterialSpec>& specs,
                               const physics::MaterialTable& table, const topology::Mesh& mesh,
                               const CellVectors& cell_vectors) {
    const auto& materials = table.materials;
    if (std::none_of(materials.begin(), materials.end(),
                     [](const physics::Material& m) { return m.has_fibres(); }))
        return {};
    std::vector<Vec3> fibres(mesh.element_capacity(), Vec3::Zero());
    for (std::size_t i = 0; i < fibres.size(); ++i) {
        const CellId e(i);
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
                specs[material].location,
                cell_vectors.file + ": element " + std::to_string(label) + ", of region " +
                    std::to_string(mesh.region(e)) + ", has " + vector_text(vector) +
                    " in the cell array '" + *array +
                    "', which is no direction of fibres: its material needs one in each "
                    "element; correct the array, or give the region a law without fibres");
    }
    return fibres;
}

std::set<int> regions_of(const topology::Mesh& mesh) {
    std::set<int> regions;
    for (const CellId e : mesh.elements()) regions.insert(mesh.region(e));
    return regions;
}

/// Lists the regions as text, at most 20 by number.
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

std::string names_region(int region, const std::set<int>& present) {
    return " names region " + std::to_string(region) + ", which the mesh does not have (it has " +
           list(present) + ")";
}

}  // namespace

physics::MaterialTable build_materials(const Scenario& scenario, const topology::Mesh& mesh,
                                       const CellVectors& cell_vectors,
                                       std::vector<std::string>& warnings) {
    const std::vector<MaterialSpec>& specs = scenario.materials;
    const std::set<int> present = regions_of(mesh);
    physics::MaterialTable table;
    for (const MaterialSpec& spec : specs) {
        table.materials.push_back(build_material(spec));
        if (!spec.regions) continue;
        for (const int region : *spec.regions) {
            table.of_region[region] = table.materials.size() - 1;
            if (!present.contains(region))
                warnings.push_back(located(spec.regions_location,
                                           "material " + std::to_string(table.materials.size()) +
                                               names_region(region, present)));
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

/// Reports the conflicts, at most ten in full, because many constraints can prescribe the same
/// nodes.
void report_conflicts(const Scenario& scenario, const topology::Mesh& mesh,
                      std::span<const physics::Constraint> constraints, BodyProblems& problems) {
    constexpr std::size_t max_told = 10;
    const auto conflicts = physics::find_conflicts(mesh, constraints);
    for (std::size_t i = 0; i < conflicts.size(); ++i) {
        const std::string& location = scenario.constraints[conflicts[i].second].location;
        if (i == max_told) {
            const std::size_t num_left = conflicts.size() - max_told;
            problems.add(location,
                         "and " + std::to_string(num_left) + " more pair" +
                             (num_left > 1 ? "s" : "") +
                             " of constraints from here on move a node differently in the "
                             "same direction; make their selections disjoint or their "
                             "motion there equal");
            return;
        }
        problems.add(location, describe(conflicts[i], mesh, constraints));
    }
}

/// Warns of selected regions that the mesh does not have. If it has none of the selected regions,
/// the empty selection is an error that is reported elsewhere.
void warn_of_missing_regions(const Scenario& scenario, const topology::Mesh& mesh,
                             std::vector<std::string>& warnings) {
    const std::set<int> present = regions_of(mesh);
    const auto is_present = [&](int region) { return present.contains(region); };
    const auto warn = [&](const auto& spec, const std::string& kind) {
        if (!spec.where.regions || std::ranges::none_of(*spec.where.regions, is_present)) return;
        for (const int region : *spec.where.regions)
            if (!is_present(region))
                warnings.push_back(located(
                    spec.location, kind + " '" + spec.name + "'" + names_region(region, present)));
    };
    for (const ConstraintSpec& spec : scenario.constraints) warn(spec, "constraint");
    for (const LoadSpec& spec : scenario.loads) warn(spec, "load");
}

physics::BoundaryConditions build_boundary_conditions(const Scenario& scenario,
                                                      const topology::Mesh& mesh,
                                                      BodyProblems& problems) {
    physics::BoundaryConditions boundary_conditions;
    boundary_conditions.gravity = scenario.dynamics.gravity;
    boundary_conditions.damping = scenario.dynamics.damping;
    for (const ConstraintSpec& spec : scenario.constraints)
        boundary_conditions.constraints.push_back(
            problems.try_to(spec.location, [&] { return build_constraint(spec, mesh); }));
    for (const LoadSpec& spec : scenario.loads)
        boundary_conditions.loads.push_back(
            problems.try_to(spec.location, [&] { return build_load(spec, mesh); }));
    report_conflicts(scenario, mesh, boundary_conditions.constraints, problems);
    return boundary_conditions;
}

}  // namespace

physics::BoundaryConditions build_boundary_conditions(const Scenario& scenario,
                                                      const topology::Mesh& mesh) {
    BodyProblems problems;
    physics::BoundaryConditions boundary_conditions =
        build_boundary_conditions(scenario, mesh, problems);
    problems.throw_if_any();
    return boundary_conditions;
}

namespace {

/// Returns the material of a region, or null if there is none.
const MaterialSpec* material_of(const Scenario& scenario, int region) {
    const MaterialSpec* found = nullptr;
    for (const MaterialSpec& spec : scenario.materials) {
        const bool names_it =
            spec.regions && std::ranges::find(*spec.regions, region) != spec.regions->end();
        if (names_it || (!spec.regions && !found)) found = &spec;
    }
    return found;
}

/// Returns the error about a material that does not suit an element, with its remedy.
BodyError with_remedy(const Scenario& scenario, const physics::UnsuitableMaterial& error) {
    const MaterialSpec* material = material_of(scenario, error.region);
    return {material ? material->location : "", error.what() + remedy_for(error, material)};
}

/// Returns the warning about a tool that touches nothing at rest. The usual cause is a wrong
/// coordinate or unit, which would otherwise be noticed only after the run.
std::string out_of_reach(const ScriptedTool& tool, const Box& body) {
    const Eigen::IOFormat list(6, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");
    std::ostringstream text;
    text << "tool '" << tool.name << "' touches nothing where the body rests, between "
         << body.min().transpose().format(list) << " and " << body.max().transpose().format(list)
         << "; check its coordinates and units, unless the tissue moves to it";
    return text.str();
}

/// Builds the tools. If `mesh` is null, only the files of surfaces are checked.
std::vector<ScriptedTool> build_tools(const Scenario& scenario, const topology::Mesh* mesh,
                                      BodyProblems& problems, std::vector<std::string>& warnings) {
    Box body;
    if (mesh)
        for (const Vec3& x : mesh->rest_positions()) body.extend(x);
    std::vector<ScriptedTool> tools;
    std::vector<std::string> idle;
    for (ToolSpec spec : scenario.tools) {
        const std::string& place = spec.surface ? spec.surface->location : spec.location;
        problems.try_to(place, [&] {
            tools.push_back(build_tool(spec, warnings));
            if (mesh) {
                const ToolKind& kind = kind_of(spec.shape);
                kind.require_fit(tools.back(), *mesh);
                if (const auto warning = kind.warning_of_begin(tools.back(), *mesh))
                    warnings.push_back(located(spec.location, *warning));
            }
            if (mesh && !spec.path.empty() && !spec.is_obstacle && !may_meet(tools.back(), body))
                idle.push_back(located(spec.location, out_of_reach(tools.back(), body)));
        });
    }
    warnings.insert(warnings.end(), idle.begin(), idle.end());
    return tools;
}

/// The parts of a body that can be built, and the problems of the others.
struct Parts {
    std::optional<SourceMesh> source;
    std::optional<physics::MaterialTable> materials;
    physics::BoundaryConditions boundary_conditions;
    std::vector<ScriptedTool> tools;
    std::vector<std::string> warnings;
    BodyProblems problems;
    std::optional<BodyFindings::Effort> effort;
};

bool is_known(const MeshSpec& mesh) {
    const auto* path = std::get_if<std::filesystem::path>(&mesh.source);
    return !path || !path->empty();
}

/// Adds the problems of blades whose force is applied.
void check_toughness(const Scenario& scenario, Parts& parts) {
    const double size = topology::mean_element_length(parts.source->mesh);
    for (const ScriptedTool& tool : parts.tools) {
        const auto* blade = std::get_if<cutting::Blade>(&tool.shape);
        if (!blade) continue;
        const auto spec = std::ranges::find(scenario.tools, tool.name, &ToolSpec::name);
        parts.problems.try_to(spec->location, [&] {
            const std::string fault = contact::fault_of_toughness(*blade, *parts.materials, size);
            if (!fault.empty()) throw InputError("tool '" + tool.name + "': " + fault);
        });
    }
}

Parts build_parts(const Scenario& scenario) {
    Parts parts;
    BodyProblems& problems = parts.problems;
    if (is_known(scenario.mesh))
        parts.source = problems.try_to(scenario.mesh.location, [&] {
            return std::optional(build_mesh(scenario.mesh, scenario.materials));
        });
    const topology::Mesh* mesh = parts.source ? &parts.source->mesh : nullptr;
    if (mesh) {
        parts.warnings = std::move(parts.source->warnings);
        if (!scenario.materials.empty())
            parts.materials = problems.try_to(scenario.materials.front().location, [&] {
                return std::optional(
                    build_materials(scenario, *mesh, parts.source->cell_vectors, parts.warnings));
            });
        if (scenario.dynamics.precision == physics::Precision::single_precision)
            if (const auto warning = warning_of_thin_elements(*mesh))
                parts.warnings.push_back(located(scenario.dynamics.precision_location, *warning));
        parts.boundary_conditions = build_boundary_conditions(scenario, *mesh, problems);
        warn_of_missing_regions(scenario, *mesh, parts.warnings);
    }
    parts.tools = build_tools(scenario, mesh, problems, parts.warnings);
    if (parts.source && parts.materials) check_toughness(scenario, parts);
    if (mesh)
        for (std::string& warning :
             implausible(scenario, *mesh, parts.materials ? &*parts.materials : nullptr))
            parts.warnings.push_back(std::move(warning));
    return parts;
}

void warn_of_costly_elements(const Scenario& scenario, const physics::Model& model,
                             std::vector<std::string>& warnings) {
    if (!scenario.dynamics.is_explicit()) return;
    if (const auto warning = warning_of_costly_elements(model))
        warnings.push_back(located(scenario.mesh.location, *warning));
}

/// Measures how long it takes to compute the forces, s: the shortest of some times.
double seconds_of_forces(physics::Model& model) {
    using Clock = std::chrono::steady_clock;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
        const auto begin = Clock::now();
        model.compute_forces(0.0);
        least = std::min(least, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    return least;
}

/// Adds the problems of the model and of the time step, if there are mesh and materials. Neither
/// depends on constraints and loads.
void check_model(const Scenario& scenario, Parts& parts) {
    if (!parts.source || !parts.materials) return;
    parts.problems.try_to("", [&] {
        auto model = make_model(scenario, parts.source->mesh, *parts.materials, {});
        const double step = step_limit(scenario, model, model.structure().rest_stable_step());
        if (!scenario.dynamics.is_explicit()) return;
        warn_of_costly_elements(scenario, model, parts.warnings);
        const double num_steps = scenario.dynamics.end_time / step;
        parts.effort = {num_steps, num_steps * seconds_of_forces(model)};
    });
}

}  // namespace

physics::Model make_model(const Scenario& scenario, const topology::Mesh& mesh,
                          const physics::MaterialTable& materials,
                          const physics::BoundaryConditions& boundary_conditions) {
    try {
        return physics::Model(mesh, materials, boundary_conditions);
    } catch (const physics::UnsuitableMaterial& error) {
        throw with_remedy(scenario, error);
    }
}

sim::World make_world(const Scenario& scenario, topology::Mesh mesh,
                      physics::MaterialTable materials,
                      physics::BoundaryConditions boundary_conditions,
                      std::vector<std::string>& warnings) {
    const DynamicsSpec& dynamics = scenario.dynamics;
    sim::WorldDef def{std::move(mesh), std::move(materials.materials),
                      std::move(materials.of_region), std::move(materials.fibres),
                      materials.precision};
    def.gravity = boundary_conditions.gravity;
    def.damping = boundary_conditions.damping;
    def.constraints = std::move(boundary_conditions.constraints);
    def.loads = std::move(boundary_conditions.loads);
    def.contact = scenario.contact;
    if (dynamics.mode == Mode::statics)
        def.solver = sim::Solver::statics;
    else if (dynamics.integrator == TimeIntegrator::implicit_euler)
        def.solver = sim::Solver::implicit_euler;
    try {
        sim::World world(std::move(def));
        warn_of_costly_elements(scenario, world.model(), warnings);
        return world;
    } catch (const physics::UnsuitableMaterial& error) {
        throw with_remedy(scenario, error);
    }
}

Body build_body(const Scenario& scenario) {
    Parts parts = build_parts(scenario);
    if (parts.problems.are_there()) {
        check_model(scenario, parts);
        parts.problems.throw_if_any(std::move(parts.warnings));
    }
    if (!parts.source || !parts.materials)
        throw InputError("a scenario needs a mesh and a material");
    return {std::move(parts.source->mesh), std::move(*parts.materials),
            std::move(parts.boundary_conditions), std::move(parts.tools),
            std::move(parts.warnings)};
}

BodyFindings check_body(const Scenario& scenario) {
    Parts parts = build_parts(scenario);
    check_model(scenario, parts);
    return {parts.problems.lines(), std::move(parts.warnings), parts.effort,
            parts.source ? std::move(parts.source->joins) : std::vector<std::string>()};
}

}  // namespace incise::scenario
