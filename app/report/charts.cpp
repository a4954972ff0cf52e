// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/charts.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

namespace incise::report {

namespace {

std::vector<Series> along_axes(const std::string& column) {
    return {{column + "_x", "x"}, {column + "_y", "y"}, {column + "_z", "z"}};
}

/// The plots of the columns that every run has.
std::vector<Chart> usual_charts() {
    return {
        {"Energy", "J", false, "", {{"kinetic_energy", "kinetic"}, {"elastic_energy", "elastic"}}},
        {"Work and loss since the start",
         "J",
         false,
         "",
         {{"external_work", "work from outside"},
          {"dissipated_energy", "dissipated"},
          {"contact_dissipation", "of that, by contact"},
          {"fracture_energy", "taken by blades to cut"}}},
        {"Energy that the account lacks",
         "J",
         false,
         "Energy at the start and work, less all losses and the energy now. Zero would be exact.",
         {{lacking_energy, "lacking"}}},
        {"Pieces", "", true, "", {{"components", "pieces"}}},
        {"Elements and nodes", "", true, "", {{"elements", "elements"}, {"nodes", "nodes"}}},
        {"Mass", "kg", true, "", {{"mass", "mass"}}},
        {"Volume at rest", "m³", true, "", {{"volume", "volume"}}},
        {"Lowest volume ratio of an element",
         "",
         false,
         "1 at rest; below 0 the element is inverted.",
         {{"min_J", "lowest ratio"}}},
        {"Time step",
         "s",
         true,
         "The stable step limits explicit steps only.",
         {{"time_step", "step"}, {"stable_step", "stable step"}}},
        {"Momentum", "kg m/s", false, "", along_axes("momentum")},
        {"Angular momentum", "kg m²/s", false, "About the origin.", along_axes("angular_momentum")},
        {"Points of contact", "", true, "", {{"contacts", "points with a force"}}},
        {"Deepest overlap of surfaces", "m", false, "", {{"max_penetration", "overlap"}}},
    };
}

/// A prefix and a suffix of the columns that a constraint or a tool adds.
std::string name_between(std::string_view column, std::string_view prefix) {
    constexpr std::string_view suffix = "_x";
    if (!column.starts_with(prefix) || !column.ends_with(suffix)) return {};
    column.remove_prefix(prefix.size());
    column.remove_suffix(suffix.size());
    return std::string(column);
}

/// Appends the plots of constraints and tools, in the order of their columns.
void append_forces(const HistoryTable& history, std::vector<Chart>& charts) {
    for (const std::string& column : history.names) {
        if (const auto name = name_between(column, "reaction_"); !name.empty()) {
            charts.push_back({"Force of the constraint " + name, "N", false, "",
                              along_axes("reaction_" + name)});
            charts.push_back({"Moment of the constraint " + name, "N m", false, "",
                              along_axes("torque_" + name)});
        } else if (const auto tool = name_between(column, "force_"); !tool.empty()) {
            charts.push_back(
                {"Force of the tissue on " + tool, "N", false, "", along_axes("force_" + tool)});
            charts.push_back({"Moment of the tissue on " + tool, "N m", false, "",
                              along_axes("torque_" + tool)});
        }
    }
}

bool is_zero(const std::vector<double>& column) {
    return std::all_of(column.begin(), column.end(), [](double x) { return x == 0.0; });
}

/// Drops the lines of a plot that are absent, and those that are zero throughout, unless the first
/// line is among these: a plot of forces shows that two of them are zero.
void keep_present(const HistoryTable& history, Chart& chart) {
    const bool has_components = chart.series.size() == 3 && chart.series.front().label == "x";
    std::erase_if(chart.series, [&](const Series& series) {
        const auto* column = history.find(series.column);
        return !column || (!has_components && &series != &chart.series.front() && is_zero(*column));
    });
}

}  // namespace

Charts charts_of(const HistoryTable& history) {
    std::vector<Chart> all = usual_charts();
    append_forces(history, all);
    std::set<std::string> used = {"time", "step"};
    for (const Chart& chart : all)
        for (const Series& series : chart.series) used.insert(series.column);
    // Columns of a later version.
    for (const std::string& column : history.names)
        if (!used.contains(column)) all.push_back({column, "", false, "", {{column, column}}});

    Charts result;
    for (Chart& chart : all) {
        keep_present(history, chart);
        if (chart.series.empty()) continue;
        const bool is_empty = std::all_of(
            chart.series.begin(), chart.series.end(),
            [&](const Series& series) { return is_zero(*history.find(series.column)); });
        if (is_empty)
            result.left_out.push_back(chart.title);
        else
            result.charts.push_back(std::move(chart));
    }
    return result;
}

}  // namespace incise::report
