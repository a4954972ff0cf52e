// Resuming of runs that were stopped.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "incise/app/verbs.h"
#include "incise/io/files/output_folder.h"
#include "incise/runner/checkpoint.h"
#include "incise/scenario/scenario.h"

namespace incise::app {

/// Returns the shell command that makes the run.
std::string run_command(const RunOptions& options);
/// Returns the shell command that resumes the run.
std::string resuming_command(const RunOptions& options);

/// The folder and the checkpoint of a run that is to be resumed. The folder is locked
/// against other runs (io::OutputFolder).
struct StoppedRun {
    io::OutputFolder folder;
    runner::Checkpoint checkpoint;
};
/// Returns the stopped run of this scenario in the folder. Prints warnings about damaged
/// checkpoints. Throws InputError if there is none, or if another run is writing to the folder.
StoppedRun stopped_run(const std::filesystem::path& folder, const scenario::Scenario& scenario);

}  // namespace incise::app
