// Construction of a world, and its main loop.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sstream>
#include <utility>

#include "incise/cutting/exact/undividable.h"
#include "incise/sim/world_checks.h"
#include "incise/sim/world_parts.h"

namespace incise::sim {

using cutting::Blade;
using cutting::Carver;
using topology::ChangeSet;
using topology::Mesh;

namespace {

Mesh mesh_of(std::variant<topology::MeshData, Mesh> mesh) {
    if (auto* built = std::get_if<Mesh>(&mesh)) return std::move(*built);
    return Mesh::build(std::get<topology::MeshData>(mesh)).mesh;
}

/// Moves the materials out of a definition. Throws InputError if the definition is invalid.
physics::MaterialTable materials_of(WorldDef& def, const Mesh& mesh) {
    require_sound(def, mesh);
    physics::MaterialTable table{std::move(def.materials), std::move(def.material_of_region),
                                 std::move(def.fibres), def.precision};
    if (table.of_region.empty() && !table.materials.empty())
        for (const ElementId e : mesh.elements()) table.of_region[mesh.region(e)] = 0;
    return table;
}

}  // namespace

std::unique_ptr<physics::Integrator> make_integrator(Solver solver) {
    if (solver == Solver::statics) return std::make_unique<physics::Statics>();
    if (solver == Solver::implicit_euler) return std::make_unique<physics::ImplicitEuler>();
    return std::make_unique<physics::SemiImplicitEuler>();
}

World::Parts::Parts(WorldDef def)
    : mesh(mesh_of(std::move(def.mesh))),
      // Braces fix the order: the definition is checked before parts of it are moved.
      model{mesh,
            materials_of(def, mesh),
            {def.gravity, def.damping, std::move(def.constraints), std::move(def.loads)}},
      integrator(make_integrator(def.solver)),
      solver(def.solver),
      ledger(model),
      cutter(mesh, model.mesh_positions()),
      constraints("constraint", model.num_constraints()),
      loads("load", model.loads().all().size()) {
    model.set_num_threads(def.num_threads);
}

void World::Parts::step_to(double end) {
    report.from = time;
    report.to = end;
    report.edits.clear();
    report.tools.clear();
    const auto begin_motion = [&] {
        if (is_any_tool_present()) cutter.begin_motion(model.mesh_positions());
    };
    const auto end_motion = [&] {
        has_moved = true;
        cutter.end_motion(mesh, model.mesh_positions(), model.largest_mesh_move());
    };

    if (loads_have_changed) model.compute_forces(time);
    loads_have_changed = false;
    for (auto& [number, grasp] : grasps) {
        model.set_grip(constraints.position_of(number),
                       physics::TimeCurve<Pose>({{time, grasp.pose}, {end, grasp.target}}));
        grasp.pose = grasp.target;
    }
    begin_motion();
    integrator->step(model, time, end - time);
    time = end;
    ++num_steps;
    end_motion();
    for (std::size_t i = 0; i < tools.size(); ++i) cut_with({i}, end);
    // Tissue that crosses a tool during the motion to the new equilibrium is cut too. The tools do
    // not move during this motion.
    for (std::size_t num_followed = 0; num_followed < report.edits.size();) {
        num_followed = report.edits.size();
        begin_motion();
        if (!integrator->equilibrate(model, end)) break;
        end_motion();
        for (std::size_t i = 0; i < tools.size(); ++i) cut_with({i}, end);
    }
    model.compute_forces(end);
    for (std::size_t i = 0; i < tools.size(); ++i)
        if (const Tool& tool = tools[i]; tool.is_present)
            report.tools.push_back({{i}, tool.pose, tool.cut && cutter.is_in_tissue(*tool.cut)});
}

/// Cuts what a tool meets on the path from its pose to its target, and moves the tool there.
void World::Parts::cut_with(ToolId id, double end) {
    Tool& tool = tools[id.index];
    if (!tool.is_present) return;
    const auto carry_out = [&](auto edit) -> cutting::Split {
        try {
            return edit();
        } catch (const InputError& error) {
            std::ostringstream text;
            text << "tool '" << tool.def.name << "', at t = " << end << " s: " << error.what();
            const auto* undividable = dynamic_cast<const cutting::UndividableElement*>(&error);
            throw ToolError(text.str(), id, undividable ? undividable->element : ElementId());
        }
    };
    follow(id, carry_out([&] { return split_with(tool); }), end);
    tool.pose = tool.target;
    if (!tool.is_leaving) return;
    if (tool.cut && cutter.is_in_tissue(*tool.cut)) {
        if (tool.pose_before_end) {
            cutting::place_edge(std::get<Blade>(tool.def.shape), *tool.pose_before_end,
                                tool.edge_before);
            for (std::size_t i = 0; i < tool.motion.size(); ++i)
                tool.motion[i] = tool.edge_after[i] - tool.edge_before[i];
        }
        const cutting::BladeEnd blade(tool.edge_after, tool.motion);
        follow(id, carry_out([&] {
                   return cutter.end_cut(*tool.cut, mesh, model.fragments(), model.mesh_positions(),
                                         blade);
               }),
               end);
    }
    tool.is_present = tool.is_leaving = false;
}

cutting::Split World::Parts::split_with(Tool& tool) {
    const auto now = model.mesh_positions();
    if (const auto* carver = std::get_if<Carver>(&tool.def.shape))
        return cutter.carve(mesh, now, carver->shape, tool.pose, tool.target);
    if (const auto* plane = std::get_if<cutting::PlaneCut>(&tool.def.shape))
        return cutter.split(mesh, now, *tool.surface, plane->snap);
    if (const auto* cut = std::get_if<cutting::SurfaceCut>(&tool.def.shape))
        return cutter.split(mesh, now, *tool.surface, cut->snap);
    const Blade& blade = std::get<Blade>(tool.def.shape);
    cutting::place_edge(blade, tool.pose, tool.edge_before);
    cutting::place_edge(blade, tool.target, tool.edge_after);
    tool.motion.resize(blade.edge.size(), Vec3::Zero());
    if (tool.edge_before != tool.edge_after)
        for (std::size_t i = 0; i < tool.motion.size(); ++i)
            tool.motion[i] = tool.edge_after[i] - tool.edge_before[i];
    if (tool.cut) return cutter.split(*tool.cut, mesh, now, tool.edge_before, tool.edge_after);
    return cutter.separate(mesh, now, tool.edge_before, tool.edge_after);
}

void World::Parts::follow(ToolId id, cutting::Split done, double end) {
    const ChangeSet& changes = done.changes;
    if (changes.is_empty()) return;
    // These totals are those before the edit: the model has not followed it yet.
    if (has_moved) model.compute_totals_and_forces();
    const BodyTotals before = has_moved ? ledger.body_totals() : ledger.last();
    has_moved = false;
    const double mass_removed = removed_mass(model, changes);
    physics::ModelChanges of_model = model.apply(mesh, changes);
    cutter.apply(mesh, changes);
    if (surface) surface->apply(mesh, changes);
    EditRecord record = ledger.record(end, num_steps, tools[id.index].def.name, done,
                                      of_model.fragments, before, mass_removed);
    report.edits.push_back({id, std::move(record), std::move(done.changes), std::move(of_model)});
}

}  // namespace incise::sim
