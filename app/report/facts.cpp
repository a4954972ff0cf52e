// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/facts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "incise/base/number_format.h"

namespace incise::report {

namespace {

double least(const std::vector<double>* column) {
    return column && !column->empty() ? *std::min_element(column->begin(), column->end()) : unknown;
}

double sum_over_edits(const RunRecord& run, double Edit::*value) {
    double sum = 0.0;
    for (const Edit& edit : run.edits) sum += edit.*value;
    return sum;
}

/// Returns a count with its noun, as the scripts of the page have it: "11,646 steps".
std::string counted(double count, const std::string& noun) {
    std::string digits = format_number(static_cast<std::int64_t>(count));
    if (count >= 10'000.0)
        for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
    return digits + " " + noun + (count == 1.0 ? "" : "s");
}

/// Returns what the wall time is that of.
std::string span_of_wall_time(const RunRecord& run) {
    // The summary counts steps and time from the last --resume.
    const double steps = run.number("steps_per_second") * run.number("wall_time");
    const bool is_resumed = run.number("step") - steps > 0.5;
    const std::string threads =
        std::isnan(run.number("threads")) ? "" : "on " + counted(run.number("threads"), "thread");
    return threads +
           (is_resumed ? (threads.empty() ? "" : ", ") + std::string("since it resumed") : "");
}

}  // namespace

std::vector<Fact> facts_of(const RunRecord& run, const EnergyBalance& balance) {
    std::vector<Fact> facts;
    const HistoryTable& history = run.history;
    const std::size_t num_rows = history.num_rows();
    if (num_rows == 0) return facts;
    const auto add = [&](Fact fact) {
        if (!std::isnan(fact.value)) facts.push_back(std::move(fact));
    };
    const auto count = [&](const char* label, const char* column) {
        add({label, history.value(column, num_rows - 1), "", history.value(column, 0), ""});
    };
    const double steps = history.value("step", num_rows - 1);
    add({"Simulated time", history.value("time", num_rows - 1), "s", unknown,
         "in " + counted(steps, "step")});
    count("Pieces", "components");
    count("Elements", "elements");
    add({"Edits of the mesh", static_cast<double>(run.edits.size()), "", unknown, ""});
    if (const double area = sum_over_edits(run, &Edit::cut_area); area > 0.0)
        add({"Cut area", area, "m²", unknown, "one side, at rest"});
    const double mass = history.value("mass", 0);
    const double removed = sum_over_edits(run, &Edit::mass_removed);
    add({"Mass kept", 100.0 * history.value("mass", num_rows - 1) / mass, "%", unknown,
         removed > 0.0 ? "the rest was taken away by tools" : ""});
    add({"Largest energy error", 100.0 * balance.largest_error(), "%", unknown,
         "of the energy turned over"});
    add({"Shortest step", least(history.find("time_step")), "s", unknown, ""});
    add({"Lowest volume ratio", least(history.find("min_J")), "", unknown, "1 at rest"});
    add({"Largest displacement", run.number("max_displacement"), "m", unknown, "at the end"});
    add({"Computing time", run.number("wall_time"), "s", unknown, span_of_wall_time(run)});
    return facts;
}

Ending ending_of(const RunRecord& run) {
    const auto status = run.text("status");
    if (status == "finished") return {status, "The run finished.", ""};
    if (status == "failed") return {status, "The run failed.", run.text("message")};
    if (status == "interrupted")
        return {status, "The run was stopped before its end.",
                run.text("message") + ". It goes on with the same command and --resume."};
    const std::size_t num_rows = run.history.num_rows();
    return {"unfinished", "The run has not ended.",
            "It still goes on, or it was killed: it has left no summary.json. This page shows what "
            "it had written up to t = " +
                (num_rows == 0 ? "0" : format_number(run.history.value("time", num_rows - 1))) +
                " s. A run that was killed goes on with the same command and --resume."};
}

}  // namespace incise::report
