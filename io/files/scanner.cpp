// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/scanner.h"

#include <algorithm>
#include <cmath>

#include "incise/base/error.h"

namespace incise::io {

void Scanner::skip_blanks() {
    bool may_comment =
        comments_ == Comments::before_any_word || position_ == 0 || bytes_[position_ - 1] == '\n';
    while (position_ < bytes_.size()) {
        const char c = bytes_[position_];
        if (is_blank(c)) {
            may_comment = may_comment || c == '\n';
            ++position_;
        } else if (c == '#' && may_comment) {
            position_ = std::min(bytes_.find('\n', position_), bytes_.size());
        } else {
            return;
        }
    }
}

bool Scanner::at_end() {
    skip_blanks();
    return remaining() == 0;
}

std::string_view Scanner::token(std::string_view what) {
    skip_blanks();
    item_begin_ = position_;
    while (position_ < bytes_.size() && !is_blank(bytes_[position_])) ++position_;
    if (position_ == item_begin_)
        fail("the file ends where " + std::string(what) + " was expected; it is cut short");
    return bytes_.substr(item_begin_, position_ - item_begin_);
}

bool Scanner::accept(std::string_view word) {
    const auto position = position_;
    const auto item_begin = item_begin_;
    if (!at_end() && lower_case(token(word)) == lower_case(word)) return true;
    position_ = position;
    item_begin_ = item_begin;
    return false;
}

bool Scanner::skip_number() {
    const auto position = position_;
    const auto item_begin = item_begin_;
    if (!at_end() && parse_number<double>(token("a number"))) return true;
    position_ = position;
    item_begin_ = item_begin;
    return false;
}

std::string_view Scanner::rest_of_line() {
    item_begin_ = position_;
    const auto end = std::min(bytes_.find('\n', position_), bytes_.size());
    auto line = bytes_.substr(position_, end - position_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    position_ = std::min(end + 1, bytes_.size());
    return line;
}

bool Scanner::skip_past(std::string_view mark) {
    const auto found = bytes_.find(mark, position_);
    position_ = found == bytes_.npos ? bytes_.size() : found + mark.size();
    return found != bytes_.npos;
}

bool Scanner::skip_past_line(std::string_view mark) {
    const auto item_begin = item_begin_;
    bool is_found = false;
    while (!is_found && remaining() > 0) {
        const auto line = trimmed(rest_of_line());
        is_found =
            line.starts_with(mark) && (line.size() == mark.size() || is_blank(line[mark.size()]));
    }
    item_begin_ = item_begin;
    return is_found;
}

std::string_view Scanner::take(std::size_t count, std::string_view what) {
    item_begin_ = position_;
    if (count > remaining())
        fail("the file ends within " + std::string(what) + ": " + std::to_string(count) +
             " bytes were expected, " + std::to_string(remaining()) + " are left; it is cut short");
    position_ += count;
    return bytes_.substr(item_begin_, count);
}

double Scanner::coordinate(std::string_view what) {
    const auto result = value<double>(what);
    if (!std::isfinite(result))
        fail(std::string(what) + " is " + shown(result) + "; it must be finite");
    return result;
}

std::size_t Scanner::count(std::string_view what, std::size_t bytes_each) {
    const auto result = number<std::uint64_t>(what);
    require_room(result, bytes_each, what);
    return static_cast<std::size_t>(result);
}

void Scanner::require_room(std::uint64_t count, std::size_t bytes_each,
                           std::string_view what) const {
    // Plus 1, since the last number of a text needs no blank after it.
    if (count > (remaining() + 1) / bytes_each)
        fail(std::string(what) + " is " + std::to_string(count) +
             ", more than can be in the remaining " + std::to_string(remaining()) +
             " bytes; the file is cut short or damaged");
}

std::string Scanner::location() const {
    const auto name = file_.name() + (is_binary_ ? ": byte " : ":");
    return name + std::to_string(is_binary_ ? item_begin_ : file_.line_of(item_begin_));
}

void Scanner::fail(const std::string& message) const {
    throw InputError(location() + ": " + message);
}

void Scanner::fail_expected(std::string_view what, std::string_view found,
                            const std::string& remark) const {
    fail("expected " + std::string(what) + ", found " + in_quotes(found) + remark);
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

}  // namespace incise::io
