// Writes a run to its folder: frames and their indexes, history.csv, edits.jsonl, summary.json.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "incise/io/files/line_file.h"
#include "incise/io/files/output_folder.h"
#include "incise/io/vtk/series.h"
#include "incise/runner/checkpoint.h"
#include "incise/runner/frame_builder.h"
#include "incise/runner/measured_quantities.h"
#include "incise/runner/simulation.h"

namespace incise::runner {

/// How a run ended.
struct Outcome {
    std::string status = "finished";  ///< or "failed", "interrupted"
    std::string message;              ///< what went wrong
    double wall_time = 0.0;           ///< s
};

/// Frames and checkpoints are written on a thread of their own while the simulation goes on, in
/// their order; the next frame waits for those before it, as does the end. Everything else is on
/// disk, readable, when a function returns; a kill at any moment leaves whole files and whole
/// lines, and a checkpoint to resume from. All functions but has_checkpoint() throw OutputError,
/// that of a frame or a checkpoint the first that is called when it is known.
class RunWriter : public Observer {
  public:
    /// Makes the folder; a former run there is replaced. InputError: see io::OutputFolder.
    RunWriter(const Simulation& simulation, const std::filesystem::path& folder)
        : RunWriter(simulation, io::OutputFolder(folder), nullptr) {}
    /// Goes on where a checkpoint was taken: what was written after it is removed. The simulation
    /// is restored from it already. Throws InputError, and has changed nothing, if files of before
    /// are no longer what they were.
    RunWriter(const Simulation& simulation, io::OutputFolder folder, const Written& written)
        : RunWriter(simulation, std::move(folder), &written) {}

    void on_start(const Simulation& simulation) override;
    void on_edit(const Simulation& simulation, const sim::EditRecord& edit) override;
    void on_frame(const Simulation& simulation) override;
    void on_step(const Simulation& simulation) override;
    void on_pause(const Simulation& simulation) override;  ///< begins a checkpoint if one is due
    /// Unless one has been taken after this step. It is on the disk when this returns.
    void take_checkpoint(const Simulation& simulation, CheckpointKind kind);
    /// Whether there is one to go on from when a run has failed, after all that is being written.
    bool has_checkpoint();
    void finish(const Simulation& simulation, const Outcome& outcome);

    std::filesystem::path pvd_path() const { return series_.pvd_path(); }
    /// The run's index, or its folder if it has no frames.
    std::filesystem::path main_result() const { return num_frames_ > 0 ? pvd_path() : folder(); }
    /// With the one that is being written.
    std::size_t num_frames() const { return num_frames_; }

  private:
    RunWriter(const Simulation& simulation, io::OutputFolder folder, const Written* written);

    const std::filesystem::path& folder() const { return folder_.path(); }
    void append_history(const Simulation& simulation, const sim::BodyTotals& body_totals);
    void begin_checkpoint(const Simulation& simulation, CheckpointKind kind);
    void note_checkpoint(const Simulation& simulation);
    template <class Job>
    void write_later(Job job);
    void wait();
    void drop_builder();

    io::OutputFolder folder_;
    io::Series series_;
    io::LineFile history_, edits_;
    Quantities last_row_;  // of the history
    double first_time_;    // s, where this process took up the run, which its wall time is of
    std::uint64_t first_step_;
    double next_checkpoint_;                        // in intervals
    std::optional<std::uint64_t> last_checkpoint_;  // its step
    std::size_t num_frames_;
    bool has_checkpoint_ = false;                // for whoever has waited
    std::optional<FrameBuilder> frame_builder_;  // of the frame that is being built
    std::atomic<bool> is_frame_built_ = false;
    bool is_checkpoint_pending_ = false;
    std::shared_future<void> pending_;  // the last job; the last member: its thread uses others
};

}  // namespace incise::runner
