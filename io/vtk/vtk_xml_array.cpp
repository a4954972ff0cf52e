// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/vtk_xml_array.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/files/base64.h"
#include "incise/io/files/number_text.h"

namespace incise::io {

namespace {

std::optional<ScalarType> scalar_type_of(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, ScalarType>, 10> names = {
        {{"Int8", ScalarType::int8},
         {"UInt8", ScalarType::uint8},
         {"Int16", ScalarType::int16},
         {"UInt16", ScalarType::uint16},
         {"Int32", ScalarType::int32},
         {"UInt32", ScalarType::uint32},
         {"Int64", ScalarType::int64},
         {"UInt64", ScalarType::uint64},
         {"Float32", ScalarType::float32},
         {"Float64", ScalarType::float64}}};
    for (const auto& [known, type] : names)
        if (name == known) return type;
    return std::nullopt;
}

/// Returns the text of an element, which comments and child elements may divide into parts.
std::string text_of(pugi::xml_node element) {
    std::string text;
    for (const auto child : element.children())
        if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
            text.append(child.value()).append(1, ' ');
    return text;
}

std::string_view next_word(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && is_blank(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const auto word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

/// Returns an upper bound on the number of bytes that the text encodes.
std::size_t capacity(std::string_view text, bool is_raw) {
    return is_raw ? text.size() : text.size() / 4 * 3 + 3;
}

}  // namespace

std::vector<double> VtkXmlArrays::reals(pugi::xml_node array, std::size_t count) const {
    return values<double>(array, count);
}

std::vector<std::int64_t> VtkXmlArrays::integers(pugi::xml_node array, std::size_t count) const {
    return values<std::int64_t>(array, count);
}

std::size_t VtkXmlArrays::count_attribute(pugi::xml_node element, const char* name) const {
    const auto attribute = element.attribute(name);
    const auto count = parse_number<std::int64_t>(attribute.value());
    constexpr std::int64_t highest = std::numeric_limits<std::int32_t>::max();  // ids are 32 bits
    if (!count || *count < 0 || *count > highest)
        fail(element, std::string(name) + " should be a whole number from 0 to " +
                          std::to_string(highest) + ", it is " + in_quotes(attribute.value()));
    return static_cast<std::size_t>(*count);
}

std::size_t VtkXmlArrays::num_components(pugi::xml_node array) const {
    return array.attribute("NumberOfComponents") ? count_attribute(array, "NumberOfComponents") : 1;
}

void VtkXmlArrays::fail(pugi::xml_node element, const std::string& message) const {
    const auto offset =
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, element.offset_debug()));
    const auto name = element.attribute("Name");
    throw InputError(file_.name() + ":" + std::to_string(file_.line_of(offset)) + ": " +
                     (name ? "array " + in_quotes(name.value()) : std::string(element.name())) +
                     ": " + message);
}

template <class T>
std::vector<T> VtkXmlArrays::values(pugi::xml_node array, std::size_t count) const {
    const std::string_view type_name = array.attribute("type").value();
    const auto type = scalar_type_of(type_name);
    if (!type) fail(array, "type " + in_quotes(type_name) + " is not a number type of VTK");
    if (std::integral<T> && !is_integer(*type))
        fail(array, "holds " + std::string(type_name) + ", but must hold whole numbers");
    if (count == 0) return {};  // the contents of an empty array depend on the writer
    if (std::string_view(array.attribute("format").as_string("ascii")) == "ascii")
        return parse_text<T>(array, count);
    return convert_scalars<T>(binary(array, count * size_of(*type)), *type, encoding_.swap_bytes);
}

template <class T>
std::vector<T> VtkXmlArrays::parse_text(pugi::xml_node array, std::size_t count) const {
    const std::string text = text_of(array);
    const auto fail_count = [&](const std::string& found) {
        fail(array, "holds " + found + " values, expected " + std::to_string(count));
    };
    std::string_view rest = text;
    std::vector<T> numbers;
    numbers.reserve(std::min(count, text.size() / 2 + 1));  // a number and a blank: two bytes
    for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
        if (numbers.size() == count) fail_count("more");
        const auto number = parse_number<T>(word);
        if (!number)
            fail(array, "value " + std::to_string(numbers.size()) + " is " + in_quotes(word) +
                            ", not a " + (std::integral<T> ? "whole " : "") + "number");
        numbers.push_back(*number);
    }
    if (numbers.size() < count) fail_count(std::to_string(numbers.size()));
    return numbers;
}

std::string VtkXmlArrays::binary(pugi::xml_node array, std::size_t num_bytes) const {
    const std::string_view format = array.attribute("format").value();
    std::string inline_text;
    std::string_view text;
    bool is_raw = false;
    if (format == "binary") {
        inline_text = text_of(array);
        text = inline_text;
    } else if (format == "appended") {
        const auto offset = parse_number<std::uint64_t>(array.attribute("offset").value());
        if (!offset || *offset >= encoding_.appended.size())
            fail(array, "offset " + in_quotes(array.attribute("offset").value()) +
                            " is outside the appended data of " +
                            std::to_string(encoding_.appended.size()) +
                            " bytes; the file is cut short or damaged");
        text = encoding_.appended.substr(static_cast<std::size_t>(*offset));
        is_raw = encoding_.is_appended_raw;
    } else {
        fail(array, "format " + in_quotes(format) + " is none of ascii, binary and appended");
    }
    return encoding_.compressor == Compressor::none ? read_plain(array, text, is_raw, num_bytes)
                                                    : read_blocks(array, text, is_raw, num_bytes);
}

std::string VtkXmlArrays::decode_first(pugi::xml_node array, std::string_view text, bool is_raw,
                                       std::size_t count) const {
    if (is_raw) {
        if (text.size() >= count) return std::string(text.substr(0, count));
    } else {
        auto bytes = decode_base64(text, count);
        if (!bytes) fail(array, "is not sound base64; the file is damaged");
        if (bytes->size() == count) return std::move(*bytes);
    }
    fail(array, "ends before " + std::to_string(count) + " bytes; the file is cut short");
}

std::uint64_t VtkXmlArrays::header_word(const std::string& bytes, std::size_t index) const {
    const char* word = bytes.data() + index * size_of(encoding_.header_type);
    return encoding_.header_type == ScalarType::uint64
               ? load_scalar<std::uint64_t>(word, encoding_.swap_bytes)
               : load_scalar<std::uint32_t>(word, encoding_.swap_bytes);
}

// Layout: the number of bytes, then the bytes.
std::string VtkXmlArrays::read_plain(pugi::xml_node array, std::string_view text, bool is_raw,
                                     std::size_t num_bytes) const {
    const auto header_size = size_of(encoding_.header_type);
    const auto declared = header_word(decode_first(array, text, is_raw, header_size), 0);
    if (declared != num_bytes)
        fail(array,
             "holds " + std::to_string(declared) + " bytes, expected " + std::to_string(num_bytes));
    if (num_bytes > capacity(text, is_raw))
        fail(array, "ends before " + std::to_string(num_bytes) + " bytes; the file is cut short");
    auto bytes = decode_first(array, text, is_raw, header_size + num_bytes);
    bytes.erase(0, header_size);
    return bytes;
}

// Layout: the number of blocks, the unpacked size of a block, the size of the last block if it
// differs (else 0), the packed size of each block; then the blocks.
std::string VtkXmlArrays::read_blocks(pugi::xml_node array, std::string_view text, bool is_raw,
                                      std::size_t num_bytes) const {
    const auto word_size = size_of(encoding_.header_type);
    const auto available = capacity(text, is_raw);
    const auto start = decode_first(array, text, is_raw, 3 * word_size);
    const auto num_blocks = header_word(start, 0);
    const auto block_size = header_word(start, 1);
    const auto last_size = header_word(start, 2) == 0 ? block_size : header_word(start, 2);
    // The product below cannot overflow: it is at most num_bytes.
    const bool is_exact =
        num_blocks > 0 && num_blocks <= available / word_size &&
        (num_blocks == 1 || (block_size > 0 && num_blocks - 1 <= num_bytes / block_size)) &&
        (num_blocks - 1) * block_size + last_size == num_bytes;
    if (!is_exact)
        fail(array, "has " + std::to_string(num_blocks) + " blocks of " +
                        std::to_string(block_size) + " bytes, the last of " +
                        std::to_string(last_size) + "; they should make " +
                        std::to_string(num_bytes) + " bytes");

    const auto header_size = (3 + static_cast<std::size_t>(num_blocks)) * word_size;
    const auto header = decode_first(array, text, is_raw, header_size);
    std::size_t packed_size = 0;
    for (std::size_t b = 0; b < num_blocks; ++b) {
        const auto size = header_word(header, 3 + b);
        if (size > available - packed_size)
            fail(array, "block " + std::to_string(b) + " has " + std::to_string(size) +
                            " bytes, more than the file; it is cut short or damaged");
        packed_size += static_cast<std::size_t>(size);
    }
    if (num_bytes / max_expansion(encoding_.compressor) > packed_size)
        fail(array, std::to_string(packed_size) + " packed bytes cannot make " +
                        std::to_string(num_bytes) + "; the file is damaged");

    const auto packed = decode_first(array, text, is_raw, header_size + packed_size);
    std::string unpacked(num_bytes, '\0');
    std::size_t read = header_size;
    std::size_t written = 0;
    for (std::size_t b = 0; b < num_blocks; ++b) {
        const auto in_size = static_cast<std::size_t>(header_word(header, 3 + b));
        const auto out_size = static_cast<std::size_t>(b + 1 < num_blocks ? block_size : last_size);
        if (!decompress(encoding_.compressor, std::string_view(packed).substr(read, in_size),
                        std::span(unpacked).subspan(written, out_size)))
            fail(array, "block " + std::to_string(b) + " does not unpack to its " +
                            std::to_string(out_size) + " bytes; the file is damaged");
        read += in_size;
        written += out_size;
    }
    return unpacked;
}

}  // namespace incise::io
