// The parts of the scenario reader, one a group of sections; used by scenario_reader.cpp alone.
// Each reads its sections from the root table and reports what is wrong with them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "incise/scenario/scenario.h"
#include "incise/scenario/table_reader.h"

namespace incise::scenario {

inline constexpr IntegerLimits region_limits{std::numeric_limits<int>::min(),
                                             std::numeric_limits<int>::max()};

MeshSpec read_mesh_spec(const TableReader& root, const std::filesystem::path& folder);
/// @param mesh  that is made of them
std::vector<MaterialSpec> read_materials(const TableReader& root, const MeshSpec& mesh);
/// @param materials  of the body, as not all methods have forces of every precision
DynamicsSpec read_dynamics(const TableReader& root, std::span<const MaterialSpec> materials);
/// Those that select something sound, as loads too; what else is at fault with them is left out.
/// @param end_time  later keys are warned of; not above 0 if it is not known
/// @param names  gets those of all
std::vector<ConstraintSpec> read_constraints(const TableReader& root, double end_time,
                                             std::vector<std::string>& names);
std::vector<LoadSpec> read_loads(const TableReader& root, double end_time);
/// Those of a known kind; without path if it is not known where they are.
/// @param folder  what the names of surface files are relative to
std::vector<ToolSpec> read_tools(const TableReader& root, const std::filesystem::path& folder,
                                 double end_time);
OutputSpec read_output(const TableReader& root, double end_time);
/// @param constraints  names of those whose reactions are among the quantities
std::vector<Expectation> read_expectations(const TableReader& root,
                                           const std::vector<std::string>& constraints);

/// The name that a constraint, load or tool gives itself, or `fallback`. Reports one that is used
/// already or has other characters than letters, digits, _ and -: it becomes part of the names of
/// columns. Adds it to `used`, once.
std::string read_name(const TableReader& table, const std::string& fallback,
                      std::vector<std::string>& used);

/// A file named relative to the scenario's folder. Reports a name that is empty, and a file that is
/// not there or cannot be read.
/// @param kind  such as "mesh file"
std::filesystem::path read_file_name(const TableReader& table, std::string_view key,
                                     const std::filesystem::path& folder, const std::string& kind);

/// Reads an array of tables that each have a time and something else, in ascending order of time.
/// Reports an empty array, and times that are negative, do not ascend or come after `end_time`.
/// None if any is at fault.
/// @param read_value  makes the value of one table
template <class T, class ReadValue>
std::vector<TimeKey<T>> read_time_keys(const TableReader& table, std::string_view key,
                                       const Names& names, double end_time,
                                       const ReadValue& read_value);

/// What read_time_keys does with the times. One that is not a number is not judged.
void check_times(const TableReader& table, std::string_view key, std::span<const TableReader> rows,
                 std::span<const double> times, double end_time);

template <class T, class ReadValue>
std::vector<TimeKey<T>> read_time_keys(const TableReader& table, std::string_view key,
                                       const Names& names, double end_time,
                                       const ReadValue& read_value) {
    std::vector<TimeKey<T>> keys;
    std::vector<double> times;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto rows = table.tables(key, names);
    for (const auto& row : rows) {
        row.require("time", "seconds, as in time = 0.5");
        times.push_back(row.number("time", unknown, limits::non_negative));
        keys.push_back({times.back(), read_value(row)});
    }
    check_times(table, key, rows, times, end_time);
    if (!table.is_sound(key)) keys.clear();
    return keys;
}

}  // namespace incise::scenario
