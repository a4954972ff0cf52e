// Moments of a run from which it can be resumed: FOLDER/checkpoints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/io/files/written_bytes.h"
#include "incise/io/vtk/series.h"
#include "incise/runner/simulation.h"

namespace incise::runner {

/// What a run has written when a checkpoint is taken, and where it goes on writing.
struct Written {
    io::BytesWritten history, edits;
    std::vector<io::FrameWritten> frames;
    std::vector<double> last_row;  ///< of the history
    static void archive(auto& ar, auto& self) {
        ar(self.history, self.edits, self.frames, self.last_row);
    }
};

/// A run that was stopped leaves those of its rhythm and one of the moment of the stop, which goes
/// when the run has gone on: in the end there is what a run without the stop leaves.
enum class CheckpointKind { regular, of_a_stop };

/// A simulation at one moment, which another thread can write while it goes on; its scenario, which
/// does not change, must outlive it.
class SavedMoment {
  public:
    /// Between two steps. Cost: see Simulation::save.
    explicit SavedMoment(const Simulation& simulation);

    /// Writes the checkpoint, which is whole or not there (io/files/checked_file.h), and tidies up.
    /// Everything that `written` speaks of must be on the disk. Throws OutputError.
    void write(const std::filesystem::path& folder, const Written& written,
               CheckpointKind kind) const;

  private:
    const scenario::Scenario* scenario_;
    std::uint64_t fingerprint_, step_;
    ArchiveWriter state_;
};

/// Throws OutputError.
void remove_checkpoints(const std::filesystem::path& folder);
/// For a run that has a whole checkpoint of this step: it stays, and the last two regular ones up
/// to then. Those of later steps are damaged, or will be written again. Throws OutputError.
void tidy_checkpoints(const std::filesystem::path& folder, std::uint64_t step);
/// For a run that has ended. Throws OutputError.
void remove_checkpoints_of_stops(const std::filesystem::path& folder);

/// A checkpoint that has been read: whole, and of this version of the program.
class Checkpoint {
  public:
    /// The newest of the run in `folder` that is whole; for each that is not, and is newer, a
    /// warning. Changes nothing. Throws InputError if there is none, if a folder is in the location
    /// of one, or if another version of the program, which might not go on to the same bits, has
    /// written it.
    static Checkpoint newest(const std::filesystem::path& folder,
                             std::vector<std::string>& warnings);

    /// Throws InputError, naming what differs, if the scenario is not the one of the run.
    void require_same(const scenario::Scenario& scenario) const;
    /// Takes a simulation of that scenario, just built, to the moment of the checkpoint.
    /// Throws InputError, naming file, fault and remedy, if its body began as another, or if what
    /// is in it is not of this run; the simulation is of no use then.
    void restore(Simulation& simulation) const;

    const Written& written() const { return written_; }

  private:
    Checkpoint(std::filesystem::path path, std::string bytes);
    void name_location(const std::function<void()>& read) const;

    std::filesystem::path path_;
    std::vector<std::pair<std::string, std::string>> contents_;  // of the scenario
    std::uint64_t fingerprint_ = 0;
    Written written_;
    std::string state_;  // of the simulation
};

}  // namespace incise::runner
