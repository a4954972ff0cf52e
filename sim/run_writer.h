// Writes a run to its folder: frames and their indexes, history.csv, edits.jsonl, summary.json.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/line_file.h"
#include "io/series.h"
#include "sim/simulation.h"

namespace incise::sim {

/// The quantities of a moment by their names in history.csv, in its order.
std::vector<std::pair<std::string, double>> history_row(const Simulation& simulation);

/// How a run ended.
struct Outcome {
    std::string status = "finished";  ///< or "failed", "interrupted"
    std::string message;              ///< what went wrong
    double wall_time = 0.0;           ///< s
};

/// The quantities of summary.json that an [expect] can name: the last history row and totals over
/// the run.
std::vector<std::pair<std::string, double>> summary_quantities(const Simulation& simulation);

/// What is not as the scenario's [expect] says; each a sentence. Its quantities must exist, which
/// the scenario reader sees to.
std::vector<std::string> failed_expectations(const Simulation& simulation);

/// Everything is on disk, readable, when a function returns; a kill at any moment leaves whole
/// files and whole lines. All functions throw OutputError.
class RunWriter : public Observer {
  public:
    /// Makes the folder; a former run there is replaced.
    RunWriter(const Simulation& simulation, std::filesystem::path folder);

    void on_start(const Simulation& simulation) override;
    void on_edit(const Simulation& simulation, const EditRecord& edit) override;
    void on_frame(const Simulation& simulation) override;
    void finish(const Simulation& simulation, const Outcome& outcome);

    std::filesystem::path pvd_path() const { return series_.pvd_path(); }
    /// The run's index, or its folder if it has no frames.
    std::filesystem::path main_result() const { return num_frames() > 0 ? pvd_path() : folder_; }
    std::size_t num_frames() const { return series_.times().size(); }

  private:
    void append_history(const Simulation& simulation);

    std::filesystem::path folder_;
    io::Series series_;
    io::LineFile history_, edits_;
    std::vector<std::pair<std::string, double>> last_row_;  // of the history
};

}  // namespace incise::sim
