// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/stopped_run.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <utility>
#include <vector>

#include "incise/app/messages.h"
#include "incise/base/error.h"
#include "incise/io/files/number_format.h"

namespace incise::app {

namespace {

/// Returns the word with quotes where a shell needs them.
std::string quoted(const std::string& word) {
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-+./,:=%@", c);
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

}  // namespace

std::string resuming_command(const RunOptions& options) {
    std::string text = "incise run " + quoted(options.scenario.string());
    if (options.out) text += " --out " + quoted(options.out->string());
    if (options.end_time) text += " --end-time " + io::format_number(*options.end_time);
    for (const std::string& value : options.overrides) text += " --set " + quoted(value);
    if (options.num_threads > 0) text += " --threads " + std::to_string(options.num_threads);
    return text + " --resume";
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
