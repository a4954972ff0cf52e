// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include "cutting/step_length.h"
#include "cutting/undividable.h"
#include "io/checked_file.h"
#include "io/input_file.h"
#include "io/number_format.h"
#include "physics/winding.h"
#include "sim/body.h"
#include "sim/step_limit.h"
#include "topology/change_check.h"
#include "topology/error.h"
#include "topology/mesh_edit.h"
#include "topology/validate.h"

namespace incise::sim {

namespace {

/// The speed of waves in a region is that which relates the stable step of an element to the
/// lengths in it.
cutting::UncutBody uncut_body(const physics::Model& model) {
    const topology::Mesh& mesh = model.mesh();
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

std::unique_ptr<physics::Integrator> make_integrator(const DynamicsSpec& dynamics) {
    if (dynamics.mode == Mode::statics) return std::make_unique<physics::Statics>();
    if (dynamics.integrator == TimeIntegrator::implicit_euler)
        return std::make_unique<physics::ImplicitEuler>();
    return std::make_unique<physics::SemiImplicitEuler>();
}

/// Of what the body is made of at the start, and of the files of tools.
std::uint64_t fingerprint_of(const physics::Model& model, const std::vector<ToolSpec>& tools) {
    const topology::Mesh& mesh = model.mesh();
    topology::ArchiveWriter ar;
    for (const Vec3& x : mesh.rest_positions()) ar(x);
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
        const topology::ElementId e(i);
        ar(mesh.label(e), mesh.kind(e), mesh.region(e));
        for (const topology::NodeId n : mesh.corners(e)) ar(n, mesh.label(n));
        for (int f = 0; f < mesh.num_faces(e); ++f) ar(mesh.neighbor({e, f}).element);
    }
    for (const Vec3& fibre : model.fibres()) ar(fibre);
    for (const ToolSpec& tool : tools)
        if (const auto* cut = std::get_if<Cut>(&tool.kind))
            if (const auto* file = std::get_if<std::filesystem::path>(&cut->along))
                ar(io::load_input_file(*file).bytes);
    return io::checksum(ar.bytes());
}

}  // namespace

Simulation::Simulation(const Scenario& scenario) : Simulation(scenario, build_body(scenario)) {}

Simulation::Simulation(const Scenario& scenario, Body body)
    : scenario_(scenario),
      warnings_(std::move(body.warnings)),
      mesh_(std::move(body.mesh)),
      model_(make_model(scenario, mesh_, body.materials, std::move(body.surroundings))),
      integrator_(make_integrator(scenario.dynamics)),
      ledger_(model_),
      tools_(std::move(body.tools)),
      boxes_(mesh_, model_.positions()),
      warned_step_(ledger_.initial().stable_step) {
    const cutting::UncutBody uncut = uncut_body(model_);
    for (Tool& tool : tools_) tool.prepare(uncut);
    fingerprint_ = fingerprint_of(model_, scenario.tools);
    step_limit();  // a fixed step that is too large is refused before anything is written
}

void Simulation::start() {
    for (Observer* observer : observers_) observer->on_start(*this);
    tell_frame();
    tell_pause();
}

bool Simulation::is_finished() const { return time_ >= scenario_.dynamics.end_time; }

void Simulation::step() {
    const auto [from, to] = next_step();
    const bool any_tool =
        std::any_of(tools_.begin(), tools_.end(),
                    [from = from, to = to](const Tool& tool) { return tool.is_present(from, to); });
    const auto keep_positions = [&] {
        if (any_tool)
            previous_positions_.assign(model_.positions().begin(), model_.positions().end());
    };
    keep_positions();
    const std::size_t num_edits = ledger_.edits().size();

    integrator_->step(model_, from, to - from);
    has_moved_ = true;

    time_ = to;
    last_step_ = to - from;
    ++num_steps_;
    boxes_.move(mesh_, model_.positions(), model_.largest_move());
    for (Tool& tool : tools_) cut(tool, from, to);
    // What the way to a new equilibrium takes across a tool, which now rests, is cut as well.
    for (std::size_t num_followed = num_edits; num_followed < ledger_.edits().size();) {
        num_followed = ledger_.edits().size();
        keep_positions();
        if (!integrator_->settle(model_, time_)) break;
        has_moved_ = true;
        boxes_.move(mesh_, model_.positions(), model_.largest_move());
        for (Tool& tool : tools_) cut(tool, to, to);
    }

    model_.compute_forces(time_);
    for (Observer* observer : observers_) observer->on_step(*this);
    if (is_finished()) warn_of_lost_elements();
    tell_frame();
    tell_pause();
}

void Simulation::save(topology::ArchiveWriter& ar) const {
    ar(edits_.bytes(), time_);
    model_.save(ar);
    integrator_->save(ar);
    ledger_.save(ar);
    for (const Tool& tool : tools_) ar(tool);
    ar(boxes_, scars_, last_step_, num_steps_, num_frames_);
}

// What follows edits follows them again, in the same order: mesh, elements, selections. What moves,
// and what tools remember, is as it was.
void Simulation::restore(topology::ArchiveReader& ar) {
    const auto edits = ar.read<std::string>();
    std::vector<EditTrace> traces;
    for (topology::ArchiveReader edit(edits); !edit.is_at_end();) {
        const auto changes = edit.read<topology::ChangeSet>();
        topology::require_fit(changes, mesh_);
        topology::replay(mesh_, changes);
        traces.push_back({changes.elements_removed.size(), changes.elements_added.size(),
                          changes.nodes_added.size(), changes.nodes_removed.size(),
                          removed_mass(model_, changes), mesh_.num_nodes(), mesh_.num_elements()});
        model_.apply(changes);
        edits_(changes);
    }
    if (const auto faults = topology::validate(mesh_); !faults.empty())
        throw InputError("its edits leave no sound mesh: " + faults.front());
    ar(time_);
    if (!(time_ >= 0.0 && time_ < scenario_.dynamics.end_time))
        throw InputError("its time, " + io::format_number(time_) + " s, is not within the run");
    model_.restore(ar, time_);
    integrator_->restore(ar, model_);
    ledger_.restore(ar, traces);
    for (const EditRecord& edit : ledger_.edits()) warn_of_short_steps(edit);
    for (Tool& tool : tools_) ar(tool);
    ar(boxes_, scars_, last_step_, num_steps_, num_frames_);
    const auto is_here = [&](const Tool& tool) { return tool.is_on(mesh_); };
    if (!std::all_of(tools_.begin(), tools_.end(), is_here) || !boxes_.cover(mesh_))
        throw InputError("what its tools remember is of another body");
    if (!(last_step_ >= 0.0 && last_step_ <= time_))
        throw InputError("its step, " + io::format_number(last_step_) + " s, is none of the run");
    if (!ar.is_at_end()) throw InputError("there are data beyond the end of its state");
}

/// Of edits after which steps are ten times as short as at the start, or as at the warning before.
void Simulation::warn_of_short_steps(const EditRecord& edit) {
    constexpr double much_shorter = 0.1;
    const DynamicsSpec& dynamics = scenario_.dynamics;
    const double now = edit.after.stable_step;
    if (dynamics.mode == Mode::statics ||
        dynamics.integrator != TimeIntegrator::semi_implicit_euler ||
        !(now < much_shorter * warned_step_))
        return;
    const auto tool = std::ranges::find(tools_, edit.tool, &Tool::name);
    std::ostringstream text;
    text.precision(3);
    text << "tool '" << edit.tool << "', at t = " << edit.time << " s: its cut has left "
         << (tool != tools_.end() && !tool->divides() ? "stiff elements with so little mass"
                                                      : "elements so thin")
         << " that the stable step fell from " << warned_step_ << " to " << now
         << " s: the run takes " << warned_step_ / now << " times as long from here on";
    if (tool != tools_.end()) text << "; " << tool->for_longer_steps();
    warnings_.push_back(text.str());
    warned_step_ = now;
}

void Simulation::warn_of_lost_elements() {
    // Tissue keeps its volume: with less it has been crushed, whatever the law thinks of it.
    constexpr double least_volume_ratio = 0.01;
    std::size_t num_crushed = 0;
    if (model_.min_volume_ratio() < least_volume_ratio)
        for (const topology::ElementId e : mesh_.elements())
            num_crushed += model_.element_result(e).volume_ratio < least_volume_ratio;
    std::ostringstream text;
    text << "at the end, t = " << time_ << " s, ";
    if (num_crushed > 0) {
        text << num_crushed << (num_crushed == 1 ? " element is" : " elements are")
             << " flat or inverted (J below " << least_volume_ratio
             << "): the body has been pressed through itself, which tissue cannot; see min_J in "
                "history.csv for when, and use smaller motions or loads, a finer mesh, or law = "
                "\"stable-neo-hookean\"";
    } else if (const auto winding = physics::find_winding(mesh_, model_.positions());
               winding.num_edges > 0) {
        text << "the body is wound up: round " << winding.num_edges
             << (winding.num_edges == 1 ? " edge" : " edges")
             << " elements go twice and lie in each other, one of them element "
             << mesh_.label(winding.element)
             << ", though none is inverted; no law can undo that: see the frames for when it "
                "happened, and use smaller motions or loads, a smaller dynamics.safety, or a lower "
                "Poisson's ratio";
    } else {
        return;
    }
    warnings_.push_back(text.str());
}

void Simulation::cut(Tool& tool, double from, double to) {
    if (!tool.is_present(from, to)) return;
    std::vector<cutting::RestingBlade> resting;
    for (Tool& other : tools_)
        if (&other != &tool)
            if (const auto blade = other.resting(from, to, &other < &tool))
                resting.push_back(*blade);
    const auto now = [&] { return model_.positions(); };
    const auto carry_out = [&](auto edit) -> cutting::Split {
        try {
            return edit();
        } catch (const InputError& error) {
            std::ostringstream text;
            text << "tool '" << tool.name() << "', at t = " << to << " s: " << error.what();
            if (dynamic_cast<const cutting::UndividableElement*>(&error))
                text << "; " << tool.instead_of_dividing();
            throw InputError(text.str());
        }
    };
    follow(tool, carry_out([&] {
               return tool.cut(mesh_, {mesh_, previous_positions_, now(), &boxes_}, scars_, resting,
                               from, to);
           }));
    if (tool.is_to_finish(from, to))
        follow(tool, carry_out([&] {
                   return tool.finish(mesh_, {mesh_, now(), now(), &boxes_}, scars_, resting);
               }));
}

void Simulation::follow(Tool& tool, const cutting::Split& done) {
    const topology::ChangeSet& changes = done.changes;
    if (changes.is_empty()) return;
    edits_(changes);
    // The model has not followed yet.
    if (has_moved_) model_.compute_states_and_forces();
    const Account before = has_moved_ ? ledger_.account() : ledger_.edits().back().after;
    has_moved_ = false;
    const double mass_removed = removed_mass(model_, changes);
    model_.apply(changes);
    topology::append_new_nodes(changes, previous_positions_);
    // Cuts that cross elements have done so already; to follow twice is as once.
    if (done.report.elements_crossed == 0) scars_.follow(changes);
    boxes_.follow(mesh_, model_.positions(), changes);
    for (Tool& other : tools_)
        if (&other != &tool) other.follow(changes);
    const EditRecord& edit =
        ledger_.record(time_, num_steps_, tool.name(), done, before, mass_removed);
    warn_of_short_steps(edit);
    for (Observer* observer : observers_) observer->on_edit(*this, edit);
}

double Simulation::time_step() const {
    if (num_steps_ > 0) return last_step_;
    const auto [from, to] = next_step();
    return to - from;
}

// Frames fall on exact multiples of their interval, and the run ends exactly at its end: the way
// to the next of these moments is divided evenly in steps below the limit.
Simulation::Interval Simulation::next_step() const {
    // A hair's breadth over a whole number of steps is rounding, not another step; so is one
    // between the last frame and the end, as after 3 * 0.3 < 0.9.
    constexpr double rounding = 1e-9;
    const double interval = scenario_.output.interval;
    double stop = scenario_.dynamics.end_time;
    if (interval > 0.0) {
        const double frame =
            static_cast<double>(std::max<std::uint64_t>(num_frames_, 1)) * interval;
        if (frame < stop - rounding * interval) stop = frame;
    }
    const double steps = std::ceil((stop - time_) / step_limit() * (1.0 - rounding));
    if (steps <= 1.0) return {time_, stop};
    return {time_, time_ + (stop - time_) / steps};
}

double Simulation::step_limit() const { return sim::step_limit(scenario_, model_, num_steps_); }

void Simulation::tell_frame() {
    const double interval = scenario_.output.interval;
    if (interval == 0.0) return;
    const bool is_due = time_ >= static_cast<double>(num_frames_) * interval;
    if (!is_due && !is_finished()) return;
    ++num_frames_;
    for (Observer* observer : observers_) observer->on_frame(*this);
}

void Simulation::tell_pause() {
    for (Observer* observer : observers_) observer->on_pause(*this);
}

}  // namespace incise::sim
