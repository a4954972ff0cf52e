// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/run_writer.h"

#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/atomic_file.h"
#include "incise/runner/edit_line.h"
#include "incise/runner/kept_scenario.h"

namespace incise::runner {

using Json = nlohmann::ordered_json;

namespace {

/// Returns JSON as text. Bytes that are not UTF-8, for example in file names, are replaced.
std::string text_of(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Throws InputError unless the files of the run begin with what the run had written.
void require_files(const std::filesystem::path& folder, const Simulation& simulation,
                   const Written& written) {
    const auto edits = folder / "edits.jsonl";
    try {
        io::require_begins_with(folder / "history.csv", written.history);
        io::require_begins_with(edits, written.edits);
        io::require_frames(folder, simulation.scenario().name, written.frames);
    } catch (const InputError& error) {
        throw InputError(std::string(error.what()) + ", or begin anew without --resume");
    }
    io::BytesWritten lines;
    for (const sim::EditRecord& edit : simulation.edits()) lines.append(edit_line(edit) + "\n");
    if (lines != written.edits)
        throw InputError(edits.string() +
                         ": its edits are not those of the checkpoint; begin anew without "
                         "--resume");
}

/// Prepares the folder for a new run, or, if `written` is not null, for resuming a run. Returns it.
io::OutputFolder prepared(io::OutputFolder folder, const Simulation& simulation,
                          const Written* written) {
    if (written) {
        require_files(folder.path(), simulation, *written);
        tidy_checkpoints(folder.path(), simulation.num_steps());
    } else {
        remove_checkpoints(folder.path());
    }
    // A summary belongs to a complete run. That of a former run must not outlive its frames.
    io::remove_output_file(folder.path() / "summary.json");
    keep_scenario(folder.path(), simulation.scenario());
    return folder;
}

}  // namespace

RunWriter::RunWriter(const Simulation& simulation, io::OutputFolder folder, const Written* written)
    : folder_(prepared(std::move(folder), simulation, written)),
      series_(this->folder(), simulation.scenario().name, simulation.scenario().output.compression,
              written ? std::span<const io::FrameWritten>(written->frames)
                      : std::span<const io::FrameWritten>()),
      history_(this->folder() / "history.csv", written ? written->history : io::BytesWritten{}),
      edits_(this->folder() / "edits.jsonl", written ? written->edits : io::BytesWritten{}),
      last_row_(history_row(simulation)),
      first_time_(simulation.time()),
      first_step_(simulation.num_steps()),
      next_checkpoint_(0.0),
      num_frames_(series_.frames().size()) {
    if (written) {
        for (std::size_t i = 0; i < last_row_.size(); ++i)
            last_row_[i].second = written->last_row[i];
        has_checkpoint_ = true;
        note_checkpoint(simulation);
        return;
    }
    std::string header;
    for (const auto& [name, value] : last_row_) header += (header.empty() ? "" : ",") + name;
    history_.append(header);
}

void RunWriter::append_history(const Simulation& simulation, const sim::BodyTotals& body_totals) {
    last_row_ = history_row(simulation, body_totals);
    std::string line;
    for (const auto& [name, value] : last_row_) {
        if (!line.empty()) line += ',';
        append_number(line, value);
    }
    history_.append(line);
}

// In a run without frames, the history still has rows for the start and the end.
void RunWriter::on_start(const Simulation& simulation) {
    if (simulation.scenario().output.interval == 0.0)
        append_history(simulation, simulation.ledger().body_totals());
}

void RunWriter::on_edit(const Simulation& simulation, const sim::EditRecord& edit) {
    edits_.append(edit_line(edit));
    append_history(simulation, edit.after);
}

void RunWriter::on_frame(const Simulation& simulation) {
    wait();
    const auto forces = simulation.world().contact_forces();
    frame_builder_.emplace(simulation.model(), simulation.time(),
                           simulation.scenario().output.fields, forces ? &*forces : nullptr);
    write_later([this] {
        const io::Frame frame = frame_builder_->finish();
        is_frame_built_ = true;
        series_.add(frame);
    });
    ++num_frames_;
    append_history(simulation, simulation.ledger().body_totals());
}

void RunWriter::on_step(const Simulation&) {
    if (is_frame_built_) drop_builder();
    // Reports a failed job early, and releases the memory of a finished one.
    constexpr std::chrono::seconds no_time(0);
    if (pending_.valid() && pending_.wait_for(no_time) == std::future_status::ready) wait();
}

/// Destroys the builder of the frame, on the thread of the simulation as physics::ElementSnapshot
/// requires. It is called early, because edits must copy the elements that the snapshot shares.
void RunWriter::drop_builder() {
    frame_builder_.reset();
    is_frame_built_ = false;
}

/// Runs the job on another thread after the previous job. If that failed, the job is not run.
template <class Job>
void RunWriter::write_later(Job job) {
    const auto after_the_last = [before = std::exchange(pending_, {}), job = std::move(job)] {
        if (before.valid()) before.get();
        job();
    };
    // If no thread can be created, `deferred` lets the waiting thread run the job. The job is
    // passed as a copy: the standard library moves its argument to the thread, even if that fails.
    pending_ = std::async(std::launch::async | std::launch::deferred, after_the_last);
}

void RunWriter::wait() {
    is_checkpoint_pending_ = false;
    if (pending_.valid()) std::exchange(pending_, {}).get();
    drop_builder();
}

void RunWriter::on_pause(const Simulation& simulation) {
    const double interval = simulation.scenario().output.checkpoint_interval;
    const bool is_due = interval > 0.0 && simulation.time() >= next_checkpoint_ * interval;
    if (is_due && !simulation.is_finished()) begin_checkpoint(simulation, CheckpointKind::regular);
}

void RunWriter::take_checkpoint(const Simulation& simulation, CheckpointKind kind) {
    begin_checkpoint(simulation, kind);
    wait();
}

void RunWriter::begin_checkpoint(const Simulation& simulation, CheckpointKind kind) {
    if (last_checkpoint_ == simulation.num_steps()) return;
    if (is_checkpoint_pending_) wait();  // otherwise waiting checkpoints could accumulate
    Written written{history_.written(), edits_.written(), {}, {}};
    for (const auto& [name, value] : last_row_) written.last_row.push_back(value);
    const auto moment = std::make_shared<const SavedMoment>(simulation);
    // What the checkpoint lists must be on the disk first. The jobs before have written the frames.
    write_later([this, kind, moment, written] {
        history_.sync();
        edits_.sync();
        series_.sync();
        Written all = written;
        all.frames.assign(series_.frames().begin(), series_.frames().end());
        moment->write(folder(), all, kind);
        has_checkpoint_ = true;
    });
    is_checkpoint_pending_ = true;
    note_checkpoint(simulation);
}

bool RunWriter::has_checkpoint() {
    try {
        wait();
    } catch (...) {
        // The caller already has an error to report.
    }
    // If only the last wait for the disk has failed, the file is there.
    return has_checkpoint_ || has_checkpoints(folder());
}

/// Sets the time of the next checkpoint: the end of the present interval, even if the last
/// checkpoint was taken within it.
void RunWriter::note_checkpoint(const Simulation& simulation) {
    last_checkpoint_ = simulation.num_steps();
    const double interval = simulation.scenario().output.checkpoint_interval;
    if (interval == 0.0) return;
    // Compares the same products as on_pause(). With the rounded quotient alone, a resumed run
    // could omit a checkpoint.
    next_checkpoint_ = std::floor(simulation.time() / interval);
    for (int i = 0; i < 2 && next_checkpoint_ * interval <= simulation.time(); ++i)
        next_checkpoint_ += 1.0;
}

void RunWriter::finish(const Simulation& simulation, const Outcome& outcome) {
    wait();
    // The state of a failed run is not valid. The summary then has the last row of the history.
    const bool has_failed = outcome.status == "failed";
    if (!has_failed && simulation.scenario().output.interval == 0.0)
        append_history(simulation, simulation.ledger().body_totals());
    history_.sync();
    edits_.sync();
    series_.sync();
    Json summary;
    const scenario::Scenario& scenario = simulation.scenario();
    summary["status"] = outcome.status;
    if (!outcome.message.empty()) summary["message"] = outcome.message;
    summary["title"] = scenario.title;
    summary["scenario"] = scenario.name;
    summary["scenario_hash"] = scenario.hash;
    summary["version"] = INCISE_VERSION;
    const auto& [command, directory, started] = outcome.invocation;
    if (!command.empty()) summary["command"] = command;
    if (!directory.empty()) summary["directory"] = directory;
    if (!started.empty()) summary["started"] = started;
    summary["threads"] = simulation.model().workers().num_threads();
    const auto quantities = has_failed ? last_row_ : summary_quantities(simulation);
    summary["edits"] = simulation.edits().size();
    for (const auto& [name, value] : quantities) summary[name] = value;
    for (const char* count :
         {"step", "nodes", "elements", "components", "edits", "elements_removed", "elements_split",
          "elements_added", "faces_opened"})
        if (summary.contains(count)) summary[count] = summary[count].get<std::int64_t>();
    summary["frames"] = num_frames();
    summary["wall_time"] = outcome.wall_time;
    if (outcome.wall_time > 0.0) {
        summary["steps_per_second"] =
            static_cast<double>(simulation.num_steps() - first_step_) / outcome.wall_time;
        summary["real_time_factor"] = (simulation.time() - first_time_) / outcome.wall_time;
    }
    summary["warnings"] = simulation.warnings();
    for (const std::string& warning : outcome.warnings) summary["warnings"].push_back(warning);
    io::write_file(folder() / "summary.json", text_of(summary, 2) + "\n");
    // Last, so that a process that is killed before can be resumed.
    if (outcome.status != "interrupted") remove_checkpoints_of_stops(folder());
}

}  // namespace incise::runner
