// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/abaqus_includes.h"

#include <algorithm>

#include "incise/base/error.h"
#include "incise/io/files/memory.h"
#include "incise/io/files/scanner.h"
#include "incise/io/mesh/abaqus_lines.h"

namespace incise::io {

namespace {

/// Files may include files that are included twice each, and so on. This bounds their number.
constexpr std::size_t most_included = 1000;

bool is_comment(std::string_view line) { return line.empty() || line.starts_with("**"); }

bool is_include(std::string_view line) {
    return line.starts_with('*') && abaqus_word(line.substr(0, line.find(','))) == "*INCLUDE";
}

bool has_include(const InputFile& file) {
    Scanner scanner(file);
    while (scanner.remaining() > 0)
        if (is_include(trimmed(scanner.rest_of_line()))) return true;
    return false;
}

/// Returns the value of the parameter INPUT of a keyword, as it is written, or an empty text.
std::string_view input_of(std::string_view keyword) {
    while (!keyword.empty()) {
        const auto parameter = trimmed(keyword.substr(0, keyword.find(',')));
        keyword.remove_prefix(std::min(keyword.find(','), keyword.size() - 1) + 1);
        const auto sign = parameter.find('=');
        if (sign == parameter.npos || abaqus_word(parameter.substr(0, sign)) != "INPUT") continue;
        auto name = trimmed(parameter.substr(sign + 1));
        if (name.size() > 1 && name.starts_with('"') && name.ends_with('"'))
            name = name.substr(1, name.size() - 2);
        return name;
    }
    return {};
}

}  // namespace

AbaqusText::AbaqusText(const InputFile& deck) : deck_(deck) {
    if (!has_include(deck)) return;
    whole_.path = deck.path;
    std::vector<std::filesystem::path> open_files;
    append(deck, open_files);
}

void AbaqusText::append(const InputFile& file, std::vector<std::filesystem::path>& open_files) {
    require_memory(2.0 * static_cast<double>(whole_.bytes.size() + file.bytes.size()),
                   deck_.name() + ": the deck with the files that it includes", "include less");
    std::error_code error;
    open_files.push_back(std::filesystem::weakly_canonical(file.path, error));
    segments_.push_back({whole_.bytes.size(), file.name(), 1});
    Scanner scanner(file);
    std::size_t line_number = 0;
    const auto next_line = [&] {
        ++line_number;
        return scanner.rest_of_line();
    };
    while (scanner.remaining() > 0) {
        auto line = next_line();
        if (!is_include(trimmed(line))) {
            whole_.bytes.append(line).append("\n");
            continue;
        }
        const auto location = file.name() + ":" + std::to_string(line_number);
        std::string keyword(trimmed(line));
        while (keyword.ends_with(',') && scanner.remaining() > 0)
            if (line = trimmed(next_line()); !is_comment(line)) keyword += line;
        include(input_of(keyword), location, open_files);
        segments_.push_back({whole_.bytes.size(), file.name(), line_number + 1});
    }
    open_files.pop_back();
}

void AbaqusText::include(std::string_view name, const std::string& location,
                         std::vector<std::filesystem::path>& open_files) {
    const auto refuse = [&](const std::string& message) {
        throw InputError(location + ": *INCLUDE" + message);
    };
    if (name.empty()) refuse(" has no INPUT=...; name the file to include");
    if (++num_included_ > most_included)
        refuse(": more than " + std::to_string(most_included) +
               " files are included; put their lines into fewer files");
    const auto path = deck_.path.parent_path() / std::string(name);
    std::error_code error;
    const auto same = std::filesystem::weakly_canonical(path, error);
    if (std::ranges::find(open_files, same) != open_files.end())
        refuse(": " + in_quotes(name) +
               " is the file of this line, or includes it, so that there is no end; take the line "
               "out");
    InputFile file;
    try {
        file = load_input_file(path);
    } catch (const InputError& fault) {
        refuse(": " + std::string(fault.what()));
    }
    append(file, open_files);
}

std::string AbaqusText::location(std::size_t byte) const {
    if (segments_.empty()) return deck_.name() + ":" + std::to_string(deck_.line_of(byte));
    const auto behind = std::ranges::upper_bound(segments_, byte, {}, &Segment::begin);
    const Segment& segment = *std::prev(behind);
    const auto begin = whole_.bytes.begin();
    const auto num_lines =
        std::count(begin + static_cast<std::ptrdiff_t>(segment.begin),
                   begin + static_cast<std::ptrdiff_t>(std::min(byte, whole_.bytes.size())), '\n');
    return segment.file + ":" + std::to_string(segment.line + static_cast<std::size_t>(num_lines));
}

}  // namespace incise::io
