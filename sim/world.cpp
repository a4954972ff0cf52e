// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/base/number_format.h"
#include "incise/contact/tool_contact.h"
#include "incise/physics/body/element_snapshot.h"
#include "incise/sim/world_checks.h"
#include "incise/sim/world_parts.h"

namespace incise::sim {

using topology::Mesh;

World::World(WorldDef def) : parts_(std::make_unique<Parts>(std::move(def))) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

const StepReport& World::step(double dt, const StepInputs& inputs) {
    if (!(dt > 0.0 && std::isfinite(dt)))
        throw InputError("a step of " + format_number(dt) + " s: it must be above 0");
    return parts_->checked_step(parts_->time + dt, dt, inputs);
}

const StepReport& World::step_to(double time, const StepInputs& inputs) {
    return parts_->checked_step(time, time - parts_->time, inputs);
}

void World::require_possible(const StepInputs& inputs) const { parts_->require_possible(inputs); }

const StepReport& World::Parts::checked_step(double end, double dt, const StepInputs& inputs) {
    if (has_failed)
        throw InputError("the world has failed in the step from " + format_number(time) +
                         " s; go back to a moment before it, by undo() or restore()");
    if (!(end > time && std::isfinite(end)))
        throw InputError("a step from " + format_number(time) + " s to " + format_number(end) +
                         " s: it must go forward");
    const double at_rest = model.structure().rest_stable_step();
    if (solver == Solver::semi_implicit_euler && !(dt <= (1.0 + rounding_of_steps) * at_rest))
        throw InputError("a step of " + format_number(dt) + " s is above the stable step of " +
                         format_number(at_rest) + " s");
    require_possible(inputs);
    const std::size_t n = num_substeps(dt, inputs);
    // From here on nothing is refused.
    report.num_substeps = n;
    take(inputs);
    has_failed = true;
    step_to(end);
    has_failed = false;
    return report;
}

void World::Parts::require_possible(const StepInputs& inputs) const {
    const auto require_once = [](auto list, auto member) {
        for (std::size_t i = 1; i < list.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (list[i].*member == list[k].*member)
                    throw InputError(
                        "the inputs of a step name the same thing twice, by an id from before a "
                        "restore and by a new one");
    };
    for (const ToolInput& input : inputs.tools()) tool_of(input.tool).require_possible(input);
    require_once(inputs.tools(), &ToolInput::tool);
    require_once(inputs.grasps(), &GraspInput::grasp);
    for (const GraspInput& input : inputs.grasps()) {
        const std::size_t index = constraints.position_of(input.grasp);
        const auto name = [&] {
            return "constraint '" + model.boundary().constraints().name(index) + "'";
        };
        if (!grasps[index]) throw InputError(name() + " is no grasp");
        if (!input.pose.is_sound()) throw InputError(name() + ": its pose is none");
    }
}

void World::Parts::take(const StepInputs& inputs) {
    for (const ToolInput& input : inputs.tools()) tool_of(input.tool).take(input);
    for (const GraspInput& input : inputs.grasps())
        grasps[constraints.position_of(input.grasp)]->target = input.pose;
}

std::size_t World::Parts::num_substeps(double dt, const StepInputs& inputs) const {
    if (solver != Solver::semi_implicit_euler) return 1;
    constexpr double most = 1000.0;
    double parts = std::max(std::ceil(dt / stable_step - rounding_of_steps), 1.0);
    if (parts > most)
        throw InputError("a step of " + format_number(dt) + " s is far above " +
                         format_number(stable_step) +
                         " s, the stable step of the tissue in its present strain; something "
                         "crushes or draws out an element: use smaller motions or loads, or "
                         "shorter steps");
    for (const ToolInput& input : inputs.tools()) {
        const ToolActor& tool = tool_of(input.tool);
        if (!contact || !tool.is_present() || !input.pose) continue;
        parts = std::max(parts, tool.num_substeps(*input.pose, contact->size()));
        if (parts > most)
            throw InputError("tool '" + tool.def().name + "' moves so far in a step of " +
                             format_number(dt) +
                             " s that the step needs more than 1000 parts; move it more slowly");
    }
    return static_cast<std::size_t>(parts);
}

const StepReport& World::report() const { return parts_->report; }
bool World::has_failed() const { return parts_->has_failed; }
double World::time() const { return parts_->time; }
std::uint64_t World::num_steps() const { return parts_->num_steps; }
double World::stable_step() const { return parts_->stable_step; }
double World::rest_stable_step() const { return parts_->model.structure().rest_stable_step(); }

topology::BoundarySurface& World::Parts::built_surface() {
    if (!surface) surface.emplace(mesh);
    return *surface;
}

cutting::Cutter& World::Parts::built_cutter() {
    if (!cutter) {
        cutter.emplace(mesh, model.mesh_positions());
        if (num_steps > 0) cutter->settle(mesh);  // as it would have in the steps so far
    }
    return *cutter;
}

ToolId World::add_tool(const ToolDef& def) {
    const bool had_cutter = parts_->cutter.has_value();
    try {
        parts_->tools.push_back(make_actor(def, parts_->tissue()));
    } catch (...) {  // a tool that is refused changes nothing
        if (!had_cutter) parts_->cutter.reset();
        throw;
    }
    return parts_->tool_ids.add();
}

void World::place_tool(ToolId id, const Pose& pose) {
    parts_->tool_of(id).place(parts_->tissue(), pose);
}

std::size_t World::close_tool(ToolId id) { return parts_->tool_of(id).close(parts_->tissue()); }
void World::open_tool(ToolId id) { parts_->tool_of(id).open(); }
bool World::is_tool_closed(ToolId id) const { return parts_->tool_of(id).is_closed(); }
std::size_t World::num_held(ToolId id) const { return parts_->tool_of(id).num_held(); }

std::size_t World::tie_suture(ToolId id) { return parts_->tool_of(id).tie(parts_->tissue()); }
double World::suture_length(ToolId id) const { return parts_->tool_of(id).length(); }
void World::untie_suture(ToolId id) { parts_->tool_of(id).untie(); }
bool World::is_suture_tied(ToolId id) const { return parts_->tool_of(id).is_tied(); }

std::span<const contact::ToolContactPoint> World::tool_contacts(ToolId id) const {
    ToolActor& tool = parts_->tool_of(id);
    const bool touches = tool.is_present() && parts_->contact && tool.contact();
    return touches ? tool.contact()->points() : std::span<const contact::ToolContactPoint>();
}
bool World::is_tool_present(ToolId id) const { return parts_->tool_of(id).is_present(); }
Pose World::tool_pose(ToolId id) const { return parts_->tool_of(id).pose(); }
const ToolDef& World::tool(ToolId id) const { return parts_->tool_of(id).def(); }
std::optional<ToolId> World::find_tool(std::string_view name) const {
    const auto found = std::ranges::find_if(
        parts_->tools, [&](const auto& tool) { return tool->def().name == name; });
    if (found == parts_->tools.end()) return std::nullopt;
    return tools()[static_cast<std::size_t>(found - parts_->tools.begin())];
}
std::span<const ToolId> World::tools() const { return parts_->tool_ids.all(); }

const topology::BoundarySurface& World::surface() { return parts_->built_surface(); }
std::vector<std::size_t> World::take_surface_changes() {
    return parts_->built_surface().take_changes();
}

void World::set_num_threads(int n) {
    require_sound_num_threads(n);
    parts_->model.set_num_threads(n);
}

const Mesh& World::mesh() const { return parts_->mesh; }
std::span<const Vec3> World::positions() const { return parts_->model.mesh_positions(); }
std::span<const Vec3> World::velocities() const { return parts_->model.mesh_velocities(); }
std::vector<double> World::masses() const { return parts_->model.structure().mesh_masses(); }
physics::BodyArrays World::body_arrays() const { return physics::body_arrays(parts_->model); }
std::vector<physics::ElementResult> World::cell_results() const {
    std::vector<ElementId> elements;
    for (const CellId e : mesh().elements())
        elements.push_back(model().fragments().fragment_of_cell(e));
    return physics::ElementSnapshot(model()).results(elements);
}
const physics::Model& World::model() const { return parts_->model; }
const cutting::Cutter& World::cutter() const { return parts_->built_cutter(); }
std::optional<std::vector<std::pair<VertexId, Vec3>>> World::contact_forces() const {
    if (!parts_->contact) return std::nullopt;
    return parts_->contact->node_forces();
}
const Ledger& World::ledger() const { return parts_->ledger; }

}  // namespace incise::sim
