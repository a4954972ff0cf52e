// Unstructured grids in VTK's legacy format (.vtk).
// Source: "VTK File Formats", VTK User's Guide; the writer of VTK 9.1, which divides CELLS into
// offsets and connectivity from version 5 on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/legacy_vtk_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/scanner.h"
#include "incise/io/vtk/vtk_cells.h"

namespace incise::io {

namespace {

/// The layout of the values of an array. Only arrays of the layout `number` can be used.
struct ValueType {
    enum class Layout : std::uint8_t { number, bits, strings };
    Layout layout = Layout::number;
    ScalarType scalar = ScalarType::uint8;
};

ValueType value_type_of(Scanner& scanner, std::string_view name) {
    using enum ValueType::Layout;
    static constexpr std::array<std::pair<std::string_view, ValueType>, 18> types = {
        {{"bit", {bits, ScalarType::uint8}},
         {"string", {strings, ScalarType::uint8}},
         {"utf8_string", {strings, ScalarType::uint8}},
         {"char", {number, ScalarType::int8}},
         {"signed_char", {number, ScalarType::int8}},
         {"unsigned_char", {number, ScalarType::uint8}},
         {"short", {number, ScalarType::int16}},
         {"unsigned_short", {number, ScalarType::uint16}},
         {"int", {number, ScalarType::int32}},
         {"unsigned_int", {number, ScalarType::uint32}},
         {"long", {number, ScalarType::int64}},
         {"unsigned_long", {number, ScalarType::uint64}},
         {"vtktypeint64", {number, ScalarType::int64}},
         {"vtktypeuint64", {number, ScalarType::uint64}},
         {"vtkidtype", {number, ScalarType::int32}},  // VTK writes 32 bits under this name
         {"float", {number, ScalarType::float32}},
         {"double", {number, ScalarType::float64}},
         {"unsigned_long_long", {number, ScalarType::uint64}}}};
    const auto lower = lower_case(name);
    for (const auto& [known, type] : types)
        if (known == lower) return type;
    scanner.fail("type " + in_quotes(name) + " is not known; export without this array");
}

/// Returns the name of an array without the percent encoding of VTK.
std::string decoded_name(std::string_view name) {
    const auto digit = [](char c) -> int {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        return -1;
    };
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool is_code = name[i] == '%' && i + 2 < name.size() && digit(name[i + 1]) >= 0 &&
                             digit(name[i + 2]) >= 0;
        result +=
            is_code ? static_cast<char>(digit(name[i + 1]) * 16 + digit(name[i + 2])) : name[i];
        if (is_code) i += 2;
    }
    return result;
}

class LegacyVtkReader {
  public:
    LegacyVtkReader(const InputFile& file, const ReadOptions& options)
        : file_(file), options_(options), scanner_(file) {}

    MeshFile read() {
        read_header();
        while (!scanner_.at_end()) read_section();
        if (!has_points_ || !has_cells_ || !has_types_)
            throw InputError(file_.name() + ": has no " +
                             (!has_points_ ? "POINTS" : (!has_cells_ ? "CELLS" : "CELL_TYPES")) +
                             " section; the file is cut short");
        if (piece_.types.size() + 1 != piece_.offsets.size())
            throw InputError(file_.name() + ": has " + std::to_string(piece_.types.size()) +
                             " CELL_TYPES for " + std::to_string(piece_.offsets.size() - 1) +
                             " CELLS");
        check_offsets(piece_.offsets, file_.name());
        if (static_cast<std::size_t>(piece_.offsets.back()) != piece_.connectivity.size())
            throw InputError(file_.name() + ": the last cell ends at offset " +
                             std::to_string(piece_.offsets.back()) + ", but the connectivity has " +
                             std::to_string(piece_.connectivity.size()) + " entries");
        if (!has_regions_ && options_.must_have_regions() && !piece_.types.empty())
            refuse_missing_regions(file_.name(), options_.region_array, other_cell_arrays_);
        for (const auto& name : options_.vector_arrays)
            if (!piece_.vectors.contains(name) && !piece_.types.empty())
                refuse_missing_vectors(file_.name(), name, other_vector_arrays_);
        piece_.is_frame = has_rest_positions_ && has_node_ids_;
        take_faces_of_polyhedra();
        MeshFile result;
        auto collector = make_vtk_collector(file_.name(), options_);
        append_piece(piece_, file_.name(), result, collector);
        collector.finish(result.mesh, result.warnings);
        return result;
    }

  private:
    enum class Association : std::uint8_t { none, points, cells };

    void read_header() {
        auto line = scanner_.rest_of_line();
        while (line.find_first_not_of(" \t\r") == line.npos && scanner_.remaining() > 0)
            line = scanner_.rest_of_line();
        constexpr std::string_view magic = "# vtk datafile version ";
        const auto version = lower_case(line);
        const auto major = version.starts_with(magic) && version.size() > magic.size()
                               ? version[magic.size()]
                               : '\0';
        if (major < '1' || major > '5')
            scanner_.fail("expected '# vtk DataFile Version' from 1.0 to 5.x, found " +
                          in_quotes(line));
        has_offsets_ = major == '5';
        scanner_.rest_of_line();  // the title: any text
        const auto encoding = scanner_.token("ASCII or BINARY");
        const bool is_binary = lower_case(encoding) == "binary";
        if (!is_binary && lower_case(encoding) != "ascii")
            scanner_.fail_expected("ASCII or BINARY", encoding);
        scanner_.set_binary(is_binary, std::endian::native == std::endian::little);
        if (!scanner_.accept("DATASET"))
            scanner_.fail_expected("DATASET", scanner_.token("DATASET"));
        const auto kind = scanner_.token("the kind of dataset");
        if (const auto word = lower_case(kind); word != "unstructured_grid")
            scanner_.fail("holds a dataset of kind " + in_quotes(kind) + remedy_for_dataset(word));
    }

    void read_section() {
        const auto word = scanner_.token("a section");
        const auto keyword = lower_case(word);
        if (keyword == "points") {
            const auto count = read_count("the number of points", 1);
            const auto type = value_type_of(scanner_, scanner_.token("the type of the points"));
            piece_.coordinates = read_values<double>(type, 3 * count, "the points");
            has_points_ = true;
        } else if (keyword == "cells") {
            has_offsets_ ? read_cells_as_offsets() : read_cells_as_lists();
            has_cells_ = true;
        } else if (keyword == "cell_types") {
            const auto count = read_count("the number of cell types", 1);
            piece_.types = read_values<std::int64_t>(int32_type, count, "the cell types");
            has_types_ = true;
        } else if (keyword == "point_data" || keyword == "cell_data") {
            association_ = keyword == "cell_data" ? Association::cells : Association::points;
            num_tuples_ = read_count("the number of tuples", 0);
        } else if (keyword == "field") {
            read_field();
        } else if (keyword == "metadata") {
            skip_metadata();
        } else {
            read_attribute(keyword, word);
        }
    }

    // CELLS n size, then n times: the number of nodes and the nodes.
    void read_cells_as_lists() {
        const auto num_cells = read_count("the number of cells", 1);
        const auto size = read_count("the size of the cell list", 1);
        const auto list = read_values<std::int64_t>(int32_type, size, "the cells");
        piece_.offsets.assign(1, 0);
        piece_.connectivity.clear();
        std::size_t position = 0;
        for (std::size_t c = 0; c < num_cells; ++c) {
            const auto left = list.size() - position;
            const auto num_nodes = left == 0 ? -1 : list[position];
            if (num_nodes < 0 || static_cast<std::uint64_t>(num_nodes) > left - 1)
                throw InputError(
                    file_.name() + ": cell " + std::to_string(c) + ": " +
                    (left == 0 ? "is missing" : "has " + std::to_string(num_nodes) + " nodes") +
                    "; the cell list has " + std::to_string(left) + " of its " +
                    std::to_string(size) + " entries left");
            const auto begin = list.begin() + static_cast<std::ptrdiff_t>(position) + 1;
            piece_.connectivity.insert(piece_.connectivity.end(), begin, begin + num_nodes);
            piece_.offsets.push_back(static_cast<std::int64_t>(piece_.connectivity.size()));
            position += 1 + static_cast<std::size_t>(num_nodes);
        }
        if (position != list.size())
            throw InputError(file_.name() + ": the cell list has " + std::to_string(size) +
                             " entries, but its " + std::to_string(num_cells) + " cells fill " +
                             std::to_string(position));
    }

    /// The entries of a polyhedron are its faces: how many, then for each face the number of its
    /// points and its points. The points of the cell are then those of its faces, each once.
    void take_faces_of_polyhedra() {
        constexpr std::int64_t polyhedron = vtk_cell_type(topology::CellKind::polyhedron);
        if (std::ranges::count(piece_.types, polyhedron) == 0) return;
        piece_.faces = std::exchange(piece_.connectivity, {});
        piece_.face_begins.assign(piece_.offsets.begin(), piece_.offsets.end() - 1);
        piece_.face_ends.assign(piece_.offsets.begin() + 1, piece_.offsets.end());
        for (std::size_t c = 0; c < piece_.types.size(); ++c) {
            const std::span<const std::int64_t> entries(piece_.faces.data() + piece_.face_begins[c],
                                                        piece_.faces.data() + piece_.face_ends[c]);
            const auto first = std::ssize(piece_.connectivity);
            if (piece_.types[c] == polyhedron)
                append_points_of_faces(entries, first);
            else
                piece_.connectivity.insert(piece_.connectivity.end(), entries.begin(),
                                           entries.end());
            piece_.offsets[c] = first;
        }
        piece_.offsets.back() = std::ssize(piece_.connectivity);
    }

    /// Appends the points of faces to the connectivity, each once. Faces that do not fill their
    /// list are refused later.
    void append_points_of_faces(std::span<const std::int64_t> faces, std::ptrdiff_t first) {
        std::size_t at = 1;
        while (at < faces.size() && faces[at] >= 0 &&
               faces[at] < std::ssize(faces) - static_cast<std::int64_t>(at)) {
            const auto end = at + 1 + static_cast<std::size_t>(faces[at]);
            for (++at; at < end; ++at)
                if (std::find(piece_.connectivity.begin() + first, piece_.connectivity.end(),
                              faces[at]) == piece_.connectivity.end())
                    piece_.connectivity.push_back(faces[at]);
        }
    }

    // CELLS n size, OFFSETS type, n numbers, CONNECTIVITY type, size numbers; n is #cells + 1.
    void read_cells_as_offsets() {
        const auto num_offsets = read_count("the number of offsets", 1);
        const auto size = read_count("the size of the connectivity", 1);
        piece_.offsets = read_part("OFFSETS", num_offsets);
        if (piece_.offsets.empty()) piece_.offsets.assign(1, 0);
        piece_.connectivity = read_part("CONNECTIVITY", size);
    }

    std::vector<std::int64_t> read_part(std::string_view word, std::size_t count) {
        if (!scanner_.accept(word)) scanner_.fail_expected(word, scanner_.token(word));
        const auto type = value_type_of(scanner_, scanner_.token("a type"));
        return read_values<std::int64_t>(type, count, word);
    }

    // Point and cell data other than FIELD: keyword, name, type and layout on one line.
    void read_attribute(const std::string& keyword, std::string_view word) {
        static constexpr std::array<std::pair<std::string_view, std::size_t>, 8> tuples = {
            {{"vectors", 3},
             {"normals", 3},
             {"tensors", 9},
             {"tensors6", 6},
             {"global_ids", 1},
             {"pedigree_ids", 1},
             {"edge_flags", 1},
             {"scalars", 1}}};
        constexpr ValueType bytes{};
        constexpr ValueType reals{ValueType::Layout::number, ScalarType::float32};
        const auto& colors = scanner_.is_binary() ? bytes : reals;  // by definition of the format
        if (keyword == "lookup_table") {
            scanner_.token("the name of the table");
            skip_values(colors, 4 * read_count("the size of the table", 1), "the table");
            return;
        }
        if (keyword == "color_scalars") {
            scanner_.token("the name of the array");
            const auto num_components = read_count("the number of components", 0);
            skip_values(colors, product(num_tuples_, num_components), "the colours");
            return;
        }
        if (keyword == "texture_coordinates") {
            scanner_.token("the name of the array");
            const auto num_components = read_count("the number of components", 0);
            const auto type = value_type_of(scanner_, scanner_.token("a type"));
            skip_values(type, product(num_tuples_, num_components), "the texture coordinates");
            return;
        }
        for (const auto& [known, tuple_size] : tuples) {
            if (known != keyword) continue;
            const auto name = decoded_name(scanner_.token("the name of the array"));
            const auto type = value_type_of(scanner_, scanner_.token("a type"));
            auto num_components = tuple_size;
            if (keyword == "scalars") num_components = read_scalars_layout();
            read_array(name, type, num_components, num_tuples_);
            return;
        }
        scanner_.fail(in_quotes(word) +
                      " is not a section of an unstructured grid; the section before "
                      "it has too many values, or the file is damaged");
    }

    /// Reads what follows the type of SCALARS: the number of components, if it is not 1, and the
    /// lookup table. Returns the number of components.
    std::size_t read_scalars_layout() {
        const auto rest = scanner_.rest_of_line();
        const auto begin = rest.find_first_not_of(" \t\r");
        std::size_t num_components = 1;
        if (begin != rest.npos) {
            const auto end = rest.find_first_of(" \t\r", begin);
            const auto text = rest.substr(begin, end - begin);
            const auto parsed = parse_number<std::uint8_t>(text);
            if (!parsed) scanner_.fail_expected("the number of components", text);
            num_components = *parsed;
        }
        is_at_data_ = true;
        if (scanner_.accept("LOOKUP_TABLE")) {
            scanner_.token("the name of the table");
            is_at_data_ = false;
        }
        return num_components;
    }

    void read_field() {
        scanner_.token("the name of the field");
        const auto num_arrays = read_count("the number of arrays", 1);
        for (std::size_t i = 0; i < num_arrays; ++i) {
            auto name = scanner_.token("the name of an array");
            while (name == "METADATA") {
                skip_metadata();
                name = scanner_.token("the name of an array");
            }
            if (name == "NULL_ARRAY") continue;
            const auto num_components = read_count("the number of components", 0);
            const auto num_tuples = read_count("the number of tuples", 0);
            const auto type = value_type_of(scanner_, scanner_.token("a type"));
            read_array(decoded_name(name), type, num_components, num_tuples);
        }
    }

    /// Reads an array if it is needed, else skips it.
    void read_array(const std::string& name, ValueType type, std::size_t num_components,
                    std::size_t num_tuples) {
        const auto count = product(num_components, num_tuples);
        if (association_ == Association::points) {
            has_rest_positions_ = has_rest_positions_ || name == "rest_position";
            has_node_ids_ = has_node_ids_ || name == "node_id";
        }
        if (association_ == Association::cells && name == options_.region_array) {
            if (num_components != 1)
                scanner_.fail("array " + in_quotes(name) +
                              ": regions need 1 component, this array has " +
                              std::to_string(num_components));
            require_tuples(name, num_tuples, piece_.types.size(), "cells");
            piece_.regions = read_values<double>(type, count, "the regions");
            has_regions_ = true;
        } else if (association_ == Association::points && name == "rest_position" &&
                   num_components == 3) {
            require_tuples(name, num_tuples, piece_.coordinates.size() / 3, "points");
            piece_.coordinates = read_values<double>(type, count, "the rest positions");
        } else if (association_ == Association::cells && is_wanted_vector(name)) {
            if (num_components != 3)
                scanner_.fail("array " + in_quotes(name) +
                              ": vectors need 3 components, this array has " +
                              std::to_string(num_components));
            require_tuples(name, num_tuples, piece_.types.size(), "cells");
            piece_.vectors[name] = read_values<double>(type, count, "array " + in_quotes(name));
        } else {
            if (association_ == Association::cells && num_components == 3 &&
                type.layout == ValueType::Layout::number)
                other_vector_arrays_.push_back(name);
            if (association_ == Association::cells && num_components == 1 &&
                type.layout == ValueType::Layout::number && is_integer(type.scalar))
                other_cell_arrays_.push_back(name);
            skip_values(type, count, "array " + in_quotes(name));
        }
    }

    bool is_wanted_vector(const std::string& name) const {
        const auto& wanted = options_.vector_arrays;
        return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    }

    void require_tuples(const std::string& name, std::size_t found, std::size_t expected,
                        const char* things) {
        if (found != expected)
            scanner_.fail("array " + in_quotes(name) + " has " + std::to_string(found) +
                          " values for " + std::to_string(expected) + " " + things);
    }

    std::size_t read_count(std::string_view what, std::size_t bytes_each) {
        if (bytes_each > 0) return scanner_.count(what, bytes_each);
        const auto count = scanner_.number<std::uint32_t>(what);  // its product is checked later
        return count;
    }

    static std::size_t product(std::size_t a, std::size_t b) { return a * b; }  // of 32-bit counts

    void begin_data() {
        if (scanner_.is_binary() && !is_at_data_) scanner_.rest_of_line();
        is_at_data_ = false;
    }

    void require_room(ValueType type, std::size_t count, std::string_view what) {
        const auto bytes_each = scanner_.is_binary() ? size_of(type.scalar) : 2;
        scanner_.require_room(count, bytes_each, "the number of values of " + std::string(what));
    }

    template <class T>
    std::vector<T> read_values(ValueType type, std::size_t count, std::string_view what) {
        if (type.layout != ValueType::Layout::number)
            scanner_.fail(std::string(what) + " must be numbers, not bits or strings");
        if (std::integral<T> && !is_integer(type.scalar))
            scanner_.fail(std::string(what) + " must be whole numbers");
        begin_data();
        require_room(type, count, what);
        if (scanner_.is_binary())
            return convert_scalars<T>(scanner_.take(count * size_of(type.scalar), what),
                                      type.scalar, scanner_.swaps_bytes());
        std::vector<T> values(count);
        for (auto& value : values) value = scanner_.number<T>(what);
        return values;
    }

    void skip_values(ValueType type, std::size_t count, std::string_view what) {
        begin_data();
        using enum ValueType::Layout;
        if (type.layout == strings) {
            skip_strings(count, what);
        } else if (!scanner_.is_binary()) {
            require_room(type, count, what);
            for (std::size_t i = 0; i < count; ++i) scanner_.token(what);
        } else if (type.layout == bits) {
            scanner_.take((count + 7) / 8, what);
        } else {
            require_room(type, count, what);
            scanner_.take(count * size_of(type.scalar), what);
        }
    }

    // In text, one string a line. In binary, the two highest bits of the first byte give the size
    // of the length of the string: 8, 4, 2 or 1 bytes.
    void skip_strings(std::size_t count, std::string_view what) {
        scanner_.require_room(count, 1, "the number of values of " + std::string(what));
        if (!scanner_.is_binary()) {
            for (std::size_t i = 0; i <= count; ++i) scanner_.rest_of_line();
            return;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const auto first = static_cast<unsigned char>(scanner_.take(1, what)[0]);
            std::size_t length = first & 0x3F;
            for (const char c : scanner_.take((std::size_t{8} >> (first >> 6)) - 1, what))
                length = length << 8 | static_cast<unsigned char>(c);
            scanner_.take(length, what);
        }
    }

    /// Skips all lines up to the next blank line.
    void skip_metadata() {
        scanner_.rest_of_line();
        while (scanner_.remaining() > 0 &&
               scanner_.rest_of_line().find_first_not_of(" \t\r") != std::string_view::npos) {
        }
    }

    static constexpr ValueType int32_type{ValueType::Layout::number, ScalarType::int32};

    const InputFile& file_;
    const ReadOptions& options_;
    Scanner scanner_;
    VtkPiece piece_;
    std::vector<std::string> other_cell_arrays_;    ///< with one whole number a cell
    std::vector<std::string> other_vector_arrays_;  ///< with three components a cell
    Association association_ = Association::none;
    std::size_t num_tuples_ = 0;
    bool has_offsets_ = false;  ///< true for version 5
    bool has_points_ = false;
    bool has_cells_ = false;
    bool has_types_ = false;
    bool has_regions_ = false;
    bool has_rest_positions_ = false;
    bool has_node_ids_ = false;
    bool is_at_data_ = false;  ///< true if the line before the data has been read
};

}  // namespace

MeshFile read_legacy_vtk(const InputFile& file, const ReadOptions& options) {
    return LegacyVtkReader(file, options).read();
}

}  // namespace incise::io
