// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/document.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/scenario/diagnostics.h"

namespace incise::scenario {

namespace {

constexpr std::size_t max_file_size = 16u << 20;  // larger files are meshes, given by mistake

/// The largest number of parts of a dotted key. Each part makes a nested table, and too many nested
/// tables would overflow the stack. The TOML library limits the nesting of explicit tables to 256,
/// but not that of dotted keys.
constexpr std::size_t max_key_parts = 16;

/// Returns the position after the quoted text that begins at `i`. Quoted text ends at the end of
/// the line, unless it is multi-line text.
std::size_t end_of_quoted(std::string_view text, std::size_t i) {
    const char quote = text[i];
    const std::string triple(3, quote);
    if (text.substr(i, 3) == triple) {
        for (i += 3; i < text.size() && text.substr(i, 3) != triple; ++i)
            if (quote == '"' && text[i] == '\\') ++i;
        return std::min(i + 3, text.size());
    }
    for (++i; i < text.size() && text[i] != quote && text[i] != '\n'; ++i)
        if (quote == '"' && text[i] == '\\') ++i;
    return std::min(i + (i < text.size() && text[i] == quote ? 1 : 0), text.size());
}

/// Throws DocumentError for a key of more than max_key_parts parts. The location is the override,
/// or the line if `override_number` is -1.
void require_flat_keys(std::string_view text, int override_number) {
    constexpr std::string_view parts_of_keys =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_- \t";
    int line = 1;
    std::size_t num_dots = 0;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] == '"' || text[i] == '\'') {
            const std::size_t end = end_of_quoted(text, i);
            line +=
                static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                            text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            i = end;
            continue;
        }
        if (text[i] == '#') {
            i = std::min(text.find('\n', i), text.size());
            continue;
        }
        if (text[i] == '\n') ++line;
        if (text[i] == '.')
            ++num_dots;
        else if (parts_of_keys.find(text[i]) == parts_of_keys.npos)
            num_dots = 0;
        if (num_dots >= max_key_parts)
            throw DocumentError{{override_number < 0 ? line : 0, 1, override_number},
                                "a key of more than " + std::to_string(max_key_parts) +
                                    " parts; no key of a scenario has more than six"};
        ++i;
    }
}

SourceLocation location_of(const toml::source_region& region, int override_number) {
    if (override_number >= 0) return {0, 0, override_number};
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), -1};
}

Value convert(const toml::node& node, int override_number) {
    Value value;
    value.location = location_of(node.source(), override_number);
    if (const auto* table = node.as_table()) {
        Table entries;
        for (const auto& [key, child] : *table)
            entries.push_back({std::string(key.str()), location_of(key.source(), override_number),
                               convert(child, override_number)});
        std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return std::pair(a.location.line, a.location.column) <
                   std::pair(b.location.line, b.location.column);
        });
        value.data = std::move(entries);
    } else if (const auto* array = node.as_array()) {
        Array elements;
        for (const auto& child : *array) elements.push_back(convert(child, override_number));
        value.data = std::move(elements);
    } else if (const auto* text = node.as_string()) {
        value.data = text->get();
    } else if (const auto* integer = node.as_integer()) {
        value.data = integer->get();
    } else if (const auto* real = node.as_floating_point()) {
        value.data = real->get();
    } else if (const auto* flag = node.as_boolean()) {
        value.data = flag->get();
    } else {
        value.data = DateOrTime{};
    }
    return value;
}

/// A step in the path of an override: a key, or the index of an array element.
struct Step {
    std::string key;
    std::optional<std::size_t> index;
};

std::optional<std::size_t> as_index(std::string_view text) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (text.empty() || error != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return index;
}

/// Splits a path at dots and brackets: "material[0].young" and "material.0.young" are equivalent.
std::vector<Step> split_path(std::string_view path, const SourceLocation& location) {
    const auto malformed = [&] {
        return DocumentError{location, in_quotes(path) +
                                           " is not a path: write it like dynamics.end_time or "
                                           "material[0].young"};
    };
    std::vector<Step> steps;
    std::size_t begin = 0;
    while (begin <= path.size()) {
        const auto end = std::min(path.find('.', begin), path.size());
        std::string_view part = path.substr(begin, end - begin);
        const auto bracket = std::min(part.find_first_of("[]"), part.size());
        const auto key = part.substr(0, bracket);
        if (key.empty()) throw malformed();
        steps.push_back({std::string(key), as_index(key)});
        for (part.remove_prefix(bracket); !part.empty();) {
            const auto close = part.find(']');
            if (part.front() != '[' || close == part.npos) throw malformed();
            const auto index = as_index(part.substr(1, close - 1));
            if (!index) throw malformed();
            steps.push_back({{}, index});
            part.remove_prefix(close + 1);
        }
        begin = end + 1;
    }
    return steps;
}

/// Returns the message that a key is missing, and with it the array element `index`.
std::string why_no_element(const Table& table, const std::string& key, std::size_t index,
                           const std::string& path) {
    std::vector<std::string_view> keys;
    for (const Entry& entry : table) keys.push_back(entry.key);
    const std::string_view meant = nearest(key, keys);
    std::string text = in_quotes(path.empty() ? key : path + "." + key) +
                       " is not there, so it has no [" + std::to_string(index) + "]";
    if (is_misspelt(key, meant)) text += "; did you mean " + in_quotes(meant) + "?";
    return text;
}

/// Returns the value to which `step` leads. A missing key is added to its table, unless the next
/// step is the index of an array element. `next` is null for the last step.
Value& descend(Value& value, const Step& step, const Step* next, const std::string& path,
               const SourceLocation& location) {
    if (auto* array = std::get_if<Array>(&value.data)) {
        if (!step.index)
            throw DocumentError{location, in_quotes(path) +
                                              " is an array: go on with the number of an "
                                              "element, as in " +
                                              path + "[0]"};
        if (*step.index >= array->size())
            throw DocumentError{location, in_quotes(path) + " has no element " +
                                              std::to_string(*step.index) + ": it has " +
                                              std::to_string(array->size()) +
                                              (array->empty() ? "" : ", numbered from 0")};
        return (*array)[*step.index];
    }
    auto* table = std::get_if<Table>(&value.data);
    if (table == nullptr)
        throw DocumentError{location, in_quotes(path) + " is " + value.description() +
                                          ": there is nothing below it"};
    if (step.key.empty())
        throw DocumentError{location, in_quotes(path) +
                                          " is a table, not an array: it has keys, no [" +
                                          std::to_string(*step.index) + "]"};
    for (auto& entry : *table)
        if (entry.key == step.key) return entry.value;
    if (next && next->key.empty())
        throw DocumentError{location, why_no_element(*table, step.key, *next->index, path)};
    return table->emplace_back(Entry{step.key, location, Value{Table{}, location}}).value;
}

Value parse_override_value(std::string_view text, int number) {
    const SourceLocation location{0, 0, number};
    const bool is_one_line = text.find_first_of("\r\n") == text.npos;
    try {
        const auto parsed = toml::parse("value = " + std::string(text));
        if (is_one_line && parsed.size() == 1) return convert(*parsed.get("value"), number);
    } catch (const toml::parse_error&) {
        if (is_one_line && !text.empty() && text.find_first_of("[]{}\"'=,#") == text.npos)
            return {std::string(text), location};
    }
    throw DocumentError{location, "the value " + in_quotes(text) +
                                      " is no TOML value: write it as in the file, such as 0.5, "
                                      "[0, 0, -9.81] or \"text\""};
}

/// The hash FNV-1a with 64 bits.
struct Hash {
    std::uint64_t state = 14695981039346656037u;

    void add(std::string_view bytes) {
        for (const char c : bytes) {
            state ^= static_cast<unsigned char>(c);
            state *= 1099511628211u;
        }
    }
};

/// Adds a value to the hash. Each value has its length or an end mark, so that different contents
/// give different bytes.
void add_value(Hash& hash, const Value& value) {
    if (const auto* table = value.get<Table>()) {
        std::vector<const Entry*> sorted;
        for (const auto& entry : *table) sorted.push_back(&entry);
        std::sort(sorted.begin(), sorted.end(),
                  [](const Entry* a, const Entry* b) { return a->key < b->key; });
        hash.add("{");
        for (const Entry* entry : sorted) {
            hash.add(std::to_string(entry->key.size()) + ":" + entry->key);
            add_value(hash, entry->value);
        }
        hash.add("}");
    } else if (const auto* array = value.get<Array>()) {
        hash.add("[");
        for (const auto& element : *array) add_value(hash, element);
        hash.add("]");
    } else if (const auto* text = value.get<std::string>()) {
        hash.add("t" + std::to_string(text->size()) + ":" + *text);
    } else if (const auto* integer = value.get<std::int64_t>()) {
        hash.add("n" + format_number(static_cast<double>(*integer)) + ";");
    } else if (const auto* real = value.get<double>()) {
        hash.add("n" + format_number(*real) + ";");
    } else if (const auto* flag = value.get<bool>()) {
        hash.add(*flag ? "yes;" : "no;");
    }
}

std::string text_of(const Value& value) {
    if (const auto* text = value.get<std::string>()) return '"' + *text + '"';
    if (const auto* integer = value.get<std::int64_t>())
        return format_number(static_cast<double>(*integer));
    if (const auto* real = value.get<double>()) return format_number(*real);
    if (const auto* flag = value.get<bool>()) return *flag ? "true" : "false";
    if (value.get<DateOrTime>()) return value.description();
    if (value.get<Table>()) return "{}";
    std::string list;
    for (const Value& element : *value.get<Array>())
        list += (list.empty() ? "" : ", ") + text_of(element);
    return '[' + list + ']';
}

void append_contents(const Value& value, const std::string& path,
                     std::vector<std::pair<std::string, std::string>>& contents) {
    const auto* table = value.get<Table>();
    const auto* array = value.get<Array>();
    const bool holds_more = array && std::any_of(array->begin(), array->end(), [](const Value& v) {
                                return v.get<Table>() || v.get<Array>();
                            });
    if (table && !table->empty()) {
        for (const Entry& entry : *table)
            append_contents(entry.value, path.empty() ? entry.key : path + "." + entry.key,
                            contents);
    } else if (holds_more) {
        for (std::size_t i = 0; i < array->size(); ++i)
            append_contents((*array)[i], path + "[" + std::to_string(i) + "]", contents);
    } else {
        contents.emplace_back(path, text_of(value));
    }
}

}  // namespace

std::string Value::description() const {
    if (const auto* text = get<std::string>()) return "the text \"" + *text + "\"";
    if (const auto* integer = get<std::int64_t>()) return "the number " + std::to_string(*integer);
    if (const auto* real = get<double>()) return "the number " + format_number(*real);
    if (const auto* flag = get<bool>()) return *flag ? "true" : "false";
    if (const auto* array = get<Array>()) return "an array of " + std::to_string(array->size());
    return get<Table>() != nullptr ? "a table" : "a date or time";
}

const Value* find(const Table& table, std::string_view key) {
    for (const auto& entry : table)
        if (entry.key == key) return &entry.value;
    return nullptr;
}

namespace {

struct Explanation {
    std::string_view of_library, in_words;
};

/// What the library says of a fault of syntax, and what it means for who has written the file. The
/// first that fits counts.
constexpr Explanation explanations[] = {
    {"parsing string: unescaped control", "the text has no closing quote on its line"},
    {"parsing string: encountered end-of-file", "the text has no closing quote"},
    {"redefine", "the name is there twice: of several tools or materials, each begins with [[ ]]"},
    {"unicode scalar", "a backslash in a text begins a special character: write paths with /"},
    {"escape", "a backslash in a text begins a special character: write paths with /"},
    {"could not determine value type", "that is no value: a text needs quotes, as in \"xyz\""},
    {"parsing boolean", "that is no value: a text needs quotes; else true or false, in full"},
    {"parsing floating-point: expected value-terminator",
     "that is no value: a text needs quotes, and a number ends before what follows it"},
    {"parsing array", "the values of a list need commas between them, and a ] at the end"},
    {"parsing inline table",
     "entries in { } are of the form key = value, with commas between them"},
    {"expected a comment or whitespace",
     "something follows the value: a number has a point, not a comma, and each key its own line"},
    {"expected '='", "a key needs an equals sign and a value, as in end_time = 1"},
    {"table header", "a section needs both brackets, as in [mesh] and [[tool]]"},
    {"expected decimal digit", "a number has digits before and after its point, as in 0.5"},
};

std::string in_words(std::string_view description) {
    for (const auto& [of_library, words] : explanations)
        if (description.find(of_library) != description.npos)
            return std::string(words) + " (" + std::string(description) + ")";
    return std::string(description);
}

}  // namespace

Value read_document(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
        throw InputError(file.string() + ": there is no such file");
    if (std::filesystem::is_directory(status))
        throw InputError(file.string() + ": is a folder, not a scenario file");
    const std::string remedy = " (at most 16 MiB); name the scenario, not a mesh";
    if (const auto size = std::filesystem::file_size(file, error); !error && size > max_file_size)
        throw InputError(file.string() + ": is " + std::to_string(size >> 20) +
                         " MiB long, too long for a scenario" + remedy);
    std::ifstream stream(file, std::ios::binary);
    std::string text;
    std::array<char, 65536> block;
    do {  // pipes and devices have no size to check before
        stream.read(block.data(), block.size());
        text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    } while (stream && text.size() <= max_file_size);
    if (!stream.is_open() || stream.bad())
        throw InputError(file.string() + ": cannot be read; check its permissions");
    if (text.size() > max_file_size)
        throw InputError(file.string() + ": is too long for a scenario" + remedy);
    if (io::begins_like_a_mesh(text))
        throw InputError(file.string() +
                         ": is a mesh, not a scenario; a scenario is a text file that names its "
                         "mesh: [mesh] file = \"" +
                         file.filename().string() + "\"");
    if (text.find('\0') != text.npos)
        throw InputError(file.string() +
                         ": is no text, and a scenario is a text file; `incise info` tells what a "
                         "mesh or a surface is");
    require_flat_keys(text, -1);
    try {
        return convert(toml::parse(text), -1);
    } catch (const toml::parse_error& failure) {
        throw DocumentError{location_of(failure.source(), -1), in_words(failure.description())};
    }
}

void apply_override(Value& document, std::string_view text, int number) {
    const SourceLocation location{0, 0, number};
    const auto equals = text.find('=');
    if (equals == text.npos)
        throw DocumentError{location, "an override has the form key.path=value"};
    const auto trimmed = [](std::string_view part) {
        while (part.starts_with(' ')) part.remove_prefix(1);
        while (part.ends_with(' ')) part.remove_suffix(1);
        return part;
    };
    require_flat_keys(text, number);
    Value changed = document;
    Value* target = &changed;
    std::string path;
    const auto steps = split_path(trimmed(text.substr(0, equals)), location);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Step& step = steps[i];
        const Step* next = i + 1 < steps.size() ? &steps[i + 1] : nullptr;
        const bool is_element = target->get<Array>() != nullptr || step.key.empty();
        target = &descend(*target, step, next, path, location);
        if (is_element) {
            path.append("[").append(std::to_string(*step.index)).append("]");
        } else {
            if (!path.empty()) path += '.';
            path += step.key;
        }
    }
    *target = parse_override_value(trimmed(text.substr(equals + 1)), number);
    document = std::move(changed);
}

std::string content_hash(const Value& value) {
    Hash hash;
    add_value(hash, value);
    std::array<char, 17> digits{};
    constexpr std::string_view hexadecimal = "0123456789abcdef";
    for (std::size_t i = 0; i < 16; ++i)
        digits[i] = hexadecimal[(hash.state >> (60 - 4 * i)) & 15u];
    return digits.data();
}

std::vector<std::pair<std::string, std::string>> contents_of(const Value& value) {
    std::vector<std::pair<std::string, std::string>> contents;
    append_contents(value, "", contents);
    std::sort(contents.begin(), contents.end());
    return contents;
}

}  // namespace incise::scenario
