// incise run: simulates a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "incise/app/dates.h"
#include "incise/app/messages.h"
#include "incise/app/progress.h"
#include "incise/app/stop_signals.h"
#include "incise/app/stopped_run.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/atomic_file.h"
#include "incise/live/recording.h"
#include "incise/physics/elements/workers.h"
#include "incise/runner/kept_scenario.h"
#include "incise/runner/run_writer.h"
#include "incise/runner/simulation.h"
#include "incise/scenario/body_problems.h"

namespace incise::app {

namespace {

class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// An observer that shows the progress of the run.
class ProgressObserver : public runner::Observer {
  public:
    ProgressObserver(double end_time, bool quiet) : progress_(end_time, "running", quiet) {}

    void on_step(const runner::Simulation& simulation) override {
        char note[128];
        std::snprintf(note, sizeof note, "t = %.4g s, %zu elements, %zu edits", simulation.time(),
                      simulation.mesh().num_elements(), simulation.edits().size());
        progress_.update(simulation.time(), note);
    }
    void finish() { progress_.finish(); }

  private:
    Progress progress_;
};

/// An observer that prints the warnings that the simulation adds during the run.
class WarningObserver : public runner::Observer {
  public:
    explicit WarningObserver(const runner::Simulation& simulation)
        : num_printed_(simulation.warnings().size()) {}

    void on_edit(const runner::Simulation& simulation, const sim::EditRecord&) override {
        print_new(simulation);
    }
    /// Prints the new warnings. Warnings of the last step are about the state at the end, so that
    /// the caller prints them after the progress.
    void print_new(const runner::Simulation& simulation) {
        for (; num_printed_ < simulation.warnings().size(); ++num_printed_)
            print_warning(simulation.warnings()[num_printed_]);
    }

  private:
    std::size_t num_printed_;
};

int num_threads(const RunOptions& options) {
    if (options.num_threads > 0) return options.num_threads;
    return physics::Workers::num_cores();
}

/// What advances a simulation: its scenario, or a recording of what hands did.
class Course {
  public:
    virtual ~Course() = default;
    virtual runner::Simulation& simulation() = 0;
    virtual void advance() = 0;  ///< by a step or a tick
    /// Returns what is wrong at the end.
    virtual std::optional<std::string> complaint() { return std::nullopt; }
};

class OfScenario : public Course {
  public:
    explicit OfScenario(const scenario::Scenario& scenario) : simulation_(scenario) {}
    runner::Simulation& simulation() override { return simulation_; }
    void advance() override { simulation_.step(); }

  private:
    runner::Simulation simulation_;
};

class OfRecording : public Course {
  public:
    OfRecording(scenario::Scenario scenario, live::Recording recording, const RunOptions& options)
        : file_(*options.replay),
          replay_(without_checkpoints(std::move(scenario)), std::move(recording),
                  !options.overrides.empty()) {}
    runner::Simulation& simulation() override { return replay_.session().simulation(); }
    void advance() override { replay_.tick(); }
    std::optional<std::string> complaint() override {
        const auto tick = replay_.first_difference();
        if (!tick) return std::nullopt;
        return file_.string() + ": from tick " + std::to_string(*tick) + " on, t = " +
               format_number(static_cast<double>(*tick) * replay_.session().tick_length()) +
               " s, the body is not as it was in the session: the scenario, the program or the "
               "processor is another";
    }

  private:
    /// A checkpoint does not say what hands were about to do.
    static scenario::Scenario without_checkpoints(scenario::Scenario scenario) {
        scenario.output.checkpoint_interval = 0.0;
        return scenario;
    }
    std::filesystem::path file_;
    live::Replay replay_;
};

/// Builds the simulation. Messages of errors name the scenario.
std::unique_ptr<Course> build(scenario::Scenario scenario, const RunOptions& options,
                              std::optional<live::Recording> recording) {
    const std::filesystem::path& file = options.scenario;
    try {
        if (!recording) return std::make_unique<OfScenario>(scenario);
        return std::make_unique<OfRecording>(std::move(scenario), std::move(*recording), options);
    } catch (const scenario::BodyError& error) {
        for (const std::string& warning : error.warnings) print_warning(warning);
        throw;
    } catch (const InputError& error) {
        throw InputError(prefixed(file.string() + ": ", error.what()));
    }
}

/// Throws InputError if the run reads a file that is among the frames in its folder, because the
/// run replaces these.
void require_inputs_elsewhere(const scenario::Scenario& scenario,
                              const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> inputs;
    if (const auto* mesh = std::get_if<std::filesystem::path>(&scenario.mesh.source))
        inputs.push_back(*mesh);
    for (const scenario::ToolSpec& tool : scenario.tools)
        if (tool.surface) inputs.push_back(tool.surface->path);
    // A path that cannot be examined gives an error when it is opened.
    std::error_code error;
    const auto frames = weakly_canonical(folder / "frames", error);
    for (const auto& input : inputs) {
        const auto path = weakly_canonical(input, error);
        const bool is_frame =
            path.filename().string().starts_with(scenario.name + "_") && path.extension() == ".vtu";
        if (!frames.empty() && is_frame && path.parent_path() == frames)
            throw InputError(input.string() + ": lies among the frames in " + folder.string() +
                             ", which the run would replace; give the run another folder with "
                             "--out, or the scenario a copy of the file elsewhere");
    }
}

/// Returns the error that prevents writing to the folder, as far as it can be found in advance.
std::optional<OutputError> refusal_of(const std::filesystem::path& folder) {
    try {
        io::require_output_folder(folder);
        return std::nullopt;
    } catch (const OutputError& error) {
        return error;
    }
}

/// Returns read(). If read() throws, adds the text of the refusal to the error.
template <class Read>
auto with_refusal(const std::optional<OutputError>& refusal, Read read) {
    if (!refusal) return read();
    const auto both = [&](const std::exception& error) {
        return std::string(error.what()) + "\n" + refusal->what();
    };
    try {
        return read();
    } catch (const InputError& error) {
        throw InputError(both(error));
    } catch (const PhysicsError& error) {
        throw PhysicsError(both(error));
    } catch (const MemoryError& error) {
        throw MemoryError(both(error));
    }
}

/// True if there is something to resume, or something that must not be replaced. A run of this
/// scenario that was stopped before its first checkpoint is neither.
bool is_to_be_resumed(const std::filesystem::path& folder, const scenario::Scenario& scenario) {
    std::error_code none;
    const bool has_checkpoints = std::filesystem::exists(folder / "checkpoints", none) &&
                                 !std::filesystem::is_empty(folder / "checkpoints", none);
    return has_checkpoints || std::filesystem::exists(folder / "summary.json", none) ||
           runner::holds_another_run(folder, scenario);
}

/// Returns warnings of tools that were present during the run and should have cut but did not,
/// because this is rarely intended.
std::vector<std::string> warnings_of_idle_tools(const runner::Simulation& simulation) {
    std::vector<std::string> warnings;
    for (const scenario::ToolSpec& tool : simulation.scenario().tools) {
        const auto& edits = simulation.edits();
        const bool has_cut = std::any_of(edits.begin(), edits.end(),
                                         [&](const auto& edit) { return edit.tool == tool.name; });
        if (!has_cut && cutting::traits_of(tool.shape).cuts &&
            tool.path.front().time < simulation.time())
            warnings.push_back("tool '" + tool.name +
                               "' has cut nothing; look at a picture of where the tissue is when "
                               "it passes");
    }
    return warnings;
}

std::string describe(const runner::Simulation& simulation) {
    const sim::BodyTotals& body = simulation.ledger().initial();
    const bool is_static = simulation.scenario().dynamics.mode == scenario::Mode::statics;
    std::ostringstream text;
    text.precision(4);
    text << body.elements << (body.elements == 1 ? " element, " : " elements, ") << body.nodes
         << " nodes, " << body.components << (body.components == 1 ? " piece, " : " pieces, ")
         << body.totals.mass << " kg, " << body.totals.rest_volume << " m3; "
         << (is_static ? "load steps of " : "steps of ") << simulation.time_step() << " s to "
         << simulation.scenario().dynamics.end_time << " s";
    // Implicit steps are stable at any length.
    if (simulation.scenario().dynamics.is_explicit())
        text << " (stable up to " << body.stable_step << " s)";
    return text.str();
}

runner::Invocation invocation_of(const RunOptions& options) {
    std::error_code none;  // a folder that was removed has no name
    return {run_command(options), std::filesystem::current_path(none).string(),
            utc_text(std::time(nullptr))};
}

int print_expectations(const scenario::Scenario& scenario, const runner::Quantities& quantities) {
    const auto failures = runner::failed_expectations(scenario, quantities);
    for (const std::string& failure : failures) print_error(scenario.name + ": " + failure);
    return failures.empty() ? done : missed_expectation;
}

/// Runs the simulation from its present state to the end or to a signal. Returns the exit status.
/// @param is_new  nothing of the run has been written yet
int simulate(Course& course, bool is_new, runner::RunWriter& writer, const RunOptions& options,
             const StopSignals& signals) {
    runner::Simulation& simulation = course.simulation();
    const scenario::Scenario& scenario = simulation.scenario();
    ProgressObserver progress(scenario.dynamics.end_time, options.quiet);
    simulation.add_observer(writer);
    simulation.add_observer(progress);
    WarningObserver warnings(simulation);
    simulation.add_observer(warnings);

    const runner::Invocation invocation = invocation_of(options);
    const Stopwatch watch;
    const auto finish = [&](runner::Outcome outcome) {
        outcome.wall_time = watch.seconds();
        outcome.invocation = invocation;
        progress.finish();
        writer.finish(simulation, outcome);
    };
    const auto failure = [&](const std::exception& error, std::uint64_t step) {
        std::ostringstream text;
        text << scenario.name << ": step " << step << ", t = " << simulation.time()
             << " s: " << error.what() << ". What was written up to then is in "
             << writer.main_result().string();
        try {
            finish({"failed", text.str()});
        } catch (const OutputError& refusal) {
            text << '\n' << refusal.what();
        }
        return text.str();
    };
    try {
        if (is_new) simulation.start();
        while (!simulation.is_finished() && signals.noted() == 0) course.advance();
    } catch (const PhysicsError& error) {
        throw PhysicsError(failure(error, simulation.num_steps() + 1));
    } catch (const InputError& error) {  // a tool has met something that it cannot cut
        throw InputError(failure(error, simulation.num_steps()));
    }
    if (!simulation.is_finished()) {
        const bool can_resume = !options.replay;
        if (can_resume) writer.take_checkpoint(simulation, runner::CheckpointKind::of_a_stop);
        finish({"interrupted", "stopped by a signal"});
        print_error("stopped at t = " + format_number(simulation.time()) +
                    " s; what was written so far is in " + writer.main_result().string() +
                    (can_resume ? "; to go on: " + resuming_command(options) : ""));
        return 128 + signals.noted();
    }
    const auto idle_tools = warnings_of_idle_tools(simulation);
    runner::Outcome outcome;
    outcome.warnings = idle_tools;
    finish(outcome);
    warnings.print_new(simulation);
    for (const std::string& warning : idle_tools) print_warning(warning);

    if (!options.quiet)
        std::cerr << scenario.name << ": " << simulation.num_steps() << " steps in "
                  << duration_text(watch.seconds()) << ", " << simulation.edits().size()
                  << " edits, " << writer.num_frames() << " frames\n";
    std::cout << writer.main_result().string() << '\n';
    // What a scenario expects, it expects without hands.
    const int status = options.replay
                           ? done
                           : print_expectations(scenario, runner::summary_quantities(simulation));
    const auto complaint = course.complaint();
    if (complaint) print_error(*complaint);
    return complaint ? missed_expectation : status;
}

}  // namespace

int run(const RunOptions& options) {
    const StopSignals signals(options.scenario.string() + ": stopped before " +
                              (options.resume ? "it went on; nothing has been changed; to go on: " +
                                                    resuming_command(options)
                                              : "its first step; nothing has been written"));
    std::optional<live::Recording> recording;
    if (options.replay) recording = live::read_recording(*options.replay);
    auto overrides = recording ? recording->scenario.overrides : std::vector<std::string>();
    overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
    if (options.end_time)
        overrides.push_back("dynamics.end_time=" + format_number(*options.end_time));
    const std::filesystem::path folder =
        options.out.value_or(options.replay.value_or(options.scenario).stem().string() + ".out");
    const auto refusal = options.resume ? std::nullopt : refusal_of(folder);
    const scenario::Scenario scenario =
        with_refusal(refusal, [&] { return load_scenario(options.scenario, overrides); });

    std::optional<StoppedRun> stopped;
    if (!options.resume && !options.force && !refusal &&
        runner::holds_another_run(folder, scenario))
        throw InputError(folder.string() +
                         ": holds the results of another run; give this one another folder with "
                         "--out, or replace the results with --force; if only end_time is later, "
                         "go on with --resume");
    if (options.resume && is_to_be_resumed(folder, scenario)) {
        if (const auto quantities = runner::finished_quantities(folder, scenario)) {
            if (!options.dry_run)  // one is left if the run was killed at the very end
                runner::remove_checkpoints_of_stops(folder);
            if (!options.quiet)
                std::cerr << scenario.name << ": the run in " << folder.string()
                          << " is finished; there is nothing to resume\n";
            const auto index = folder / (scenario.name + ".pvd");
            std::cout << (std::filesystem::exists(index) ? index : folder).string() << '\n';
            return print_expectations(scenario, *quantities);
        }
        stopped.emplace(stopped_run(folder, scenario));
    } else {
        require_inputs_elsewhere(scenario, folder);
    }
    if (options.resume && !stopped && !options.quiet)
        std::cerr << scenario.name << ": begins, as there is nothing to resume in "
                  << folder.string() << '\n';

    const auto course =
        with_refusal(refusal, [&] { return build(scenario, options, std::move(recording)); });
    runner::Simulation& simulation = course->simulation();
    if (!options.dry_run && !refusal) simulation.set_num_threads(num_threads(options));
    if (stopped) stopped->checkpoint.restore(simulation);
    for (const std::string& warning : simulation.warnings()) print_warning(warning);
    if (refusal) throw OutputError(*refusal);
    if (!options.quiet) {
        std::cerr << scenario.name << ": " << describe(simulation) << '\n';
        if (stopped)
            std::cerr << scenario.name << ": goes on at t = " << simulation.time() << " s, step "
                      << simulation.num_steps() << '\n';
    }
    if (options.dry_run) return done;

    signals.note_only();
    runner::RunWriter writer = stopped ? runner::RunWriter(simulation, std::move(stopped->folder),
                                                           stopped->checkpoint.written())
                                       : runner::RunWriter(simulation, folder);
    try {
        return simulate(*course, !stopped, writer, options, signals);
    } catch (const OutputError& error) {
        if (!writer.has_checkpoint()) throw;
        throw OutputError(std::string(error.what()) +
                          "; to go on then: " + resuming_command(options));
    }
}

}  // namespace incise::app
