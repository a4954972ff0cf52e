// Programs that belong to incise and run as processes of their own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace incise::app {

/// Files that a program writes its output to. An empty path stands for the stream of this process.
struct CompanionOutput {
    std::filesystem::path out, err;
};

/// Runs a program and waits for it. It is looked up in the folder of this program, then in PATH.
/// Returns its exit status, or 128 + number of the signal that ended it. Throws InputError, with
/// the remedy, if it cannot be started, and MemoryError if it was killed, as the system does where
/// memory is short.
int run_companion(const std::string& name, const std::vector<std::string>& arguments,
                  const std::string& remedy, const CompanionOutput& output = {});

}  // namespace incise::app
