// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/history_table.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"

namespace incise::report {

namespace {

constexpr const char* history_remedy =
    "; remove that line if it is the last one, or run the scenario again";

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t from = 0;;) {
        const auto comma = line.find(',', from);
        fields.push_back(line.substr(from, comma - from));
        if (comma == line.npos) return fields;
        from = comma + 1;
    }
}

}  // namespace

const std::vector<double>* HistoryTable::find(std::string_view name) const {
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end() ? nullptr : &columns[static_cast<std::size_t>(it - names.begin())];
}

double HistoryTable::value(std::string_view name, std::size_t row) const {
    const auto* column = find(name);
    return column && row < column->size() ? (*column)[row]
                                          : std::numeric_limits<double>::quiet_NaN();
}

void HistoryTable::add(std::string name, std::vector<double> column) {
    names.push_back(std::move(name));
    columns.push_back(std::move(column));
}

HistoryTable read_history(const std::filesystem::path& path) {
    const io::InputFile file = io::load_input_file(path);
    HistoryTable history;
    std::size_t line_number = 0;
    const auto refuse = [&](const std::string& why) {
        throw InputError(file.name() + ":" + std::to_string(line_number) + ": " + why +
                         history_remedy);
    };
    for (std::string_view rest = file.bytes; !rest.empty();) {
        const auto end = rest.find('\n');
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++line_number;
        const auto fields = fields_of(line);
        if (line_number == 1) {
            if (fields.front() != "time")
                throw InputError(file.name() + ":1: begins with " + io::in_quotes(fields.front()) +
                                 ", and the history of a run begins with the column 'time'; give "
                                 "the folder that incise run made");
            for (const auto field : fields) history.names.emplace_back(field);
            history.columns.resize(fields.size());
            continue;
        }
        if (fields.size() != history.names.size())
            refuse("has " + std::to_string(fields.size()) + " of " +
                   std::to_string(history.names.size()) + " values");
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const auto value = io::parse_number<double>(fields[i]);
            if (!value)
                refuse("column " + io::in_quotes(history.names[i]) + " is " +
                       io::in_quotes(fields[i]) + ", which is not a number");
            history.columns[i].push_back(*value);
        }
        // A number that is cut short is still a number, but a wrong one.
        if (end == line.npos && rest.empty() && !file.bytes.ends_with('\n'))
            refuse("the file is cut short within the line");
    }
    const auto& times = history.columns.front();
    const auto later = std::is_sorted_until(times.begin(), times.end());
    if (later != times.end()) {
        line_number = static_cast<std::size_t>(later - times.begin()) + 2;
        refuse("the time " + io::shown(*later) + " s is before that of the line above");
    }
    return history;
}

std::vector<std::size_t> rows_to_show(const HistoryTable& history, std::size_t most) {
    const std::size_t num_rows = history.num_rows();
    std::vector<std::size_t> rows;
    const std::size_t stride = num_rows <= most ? 1 : (num_rows + most - 1) / most;
    for (std::size_t i = 0; i < num_rows; i += stride) rows.push_back(i);
    if (stride == 1) return rows;
    rows.push_back(num_rows - 1);
    for (const auto& column : history.columns) {
        const auto [low, high] = std::minmax_element(column.begin(), column.end());
        rows.push_back(static_cast<std::size_t>(low - column.begin()));
        rows.push_back(static_cast<std::size_t>(high - column.begin()));
    }
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

}  // namespace incise::report
