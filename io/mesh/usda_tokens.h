// The tokens of a text file of USD.
// Source: OpenUSD, "USD file format: text (.usda)", grammar of version 1.0.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "incise/io/files/input_file.h"

namespace incise::io {

/// A token of a text file of USD.
struct UsdaToken {
    enum class Kind : std::uint8_t {
        word,    ///< a name, a keyword or a number
        string,  ///< in quotes; `text` is without them
        asset,   ///< the name of another file between @ signs
        path,    ///< of a prim or property, between < and >
        symbol,  ///< one of ( ) [ ] { } = , ;
        end
    };
    Kind kind = Kind::end;
    std::string_view text;
    std::size_t byte = 0;      ///< of its beginning
    bool begins_line = false;  ///< true if it is the first token of its line

    bool is(char symbol) const { return kind == Kind::symbol && text[0] == symbol; }
    bool is_word(std::string_view word) const { return kind == Kind::word && text == word; }
};

/// A position among the tokens of a file. Comments, from # to the end of the line, are skipped.
class UsdaTokens {
  public:
    /// Throws InputError as take() does.
    /// @lifetime  the file must outlive the tokens
    explicit UsdaTokens(const InputFile& file) : file_(file), bytes_(file.bytes) { advance(); }

    const UsdaToken& next() const { return next_; }
    /// Returns the next token and goes on to the one after it. Throws InputError for a string, an
    /// asset or a path without end.
    UsdaToken take();
    /// Goes on if the next token is this symbol. Returns whether it is.
    bool accept(char symbol);
    /// Goes past this symbol. Throws InputError if the next token is another one.
    void expect(char symbol, std::string_view where);
    /// Goes past a value: one token, or all tokens between brackets.
    void skip_value();

    std::string location_of(std::size_t byte) const;
    /// Throws InputError with the line of a byte and the message.
    [[noreturn]] void fail(std::size_t byte, const std::string& message) const;
    /// Throws InputError: `what` was expected, and the next token is another one.
    [[noreturn]] void fail_expected(std::string_view what) const;

  private:
    void advance();
    /// Reads up to the mark, which ends a token that began at `begin`. A short mark must be on the
    /// same line.
    std::string_view up_to(std::string_view mark, std::size_t begin, const char* what);

    const InputFile& file_;
    std::string_view bytes_;
    std::size_t position_ = 0;
    UsdaToken next_;
};

}  // namespace incise::io
