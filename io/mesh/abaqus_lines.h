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
#include "incise/io/mesh/abaqus_includes.h"

namespace incise::io {

/// A keyword line: *NAME, PARAMETER=VALUE, PARAMETER. All texts are in upper case and without
/// blanks, since Abaqus ignores case and blanks.
struct AbaqusKeyword {
    std::string name;  ///< without the asterisk
    std::map<std::string, std::string> parameters;

    std::optional<std::string> parameter(const std::string& wanted) const;
};

/// Returns the text as Abaqus compares it: in upper case, without blanks.
std::string abaqus_word(std::string_view text);

/// A position in a deck, with the files that it includes, that moves line by line.
class AbaqusLines {
  public:
    /// Reads the included files. Throws InputError as AbaqusText does.
    /// @lifetime  the file must outlive the lines
    explicit AbaqusLines(const InputFile& file) : text_(file), scanner_(text_.whole()) {}

    /// Goes to the next line that is neither empty nor a comment. Returns false if there is none.
    bool next();
    bool is_keyword() const { return line_.starts_with('*'); }
    /// True if the line ends with a comma. A row or a keyword may then continue on the next line.
    bool goes_on() const { return line_.ends_with(','); }

    /// Reads the keyword of this line and of the lines that continue it.
    /// @pre  is_keyword()
    AbaqusKeyword keyword();
    /// Returns the fields of this line, without the blanks around them.
    std::vector<std::string_view> fields() const;

    /// Returns the number in a field, 1 or more. Throws InputError if the field has none; `what`
    /// names the expected number in the message.
    std::int64_t number(std::string_view field, std::string_view what) const;
    /// Returns the real in a field. Its exponent may be that of C (e) or of Fortran (D). Throws
    /// InputError as number() does, and for a real that is not finite.
    double real(std::string_view field, std::string_view what) const;

    /// Returns the byte of the text whose line location() names: the beginning of this line, or the
    /// byte of the last point_to().
    std::size_t byte() const { return byte_; }
    void point_to(std::size_t byte) { byte_ = byte; }
    std::string location() const;
    /// Throws InputError with location() and the message.
    [[noreturn]] void fail(const std::string& message) const;

  private:
    AbaqusText text_;
    Scanner scanner_;
    std::string_view line_;
    std::size_t byte_ = 0;
};

}  // namespace incise::io
