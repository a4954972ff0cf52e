// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/usda_tokens.h"

#include <algorithm>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"

namespace incise::io {

namespace {

constexpr std::string_view symbols = "()[]{}=,;";

bool ends_word(char c) {
    constexpr std::string_view others = "\"'@<>#";
    return is_blank(c) || symbols.find(c) != symbols.npos || others.find(c) != others.npos;
}

}  // namespace

UsdaToken UsdaTokens::take() {
    const UsdaToken token = next_;
    advance();
    return token;
}

bool UsdaTokens::accept(char symbol) {
    if (!next_.is(symbol)) return false;
    advance();
    return true;
}

void UsdaTokens::expect(char symbol, std::string_view where) {
    if (!accept(symbol)) fail_expected("'" + std::string(1, symbol) + "' " + std::string(where));
}

void UsdaTokens::skip_value() {
    std::size_t depth = 0;
    do {
        const bool opens = next_.is('(') || next_.is('[') || next_.is('{');
        const bool closes = next_.is(')') || next_.is(']') || next_.is('}');
        if (next_.kind == UsdaToken::Kind::end || (closes && depth == 0)) fail_expected("a value");
        if (opens) ++depth;
        if (closes) --depth;
        advance();
    } while (depth > 0);
}

std::string UsdaTokens::location_of(std::size_t byte) const {
    return file_.name() + ":" + std::to_string(file_.line_of(byte));
}

void UsdaTokens::fail(std::size_t byte, const std::string& message) const {
    throw InputError(location_of(byte) + ": " + message);
}

void UsdaTokens::fail_expected(std::string_view what) const {
    if (next_.kind == UsdaToken::Kind::end)
        fail(next_.byte, "the file ends where " + std::string(what) +
                             " was expected; it is cut short or damaged");
    fail(next_.byte, "expected " + std::string(what) + ", found " + in_quotes(next_.text));
}

std::string_view UsdaTokens::up_to(std::string_view mark, std::size_t begin, const char* what) {
    const bool has_escapes = mark[0] == '"' || mark[0] == '\'';
    auto at = position_;
    while (at < bytes_.size() && !bytes_.substr(at).starts_with(mark)) {
        if (mark.size() == 1 && bytes_[at] == '\n') at = bytes_.size();
        at += has_escapes && at < bytes_.size() && bytes_[at] == '\\' ? 2 : 1;
    }
    if (at >= bytes_.size())
        fail(begin, std::string(what) + " has no end; the file is cut short or damaged");
    const auto text = bytes_.substr(position_, at - position_);
    position_ = at + mark.size();
    return text;
}

void UsdaTokens::advance() {
    using enum UsdaToken::Kind;
    bool begins_line = position_ == 0;
    while (position_ < bytes_.size() && (is_blank(bytes_[position_]) || bytes_[position_] == '#')) {
        if (bytes_[position_] == '#')
            position_ = std::min(bytes_.find('\n', position_), bytes_.size());
        else
            begins_line = bytes_[position_++] == '\n' || begins_line;
    }
    const auto begin = position_;
    next_ = {end, {}, begin, begins_line};
    if (position_ == bytes_.size()) return;
    const char c = bytes_[position_];
    const auto rest = bytes_.substr(position_);
    const std::string three(3, c);
    const bool is_triple = rest.starts_with(three);
    if (c == '"' || c == '\'' || c == '@') {
        position_ += is_triple ? 3 : 1;
        next_.kind = c == '@' ? asset : string;
        next_.text = up_to(is_triple ? three : three.substr(0, 1), begin,
                           c == '@' ? "the name of a file" : "a text in quotes");
    } else if (c == '<') {
        ++position_;
        next_.kind = path;
        next_.text = up_to(">", begin, "a path");
    } else if (symbols.find(c) != symbols.npos || c == '>') {
        ++position_;
        next_.kind = symbol;
        next_.text = rest.substr(0, 1);
    } else {
        while (position_ < bytes_.size() && !ends_word(bytes_[position_])) ++position_;
        next_.kind = word;
        next_.text = bytes_.substr(begin, position_ - begin);
    }
}

}  // namespace incise::io
