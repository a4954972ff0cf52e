// Construction of a world, and its main loop.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "incise/sim/world_checks.h"
#include "incise/sim/world_parts.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::sim {

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
        for (const CellId e : mesh.elements()) table.of_region[mesh.region(e)] = 0;
    return table;
}

}  // namespace

std::uint32_t next_number() {
    // The one thing that worlds share: no result depends on it, and no bytes hold it.
    static std::atomic<std::uint32_t> last = 0;
    return ++last;
}

std::unique_ptr<physics::Integrator> make_integrator(Solver solver, contact::Contact* contact) {
    if (solver == Solver::statics) return std::make_unique<physics::Statics>();
    if (solver == Solver::implicit_euler) return std::make_unique<physics::ImplicitEuler>();
    auto integrator = std::make_unique<physics::SemiImplicitEuler>();
    if (contact) integrator->add_projection(*contact);
    return integrator;
}

std::unique_ptr<contact::Contact> World::Parts::make_contact(
    const contact::ContactSettings& settings, Solver with) {
    if (!settings.enabled || with != Solver::semi_implicit_euler) return nullptr;
    return std::make_unique<contact::Contact>(settings, topology::mean_element_length(mesh));
}

World::Parts::Parts(WorldDef def)
    : number(next_number()),
      mesh(mesh_of(std::move(def.mesh))),
      // Braces fix the order: the definition is checked before parts of it are moved.
      model{mesh,
            materials_of(def, mesh),
            {def.gravity, def.damping, std::move(def.constraints), std::move(def.loads)}},
      contact(make_contact(def.contact, def.solver)),
      integrator(make_integrator(def.solver, contact.get())),
      solver(def.solver),
      ledger(model),
      constraints("constraint", number, model.boundary().constraints().size()),
      grasps(model.boundary().constraints().size()),
      loads("load", number, model.boundary().loads().all().size()),
      stable_step(model.stable_step()),
      bound_interval{topology::mean_element_length(mesh)} {
    model.set_num_threads(def.num_threads);
    // An archive does not keep the carriers of the source, from which a cutter starts.
    if (!mesh.source_carriers().is_empty()) built_cutter();
    if (contact) contact->follow(model, built_surface());
}

void World::Parts::step_to(double end) {
    report.from = time;
    report.to = end;
    report.edits.clear();
    report.tools.clear();
    const auto cut = [&] {
        has_moved = true;
        if (cutter) cutter->follow_motion(mesh, model.mesh_positions());
        for (const ToolId id : tool_ids.all()) cut_with(id, end);
    };

    if (loads_have_changed) model.compute_forces(time);
    loads_have_changed = false;
    for (std::size_t i = 0; i < grasps.size(); ++i) {
        if (!grasps[i]) continue;
        auto& [pose, target] = *grasps[i];
        model.boundary().set_grip(i, physics::TimeCurve<Pose>({{time, pose}, {end, target}}));
        pose = target;
    }
    for (const auto& tool : tools) tool->begin_step(end - time);
    move_to(end);
    time = end;
    ++num_steps;
    cut();
    // Tissue that crosses a tool during the motion to the new equilibrium is cut too. The tools do
    // not move during this motion.
    for (std::size_t num_followed = 0; num_followed < report.edits.size();) {
        num_followed = report.edits.size();
        if (!integrator->equilibrate(model, end)) break;
        cut();
    }
    model.compute_forces(end);
    if (contact && !report.edits.empty()) follow_with_contact();
    update_stable_step();
    for (const ToolId id : tool_ids.all()) report_tool(id);
    report_contact();
}

void World::Parts::follow_with_contact() {
    contact->follow(model, built_surface());
    for (const auto& tool : tools)
        if (auto* touching = tool->contact()) touching->follow(model);
}

void World::Parts::report_tool(ToolId id) {
    ToolActor& tool = *tools[id.index];
    if (!tool.is_present() && !tool.has_just_left()) return;
    ToolState state{id, tool.pose(), tool.is_in_tissue(built_cutter())};
    if (contact) {
        auto* touching = tool.contact();
        const auto done = touching ? touching->take_sum() : contact::ToolImpulse();
        state.force = -done.force / (report.to - report.from);
        state.torque = -done.torque / (report.to - report.from);
    }
    report.tools.push_back(state);
    if (tool.has_just_left()) tool.forget_leaving();
}

void World::Parts::report_contact() {
    if (contact)
        report.contact = {contact->num_points(), contact->max_penetration(), contact->dissipation(),
                          contact->fracture_energy()};
}

double World::Parts::present_bound() const {
    // A step in which nodes cross much of an element changes the stiffness by more than is known.
    constexpr double largest_motion = 0.15;
    Vec3 momentum = Vec3::Zero();
    double mass = 0.0, fastest = 0.0;
    for (std::size_t n = 0; n < model.masses().size(); ++n) {
        mass += model.masses()[n];
        momentum += model.masses()[n] * model.velocities()[n];
    }
    const Vec3 mean = momentum / mass;
    for (std::size_t n = 0; n < model.masses().size(); ++n)
        if (model.masses()[n] > 0.0)
            fastest = std::max(fastest, (model.velocities()[n] - mean).squaredNorm());
    const double motion = largest_motion * bound_interval.element_length;
    return std::min(model.stable_step(), motion / std::sqrt(fastest));
}

void World::Parts::renew_stable_step() {
    stable_step = present_bound();
    bound_interval = {bound_interval.element_length};
}

void World::Parts::update_stable_step() {
    BoundInterval& interval = bound_interval;
    ++interval.num_steps;
    ++interval.num_held;
    double bound = stable_step;
    if (interval.is_over()) {
        bound = present_bound();
        interval.least = std::min(interval.least, bound);
        interval.num_steps = 0;
        interval.moved = 0.0;
    } else {
        for (const Edit& edit : report.edits)
            bound = std::min(bound,
                             model.structure().stable_step(model.state(), edit.body.touched_nodes));
    }
    bound = interval.may_rise(stable_step) ? interval.least : std::min(bound, stable_step);
    if (bound == stable_step) return;
    stable_step = bound;
    interval.num_held = 0;
    interval.least = std::numeric_limits<double>::infinity();
}

void World::Parts::touch_with_tools(double from, double to, double moved) {
    contact->begin_tools();
    for (const auto& tool : tools) {
        if (!tool->is_present() || !cutting::feels_force(tool->def().shape)) continue;
        if (auto* touching = tool->touch(tissue(), from, to, moved)) contact->add_tool(*touching);
    }
}

void World::Parts::move_to(double end) {
    const double from = time, dt = end - time;
    const std::size_t n = report.num_substeps;
    double moved = 0.0;  // how far a node has moved, at most
    reactions.assign(model.boundary().constraints().size(), {});
    for (std::size_t i = 0; i < n; ++i) {
        const double next =
            i + 1 == n ? end : from + dt * static_cast<double>(i + 1) / static_cast<double>(n);
        if (i > 0) model.compute_forces(time);
        if (contact)
            touch_with_tools(static_cast<double>(i) / static_cast<double>(n),
                             static_cast<double>(i + 1) / static_cast<double>(n), moved);
        integrator->step(model, time, next - time);
        if (contact) contact->book_work(model);
        for (std::size_t k = 0; k < reactions.size() && n > 1; ++k)
            reactions[k] += (next - time) / dt * model.boundary().reactions()[k];
        moved += model.largest_mesh_move();
        bound_interval.moved += model.state().largest_move();
        time = next;
    }
    if (n > 1) model.boundary().set_reactions(reactions);
}

/// Cuts what a tool meets on the path from its pose to its target, and moves the tool there.
void World::Parts::cut_with(ToolId id, double end) {
    ToolActor& tool = *tools[id.index];
    const auto carry_out = [&](const std::function<cutting::Split()>& edit) {
        const cutting::Split done = [&] {
            try {
                return edit();
            } catch (const InputError& error) {
                std::ostringstream text;
                text << "tool '" << tool.def().name << "', at t = " << end
                     << " s: " << error.what();
                throw ToolError(text.str(), id);
            }
        }();
        follow(id, done, end);
    };
    tool.act(tissue(), std::ref(carry_out));  // a copy would take memory in each step
}

void World::Parts::follow(ToolId id, const cutting::Split& done, double end) {
    const ChangeSet& changes = done.changes;
    if (changes.is_empty()) return;
    // These totals are those before the edit: the model has not followed it yet.
    if (has_moved) model.compute_totals_and_forces();
    const BodyTotals before = has_moved ? ledger.body_totals() : ledger.last();
    has_moved = false;
    const double mass_removed = removed_mass(model, changes);
    physics::BodyEdit edit = model.apply(mesh, changes);
    if (is_undo_wanted()) log_end = log_end->append(edit);
    cutter->apply(mesh, changes);
    if (surface) surface->apply(mesh, changes);
    EditRecord record = ledger.record(end, num_steps, tools[id.index]->def().name, done,
                                      edit.physics, before, mass_removed);
    report.edits.push_back({id, std::move(record), std::move(edit)});
}

}  // namespace incise::sim
