// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/page_data.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "incise/app/report/accounts.h"
#include "incise/app/report/charts.h"
#include "incise/app/report/energy_balance.h"
#include "incise/app/report/expectations.h"
#include "incise/app/report/facts.h"
#include "incise/io/files/base64.h"

namespace incise::report {

namespace {

/// Returns the number rounded to seven digits, which is more than a plot shows and half as long as
/// all. Returns null for what JSON cannot hold.
Json rounded(double value) {
    if (!std::isfinite(value)) return nullptr;
    constexpr int digits = 7;
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                   std::chars_format::general, digits)
                         .ptr;
    std::from_chars(text.data(), end, value);
    // A count without ".0" is shorter.
    constexpr double whole = 1e7;
    if (std::abs(value) < whole && value == std::floor(value))
        return static_cast<std::int64_t>(value);
    return value;
}

Json rounded(std::span<const double> values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(rounded(value));
    return list;
}

Json fact_data(std::span<const Fact> facts) {
    Json list = Json::array();
    for (const Fact& fact : facts)
        list.push_back({{"label", fact.label},
                        {"value", rounded(fact.value)},
                        {"unit", fact.unit},
                        {"from", rounded(fact.from)},
                        {"note", fact.note}});
    return list;
}

std::string png_uri(std::string_view png) {
    std::string text = "data:image/png;base64,";
    io::append_base64(png, text);
    return text;
}

Json picture_data(const RunRecord& run, const Pictures& pictures) {
    Json items = Json::array();
    for (const Picture& picture : pictures.items)
        items.push_back({{"frame", picture.frame},
                         {"time", picture.frame < run.frame_times.size()
                                      ? rounded(run.frame_times[picture.frame])
                                      : Json()},
                         {"source", png_uri(picture.png)}});
    return {{"note", pictures.note}, {"frames", run.frame_times.size()}, {"items", items}};
}

/// The plots, with the rows of the history that they show.
Json plot_data(const HistoryTable& history) {
    const auto rows = rows_to_show(history, most_history_rows);
    const auto values = [&](const std::vector<double>& column) {
        Json list = Json::array();
        for (const std::size_t row : rows) list.push_back(rounded(column[row]));
        return list;
    };
    const Charts charts = charts_of(history);
    Json list = Json::array();
    for (const Chart& chart : charts.charts) {
        Json lines = Json::array();
        for (const Series& series : chart.series)
            lines.push_back({{"label", series.label},
                             {"column", series.column},
                             {"values", values(*history.find(series.column))}});
        list.push_back({{"title", chart.title},
                        {"unit", chart.unit},
                        {"stepped", chart.is_stepped},
                        {"note", chart.note},
                        {"series", lines}});
    }
    const auto* time = history.find("time");
    return {{"rows", history.num_rows()},
            {"time", time ? values(*time) : Json::array()},
            {"charts", list},
            {"left_out", charts.left_out}};
}

/// A column of the table of edits.
struct EditColumn {
    const char* label;
    const char* unit;
    const char* meaning;
    double (*value)(const Edit&);
};

constexpr EditColumn edit_columns[] = {
    {"time", "s", "at the end of the step", [](const Edit& e) { return e.time; }},
    {"step", "", "number of the step", [](const Edit& e) { return e.step; }},
    {"crossed", "", "elements that the cut passed through",
     [](const Edit& e) { return e.elements_crossed; }},
    {"divided", "", "elements that were divided", [](const Edit& e) { return e.elements_split; }},
    {"added", "", "elements that came of them", [](const Edit& e) { return e.elements_added; }},
    {"removed", "", "elements that were taken away",
     [](const Edit& e) { return e.elements_removed; }},
    {"faces", "", "opened faces", [](const Edit& e) { return e.faces_opened; }},
    {"nodes", "", "new nodes", [](const Edit& e) { return e.nodes_added; }},
    {"cut area", "m²", "one side of the opened faces, at rest",
     [](const Edit& e) { return e.cut_area; }},
    {"mass removed", "kg", "density times volume at rest of removed elements",
     [](const Edit& e) { return e.mass_removed; }},
    {"Δ mass", "kg", "mass of the body after the edit, less that before",
     [](const Edit& e) { return e.after.mass - e.before.mass; }},
    {"Δ kinetic", "J", "change of the kinetic energy",
     [](const Edit& e) { return e.after.kinetic_energy - e.before.kinetic_energy; }},
    {"Δ elastic", "J", "change of the elastic energy",
     [](const Edit& e) { return e.after.elastic_energy - e.before.elastic_energy; }},
    {"|Δ momentum|", "kg m/s", "length of the change of the momentum",
     [](const Edit& e) { return (e.after.momentum - e.before.momentum).norm(); }},
    {"|Δ ang. mom.|", "kg m²/s", "length of the change of the angular momentum",
     [](const Edit& e) { return (e.after.angular_momentum - e.before.angular_momentum).norm(); }},
};

/// What each tool did in all.
Json tool_data(std::span<const Edit> edits) {
    struct Sums {
        double edits = 0.0, crossed = 0.0, removed = 0.0, cut_area = 0.0, mass_removed = 0.0;
        double first = 0.0, last = 0.0;
    };
    std::vector<std::pair<std::string, Sums>> tools;  // in the order of their first edits
    std::map<std::string, std::size_t> rows;
    for (const Edit& edit : edits) {
        const auto [row, is_new] = rows.emplace(edit.tool, tools.size());
        if (is_new) tools.push_back({edit.tool, {.first = edit.time}});
        Sums& sums = tools[row->second].second;
        ++sums.edits;
        sums.crossed += edit.elements_crossed;
        sums.removed += edit.elements_removed;
        sums.cut_area += edit.cut_area;
        sums.mass_removed += edit.mass_removed;
        sums.last = edit.time;
    }
    Json list = Json::array();
    for (const auto& [tool, sums] : tools)
        list.push_back(
            {{"tool", tool},
             {"values", rounded(std::array{sums.edits, sums.first, sums.last, sums.crossed,
                                           sums.removed, sums.cut_area, sums.mass_removed})}});
    return list;
}

/// The edits, column by column. Tools are numbers, because many edits have the same one.
Json edit_data(std::span<const Edit> edits) {
    const auto shown = edits.first(std::min(edits.size(), most_edits));
    Json tools = tool_data(edits);
    std::map<std::string, std::size_t> number;
    for (std::size_t i = 0; i < tools.size(); ++i)
        number.emplace(tools[i]["tool"].get<std::string>(), i);
    Json tool_column = Json::array();
    for (const Edit& edit : shown) tool_column.push_back(number.at(edit.tool));
    Json columns = Json::array();
    for (const EditColumn& column : edit_columns) {
        Json values = Json::array();
        for (const Edit& edit : shown) values.push_back(rounded(column.value(edit)));
        columns.push_back({{"label", column.label},
                           {"unit", column.unit},
                           {"meaning", column.meaning},
                           {"values", values}});
    }
    return {{"count", edits.size()},
            {"shown", shown.size()},
            {"tools", tools},
            {"tool_column", tool_column},
            {"columns", columns}};
}

Json account_data(std::span<const Account> accounts) {
    Json list = Json::array();
    for (const Account& account : accounts) {
        Json rows = Json::array();
        for (const AccountRow& row : account.rows)
            rows.push_back({{"label", row.label},
                            {"values", rounded(row.values)},
                            {"unit", row.unit.empty() ? account.unit : row.unit},
                            {"result", row.is_result}});
        list.push_back({{"title", account.title},
                        {"unit", account.unit},
                        {"note", account.note},
                        {"rows", rows}});
    }
    return list;
}

Json expectation_data(std::span<const ExpectationResult> results) {
    Json list = Json::array();
    for (const ExpectationResult& result : results)
        list.push_back({{"quantity", result.quantity},
                        {"min", result.min ? rounded(*result.min) : Json()},
                        {"max", result.max ? rounded(*result.max) : Json()},
                        {"value", rounded(result.value)},
                        {"met", result.is_met}});
    return list;
}

Json warning_data(const RunRecord& run) {
    Json list = Json::array();
    if (const auto it = run.summary.find("warnings"); it != run.summary.end() && it->is_array())
        for (const Json& warning : *it)
            if (warning.is_string()) list.push_back(warning);
    return list;
}

}  // namespace

Json page_data(const RunRecord& run, const Pictures& pictures, const Origin& origin) {
    const EnergyBalance balance = energy_balance(run);
    HistoryTable history = run.history;
    if (!balance.lacking.empty()) history.add(lacking_energy, balance.lacking);
    const Ending ending = ending_of(run);
    Json data;
    data["title"] = run.title();
    data["name"] = run.name;
    data["folder"] = run.folder.string();
    data["version"] = run.text("version");
    data["started"] = run.text("started");
    data["written"] = run.written;
    data["ending"] = {{"kind", ending.kind}, {"headline", ending.headline}, {"text", ending.text}};
    data["facts"] = fact_data(facts_of(run, balance));
    data["warnings"] = warning_data(run);
    data["expectations"] = expectation_data(expectations_of(run));
    data["pictures"] = picture_data(run, pictures);
    data["plots"] = plot_data(history);
    data["accounts"] = account_data(accounts_of(run, balance));
    data["edits"] = edit_data(run.edits);
    data["scenario"] = run.scenario_text ? Json(*run.scenario_text) : Json();
    data["command"] = {{"run", run.text("command")}, {"directory", run.text("directory")},
                       {"rerun", origin.rerun},      {"report", origin.command},
                       {"date", origin.date},        {"version", INCISE_VERSION}};
    return data;
}

}  // namespace incise::report
