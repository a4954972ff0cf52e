// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/world_driver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "incise/base/archive.h"
#include "incise/base/checksum.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/runner/step_policy.h"
#include "incise/scenario/remedies.h"
#include "incise/scenario/step_limit.h"
#include "incise/scenario/tool_build.h"

namespace incise::python {

namespace {

/// Names the step in which something went wrong, as the program does.
std::string at_step(const scenario::Scenario& scenario, std::uint64_t step, double time,
                    const std::string& text) {
    return scenario.name + ": step " + std::to_string(step) + ", t = " + format_number(time) +
           " s: " + text;
}

}  // namespace

WorldDriver::WorldDriver(const scenario::Scenario& scenario)
    : WorldDriver(scenario, scenario::build_body(scenario)) {}

WorldDriver::WorldDriver(scenario::Scenario scenario, scenario::Body body)
    : scenario_(std::move(scenario)),
      warnings_(std::move(body.warnings)),
      world_(scenario::make_world(scenario_, std::move(body.mesh), std::move(body.materials),
                                  std::move(body.boundary_conditions), warnings_)),
      run_warnings_(world_, scenario_.dynamics),
      scripts_(world_, std::move(body.tools)) {
    note_tools();
    next_step();  // refuses a fixed step that is too large
}

void WorldDriver::note_tools() {
    auto feeling = std::make_shared<FeelingTools>();
    for (const sim::ToolId id : world_.tools())
        if (const sim::ToolDef& tool = world_.tool(id); cutting::feels_force(tool.shape)) {
            feeling->ids.push_back(id);
            feeling->names.push_back(tool.name);
        }
    feeling_ = std::move(feeling);
}

double WorldDriver::next_step() const {
    return scenario::step_limit(scenario_, world_.model(), world_.stable_step(),
                                world_.num_steps());
}

// --- Steps

void WorldDriver::make_step(double end, double part, bool is_last, Report& report) {
    const double from = world_.time();
    const std::uint64_t number = world_.num_steps() + 1;
    inputs_ = player_.inputs(part, is_last);
    scripts_.lead(world_, from, end, inputs_, warnings_);
    try {
        world_.step_to(end, inputs_);
    } catch (const sim::ToolError& error) {
        note(report);
        throw InputError(at_step(scenario_, number, from, error.what()));
    } catch (const physics::MotionFailure& failure) {
        note(report);
        throw PhysicsError(
            at_step(scenario_, number, from, failure.what() + scenario::remedy_for(failure)));
    }
    last_step_ = end - from;
    note(report);
    scripts_.warn_of_lost_holds(world_, warnings_);
}

/// Adds the last step to a report.
void WorldDriver::note(Report& report) {
    const sim::StepReport& step = world_.report();
    report.to = step.to;
    ++report.num_steps;
    report.num_substeps += step.num_substeps;
    report.contact = step.contact;
    report.max_penetration = std::max(report.max_penetration, step.contact.max_penetration);
    for (const sim::Edit& edit : step.edits) {
        edits_.push_back(edit.record);
        report.edits.push_back(edit.record);
    }
    player_.add(step);
    run_warnings_.add_step(world_, warnings_);
}

/// Adds the means of a call to its report.
void WorldDriver::finish(Report& report) const {
    for (const sim::ToolId tool : report.tools->ids) {
        const auto [force, torque] = player_.forces().of(tool);
        report.forces.push_back(force);
        report.torques.push_back(torque);
    }
}

/// Makes steps. next_end(i) returns the end of step i, which part of the call it ends, and whether
/// it is the last.
template <class NextEnd>
Report WorldDriver::call(NextEnd next_end, const Poll& poll) {
    using Clock = std::chrono::steady_clock;
    constexpr auto between_polls = std::chrono::milliseconds(100);
    Report report;
    report.from = report.to = world_.time();
    report.tools = feeling_;
    player_.begin(world_);
    auto polled = Clock::now();
    for (std::uint64_t i = 0;; ++i) {
        const auto [end, part, is_last] = next_end(i);
        make_step(end, part, is_last, report);
        if (is_last) break;
        if (const auto now = Clock::now(); now - polled > between_polls) {
            polled = now;
            poll();
        }
    }
    player_.end();
    finish(report);
    run_warnings_.add_meanwhile(world_, warnings_);
    return report;
}

namespace {
struct NextStep {
    double end, part;
    bool is_last;
};
}  // namespace

Report WorldDriver::step(std::optional<double> dt, std::uint64_t n, const Poll& poll) {
    if (n == 0) throw InputError("a call of 0 steps: n must be at least 1");
    if (dt && !(*dt > 0.0 && std::isfinite(*dt)))
        throw InputError("a step of " + format_number(*dt) + " s: it must be above 0");
    // The world would refuse it too, but only after tools were placed for it.
    const scenario::DynamicsSpec& dynamics = scenario_.dynamics;
    const bool is_explicit = dynamics.mode == scenario::Mode::dynamic &&
                             dynamics.integrator == scenario::TimeIntegrator::semi_implicit_euler;
    constexpr double rounding = 1e-9;
    if (dt && is_explicit && !(*dt <= (1.0 + rounding) * world_.rest_stable_step())) {
        std::string text = "a step of " + format_number(*dt) + " s is above the stable step of " +
                           format_number(world_.rest_stable_step()) + " s";
        constexpr double most_steps = 1e9;
        if (*dt >= 1.0 && *dt < most_steps && *dt == std::floor(*dt)) {
            const std::string count = std::to_string(static_cast<std::uint64_t>(*dt));
            text += "; for " + count + (*dt > 1.0 ? " steps" : " step") + " write step(n=" + count +
                    ")";
        }
        throw InputError(text);
    }
    return call(
        [&](std::uint64_t i) {
            const double length = dt ? *dt : next_step();
            if (!dt && !(world_.time() + length > world_.time()))
                throw PhysicsError(at_step(
                    scenario_, world_.num_steps() + 1, world_.time(),
                    "the stable step has fallen to " + format_number(length) +
                        " s, too short for the time to go on: something crushes or draws out an "
                        "element; use smaller motions or loads"));
            return NextStep{world_.time() + length,
                            static_cast<double>(i + 1) / static_cast<double>(n), i + 1 == n};
        },
        poll);
}

Report WorldDriver::run_until(double time, const Poll& poll) {
    const double from = world_.time();
    if (!std::isfinite(time))
        throw InputError("the world cannot run until " + format_number(time) +
                         " s: the time must be finite");
    if (!(time >= from))
        throw InputError("the world cannot run until " + format_number(time) + " s: its time is " +
                         format_number(from) + " s");
    if (time == from) {
        Report report;
        report.from = report.to = time;
        report.tools = feeling_;
        player_.begin(world_);  // nothing was felt
        finish(report);
        return report;
    }
    constexpr double max_steps = 1e10;  // more would take years
    if (!(next_step() * max_steps >= time - from))
        throw InputError("to run until " + format_number(time) +
                         " s takes more than 1e10 steps of " + format_number(next_step()) +
                         " s: use an earlier time");
    return call(
        [&](std::uint64_t) {
            const double end = runner::even_steps({scenario_, world_.model(), world_.time(), time,
                                                   world_.stable_step(), world_.num_steps()});
            return NextStep{end, (end - from) / (time - from), end == time};
        },
        poll);
}

// --- State

namespace {
constexpr std::string_view mark = "Incise state";

[[noreturn]] void refuse(const std::string& why) {
    throw InputError("these bytes are no state of this world: " + why);
}
}  // namespace

void WorldDriver::save_rest(ArchiveWriter& ar) const {
    ar(std::uint64_t{scripts_.size()}, last_step_, scripts_, run_warnings_, player_.targets(),
       edits_);
}

UndoPoint WorldDriver::undo_point() const {
    ArchiveWriter ar;
    save_rest(ar);
    return {world_.undo_point(), ar.take(), world_.time()};
}

void WorldDriver::undo(const UndoPoint& point) {
    ArchiveReader ar(point.driver);
    restore_rest(ar, [&] { world_.undo(point.world); });
}

std::string WorldDriver::save() const {
    ArchiveWriter ar;
    ar(world_.save());
    save_rest(ar);
    const std::string& bytes = ar.bytes();
    ArchiveWriter head;
    head(std::string(mark), sim::World::state_format, checksum(bytes));
    return head.take() + bytes;
}

void WorldDriver::restore(std::string_view bytes) {
    ArchiveReader head(bytes);
    std::string name;
    std::uint32_t format = 0;
    std::uint64_t sum = 0;
    const std::size_t head_size = sizeof(std::uint64_t) + mark.size() + sizeof format + sizeof sum;
    if (bytes.size() < head_size) refuse("they are too few");
    head(name);
    if (name != mark) refuse("save() has not made them");
    head(format, sum);
    if (format != sim::World::state_format) refuse("another version of Incise has saved them");
    const std::string_view body = bytes.substr(head_size);
    if (checksum(body) != sum) refuse("they are damaged");
    ArchiveReader ar(body);
    const auto state = ar.read<std::string>();
    restore_rest(ar, [&] { world_.restore(state); });
}

void WorldDriver::restore_rest(ArchiveReader& ar, const std::function<void()>& restore_world) {
    std::uint64_t num_scripts = 0;
    double last = 0.0;
    ar(num_scripts, last);
    if (num_scripts != scripts_.size())
        refuse("the scenario of the saved world has " + std::to_string(num_scripts) +
               " tools, and this one " + std::to_string(scripts_.size()));
    runner::ScriptedTools scripts = scripts_;
    runner::RunWarnings run_warnings = run_warnings_;
    sim::StepInputs targets;
    std::vector<sim::EditRecord> edits;
    ar(scripts, run_warnings, targets, edits);
    const std::uint64_t version = topology_version();
    restore_world();
    version_base_ = version + 1 - world_.mesh().epoch();
    note_tools();
    last_step_ = last;
    scripts_ = std::move(scripts);
    run_warnings_ = run_warnings;
    player_.restore(targets, world_);
    edits_ = std::move(edits);
    if (world_.tools().size() < scripts_.size()) refuse("its tools are not those of its world");
}

}  // namespace incise::python
