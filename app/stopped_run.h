// Runs that were stopped: how to go on with them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "incise/app/verbs.h"
#include "incise/io/files/output_folder.h"
#include "incise/runner/checkpoint.h"
#include "incise/scenario/scenario.h"

namespace incise::app {

/// The command that goes on with the run, for a shell.
std::string resuming_command(const RunOptions& options);

/// What is there of a run to be resumed: nobody else writes there from now on.
struct StoppedRun {
    io::OutputFolder folder;
    runner::Checkpoint checkpoint;
};
/// The run of this scenario in the folder; damaged checkpoints are warned of.
/// Throws InputError if there is none, or another run is writing there.
StoppedRun stopped_run(const std::filesystem::path& folder, const scenario::Scenario& scenario);

}  // namespace incise::app
