// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "cutting/step_length.h"
#include "cutting/undividable.h"
#include "io/number_format.h"
#include "physics/integrator.h"
#include "topology/archive.h"
#include "topology/mesh_archive.h"

namespace incise::sim {

using cutting::Blade;
using cutting::Carver;
using cutting::CutMode;
using topology::ChangeSet;
using topology::Mesh;

namespace {

Mesh mesh_of(std::variant<topology::MeshData, Mesh> mesh) {
    if (auto* built = std::get_if<Mesh>(&mesh)) return std::move(*built);
    return Mesh::build(std::get<topology::MeshData>(mesh)).mesh;
}

physics::MaterialTable materials_of(WorldDef& def, const Mesh& mesh) {
    physics::MaterialTable table{std::move(def.materials), std::move(def.material_of_region),
                                 std::move(def.fibres), def.precision};
    if (table.of_region.empty() && !table.materials.empty())
        for (const topology::ElementId e : mesh.elements()) table.of_region[mesh.region(e)] = 0;
    return table;
}

std::unique_ptr<physics::Integrator> make_integrator(Solver solver) {
    if (solver == Solver::statics) return std::make_unique<physics::Statics>();
    if (solver == Solver::implicit_euler) return std::make_unique<physics::ImplicitEuler>();
    return std::make_unique<physics::SemiImplicitEuler>();
}

/// The speed of waves in a region is that which relates the stable step of an element to the
/// lengths in it.
cutting::UncutBody uncut_body(const physics::Model& model) {
    const Mesh& mesh = model.mesh();
    cutting::UncutBody body{cutting::mean_edge_length(mesh), {}};
    const double stable_step = model.stable_step();
    for (const topology::ElementId e : mesh.elements()) {
        if (mesh.kind(e) != topology::CellKind::tetrahedron) continue;
        std::array<Vec3, 4> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = mesh.rest_position(mesh.corners(e)[k]);
        const double speed = cutting::own_step_length(x) / model.own_step(e);
        double& length = body.step_length[mesh.region(e)];
        length = std::max(length, speed * stable_step);
    }
    return body;
}

/// Throws InputError.
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

double read_time(topology::ArchiveReader& ar) {
    const auto time = ar.read<double>();
    if (!(time >= 0.0 && std::isfinite(time)))
        throw InputError("its time is " + io::format_number(time) + " s");
    return time;
}

bool is_sound(const Pose& pose) {
    return pose.position.allFinite() && std::abs(pose.rotation.squaredNorm() - 1.0) < 1e-6;
}

}  // namespace

// A body that can be cut, in the order in which its parts refer to each other.
struct World::Parts {
    /// A tool in its world.
    struct Tool {
        ToolDef def;
        std::optional<cutting::CutId> cut = {};                   // of a blade that splits
        std::shared_ptr<const cutting::CutSurface> surface = {};  // of a cut at once
        bool is_present = false;
        Pose pose = {};    // now
        Pose target = {};  // at the end of the next step
        bool is_leaving = false;
        std::optional<Pose> pose_before_end = {};
        std::vector<Vec3> edge_before = {}, edge_after = {}, motion = {};  // of a blade

        static void archive(auto& ar, auto& self) {
            ar(self.def.name, self.def.shape, self.cut, self.is_present, self.pose, self.target,
               self.is_leaving, self.pose_before_end, self.edge_after, self.motion);
        }
    };

    explicit Parts(WorldDef def)
        : mesh(mesh_of(std::move(def.mesh))),
          model(mesh, materials_of(def, mesh),
                {def.gravity, def.damping, std::move(def.constraints), std::move(def.loads)}),
          integrator(make_integrator(def.solver)),
          solver(def.solver),
          ledger(model),
          cutter(mesh, model.positions(), uncut_body(model)) {
        model.set_num_threads(def.num_threads);
    }
    /// What save() wrote of a world that was made as `former` was.
    Parts(const Parts& former, topology::ArchiveReader& ar)
        : mesh(topology::load_mesh(ar)),
          time(read_time(ar)),
          model(mesh, former.model.elements().materials(), ar, time),
          integrator(make_integrator(former.solver)),
          solver(former.solver),
          ledger(model),
          cutter(mesh, model.positions()) {
        integrator->restore(ar, model);
        ledger.restore(ar);
        ar(cutter, tools, num_steps, has_moved);
        if (!ar.is_at_end()) throw InputError("there are data beyond the end of the world");
        prepare_tools();
        model.set_num_threads(former.model.num_threads());
    }
    void save(topology::ArchiveWriter& ar) const;
    void prepare_tools();

    void step_to(double end);
    void cut_with(ToolId id, double end);
    cutting::Split split_with(Tool& tool);
    void follow(ToolId id, cutting::Split done, double end);
    Tool& tool_of(ToolId id);
    void require_sound_pose(ToolId id, const Pose& pose) const;
    bool is_any_tool_present() const {
        return std::ranges::any_of(tools, [](const Tool& tool) { return tool.is_present; });
    }

    Mesh mesh;
    double time = 0.0;
    physics::Model model;
    std::unique_ptr<physics::Integrator> integrator;
    Solver solver;
    Ledger ledger;
    cutting::Cutter cutter;
    std::vector<Tool> tools;
    StepReport report;
    std::uint64_t num_steps = 0;
    bool has_moved = true;  // since the last edit
    bool has_failed = false;
};

World::World(WorldDef def) : parts_(std::make_unique<Parts>(std::move(def))) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

const StepReport& World::step(double dt) {
    if (!(dt > 0.0 && std::isfinite(dt)))
        throw InputError("a step of " + io::format_number(dt) + " s: it must be above 0");
    return step_to(parts_->time + dt);
}

const StepReport& World::step_to(double time) {
    Parts& p = *parts_;
    if (p.has_failed)
        throw InputError("the world has failed in the step from " + io::format_number(p.time) +
                         " s; restore a state that was saved before");
    const double dt = time - p.time;
    if (!(dt > 0.0 && std::isfinite(dt)))
        throw InputError("a step from " + io::format_number(p.time) + " s to " +
                         io::format_number(time) + " s: it must go forward");
    // Steps that divide an interval evenly may be longer by rounding.
    constexpr double rounding = 1e-8;
    if (p.solver == Solver::semi_implicit_euler &&
        !(dt <= (1.0 + rounding) * p.model.stable_step()))
        throw InputError("a step of " + io::format_number(dt) + " s is above the stable step of " +
                         io::format_number(p.model.stable_step()) + " s");
    p.has_failed = true;
    p.step_to(time);
    p.has_failed = false;
    return p.report;
}

void World::Parts::step_to(double end) {
    report.from = time;
    report.to = end;
    report.edits.clear();
    report.tools.clear();
    const auto begin_motion = [&] {
        if (is_any_tool_present()) cutter.begin_motion(model.positions());
    };
    const auto end_motion = [&] {
        has_moved = true;
        cutter.end_motion(mesh, model.positions(), model.largest_move());
    };

    begin_motion();
    integrator->step(model, time, end - time);
    time = end;
    ++num_steps;
    end_motion();
    for (std::size_t i = 0; i < tools.size(); ++i) cut_with({i}, end);
    // What the way to a new equilibrium takes across a tool, which now rests, is cut as well.
    for (std::size_t num_followed = 0; num_followed < report.edits.size();) {
        num_followed = report.edits.size();
        begin_motion();
        if (!integrator->settle(model, end)) break;
        end_motion();
        for (std::size_t i = 0; i < tools.size(); ++i) cut_with({i}, end);
    }
    model.compute_forces(end);
    for (std::size_t i = 0; i < tools.size(); ++i)
        if (const Tool& tool = tools[i]; tool.is_present)
            report.tools.push_back({{i}, tool.pose, tool.cut && cutter.is_in_tissue(*tool.cut)});
}

/// What a tool meets while it goes from its pose to its target. Then it is there.
void World::Parts::cut_with(ToolId id, double end) {
    Tool& tool = tools[id.index];
    if (!tool.is_present) return;
    const auto carry_out = [&](auto edit) -> cutting::Split {
        try {
            return edit();
        } catch (const InputError& error) {
            std::ostringstream text;
            text << "tool '" << tool.def.name << "', at t = " << end << " s: " << error.what();
            throw ToolError(text.str(), id,
                            dynamic_cast<const cutting::UndividableElement*>(&error) != nullptr);
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
        follow(id,
               carry_out([&] { return cutter.end_cut(*tool.cut, mesh, model.positions(), blade); }),
               end);
    }
    tool.is_present = tool.is_leaving = false;
}

cutting::Split World::Parts::split_with(Tool& tool) {
    const auto now = model.positions();
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
    // The model has not followed yet.
    if (has_moved) model.compute_states_and_forces();
    const Account before = has_moved ? ledger.account() : ledger.last();
    has_moved = false;
    const double mass_removed = removed_mass(model, changes);
    model.apply(changes);
    cutter.apply(mesh, model.positions(), changes);
    EditRecord record =
        ledger.record(end, num_steps, tools[id.index].def.name, done, before, mass_removed);
    report.edits.push_back({id, std::move(record), std::move(done.changes)});
}

const StepReport& World::report() const { return parts_->report; }
bool World::has_failed() const { return parts_->has_failed; }
double World::time() const { return parts_->time; }
std::uint64_t World::num_steps() const { return parts_->num_steps; }
double World::stable_step() const { return parts_->model.stable_step(); }

World::Parts::Tool& World::Parts::tool_of(ToolId id) {
    if (id.index >= tools.size())
        throw InputError("there is no tool " + std::to_string(id.index) + ": the world has " +
                         std::to_string(tools.size()));
    return tools[id.index];
}

void World::Parts::require_sound_pose(ToolId id, const Pose& pose) const {
    if (!is_sound(pose))
        throw InputError("tool '" + tools[id.index].def.name +
                         "': its pose must have a finite position, m, and a rotation of length 1");
}

ToolId World::add_tool(ToolDef def) {
    require_sound(def);
    Parts& p = *parts_;
    Parts::Tool tool{std::move(def)};
    tool.surface = cutting::cut_surface_of(tool.def.shape);
    if (const auto* blade = std::get_if<Blade>(&tool.def.shape))
        if (blade->mode == CutMode::split) tool.cut = p.cutter.begin_cut(blade->snap);
    p.tools.push_back(std::move(tool));
    return {p.tools.size() - 1};
}

void World::place_tool(ToolId id, const Pose& pose) {
    Parts::Tool& tool = parts_->tool_of(id);
    parts_->require_sound_pose(id, pose);
    if (tool.cut && parts_->cutter.is_in_tissue(*tool.cut))
        throw InputError("tool '" + tool.def.name +
                         "' is in the tissue: withdraw it before it is put elsewhere");
    tool.is_present = true;
    tool.pose = tool.target = pose;
}

void World::set_tool_pose(ToolId id, const Pose& pose) {
    Parts::Tool& tool = parts_->tool_of(id);
    parts_->require_sound_pose(id, pose);
    if (!tool.is_present) tool.pose = pose;
    tool.is_present = true;
    tool.target = pose;
}

void World::withdraw_tool(ToolId id, const Pose* pose_before) {
    Parts::Tool& tool = parts_->tool_of(id);
    if (!tool.is_present)
        throw InputError("tool '" + tool.def.name + "' is not there to be withdrawn");
    tool.is_leaving = true;
    tool.pose_before_end.reset();
    if (pose_before) tool.pose_before_end = *pose_before;
}

bool World::is_tool_present(ToolId id) const { return parts_->tool_of(id).is_present; }
Pose World::tool_pose(ToolId id) const { return parts_->tool_of(id).pose; }
const ToolDef& World::tool(ToolId id) const { return parts_->tool_of(id).def; }
std::size_t World::num_tools() const { return parts_->tools.size(); }

void World::Parts::save(topology::ArchiveWriter& ar) const {
    topology::save(mesh, ar);
    ar(time);
    model.save(ar);
    integrator->save(ar);
    ledger.save(ar);
    ar(cutter, tools, num_steps, has_moved);
}

/// What an archive does not hold of tools, or holds wrongly.
void World::Parts::prepare_tools() {
    if (!cutter.is_on(mesh)) throw InputError("what its tools remember is of another body");
    for (std::size_t i = 0; i < tools.size(); ++i) {
        Tool& tool = tools[i];
        require_sound(tool.def);
        require_sound_pose({i}, tool.pose);
        require_sound_pose({i}, tool.target);
        const auto* blade = std::get_if<Blade>(&tool.def.shape);
        const bool splits = blade && blade->mode == CutMode::split;
        if (tool.cut.has_value() != splits || (tool.cut && !cutter.has_cut(*tool.cut)))
            throw InputError("the cut of a tool is not there");
        tool.surface = cutting::cut_surface_of(tool.def.shape);
    }
}

namespace {

/// To be changed with what save() lists and with the bits that a world computes.
constexpr std::uint32_t state_format = 1;
constexpr std::uint32_t state_mark = 0x57434e49;  // "INCW"

}  // namespace

std::string World::save() const {
    topology::ArchiveWriter ar;
    ar(state_mark, state_format);
    parts_->save(ar);
    return ar.bytes();
}

void World::restore(std::string_view bytes) {
    topology::ArchiveReader ar(bytes);
    const auto mark = ar.read<std::uint32_t>();
    const auto format = ar.read<std::uint32_t>();
    if (mark != state_mark) throw InputError("this is no saved world");
    if (format != state_format)
        throw InputError("the world was saved in format " + std::to_string(format) +
                         ", and this version reads " + std::to_string(state_format));
    parts_ = std::make_unique<Parts>(*parts_, ar);
}

void World::set_num_threads(int n) { parts_->model.set_num_threads(n); }

const Mesh& World::mesh() const { return parts_->mesh; }
const physics::Model& World::model() const { return parts_->model; }
const cutting::Cutter& World::cutter() const { return parts_->cutter; }
const Ledger& World::ledger() const { return parts_->ledger; }

}  // namespace incise::sim
