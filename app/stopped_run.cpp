// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/stopped_run.h"

#include <utility>
#include <vector>

#include "incise/app/messages.h"
#include "incise/app/shell_word.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"

namespace incise::app {

std::string run_command(const RunOptions& options) {
    std::string text = "incise run " + shell_word(options.scenario.string());
    if (options.out) text += " --out " + shell_word(options.out->string());
    if (options.replay) text += " --replay " + shell_word(options.replay->string());
    if (options.end_time) text += " --end-time " + format_number(*options.end_time);
    for (const std::string& value : options.overrides) text += " --set " + shell_word(value);
    if (options.num_threads > 0) text += " --threads " + std::to_string(options.num_threads);
    return text;
}

std::string resuming_command(const RunOptions& options) {
    return run_command(options) + " --resume";
}

StoppedRun stopped_run(const std::filesystem::path& folder, const scenario::Scenario& scenario) {
    if (!std::filesystem::is_directory(folder / "checkpoints"))
        throw InputError(folder.string() +
                         ": there is no run with checkpoints to resume; check --out, or begin anew "
                         "without --resume");
    io::OutputFolder ours(folder);
    std::vector<std::string> warnings;
    auto checkpoint = [&] {
        try {
            return runner::Checkpoint::newest(folder, warnings);
        } catch (const InputError&) {
            for (const std::string& warning : warnings) print_warning(warning);
            throw;
        }
    }();
    for (const std::string& warning : warnings) print_warning(warning);
    checkpoint.require_same(scenario);
    return {std::move(ours), std::move(checkpoint)};
}

}  // namespace incise::app
