// The parts of the scenario reader, each for one group of sections. Each part reads its sections
// from the root table and reports what is wrong with them.
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
/// Reads the [[material]] sections.
/// @param root  the root table
/// @param mesh  the mesh that consists of these materials
std::vector<MaterialSpec> read_materials(const TableReader& root, const MeshSpec& mesh);
/// Reads the [dynamics] section.
/// @param root       the root table
/// @param materials  the materials of the body; not all methods have forces in single precision
/// @param needs_end  false: see ForProgram
DynamicsSpec read_dynamics(const TableReader& root, std::span<const MaterialSpec> materials,
                           bool needs_end);
/// Reads the [contact] section.
/// @param dynamics  contact exists in explicit dynamics only
contact::ContactSettings read_contact(const TableReader& root, const DynamicsSpec& dynamics);
/// Reads the [[constraint]] sections. The result has only constraints whose selection is sound. Of
/// these, faulty parts are left out.
/// @param root      the root table
/// @param end_time  end of the run, s: later keys give a warning; not above 0 if not known
/// @param names     receives the names of all constraints
std::vector<ConstraintSpec> read_constraints(const TableReader& root, double end_time,
                                             std::vector<std::string>& names);
/// Reads the [[load]] sections. The result has only loads of one kind whose selection is sound.
std::vector<LoadSpec> read_loads(const TableReader& root, double end_time);
/// Read what a program adds to a world which runs: a section without a name, which the program
/// gives beside it.
ConstraintSpec read_added_constraint(const Table& table, Diagnostics& diagnostics);
LoadSpec read_added_load(const Table& table, Diagnostics& diagnostics);
/// The same; no array of the mesh file has its fibres.
MaterialSpec read_added_material(const Table& table, Diagnostics& diagnostics);
/// Reads the [[tool]] and [[obstacle]] sections. The result has only tools of a known kind, and
/// tools that name the file of a surface. A tool with a faulty path or shape has an empty path.
/// @param root      the root table
/// @param folder    folder of the scenario, to which names of surface files are relative
/// @param end_time  end of the run, s: later keys give a warning; not above 0 if not known
/// @param why_no_contact  why tools cannot touch tissue; empty if they can
std::vector<ToolSpec> read_tools(const TableReader& root, const std::filesystem::path& folder,
                                 double end_time, const std::string& why_no_contact);
/// Reads a tool that is led by hand: the keys of a [[tool]] without those that say when it is
/// where, and without a name. The tool is named as its kind, and has no path.
ToolSpec read_hand_tool(const Table& table, const std::filesystem::path& folder,
                        const std::string& why_no_contact, Diagnostics& diagnostics);
/// Reads the [output] section.
/// @param end_time    end of the run, s; not above 0 if not known
/// @param has_frames  without the section
OutputSpec read_output(const TableReader& root, double end_time, bool has_frames);
/// Reads the [expect] section.
/// @param root         the root table
/// @param constraints  names of the constraints, whose reactions are quantities
/// @param probes       names of the probes and obstacles, the forces on which are quantities
std::vector<Expectation> read_expectations(const TableReader& root,
                                           const std::vector<std::string>& constraints,
                                           const std::vector<std::string>& probes);

/// Returns the name of a constraint, load or tool, or `fallback` if it has none, and adds the name
/// to `used`. Reports a name that is in `used` already. Reports characters other than letters,
/// digits, _ and -, because names become parts of column names.
std::string read_name(const TableReader& table, const std::string& fallback,
                      std::vector<std::string>& used);

/// Returns the path of a file whose name is relative to the folder of the scenario. Reports an
/// empty name, and a file that is missing or cannot be read.
/// @param table   the table with the key
/// @param key     the key that holds the name
/// @param folder  folder of the scenario
/// @param kind    kind of file for messages, such as "mesh file"
std::filesystem::path read_file_name(const TableReader& table, std::string_view key,
                                     const std::filesystem::path& folder, const std::string& kind);

/// Reads an array of tables, each with a time and a value, in ascending order of time. Reports an
/// empty array, and times that are negative or do not ascend. Warns of times after `end_time`.
/// Returns no keys if one of them is faulty.
/// @param table       the table with the array
/// @param key         the key of the array
/// @param names       allowed keys of the tables in the array
/// @param end_time    end of the run, s; not above 0 if not known
/// @param read_value  function that reads the value of one table
template <class T, class ReadValue>
std::vector<TimeKey<T>> read_time_keys(const TableReader& table, std::string_view key,
                                       const Names& names, double end_time,
                                       const ReadValue& read_value);

/// Checks the times for read_time_keys(). A time that is not a number is not checked.
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
