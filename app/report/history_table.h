// history.csv of a run, as columns of numbers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace incise::report {

/// A table of numbers with named columns of equal length.
struct HistoryTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;

    std::size_t num_rows() const { return columns.empty() ? 0 : columns.front().size(); }
    /// Returns the column of this name, or a null pointer.
    const std::vector<double>* find(std::string_view name) const;
    /// Returns the value of a row. Returns NaN if there is no such column.
    double value(std::string_view name, std::size_t row) const;
    /// @pre  the column has a value for each row
    void add(std::string name, std::vector<double> column);
};

/// Reads history.csv. The table may be without rows.
/// Throws InputError that names the line and the column, and says what to do, if the file is
/// missing, empty, or cut short, or if a value is not a number.
HistoryTable read_history(const std::filesystem::path& path);

/// Returns the numbers of the rows to show, in ascending order. If the table has more than `most`
/// rows, these are evenly spread rows, with the first, the last, and the rows that have the lowest
/// or the highest value of a column. The result can therefore be longer than `most`, by two rows a
/// column.
std::vector<std::size_t> rows_to_show(const HistoryTable& history, std::size_t most);

}  // namespace incise::report
