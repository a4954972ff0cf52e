// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/table_reader.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "incise/base/number_format.h"

namespace incise::scenario {

namespace {

std::string element_path(const std::string& path, std::size_t index) {
    return path + "[" + std::to_string(index) + "]";
}

std::string text_of(const IntegerLimits& limits) {
    const IntegerLimits all;
    if (limits.high == all.high) return "at least " + std::to_string(limits.low);
    return "from " + std::to_string(limits.low) + " to " + std::to_string(limits.high);
}

std::string text_of_unknown(std::string_view meant, const Names& names) {
    std::string text = "is not known; did you mean " + in_quotes(meant) + "?";
    if (names.supported.size() > 1) text += " Known here: " + list_of(names.supported);
    return text;
}

}  // namespace

std::optional<std::string> complaint(std::string_view name, const Names& names) {
    if (std::ranges::find(names.supported, name) != names.supported.end()) return std::nullopt;
    if (std::ranges::find(names.given, name) != names.given.end())
        return "need not be asked for: it is there wherever it exists. Known here: " +
               list_of(names.supported);
    return text_of_unknown(nearest(name, names.supported), names);
}

TableReader::TableReader(const Table& table, const SourceLocation& location, std::string path,
                         const Names& keys, Diagnostics& diagnostics)
    : table_(table), place_(location), path_(std::move(path)), diagnostics_(diagnostics) {
    std::vector<std::string_view> likely(keys.supported.begin(), keys.supported.end());
    std::stable_partition(likely.begin(), likely.end(),
                          [&](std::string_view key) { return !find(table_, key); });
    for (const auto& entry : table_) {
        if (std::ranges::find(likely, entry.key) != likely.end()) continue;
        const std::string_view meant = nearest(entry.key, likely);
        diagnostics_.unknown_key_error(entry.location, path_of(entry.key),
                                       text_of_unknown(meant, keys));
        if (is_misspelt(entry.key, meant)) misspelt_.emplace_back(meant, &entry.value);
    }
}

const Value* TableReader::value_of(std::string_view key) const {
    if (const Value* value = find(table_, key)) return value;
    for (const auto& [meant, value] : misspelt_)
        if (meant == key) return value;
    return nullptr;
}

bool TableReader::is_text(std::string_view key) const {
    const Value* value = value_of(key);
    return value != nullptr && value->get<std::string>() != nullptr;
}

bool TableReader::is_empty_array(std::string_view key) const {
    const Value* value = value_of(key);
    const Array* elements = value != nullptr ? value->get<Array>() : nullptr;
    return elements != nullptr && elements->empty();
}

bool TableReader::require(std::string_view key, std::string_view remedy) const {
    if (has(key)) return true;
    diagnostics_.key_error(place_, path_of(key), "is missing: " + std::string(remedy));
    return false;
}

double TableReader::number(std::string_view key, double fallback, const Limits& limits) const {
    return number_if_given(key, limits).value_or(fallback);
}

std::optional<double> TableReader::number_if_given(std::string_view key,
                                                   const Limits& limits) const {
    const Value* value = value_of(key);
    return value != nullptr ? number_of(*value, path_of(key), limits) : std::nullopt;
}

std::int64_t TableReader::integer(std::string_view key, std::int64_t fallback,
                                  const IntegerLimits& limits) const {
    const Value* value = value_of(key);
    return value != nullptr ? integer_of(*value, path_of(key), limits).value_or(fallback)
                            : fallback;
}

bool TableReader::flag(std::string_view key, bool fallback) const {
    const Value* value = value_of(key);
    if (value == nullptr) return fallback;
    if (const auto* given = value->get<bool>()) return *given;
    report_type(*value, path_of(key), "true or false");
    return fallback;
}

std::string TableReader::text(std::string_view key, const std::string& fallback) const {
    const Value* value = value_of(key);
    if (value == nullptr) return fallback;
    if (const auto* given = value->get<std::string>()) return *given;
    report_type(*value, path_of(key), "text in quotes");
    return fallback;
}

Vec3 TableReader::vector(std::string_view key, const Vec3& fallback) const {
    const Value* value = value_of(key);
    return value != nullptr ? vector_of(*value, path_of(key)).value_or(fallback) : fallback;
}

Vec3 TableReader::direction(std::string_view key, const Vec3& fallback) const {
    const Vec3 given = vector(key, fallback);
    const double length = given.stableNorm();
    if (length > 0.0 && std::isfinite(length)) return given / length;
    error(key, "is not allowed: a direction must have a length above 0");
    return fallback;
}

std::vector<Vec3> TableReader::vectors(std::string_view key) const {
    std::vector<Vec3> result;
    if (const Array* values = array(key, "an array of points, as in [[0, 0, 0], [1, 0, 0]]"))
        for (std::size_t i = 0; i < values->size(); ++i)
            if (const auto point = vector_of((*values)[i], element_path(path_of(key), i)))
                result.push_back(*point);
    return result;
}

std::vector<std::int64_t> TableReader::integers(std::string_view key, const IntegerLimits& limits,
                                                Repeats repeats) const {
    std::vector<std::int64_t> result;
    std::set<std::int64_t> before;
    const Value* value = value_of(key);
    if (value == nullptr) return result;
    const auto add = [&](const Value& element, const std::string& path) {
        const auto number = integer_of(element, path, limits);
        if (!number) return;
        result.push_back(*number);
        if (repeats == Repeats::refused && !before.insert(*number).second)
            report(element.location, path, std::to_string(*number) + " is there twice");
    };
    if (const auto* values = value->get<Array>()) {
        for (std::size_t i = 0; i < values->size(); ++i)
            add((*values)[i], element_path(path_of(key), i));
        if (values->empty()) error(key, "is empty: give at least one number");
    } else if (value->get<std::int64_t>() != nullptr) {
        add(*value, path_of(key));
    } else {
        report_type(*value, path_of(key), "a whole number or an array of them");
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

std::optional<std::size_t> TableReader::choice(std::string_view key, const Names& names) const {
    const std::string name = text(key);
    const Value* value = value_of(key);
    if (value == nullptr || value->get<std::string>() == nullptr) return std::nullopt;
    if (const auto wrong = complaint(name, names)) {
        error(key, in_quotes(name) + ": " + *wrong);
        return std::nullopt;
    }
    const auto found = std::find(names.supported.begin(), names.supported.end(), name);
    return static_cast<std::size_t>(found - names.supported.begin());
}

std::vector<std::size_t> TableReader::choices(std::string_view key, const Names& names) const {
    std::vector<std::size_t> result;
    const Array* values = array(key, "an array of texts in quotes");
    if (values == nullptr) return result;
    for (std::size_t i = 0; i < values->size(); ++i) {
        const Value& value = (*values)[i];
        const std::string path = element_path(path_of(key), i);
        const auto* name = value.get<std::string>();
        if (name == nullptr) {
            report_type(value, path, "text in quotes");
        } else if (const auto wrong = complaint(*name, names)) {
            report(value.location, path, in_quotes(*name) + ": " + *wrong);
        } else {
            const auto found = std::find(names.supported.begin(), names.supported.end(), *name);
            const auto index = static_cast<std::size_t>(found - names.supported.begin());
            if (std::find(result.begin(), result.end(), index) == result.end())
                result.push_back(index);
            else
                report(value.location, path, in_quotes(*name) + " is there twice");
        }
    }
    return result;
}

std::optional<TableReader> TableReader::table(std::string_view key, const Names& keys) const {
    const Value* value = value_of(key);
    if (value == nullptr) return std::nullopt;
    const auto* entries = value->get<Table>();
    if (entries == nullptr) {
        report_type(*value, path_of(key), "a table");
        const auto* elements = value->get<Array>();
        if (elements != nullptr && !elements->empty()) entries = elements->front().get<Table>();
    }
    if (entries == nullptr) return std::nullopt;
    return TableReader(*entries, value->location, path_of(key), keys, diagnostics_);
}

std::vector<TableReader> TableReader::tables(std::string_view key, const Names& keys) const {
    std::vector<TableReader> result;
    std::size_t num_elements = 0;
    const auto add = [&](const Value& value) {
        const std::string path = element_path(path_of(key), num_elements++);
        if (const auto* entries = value.get<Table>())
            result.emplace_back(*entries, value.location, path, keys, diagnostics_);
        else
            report_type(value, path, "a table");
    };
    const Value* given = value_of(key);
    if (given == nullptr) return result;
    if (const auto* elements = given->get<Array>()) {
        std::ranges::for_each(*elements, add);
    } else {
        report_type(*given, path_of(key),
                    path_.empty() ? "an array of tables, as in [[" + std::string(key) + "]]"
                                  : "an array of tables, as in [{ ... }, { ... }]");
        if (given->get<Table>() != nullptr) add(*given);
    }
    for (const auto& [meant, value] : misspelt_) {
        const bool is_more = path_.empty() && meant == key && value != given;
        const auto* elements = is_more ? value->get<Array>() : nullptr;
        if (elements == nullptr) continue;
        for (const Value& element : *elements)
            if (element.get<Table>() != nullptr) add(element);
    }
    return result;
}

std::optional<std::string_view> TableReader::one_of(
    std::initializer_list<std::string_view> keys) const {
    std::vector<std::string_view> given;
    for (const auto key : keys)
        if (has(key)) given.push_back(key);
    if (given.size() == 1) return given.front();
    const std::string allowed = list_of(std::vector<std::string_view>(keys));
    error({}, given.empty()
                  ? "must have exactly one of " + allowed
                  : "has " + list_of(given) + ", but only one of " + allowed + " is allowed");
    return std::nullopt;
}

std::string TableReader::path_of(std::string_view key) const {
    if (path_.empty() || key.empty()) return path_ + std::string(key);
    return path_ + "." + std::string(key);
}

const SourceLocation& TableReader::location_of(std::string_view key) const {
    const Value* value = value_of(key);
    return value != nullptr ? value->location : place_;
}

std::string TableReader::location_text(std::string_view key) const {
    return diagnostics_.text_of(location_of(key));
}

void TableReader::error(std::string_view key, const std::string& text) const {
    report(location_of(key), path_of(key), text);
}

void TableReader::warning(std::string_view key, const std::string& text) const {
    diagnostics_.warning(location_of(key), text);
}

const Array* TableReader::array(std::string_view key, std::string_view wanted) const {
    const Value* value = value_of(key);
    if (value == nullptr) return nullptr;
    if (const auto* elements = value->get<Array>()) return elements;
    report_type(*value, path_of(key), wanted);
    return nullptr;
}

std::optional<double> TableReader::number_of(const Value& value, const std::string& path,
                                             const Limits& limits) const {
    double number = 0.0;
    if (const auto* integer = value.get<std::int64_t>()) {
        number = static_cast<double>(*integer);
    } else if (const auto* real = value.get<double>()) {
        number = *real;
    } else {
        report_type(value, path, "a number");
        return std::nullopt;
    }
    if (limits.contains(number)) return number;
    const char* finite = std::isinf(number) && limits.excludes_infinity() ? "finite, " : "";
    report(value.location, path,
           format_number(number) + " is not allowed: must be " + finite + limits.text());
    return std::nullopt;
}

std::optional<std::int64_t> TableReader::integer_of(const Value& value, const std::string& path,
                                                    const IntegerLimits& limits) const {
    const auto* integer = value.get<std::int64_t>();
    if (integer == nullptr) {
        report_type(value, path, "a whole number");
        return std::nullopt;
    }
    if (*integer >= limits.low && *integer <= limits.high) return *integer;
    report(value.location, path,
           std::to_string(*integer) + " is not allowed: must be " + text_of(limits));
    return std::nullopt;
}

std::optional<Vec3> TableReader::vector_of(const Value& value, const std::string& path) const {
    const auto* elements = value.get<Array>();
    if (elements == nullptr || elements->size() != 3) {
        report_type(value, path, "an array of 3 numbers, as in [0, 0, 1]");
        return std::nullopt;
    }
    Vec3 vector = Vec3::Zero();
    bool is_complete = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto number = number_of((*elements)[i], element_path(path, i), {});
        is_complete = is_complete && number.has_value();
        vector[static_cast<Eigen::Index>(i)] = number.value_or(0.0);
    }
    return is_complete ? std::optional(vector) : std::nullopt;
}

void TableReader::report_type(const Value& value, const std::string& path,
                              std::string_view wanted) const {
    report(value.location, path,
           "must be " + std::string(wanted) + ", but is " + value.description());
}

void TableReader::report(const SourceLocation& location, const std::string& path,
                         const std::string& text) const {
    if (is_guess(path))
        diagnostics_.note_error(path);
    else
        diagnostics_.key_error(location, path, text);
}

bool TableReader::is_guess(std::string_view path) const {
    return std::ranges::any_of(misspelt_, [&](const auto& guess) {
        return !find(table_, guess.first) && is_at_or_below(path, path_of(guess.first));
    });
}

}  // namespace incise::scenario
