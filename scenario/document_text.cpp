// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/document_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "incise/base/number_format.h"

namespace incise::scenario {

namespace {

/// The keys whose texts name files, wherever they are.
constexpr std::array<std::string_view, 2> file_keys = {"file", "surface"};

std::string text_quoted(std::string_view text) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (code < 0x20 || code == 0x7f) {
            out += "\\u00";
            out += digits[code >> 4];
            out += digits[code & 15u];
        } else {
            out += c;
        }
    }
    return out + '"';
}

std::string key_text(std::string_view key) {
    const bool is_bare = !key.empty() && std::ranges::all_of(key, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    });
    return is_bare ? std::string(key) : text_quoted(key);
}

std::string number_text(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
    std::string text = format_number(value);
    // A whole number has a point, so that it stays a real one.
    if (text.find_first_of(".e") == text.npos) text += ".0";
    return text;
}

std::string inline_text(const Value& value) {
    if (const auto* text = value.get<std::string>()) return text_quoted(*text);
    if (const auto* integer = value.get<std::int64_t>()) return std::to_string(*integer);
    if (const auto* real = value.get<double>()) return number_text(*real);
    if (const auto* flag = value.get<bool>()) return *flag ? "true" : "false";
    std::string list;
    if (const auto* table = value.get<Table>()) {
        for (const Entry& entry : *table)
            list += (list.empty() ? " " : ", ") + key_text(entry.key) + " = " +
                    inline_text(entry.value);
        return list.empty() ? "{}" : "{" + list + " }";
    }
    if (const auto* array = value.get<Array>())
        for (const Value& element : *array)
            list += (list.empty() ? "" : ", ") + inline_text(element);
    return "[" + list + "]";
}

void append_entries(const Table& table, std::string& text) {
    for (const Entry& entry : table)
        text += key_text(entry.key) + " = " + inline_text(entry.value) + "\n";
}

/// True for an array that is written as sections of the same name.
bool is_list_of_sections(const Value& value) {
    const auto* array = value.get<Array>();
    return array && !array->empty() && std::ranges::all_of(*array, [](const Value& element) {
               return element.get<Table>() != nullptr;
           });
}

/// Makes the name of a file absolute. An empty name, which the reader refuses, stays empty; so does
/// a relative one if the current folder is gone.
void make_absolute(std::string& name, const std::filesystem::path& folder) {
    if (name.empty()) return;
    std::error_code error;
    const auto path = std::filesystem::absolute(folder / name, error);
    if (!error) name = path.lexically_normal().string();
}

}  // namespace

std::string toml_text(const Value& document) {
    const Table& root = *document.get<Table>();
    std::string text;
    for (const Entry& entry : root)
        if (!entry.value.get<Table>() && !is_list_of_sections(entry.value))
            text += key_text(entry.key) + " = " + inline_text(entry.value) + "\n";
    for (const Entry& entry : root) {
        if (const auto* table = entry.value.get<Table>()) {
            text += "\n[" + key_text(entry.key) + "]\n";
            append_entries(*table, text);
        } else if (is_list_of_sections(entry.value)) {
            for (const Value& element : *entry.value.get<Array>()) {
                text += "\n[[" + key_text(entry.key) + "]]\n";
                append_entries(*element.get<Table>(), text);
            }
        }
    }
    return text;
}

void make_files_absolute(Value& document, const std::filesystem::path& folder) {
    if (auto* array = std::get_if<Array>(&document.data)) {
        for (Value& element : *array) make_files_absolute(element, folder);
    } else if (auto* table = std::get_if<Table>(&document.data)) {
        for (Entry& entry : *table) {
            auto* name = std::get_if<std::string>(&entry.value.data);
            if (name && std::ranges::find(file_keys, entry.key) != file_keys.end())
                make_absolute(*name, folder);
            else
                make_files_absolute(entry.value, folder);
        }
    }
}

}  // namespace incise::scenario
