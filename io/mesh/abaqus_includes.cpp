// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/abaqus_includes.h"

#include <algorithm>
#include <optional>

#include "incise/base/error.h"
#include "incise/io/files/memory.h"
#include "incise/io/files/scanner.h"
#include "incise/io/mesh/abaqus_lines.h"

namespace incise::io {

namespace {

/// Files may include files that are included twice each, and so on. This bounds their number.
constexpr std::size_t most_included = 1000;

bool is_comment(std::string_view line) { return line.empty() || line.starts_with("**"); }

/// Returns the keyword of a line, if it is one of those that may name a file, or an empty text.
std::string keyword_with_file(std::string_view line) {
    if (!line.starts_with('*') || is_comment(line)) return {};
    auto word = abaqus_word(line.substr(0, line.find(',')));
    return word == "*INCLUDE" || word == "*NODE" || word == "*ELEMENT" ? word : std::string();
}

/// Returns the value of the parameter INPUT of a keyword, as it is written, if there is one.
std::optional<std::string_view> input_of(std::string_view keyword) {
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
    return std::nullopt;
}

/// A keyword that may name a file, with the lines that continue it.
struct KeywordText {
    std::string word;   ///< empty: the line is no such keyword
    std::string lines;  ///< as they are in the file
    std::string text;   ///< the same as one line, without comments
    std::size_t num_lines = 0;

    bool is_include() const { return word == "*INCLUDE"; }
    bool names_file() const { return is_include() || (!word.empty() && input_of(text)); }
};

/// Reads the next line, and those that continue it if it is a keyword that may name a file.
KeywordText next_keyword(Scanner& scanner) {
    KeywordText keyword;
    const auto take_line = [&] {
        const auto line = scanner.rest_of_line();
        keyword.lines.append(line).append("\n");
        ++keyword.num_lines;
        return trimmed(line);
    };
    const auto first = take_line();
    keyword.word = keyword_with_file(first);
    if (keyword.word.empty()) return keyword;
    keyword.text = first;
    while (keyword.text.ends_with(',') && scanner.remaining() > 0)
        if (const auto line = take_line(); !is_comment(line)) keyword.text += line;
    return keyword;
}

bool names_files(const InputFile& deck) {
    Scanner scanner(deck);
    while (scanner.remaining() > 0)
        if (next_keyword(scanner).names_file()) return true;
    return false;
}

}  // namespace

AbaqusText::AbaqusText(const InputFile& deck) : deck_(deck) {
    if (!names_files(deck)) return;
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
    std::size_t line_number = 1;
    while (scanner.remaining() > 0) {
        const auto keyword = next_keyword(scanner);
        if (!keyword.is_include()) whole_.bytes += keyword.lines;
        const auto location = file.name() + ":" + std::to_string(line_number) + ": ";
        line_number += keyword.num_lines;
        if (!keyword.names_file()) continue;
        include(input_of(keyword.text).value_or(""), location + keyword.word, open_files);
        segments_.push_back({whole_.bytes.size(), file.name(), line_number});
    }
    open_files.pop_back();
}

void AbaqusText::include(std::string_view name, const std::string& place,
                         std::vector<std::filesystem::path>& open_files) {
    const auto refuse = [&](const std::string& message) { throw InputError(place + message); };
    if (name.empty()) refuse(" names no file: write INPUT= and the name of the file to include");
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
