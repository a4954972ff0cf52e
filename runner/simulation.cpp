// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/simulation.h"

#include <algorithm>
#include <cmath>

#include "incise/base/checksum.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/input_file.h"
#include "incise/scenario/body.h"
#include "incise/scenario/remedies.h"
#include "incise/scenario/step_limit.h"

namespace incise::runner {

namespace {

/// Returns a checksum of mesh, carriers, cut faces and fibres at the start, and of the files of
/// surfaces.
std::uint64_t fingerprint_of(const physics::Model& model,
                             const std::vector<scenario::ToolSpec>& tools) {
    const topology::Mesh& mesh = model.mesh();
    ArchiveWriter ar;
    for (const Vec3& x : mesh.rest_positions()) ar(x);
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
        const CellId e(i);
        ar(mesh.label(e), mesh.kind(e), mesh.region(e));
        for (const VertexId n : mesh.corners(e)) ar(n, mesh.label(n));
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            ar(mesh.neighbor({e, f}).cell);
            if (mesh.is_on_cut({e, f})) ar(f);
        }
    }
    for (const std::int64_t row : mesh.source_carriers().of_cell) ar(row);
    for (const auto& corners : mesh.source_carriers().corners)
        for (const Vec3& x : corners) ar(x);
    for (const Vec3& fibre : model.structure().fibres()) ar(fibre);
    for (const scenario::ToolSpec& tool : tools) {
        if (tool.surface) ar(io::load_input_file(tool.surface->path).bytes);
    }
    return incise::checksum(ar.bytes());
}

}  // namespace

Simulation::Simulation(const scenario::Scenario& scenario, StepPolicy policy)
    : Simulation(scenario, scenario::build_body(scenario), std::move(policy)) {}

Simulation::Simulation(const scenario::Scenario& scenario, scenario::Body body, StepPolicy policy)
    : scenario_(scenario),
      policy_(std::move(policy)),
      warnings_(std::move(body.warnings)),
      world_(scenario::make_world(scenario, std::move(body.mesh), std::move(body.materials),
                                  std::move(body.boundary_conditions), warnings_)),
      tools_(world_, std::move(body.tools)),
      fingerprint_(fingerprint_of(model(), scenario.tools)),
      run_warnings_(world_, scenario_.dynamics),
      num_body_warnings_(warnings_.size()) {
    // Refuses a fixed step that is too large before anything is written.
    scenario::step_limit(scenario_, model(), world_.stable_step(), num_steps());
}

void Simulation::start() {
    for (Observer* observer : observers_) observer->on_start(*this);
    report_frame();
    report_pause();
}

bool Simulation::is_finished() const { return time() >= scenario_.dynamics.end_time; }

void Simulation::step(Interval step, const sim::StepInputs& inputs) {
    inputs_ = inputs;
    tools_.lead(world_, step.from, step.to, inputs_, warnings_);
    if (begins_row_) forces_.begin(step.from);
    begins_row_ = false;
    try {
        world_.step_to(step.to, inputs_);
    } catch (const sim::ToolError&) {
        report_edits();
        throw;
    } catch (const physics::MotionFailure& failure) {
        report_edits();
        throw PhysicsError(failure.what() + scenario::remedy_for(failure));
    }
    last_step_ = step.to - step.from;
    forces_.add(world_.report());
    begins_row_ = !world_.report().edits.empty();
    report_edits();
    tools_.warn_of_lost_holds(world_, warnings_);
    for (Observer* observer : observers_) observer->on_step(*this);
    if (is_finished()) run_warnings_.add_end(world_, warnings_);
    report_frame();
    report_pause();
}

void Simulation::report_edits() {
    run_warnings_.add_step(world_, warnings_);
    for (const sim::Edit& edit : world_.report().edits) {
        edits_.push_back(edit.record);
        for (Observer* observer : observers_) observer->on_edit(*this, edits_.back());
    }
}

void Simulation::save(ArchiveWriter& ar) const {
    ar(world_.save());
    save_run(ar);
}

void Simulation::restore(ArchiveReader& ar) {
    world_.restore(ar.read<std::string>());
    restore_run(ar);
}

Simulation::UndoPoint Simulation::undo_point() const {
    ArchiveWriter run;
    save_run(run);
    return {world_.undo_point(), run.take()};
}

void Simulation::undo(const UndoPoint& point) {
    world_.undo(point.world);
    ArchiveReader run(point.run);
    restore_run(run);
}

void Simulation::save_run(ArchiveWriter& ar) const {
    const std::vector<std::string> added(
        warnings_.begin() + static_cast<std::ptrdiff_t>(num_body_warnings_), warnings_.end());
    ar(edits_, last_step_, num_frames_, run_warnings_, tools_, forces_, begins_row_, added);
}

void Simulation::restore_run(ArchiveReader& ar) {
    std::vector<std::string> added;
    ar(edits_, last_step_, num_frames_, run_warnings_, tools_, forces_, begins_row_, added);
    warnings_.resize(num_body_warnings_);
    warnings_.insert(warnings_.end(), added.begin(), added.end());
    if (!(time() < scenario_.dynamics.end_time))
        throw InputError("its time, " + format_number(time()) + " s, is not within the run");
    if (world_.tools().size() < tools_.size())
        throw InputError("its tools are not those of the run");
    if (edits_.size() != ledger().num_edits())
        throw InputError("its ledger is not that of its edits");
    if (!(last_step_ >= 0.0 && last_step_ <= time()))
        throw InputError("its step, " + format_number(last_step_) + " s, is none of the run");
    if (!ar.is_at_end()) throw InputError("there are data beyond the end of its state");
}

double Simulation::time_step() const {
    if (num_steps() > 0) return last_step_;
    const auto [from, to] = next_step(next_stop());
    return to - from;
}

// Frames are at exact multiples of their interval, and the run ends exactly at its end time.
double Simulation::next_stop() const {
    // A tiny time between the last frame and the end is due to rounding, as 3 * 0.3 < 0.9.
    constexpr double rounding = 1e-9;
    const double interval = scenario_.output.interval;
    double stop = scenario_.dynamics.end_time;
    if (interval > 0.0) {
        const double frame =
            static_cast<double>(std::max<std::uint64_t>(num_frames_, 1)) * interval;
        if (frame < stop - rounding * interval) stop = frame;
    }
    return stop;
}

Simulation::Interval Simulation::next_step(double stop) const {
    const double end =
        policy_({scenario_, model(), time(), stop, world_.stable_step(), num_steps()});
    if (!(end > time() && end <= stop))
        throw InputError("the policy of steps chose a step from " + format_number(time()) +
                         " s to " + format_number(end) +
                         " s: it must end after its start, "
                         "and at " +
                         format_number(stop) + " s at the latest");
    return {time(), end};
}

void Simulation::report_frame() {
    const double interval = scenario_.output.interval;
    if (interval == 0.0) return;
    const bool is_due = time() >= static_cast<double>(num_frames_) * interval;
    if (!is_due && !is_finished()) return;
    ++num_frames_;
    begins_row_ = true;
    for (Observer* observer : observers_) observer->on_frame(*this);
}

void Simulation::report_pause() {
    for (Observer* observer : observers_) observer->on_pause(*this);
}

}  // namespace incise::runner
