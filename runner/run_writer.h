// Writes a run to its folder: frames and their indexes, history.csv, edits.jsonl, summary.json.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "incise/io/files/line_file.h"
#include "incise/io/files/output_folder.h"
#include "incise/io/vtk/series.h"
#include "incise/runner/checkpoint.h"
#include "incise/runner/frame_builder.h"
#include "incise/runner/measured_quantities.h"
#include "incise/runner/simulation.h"

namespace incise::runner {

/// How a run was started, as its summary tells it. Empty texts are left out.
struct Invocation {
    std::string command;    ///< words for a shell that make the same run
    std::string directory;  ///< in which the command was given
    std::string started;    ///< date and time, UTC, in the form of ISO 8601
};

/// The end of a run.
struct Outcome {
    std::string status = "finished";         ///< or "failed", "interrupted"
    std::string message;                     ///< the error, if any
    double wall_time = 0.0;                  ///< s
    std::vector<std::string> warnings = {};  ///< besides those of the simulation
    Invocation invocation = {};
};

/// An observer that writes the files of a run.
///
/// Another thread writes frames and checkpoints, in order, while the simulation continues. Before a
/// new frame and at the end, the writer waits for them. All other output is in its file when a
/// function returns. If the process is killed, files and lines are complete, and the run can be
/// resumed from its last checkpoint.
///
/// All functions except has_checkpoint() throw OutputError. An error of a frame or a checkpoint is
/// thrown by the next function that finds it.
class RunWriter : public Observer {
  public:
    /// Creates the folder. The files of a former run in it are replaced. Throws InputError as
    /// io::OutputFolder.
    RunWriter(const Simulation& simulation, const std::filesystem::path& folder)
        : RunWriter(simulation, io::OutputFolder(folder), nullptr) {}
    /// Continues a run from a checkpoint. What was written after the checkpoint is removed. Throws
    /// InputError, and changes nothing, if the files of the run have been changed since.
    /// @param simulation  a simulation that was restored from the checkpoint
    /// @param folder      the folder of the run
    /// @param written     see Checkpoint::written()
    RunWriter(const Simulation& simulation, io::OutputFolder folder, const Written& written)
        : RunWriter(simulation, std::move(folder), &written) {}

    void on_start(const Simulation& simulation) override;
    void on_edit(const Simulation& simulation, const sim::EditRecord& edit) override;
    void on_frame(const Simulation& simulation) override;
    void on_step(const Simulation& simulation) override;
    void on_pause(const Simulation& simulation) override;  ///< starts a checkpoint if due
    /// Takes a checkpoint, unless there is one of this step. It is on the disk on return.
    void take_checkpoint(const Simulation& simulation, CheckpointKind kind);
    /// Waits for the writing thread, then returns true if the run has a checkpoint to resume from.
    /// Does not throw.
    bool has_checkpoint();
    /// Writes the end of the run and summary.json.
    void finish(const Simulation& simulation, const Outcome& outcome);

    std::filesystem::path pvd_path() const { return series_.pvd_path(); }
    /// Returns the path of the .pvd index, or of the folder if the run has no frames.
    std::filesystem::path main_result() const { return num_frames_ > 0 ? pvd_path() : folder(); }
    /// Returns the number of frames, with the one that is being written.
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
    Quantities last_row_;  // of history.csv
    double first_time_;    // s, at which this process started or resumed the run
    std::uint64_t first_step_;
    double next_checkpoint_;                        // in checkpoint intervals
    std::optional<std::uint64_t> last_checkpoint_;  // step of the last one
    std::size_t num_frames_;
    bool has_checkpoint_ = false;                // read only after wait()
    std::optional<FrameBuilder> frame_builder_;  // of the frame in progress
    std::atomic<bool> is_frame_built_ = false;
    bool is_checkpoint_pending_ = false;
    std::shared_future<void> pending_;  // the last job; last member, as its thread uses the others
};

}  // namespace incise::runner
