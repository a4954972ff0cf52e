// Surfaces in the Polygon File Format (.ply).
// Source: Turk, "The PLY Polygon File Format" (1994).
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/surface/ply_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/line_words.h"
#include "incise/io/files/scanner.h"
#include "incise/io/surface/surface_collector.h"

namespace incise::io {

namespace {

struct Type {
    std::string_view name;
    std::size_t size;
    bool is_integer;
    double (*read)(Scanner& scanner, std::string_view what);  ///< exact: double holds all types
};

template <class T>
constexpr Type type_as(std::string_view name) {
    return {name, sizeof(T), std::integral<T>, [](Scanner& scanner, std::string_view what) {
                return static_cast<double>(scanner.value<T>(what));
            }};
}

constexpr std::array number_types = {
    type_as<std::int8_t>("char"),     type_as<std::int8_t>("int8"),
    type_as<std::uint8_t>("uchar"),   type_as<std::uint8_t>("uint8"),
    type_as<std::int16_t>("short"),   type_as<std::int16_t>("int16"),
    type_as<std::uint16_t>("ushort"), type_as<std::uint16_t>("uint16"),
    type_as<std::int32_t>("int"),     type_as<std::int32_t>("int32"),
    type_as<std::uint32_t>("uint"),   type_as<std::uint32_t>("uint32"),
    type_as<float>("float"),          type_as<float>("float32"),
    type_as<double>("double"),        type_as<double>("float64"),
};

struct Property {
    std::string_view name;
    const Type* type;
    const Type* count_type = nullptr;  ///< of the length of a list; null if it is no list
    int use = -1;  ///< x, y, z of a vertex: 0, 1, 2; corners of a face: 0; skipped: -1

    bool is_list() const { return count_type != nullptr; }
};

struct Element {
    std::string_view name;
    std::uint64_t count;
    std::vector<Property> properties;
};

class PlyReader {
  public:
    explicit PlyReader(const InputFile& file) : scanner_(file), collector_(file, scanner_) {}

    SurfaceFile read() {
        read_header();
        auto& vertex = only_element("vertex");
        choose_property(vertex, {"x"}, 0);
        choose_property(vertex, {"y"}, 1);
        choose_property(vertex, {"z"}, 2);
        auto& face = only_element("face");
        choose_property(face, {"vertex_indices", "vertex_index"}, 0);
        num_points_ = vertex.count;

        scanner_.set_binary(is_binary_, must_swap_);
        for (const auto& element : elements_) {
            require_room(element);
            if (&element == &vertex)
                read_vertices(element);
            else if (&element == &face)
                read_faces(element);
            else
                skip(element);
        }
        if (!scanner_.at_end())
            scanner_.fail(std::to_string(scanner_.remaining()) +
                          " bytes follow the last element; the counts of the header are wrong, or "
                          "the file is damaged");
        return collector_.finish();
    }

  private:
    void read_header() {
        scanner_.at_end();  // goes to the first line that is not empty
        read_line();
        if (words_.size() != 1 || words_[0] != "ply")
            scanner_.fail("expected 'ply' alone on the first line");
        for (read_line(); words_.empty() || words_[0] != "end_header"; read_line())
            if (!words_.empty()) read_header_line();
        if (!has_format_) scanner_.fail("the header has no line 'format'");
    }

    void read_line() {
        if (scanner_.remaining() == 0)
            scanner_.fail("the file ends before 'end_header'; it is cut short");
        words_.clear();
        append_words(scanner_.rest_of_line(), words_);
    }

    void read_header_line() {
        const auto keyword = words_[0];
        if (keyword == "format") {
            require_words(3, "format <encoding> 1.0");
            read_format();
        } else if (keyword == "element") {
            require_words(3, "element <name> <count>");
            const auto count = parse_number<std::uint64_t>(words_[2]);
            if (!count) scanner_.fail_expected("a count of elements", words_[2]);
            elements_.push_back({words_[1], *count, {}});
        } else if (keyword == "property") {
            if (elements_.empty()) scanner_.fail("a property comes before the first element");
            elements_.back().properties.push_back(property_of_words());
        } else if (keyword != "comment" && keyword != "obj_info") {
            scanner_.fail(in_quotes(keyword) + " is not a keyword of PLY headers");
        }
    }

    void read_format() {
        const auto encoding = words_[1];
        const bool is_big = encoding == "binary_big_endian";
        if (encoding != "ascii" && encoding != "binary_little_endian" && !is_big)
            scanner_.fail_expected("ascii, binary_little_endian or binary_big_endian", encoding);
        if (words_[2] != "1.0")
            scanner_.fail("version " + in_quotes(words_[2]) + " cannot be read; it must be 1.0");
        if (has_format_) scanner_.fail("the header has a second line 'format'");
        has_format_ = true;
        is_binary_ = encoding != "ascii";
        must_swap_ = is_big != (std::endian::native == std::endian::big);
    }

    Property property_of_words() const {
        if (words_.size() < 2 || words_[1] != "list") {
            require_words(3, "property <type> <name>");
            return {words_[2], type_of(words_[1])};
        }
        require_words(5, "property list <type of the length> <type> <name>");
        const auto* count_type = type_of(words_[2]);
        if (!count_type->is_integer)
            scanner_.fail("the length of list " + in_quotes(words_[4]) + " has type " +
                          in_quotes(words_[2]) + "; it must be a type of whole numbers");
        return {words_[4], type_of(words_[3]), count_type};
    }

    const Type* type_of(std::string_view name) const {
        const auto* type = std::ranges::find(number_types, name, &Type::name);
        if (type == number_types.end()) {
            std::string known;
            for (const auto& row : number_types)
                known += (known.empty() ? "" : ", ") + std::string(row.name);
            scanner_.fail("type " + in_quotes(name) + " is not one of: " + known);
        }
        return type;
    }

    void require_words(std::size_t count, const char* form) const {
        if (words_.size() != count)
            scanner_.fail("expected '" + std::string(form) + "', found " +
                          std::to_string(words_.size()) + " words");
    }

    Element& only_element(std::string_view name) {
        const auto count = std::ranges::count(elements_, name, &Element::name);
        if (count != 1)
            scanner_.fail("the header has " + std::to_string(count) + " elements " +
                          in_quotes(name) + "; it must have 1");
        return *std::ranges::find(elements_, name, &Element::name);
    }

    /// Sets the use of the property that has one of these names. Throws InputError unless there is
    /// exactly one, which must be a list of whole numbers for corners and no list for coordinates.
    void choose_property(Element& element, std::initializer_list<std::string_view> names, int use) {
        Property* chosen = nullptr;
        for (auto& property : element.properties) {
            if (std::ranges::find(names, property.name) == names.end()) continue;
            if (chosen != nullptr)
                scanner_.fail("element " + in_quotes(element.name) + " has a second property " +
                              in_quotes(property.name));
            chosen = &property;
        }
        if (chosen == nullptr)
            scanner_.fail("element " + in_quotes(element.name) + " has no property " +
                          in_quotes(*names.begin()));
        const bool must_be_list = element.name == "face";
        if (chosen->is_list() != must_be_list || (must_be_list && !chosen->type->is_integer))
            scanner_.fail("property " + in_quotes(chosen->name) + " of element " +
                          in_quotes(element.name) + " must be " +
                          (must_be_list ? "a list of whole numbers" : "a number, not a list"));
        chosen->use = use;
    }

    /// Throws InputError if so many elements do not fit in the rest of the file. Elements without
    /// properties take no bytes.
    void require_room(const Element& element) const {
        std::size_t bytes_each = 0;
        for (const auto& property : element.properties)
            bytes_each += size_of(property.is_list() ? *property.count_type : *property.type);
        if (bytes_each > 0)
            scanner_.require_room(element.count, bytes_each,
                                  "the number of elements " + in_quotes(element.name));
    }
    /// Returns the least size of a number, in bytes. In text, that is a digit and a blank.
    std::size_t size_of(const Type& type) const { return is_binary_ ? type.size : 2; }

    void read_vertices(const Element& element) {
        constexpr std::array what = {"coordinate x", "coordinate y", "coordinate z"};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            Vec3 point;
            for (const auto& property : element.properties)
                if (property.use < 0)
                    skip(property);
                else
                    point[property.use] =
                        property.type->read(scanner_, what[static_cast<std::size_t>(property.use)]);
            collector_.add_point(point);
        }
    }

    void read_faces(const Element& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const auto& property : element.properties)
                if (property.use < 0)
                    skip(property);
                else
                    read_corners(property);
            collector_.add_polygon(corners_);
        }
    }

    void read_corners(const Property& property) {
        corners_.resize(read_length(property));
        for (auto& corner : corners_) {
            corner = static_cast<std::int64_t>(property.type->read(scanner_, "a point index"));
            collector_.check_corner(corner, num_points_);
        }
    }

    void skip(const Element& element) {
        if (element.properties.empty()) return;
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const auto& property : element.properties) skip(property);
    }

    void skip(const Property& property) {
        const auto count = property.is_list() ? read_length(property) : 1;
        if (is_binary_)
            scanner_.take(count * property.type->size, "a property");
        else
            for (std::size_t i = 0; i < count; ++i) scanner_.token("a property");
    }

    /// Reads the length of a list. Throws InputError if the list does not fit in the rest of the
    /// file.
    std::size_t read_length(const Property& list) {
        const double length = list.count_type->read(scanner_, "the length of a list");
        if (length < 0)
            scanner_.fail("the length of list " + in_quotes(list.name) + " is " + shown(length) +
                          "; it must be 0 or more");
        const auto result = static_cast<std::size_t>(length);
        scanner_.require_room(result, size_of(*list.type), "the length of a list");
        return result;
    }

    Scanner scanner_;
    SurfaceCollector collector_;
    std::vector<std::string_view> words_;  ///< of the current header line
    std::vector<Element> elements_;
    std::vector<std::int64_t> corners_;  ///< of the current face
    std::uint64_t num_points_ = 0;
    bool has_format_ = false;
    bool is_binary_ = false;
    bool must_swap_ = false;
};

}  // namespace

SurfaceFile read_ply(const InputFile& file) { return PlyReader(file).read(); }

}  // namespace incise::io
