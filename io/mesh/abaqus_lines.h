// The lines of an Abaqus or CalculiX input file: keywords with parameters, and rows of fields.
// Source: Abaqus 6.14 Analysis User's Guide, 1.2.1 "Input syntax rules".
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/scanner.h"

namespace incise::io {

/// *NAME, PARAMETER=VALUE, PARAMETER. All in upper case and without blanks: Abaqus sees no
/// difference.
struct AbaqusKeyword {
    std::string name;  ///< without the asterisk
    std::map<std::string, std::string> parameters;

    std::optional<std::string> parameter(const std::string& wanted) const;
};

/// Text as Abaqus compares it: in upper case, without blanks.
std::string abaqus_word(std::string_view text);

class AbaqusLines {
  public:
    /// The file must outlive the lines.
    explicit AbaqusLines(const InputFile& file) : file_(file), scanner_(file) {}

    /// Goes to the next line that is neither empty nor a comment; false if there is none.
    bool next();
    bool is_keyword() const { return line_.starts_with('*'); }
    /// Whether the line ends with a comma: then what it says may go on on the next one.
    bool goes_on() const { return line_.ends_with(','); }

    /// The keyword of this line and of those on which it goes on. @pre is_keyword()
    AbaqusKeyword keyword();
    /// The fields of this line, without the blanks about them.
    std::vector<std::string_view> fields() const;

    /// The number in a field, from 1 on; `what` it should be is said if it is none.
    std::int64_t number(std::string_view field, std::string_view what) const;
    /// The real in a field, with an exponent as C or Fortran (D) writes it; refused unless finite.
    double real(std::string_view field, std::string_view what) const;

    /// Where messages point: the byte at which the line begins, unless moved elsewhere.
    std::size_t byte() const { return byte_; }
    void point_to(std::size_t byte) { byte_ = byte; }
    std::string location() const;
    [[noreturn]] void fail(const std::string& message) const;

  private:
    const InputFile& file_;
    Scanner scanner_;
    std::string_view line_;
    std::size_t byte_ = 0;
};

}  // namespace incise::io
