// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/number_list.h"

#include <cmath>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/number_text.h"
#include "incise/scenario/diagnostics.h"

namespace incise::app {

std::vector<std::string_view> parts_of(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const auto end = text.find(separator);
        std::string_view part = text.substr(0, end);
        while (!part.empty() && io::is_blank(part.front())) part.remove_prefix(1);
        while (!part.empty() && io::is_blank(part.back())) part.remove_suffix(1);
        parts.push_back(part);
        if (end == text.npos) return parts;
        text.remove_prefix(end + 1);
    }
}

std::vector<double> parse_numbers(const std::string& what, std::string_view text,
                                  std::string_view form) {
    const auto parts = parts_of(text, ',');
    const std::size_t wanted = parts_of(form, ',').size();
    const auto fail = [&](const std::string& wrong) {
        throw InputError(what + ": " + wrong + "; it needs " + std::to_string(wanted) + ": " +
                         std::string(form));
    };
    const std::size_t given = parts.size() == 1 && parts.front().empty() ? 0 : parts.size();
    if (given != wanted)
        fail(scenario::in_quotes(text) + " has " + std::to_string(given) +
             (given == 1 ? " number" : " numbers"));
    std::vector<double> numbers;
    for (const auto part : parts) {
        const auto number = io::parse_number<double>(part);
        if (!number)
            fail(scenario::in_quotes(part) + " in " + scenario::in_quotes(text) + " is no number");
        if (!(std::abs(*number) <= largest_coordinate))
            fail(scenario::in_quotes(part) + " in " + scenario::in_quotes(text) +
                 " is not allowed, numbers lie between -" + format_number(largest_coordinate) +
                 " and " + format_number(largest_coordinate));
        numbers.push_back(*number);
    }
    return numbers;
}

std::vector<Vec3> parse_points(const std::string& what, std::string_view text) {
    std::vector<Vec3> points;
    for (const auto part : parts_of(text, ';')) {
        const auto x =
            parse_numbers(what + ", point " + std::to_string(points.size() + 1), part, "x,y,z");
        points.emplace_back(x[0], x[1], x[2]);
    }
    return points;
}

}  // namespace incise::app
