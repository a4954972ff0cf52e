// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/checkpoint.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <system_error>

#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/checked_file.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"
#include "incise/runner/measured_quantities.h"

namespace incise::runner {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view suffix = ".checkpoint";

constexpr std::string_view prefix_of(CheckpointKind kind) {
    return kind == CheckpointKind::regular ? "step_" : "stop_";
}

fs::path folder_of_checkpoints(const fs::path& folder) { return folder / "checkpoints"; }

struct CheckpointName {
    CheckpointKind kind;
    std::uint64_t step;

    std::string text() const {
        constexpr std::size_t num_digits = 12;  // minimum
        std::string digits = std::to_string(step);
        digits.insert(0, num_digits - std::min(num_digits, digits.size()), '0');
        return std::string(prefix_of(kind)) + digits + std::string(suffix);
    }
};

struct CheckpointFile {
    fs::path path;
    CheckpointName name;
};

/// Parses the name of a file. Returns nothing if it is not the name of a checkpoint.
std::optional<CheckpointName> checkpoint_name(const std::string& text) {
    for (const auto kind : {CheckpointKind::regular, CheckpointKind::of_a_stop}) {
        std::string_view digits = text;
        if (!digits.starts_with(prefix_of(kind)) || !digits.ends_with(suffix)) continue;
        digits.remove_prefix(prefix_of(kind).size());
        digits.remove_suffix(std::min(digits.size(), suffix.size()));
        if (const auto step = io::parse_number<std::uint64_t>(digits))
            if (const CheckpointName name{kind, *step}; name.text() == text) return name;
    }
    return std::nullopt;
}

/// Returns the checkpoints in the order of their steps.
std::vector<CheckpointFile> checkpoints(const fs::path& folder) {
    std::vector<CheckpointFile> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder_of_checkpoints(folder), error), end;
         !error && entry != end; entry.increment(error))
        if (const auto name = checkpoint_name(entry->path().filename().string()))
            found.push_back({entry->path(), *name});
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.name.step < b.name.step; });
    return found;
}

template <class Condition>
void remove_checkpoints_if(const fs::path& folder, const Condition& condition) {
    for (const auto& [path, name] : checkpoints(folder))
        if (condition(name)) io::remove_output_file(path);
}

/// True if a scenario differs from a former one only by a later end, and its steps up to then do
/// not depend on that. Load steps of statics do.
bool is_longer(const std::vector<std::pair<std::string, std::string>>& before,
               const scenario::Scenario& now) {
    const std::string end = "dynamics.end_time";
    if (now.dynamics.mode == scenario::Mode::statics || before.size() != now.contents.size())
        return false;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i] == now.contents[i]) continue;
        if (before[i].first != end || now.contents[i].first != end) return false;
        const auto end_before = io::parse_number<double>(before[i].second);
        if (!end_before || now.dynamics.end_time < *end_before) return false;
    }
    return true;
}

/// Returns "KEY was A and is B" for the first three values that differ.
std::string differences(const std::vector<std::pair<std::string, std::string>>& before,
                        const std::vector<std::pair<std::string, std::string>>& now) {
    constexpr std::size_t most_named = 3;
    std::vector<std::pair<std::string, std::string>> changed;
    std::set_symmetric_difference(before.begin(), before.end(), now.begin(), now.end(),
                                  std::back_inserter(changed));
    std::vector<std::string> keys;
    for (const auto& [key, value] : changed)
        if (keys.empty() || keys.back() != key) keys.push_back(key);
    const auto value_of = [](const auto& contents, const std::string& key) -> std::string {
        for (const auto& [name, value] : contents)
            if (name == key) return value;
        return "not given";
    };
    std::string text;
    for (std::size_t i = 0; i < std::min(keys.size(), most_named); ++i)
        text += (i == 0 ? "" : ", ") + io::printable(keys[i]) + " was " +
                io::printable(value_of(before, keys[i])) + " and is " + value_of(now, keys[i]);
    if (keys.size() > most_named)
        text += ", and " + std::to_string(keys.size() - most_named) + " more";
    return text;
}

}  // namespace

SavedMoment::SavedMoment(const Simulation& simulation)
    : scenario_(&simulation.scenario()),
      fingerprint_(simulation.fingerprint()),
      step_(simulation.num_steps()) {
    simulation.save(state_);
}

void SavedMoment::write(const fs::path& folder, const Written& written, CheckpointKind kind) const {
    if (!fs::is_directory(folder_of_checkpoints(folder)))
        io::make_output_folder(folder_of_checkpoints(folder));
    ArchiveWriter ar;
    ar(std::string(INCISE_VERSION), sim::World::state_format, scenario_->contents, fingerprint_,
       written, state_.bytes());
    io::write_checked_file(folder_of_checkpoints(folder) / CheckpointName{kind, step_}.text(),
                           ar.bytes());
    tidy_checkpoints(folder, step_);
}

void remove_checkpoints(const fs::path& folder) {
    io::remove_unfinished_files(folder_of_checkpoints(folder));
    remove_checkpoints_if(folder, [](const CheckpointName&) { return true; });
}

void tidy_checkpoints(const fs::path& folder, std::uint64_t step) {
    io::remove_unfinished_files(folder_of_checkpoints(folder));
    std::size_t num_regular = 0;  // that are left
    for (const auto& [path, name] : checkpoints(folder))
        if (name.kind == CheckpointKind::regular && name.step <= step) ++num_regular;
    constexpr std::size_t num_kept = 2;
    remove_checkpoints_if(folder, [&](const CheckpointName& name) {
        if (name.step > step) return true;
        if (name.kind == CheckpointKind::of_a_stop) return name.step < step;
        return num_regular-- > num_kept;
    });
}

bool has_checkpoints(const std::filesystem::path& folder) { return !checkpoints(folder).empty(); }

void remove_checkpoints_of_stops(const fs::path& folder) {
    remove_checkpoints_if(
        folder, [](const CheckpointName& name) { return name.kind == CheckpointKind::of_a_stop; });
}

Checkpoint::Checkpoint(fs::path path, const std::string& bytes) : path_(std::move(path)) {
    ArchiveReader ar(bytes);
    std::string version;
    name_location([&] { ar(version); });
    if (version != INCISE_VERSION)
        throw InputError(path_.string() + ": was written by version " + io::in_quotes(version) +
                         " of incise, and this is " + INCISE_VERSION +
                         "; resume with that one, or begin anew without --resume");
    std::uint32_t format = 0;
    name_location([&] { ar(format); });
    if (format != sim::World::state_format)
        throw InputError(path_.string() + ": was written by another build of version " + version +
                         " of incise, with state format " + std::to_string(format) +
                         ", and this has " + std::to_string(sim::World::state_format) +
                         "; resume with that one, or begin anew without --resume");
    name_location([&] {
        ar(contents_, fingerprint_, written_, state_);
        if (!ar.is_at_end()) throw InputError("there are data beyond its end");
    });
}

Checkpoint Checkpoint::newest(const fs::path& folder, std::vector<std::string>& warnings) {
    auto all = checkpoints(folder);
    std::reverse(all.begin(), all.end());
    std::error_code error;
    for (const auto& [path, name] : all)
        if (fs::is_directory(path, error))
            throw InputError(path.string() +
                             ": is a directory in the place of a checkpoint; remove it, and "
                             "resume then");
    for (const auto& [path, name] : all) {
        std::string bytes;
        try {
            bytes = io::read_checked_file(path);
        } catch (const InputError& damage) {
            warnings.push_back(
                std::string(damage.what()) +
                "; trying the checkpoint before it; if the run goes on from there, this one "
                "is removed");
            continue;
        }
        return Checkpoint(path, bytes);
    }
    throw InputError(folder.string() + ": there is no " + (all.empty() ? "" : "whole ") +
                     "checkpoint of a run to resume; check --out, or begin anew without --resume");
}

void Checkpoint::require_same(const scenario::Scenario& scenario) const {
    if (contents_ == scenario.contents || is_longer(contents_, scenario)) return;
    const bool is_static = scenario.dynamics.mode == scenario::Mode::statics;
    throw InputError(path_.string() + ": the run was of another scenario: " +
                     differences(contents_, scenario.contents) +
                     "; resume with the scenario and --set that it began with, and " +
                     (is_static ? "in statics with the same end" : "an end that is not earlier") +
                     ", or begin anew without --resume");
}

void Checkpoint::restore(Simulation& simulation) const {
    require_same(simulation.scenario());
    if (fingerprint_ != simulation.fingerprint())
        throw InputError(path_.string() +
                         ": the run was of another body: the file of the mesh, or of a surface "
                         "that cuts it, has changed since; put the former one back, or begin anew "
                         "without --resume");
    name_location([&] {
        ArchiveReader ar(state_);
        simulation.restore(ar);
        if (simulation.world().has_failed())
            throw InputError("it is of a world that has failed, which cannot go on");
        const auto& frames = written_.frames;
        const auto is_late = [](const auto& a, const auto& b) { return !(a.time < b.time); };
        const bool ascends =
            std::adjacent_find(frames.begin(), frames.end(), is_late) == frames.end();
        if (frames.size() != simulation.num_frames() || !ascends ||
            !(frames.empty() ||
              (frames.front().time >= 0.0 && frames.back().time <= simulation.time())))
            throw InputError("its frames are not those of the run up to then");
        if (written_.last_row.size() != history_row(simulation).size())
            throw InputError("its row of the history has " +
                             std::to_string(written_.last_row.size()) + " columns");
        if (checkpoint_name(path_.filename().string())->step != simulation.num_steps())
            throw InputError("it is of step " + std::to_string(simulation.num_steps()));
    });
}

// The checksum is correct, so that a fault means a forged or renamed file.
void Checkpoint::name_location(const std::function<void()>& read) const {
    try {
        read();
    } catch (const InputError& error) {
        throw InputError(path_.string() + ": is not what the run has written: " + error.what() +
                         "; remove it to go on from the checkpoint before it, or begin anew "
                         "without --resume");
    }
}

}  // namespace incise::runner
