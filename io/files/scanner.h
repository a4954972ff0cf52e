// A scanner of files of words and numbers, as text or binary. Checks every read against the end of
// the file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/scalar_type.h"

namespace incise::io {

/// Where a # begins a comment. A comment ends at the end of the line.
enum class Comments : std::uint8_t { on_lines_of_their_own, before_any_word };

/// A position in a file, with functions that read the next item. token(), take() and the functions
/// that read numbers throw InputError, as fail() does, if the item is missing or has another form.
class Scanner {
  public:
    /// @lifetime  the file must outlive the scanner
    explicit Scanner(const InputFile& file, Comments comments = Comments::on_lines_of_their_own)
        : file_(file), bytes_(file.bytes), comments_(comments) {}

    /// Sets whether value() reads binary numbers, and whether it swaps their bytes. In a binary
    /// file, messages name the byte instead of the line.
    void set_binary(bool is_binary, bool swap_bytes = false) {
        is_binary_ = is_binary;
        swap_bytes_ = swap_bytes;
    }
    bool is_binary() const { return is_binary_; }
    bool swaps_bytes() const { return swap_bytes_; }

    std::size_t remaining() const { return bytes_.size() - position_; }
    /// Skips white space and comments. Returns true if nothing follows.
    bool at_end();

    /// Reads the next word. Here and below, `what` names the expected item in error messages.
    std::string_view token(std::string_view what);
    /// Reads the next word if it is `word`, in upper or lower case. Else does not move.
    bool accept(std::string_view word);
    /// Reads the next word if it is a number. Else does not move.
    bool skip_number();
    /// Reads the rest of this line, without its end, and goes to the next line.
    std::string_view rest_of_line();
    /// Goes to the end of the next `mark`. If there is none, goes to the end of the file and
    /// returns false.
    bool skip_past(std::string_view mark);
    /// Goes to the end of the next line whose first word is `mark`. If there is none, goes to the
    /// end of the file and returns false.
    bool skip_past_line(std::string_view mark);
    /// Reads the next `count` bytes.
    std::string_view take(std::size_t count, std::string_view what);

    /// Reads the next number, as text or binary; see set_binary().
    template <class T>
    T value(std::string_view what) {
        if (is_binary_) return load_scalar<T>(take(sizeof(T), what).data(), swap_bytes_);
        return number<T>(what);
    }
    /// Reads the next number as text, also in a binary file.
    template <class T>
    T number(std::string_view what) {
        const auto text = token(what);
        const auto parsed = parse_number<T>(text);
        if (!parsed) fail_expected(what, text, range_remark<T>(text));
        return *parsed;
    }
    /// Reads the next number as value() does. Throws InputError also if it is not finite.
    double coordinate(std::string_view what);
    /// Reads the next number as text: the count of items that follow, of at least `bytes_each`
    /// bytes each. Throws InputError also if so many do not fit in the rest of the file.
    std::size_t count(std::string_view what, std::size_t bytes_each);
    /// Throws InputError if `count` items of at least `bytes_each` bytes do not fit in the rest of
    /// the file.
    void require_room(std::uint64_t count, std::size_t bytes_each, std::string_view what) const;

    /// Returns the name of the file, with the line or byte of the last item that was read.
    std::string location() const;
    /// Throws InputError with location() and the message.
    [[noreturn]] void fail(const std::string& message) const;
    /// Throws InputError: `what` was expected and `found` was found. `remark` is added to the end.
    [[noreturn]] void fail_expected(std::string_view what, std::string_view found,
                                    const std::string& remark = {}) const;

  private:
    void skip_blanks();

    const InputFile& file_;
    std::string_view bytes_;
    Comments comments_;
    std::size_t position_ = 0;
    std::size_t item_begin_ = 0;
    bool is_binary_ = false;
    bool swap_bytes_ = false;
};

/// Returns the text in lower case (ASCII letters only).
std::string lower_case(std::string_view text);

/// Returns the text without blanks at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace incise::io
