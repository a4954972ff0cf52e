// Walks through a file of words and numbers, as text or binary.
// Every step is checked against the end of the file.
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

/// Where a # begins a comment, which goes to the end of the line.
enum class Comments : std::uint8_t { on_lines_of_their_own, before_any_word };

class Scanner {
  public:
    /// The file must outlive the scanner.
    explicit Scanner(const InputFile& file, Comments comments = Comments::on_lines_of_their_own)
        : file_(file), bytes_(file.bytes), comments_(comments) {}

    /// Whether value() reads binary numbers, and whether their bytes are to be swapped.
    /// Messages then name bytes in place of lines.
    void set_binary(bool is_binary, bool swap_bytes = false) {
        is_binary_ = is_binary;
        swap_bytes_ = swap_bytes;
    }
    bool is_binary() const { return is_binary_; }
    bool swaps_bytes() const { return swap_bytes_; }

    std::size_t remaining() const { return bytes_.size() - position_; }
    /// Skips white space and comments; true if nothing follows.
    bool at_end();

    /// The next word. `what` says, in the message if there is none, what it should have been.
    std::string_view token(std::string_view what);
    /// Takes the next word if it is `word`, in upper or lower case, else stays.
    bool accept(std::string_view word);
    /// Takes the next word if it is a number, else stays.
    bool skip_number();
    /// What is left of this line, without its end; goes on to the next line.
    std::string_view rest_of_line();
    /// Goes to just behind the next `mark`; false, and to the end, if there is none.
    bool skip_past(std::string_view mark);
    /// Goes to behind the next line whose first word is `mark`; false, and to the end, if there is
    /// none.
    bool skip_past_line(std::string_view mark);
    /// The next `count` bytes.
    std::string_view take(std::size_t count, std::string_view what);

    /// The next number, as text or binary as the file has it.
    template <class T>
    T value(std::string_view what) {
        if (is_binary_) return load_scalar<T>(take(sizeof(T), what).data(), swap_bytes_);
        return number<T>(what);
    }
    /// The next number as text, also in a binary file.
    template <class T>
    T number(std::string_view what) {
        const auto text = token(what);
        const auto parsed = parse_number<T>(text);
        if (!parsed) fail_expected(what, text, range_remark<T>(text));
        return *parsed;
    }
    /// The next number, refused if it is not finite.
    double coordinate(std::string_view what);
    /// The next number as text, which must be a count of things of at least `bytes_each` bytes
    /// that follow: a count that cannot fit in the rest of the file is refused.
    std::size_t count(std::string_view what, std::size_t bytes_each);
    /// Refuses a count of things of at least `bytes_each` bytes that the file has no room for.
    void require_room(std::uint64_t count, std::size_t bytes_each, std::string_view what) const;

    /// The file and the line or byte of the last item read.
    std::string location() const;
    /// Throws InputError with that place.
    [[noreturn]] void fail(const std::string& message) const;
    /// @param remark  about what was found
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

/// In lower case (ASCII letters only).
std::string lower_case(std::string_view text);

/// The text without blanks at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace incise::io
