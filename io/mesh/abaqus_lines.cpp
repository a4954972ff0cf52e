// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/abaqus_lines.h"

#include <cmath>

#include "incise/base/error.h"

namespace incise::io {

namespace {

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> fields;
    while (true) {
        const auto comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == line.npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

/// Returns the text of a real with the exponent of C (e) instead of that of Fortran (D).
std::string as_in_c(std::string_view real) {
    std::string text(real);
    if (const auto exponent = text.find_first_of("dD"); exponent != text.npos) text[exponent] = 'e';
    return text;
}

}  // namespace

std::string abaqus_word(std::string_view text) {
    std::string word;
    for (const char c : text)
        if (!is_blank(c)) word += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return word;
}

std::optional<std::string> AbaqusKeyword::parameter(const std::string& wanted) const {
    const auto found = parameters.find(wanted);
    if (found == parameters.end()) return std::nullopt;
    return found->second;
}

bool AbaqusLines::next() {
    while (scanner_.remaining() > 0) {
        byte_ = text_.whole().bytes.size() - scanner_.remaining();
        line_ = trimmed(scanner_.rest_of_line());
        if (!line_.empty() && !line_.starts_with("**")) return true;
    }
    return false;
}

AbaqusKeyword AbaqusLines::keyword() {
    const auto begin = byte_;
    std::string text(line_);
    while (text.ends_with(',') && next()) text += line_;
    byte_ = begin;
    const auto parts = split(text);
    AbaqusKeyword keyword{abaqus_word(parts.front().substr(1)), {}};
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const auto sign = std::min(parts[i].find('='), parts[i].size());
        keyword.parameters[abaqus_word(parts[i].substr(0, sign))] =
            abaqus_word(parts[i].substr(std::min(sign + 1, parts[i].size())));
    }
    return keyword;
}

std::vector<std::string_view> AbaqusLines::fields() const { return split(line_); }

std::int64_t AbaqusLines::number(std::string_view field, std::string_view what) const {
    const auto parsed = parse_number<std::int64_t>(field);
    if (!parsed || *parsed < 1)
        fail("expected " + std::string(what) + ", from 1 on, found " + in_quotes(field) +
             range_remark<std::int64_t>(field));
    return *parsed;
}

double AbaqusLines::real(std::string_view field, std::string_view what) const {
    const std::string text = as_in_c(field);
    const auto parsed = parse_number<double>(text);
    if (!parsed)
        fail("expected " + std::string(what) + ", found " + in_quotes(field) +
             range_remark<double>(text));
    if (!std::isfinite(*parsed))
        fail(std::string(what) + " is " + shown(*parsed) + "; it must be finite");
    return *parsed;
}

std::string AbaqusLines::location() const { return text_.location(byte_); }

void AbaqusLines::fail(const std::string& message) const {
    throw InputError(location() + ": " + message);
}

}  // namespace incise::io
