// Checkpoints of a run, from which it can be resumed: files in FOLDER/checkpoints.
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

/// What a run has written to its files when a checkpoint is taken.
struct Written {
    io::BytesWritten history, edits;
    std::vector<io::FrameWritten> frames;
    std::vector<double> last_row;  ///< of history.csv
    static void archive(auto& ar, auto& self) {
        ar(self.history, self.edits, self.frames, self.last_row);
    }
};

/// The kind of a checkpoint. A regular one is taken at the checkpoint interval. One of a stop is
/// taken when a signal stops the run. It is removed when a later checkpoint is written or the run
/// ends, so that a resumed run leaves the same files as a run without the stop.
enum class CheckpointKind { regular, of_a_stop };

/// A copy of the state of a simulation at one time.
/// @thread  another thread can write the copy while the simulation continues
/// @lifetime  the simulation, which owns the scenario, must outlive the copy
class SavedMoment {
  public:
    /// Copies the state. Cost: see Simulation::save().
    /// @pre  the simulation is between two steps
    explicit SavedMoment(const Simulation& simulation);

    /// Writes the checkpoint completely or not at all (io/files/checked_file.h), then calls
    /// tidy_checkpoints(). Throws OutputError.
    /// @pre  all bytes and frames that `written` lists are on the disk
    void write(const std::filesystem::path& folder, const Written& written,
               CheckpointKind kind) const;

  private:
    const scenario::Scenario* scenario_;
    std::uint64_t fingerprint_, step_;
    ArchiveWriter state_;
};

/// Removes all checkpoints of a run. Throws OutputError.
void remove_checkpoints(const std::filesystem::path& folder);
/// Removes the checkpoints that are no longer needed. The last two regular ones up to `step` stay,
/// and one of a stop at `step`. Checkpoints of later steps are removed: they are damaged, or the
/// run will write them again. Throws OutputError.
/// @pre  there is an undamaged checkpoint of `step`
void tidy_checkpoints(const std::filesystem::path& folder, std::uint64_t step);
/// True if there is a checkpoint in the folder of a run, whole or not.
bool has_checkpoints(const std::filesystem::path& folder);
/// Removes the checkpoints of stops, at the end of a run. Throws OutputError.
void remove_checkpoints_of_stops(const std::filesystem::path& folder);

/// A checkpoint that was read from its file. It is undamaged, and this version of the program has
/// written it.
class Checkpoint {
  public:
    /// Returns the newest undamaged checkpoint of the run in `folder`. Adds a warning for each
    /// newer one that is damaged. Changes no files. Throws InputError if there is none, or if a
    /// folder has the name of a checkpoint. Throws InputError too if another version of the program
    /// has written it, because a resumed run might then differ in its bits.
    static Checkpoint newest(const std::filesystem::path& folder,
                             std::vector<std::string>& warnings);

    /// Throws InputError if the scenario is not that of the run. The message lists the differences.
    /// A dynamic run may have a later end: its steps up to the checkpoint are the same.
    void require_same(const scenario::Scenario& scenario) const;
    /// Restores the state of the checkpoint.
    /// Throws InputError if the scenario, the body at the start or the data are not those of the
    /// run. The message has file, problem and remedy. The simulation is then unusable.
    /// @pre  the simulation has not made a step
    void restore(Simulation& simulation) const;

    const Written& written() const { return written_; }

  private:
    Checkpoint(std::filesystem::path path, const std::string& bytes);
    void name_location(const std::function<void()>& read) const;

    std::filesystem::path path_;
    std::vector<std::pair<std::string, std::string>> contents_;  // of the scenario
    std::uint64_t fingerprint_ = 0;
    Written written_;
    std::string state_;  // of the simulation
};

}  // namespace incise::runner
