// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/run_writer.h"

#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/number_format.h"

namespace incise::runner {

using Json = nlohmann::ordered_json;

namespace {

Json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json to_json(const sim::BodyTotals& body_totals) {
    return {{"nodes", body_totals.nodes},
            {"elements", body_totals.elements},
            {"components", body_totals.components},
            {"mass", body_totals.totals.mass},
            {"volume", body_totals.totals.rest_volume},
            {"kinetic_energy", body_totals.totals.kinetic_energy},
            {"elastic_energy", body_totals.totals.elastic_energy},
            {"momentum", to_json(body_totals.totals.momentum)},
            {"angular_momentum", to_json(body_totals.totals.angular_momentum)},
            {"centre_of_mass", to_json(body_totals.totals.centre_of_mass)},
            {"stable_step", body_totals.stable_step}};
}

Json to_json(const sim::EditRecord& edit) {
    return {{"time", edit.time},
            {"step", edit.step},
            {"tool", edit.tool},
            {"elements_removed", edit.elements_removed},
            {"elements_crossed", edit.elements_crossed},
            {"elements_split", edit.elements_split},
            {"elements_added", edit.elements_added},
            {"faces_opened", edit.faces_opened},
            {"nodes_added", edit.nodes_added},
            {"nodes_duplicated", edit.nodes_duplicated},
            {"nodes_removed", edit.nodes_removed},
            {"nodes_snapped", edit.nodes_snapped},
            {"cut_area", edit.cut_area},
            {"mass_removed", edit.mass_removed},
            {"min_altitude_ratio", edit.min_altitude_ratio},
            {"before", to_json(edit.before)},
            {"after", to_json(edit.after)}};
}

/// What is no UTF-8 in it, as names in files can be, is replaced.
std::string text_of(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string line_of(const sim::EditRecord& edit) {
    // A name that is no text can only come from a checkpoint that somebody has made up.
    return text_of(to_json(edit), -1);
}

/// Throws InputError unless the files of the run are those that it had written.
void require_files(const std::filesystem::path& folder, const Simulation& simulation,
                   const Written& written) {
    const auto edits = folder / "edits.jsonl";
    io::require_begins_with(folder / "history.csv", written.history);
    io::require_begins_with(edits, written.edits);
    io::require_frames(folder, simulation.scenario().name, written.frames);
    io::BytesWritten lines;
    for (const sim::EditRecord& edit : simulation.edits()) lines.append(line_of(edit) + "\n");
    if (lines != written.edits)
        throw InputError(edits.string() +
                         ": its edits are not those of the checkpoint; begin anew without "
                         "--resume");
}

/// The folder, prepared for a new run or to go on with one.
io::OutputFolder prepared(io::OutputFolder folder, const Simulation& simulation,
                          const Written* written) {
    if (written) {
        require_files(folder.path(), simulation, *written);
        tidy_checkpoints(folder.path(), simulation.num_steps());
    } else {
        remove_checkpoints(folder.path());
    }
    // A summary speaks of a whole run: that of a former one must not outlive its frames.
    io::remove_output_file(folder.path() / "summary.json");
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
        io::append_number(line, value);
    }
    history_.append(line);
}

// A run without frames still tells how it began and ended.
void RunWriter::on_start(const Simulation& simulation) {
    if (simulation.scenario().output.interval == 0.0)
        append_history(simulation, simulation.ledger().body_totals());
}

void RunWriter::on_edit(const Simulation& simulation, const sim::EditRecord& edit) {
    edits_.append(line_of(edit));
    append_history(simulation, edit.after);
}

void RunWriter::on_frame(const Simulation& simulation) {
    wait();
    frame_builder_.emplace(simulation.model(), simulation.time(),
                           simulation.scenario().output.fields);
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
    // What has failed is told at once, and what was written lets go of its memory.
    constexpr std::chrono::seconds no_time(0);
    if (pending_.valid() && pending_.wait_for(no_time) == std::future_status::ready) wait();
}

/// On the simulation's thread, as physics::ElementSnapshot is; as soon as it can be, since edits
/// copy the elements that it shares.
void RunWriter::drop_builder() {
    frame_builder_.reset();
    is_frame_built_ = false;
}

/// Begins when the job before is done, on whose failure it is left out.
template <class Job>
void RunWriter::write_later(Job job) {
    const auto after_the_last = [before = std::exchange(pending_, {}), job = std::move(job)] {
        if (before.valid()) before.get();
        job();
    };
    // By this policy it is done by whoever waits for it if no thread can be had. Handed over as a
    // copy, since the standard library would move it to the thread and have none left for that.
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
    if (is_checkpoint_pending_) wait();  // or they could pile up
    Written written{history_.written(), edits_.written(), {}, {}};
    for (const auto& [name, value] : last_row_) written.last_row.push_back(value);
    const auto moment = std::make_shared<const SavedMoment>(simulation);
    // What it speaks of goes to the disk before it; the frames of before are there by then.
    write_later([this, kind, moment, written] {
        history_.sync();
        edits_.sync();
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
        // Who asks has an error to tell already.
    }
    return has_checkpoint_;
}

/// The next is due after the interval that has begun, wherever in it this one was taken.
void RunWriter::note_checkpoint(const Simulation& simulation) {
    last_checkpoint_ = simulation.num_steps();
    const double interval = simulation.scenario().output.checkpoint_interval;
    if (interval == 0.0) return;
    // By the products that on_pause() compares with, or the quotient's rounding could let a resumed
    // run leave out a checkpoint.
    next_checkpoint_ = std::floor(simulation.time() / interval);
    for (int i = 0; i < 2 && next_checkpoint_ * interval <= simulation.time(); ++i)
        next_checkpoint_ += 1.0;
}

void RunWriter::finish(const Simulation& simulation, const Outcome& outcome) {
    wait();
    // The state that a run failed in is not one to keep: the last row written stands.
    const bool has_failed = outcome.status == "failed";
    if (!has_failed && simulation.scenario().output.interval == 0.0)
        append_history(simulation, simulation.ledger().body_totals());
    history_.sync();
    edits_.sync();
    Json summary;
    const scenario::Scenario& scenario = simulation.scenario();
    summary["status"] = outcome.status;
    if (!outcome.message.empty()) summary["message"] = outcome.message;
    summary["title"] = scenario.title;
    summary["scenario"] = scenario.name;
    summary["scenario_hash"] = scenario.hash;
    summary["version"] = INCISE_VERSION;
    summary["threads"] = simulation.model().num_threads();
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
    io::write_file(folder() / "summary.json", text_of(summary, 2) + "\n");
    // Last, as what a kill just before would have to go on from.
    if (outcome.status != "interrupted") remove_checkpoints_of_stops(folder());
}

}  // namespace incise::runner
