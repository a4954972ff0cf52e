// Unstructured grids in VTK's XML format (.vtu).
// Source: "VTK XML Formats", VTK wiki.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/vtu_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/scanner.h"
#include "incise/io/vtk/frame_index.h"
#include "incise/io/vtk/vtk_cells.h"
#include "incise/io/vtk/vtk_xml_array.h"

namespace incise::io {

using topology::CellKind;

namespace {

/// A file in two parts: the head, which is XML, and the appended data, which may be binary.
struct VtuText {
    std::string_view head;  ///< up to the start tag of AppendedData, inclusive
    std::string_view appended;
    bool is_cut = false;
};

/// Returns the beginning of the start tag of AppendedData outside comments, or npos.
std::size_t find_appended(std::string_view bytes) {
    auto at = bytes.find('<');
    while (at != bytes.npos && !bytes.substr(at).starts_with("<AppendedData")) {
        const bool is_comment = bytes.substr(at).starts_with("<!--");
        at = bytes.find('<', is_comment ? bytes.find("-->", at + 4) : at + 1);
    }
    return at;
}

VtuText cut_appended(const InputFile& file) {
    const std::string_view bytes = file.bytes;
    const auto tag = find_appended(bytes);
    if (tag == bytes.npos) return {bytes, {}, false};
    const auto tag_end = bytes.find('>', tag);
    if (tag_end == bytes.npos) return {bytes, {}, false};  // the XML parser reports it
    auto begin = tag_end + 1;
    while (begin < bytes.size() && is_blank(bytes[begin])) ++begin;
    if (begin == bytes.size() || bytes[begin] != '_')
        throw InputError(file.name() + ":" + std::to_string(file.line_of(tag)) +
                         ": AppendedData does not begin with an underscore; the file is cut short "
                         "or damaged");
    return {bytes.substr(0, tag_end + 1), bytes.substr(begin + 1), true};
}

class VtuReader {
  public:
    VtuReader(const InputFile& file, const ReadOptions& options)
        : file_(file), options_(options), collector_(make_vtk_collector(file.name(), options)) {}

    MeshFile read() {
        const auto text = cut_appended(file_);
        parse(text);
        const auto root = document_.child("VTKFile");
        if (!root)
            throw InputError(file_.name() +
                             ": is XML, but has no VTKFile element: its first one is " +
                             in_quotes(document_.document_element().name()));
        const std::string_view type = root.attribute("type").value();
        if (type != "UnstructuredGrid") {
            std::vector<std::string> files;
            for (const auto& found : root.select_nodes(".//@file | .//@Source"))
                files.emplace_back(found.attribute().value());
            if (!files.empty()) refuse_index(file_, files, type == "PUnstructuredGrid");
            if (type == "Collection" || type == "PUnstructuredGrid") refuse_empty_index(file_);
            throw InputError(file_.name() + ": holds a VTK dataset of type " + in_quotes(type) +
                             remedy_for_dataset(lower_case(type)));
        }
        const VtkXmlArrays arrays(file_, encoding_of(root, text));
        const auto field_data = root.child("UnstructuredGrid").child("FieldData");
        const auto corners = named(field_data, carrier_corners_array);
        if (corners)
            read_carrier_corners(arrays, corners, named(field_data, carrier_types_array),
                                 named(field_data, carrier_diagonals_array));
        const auto pieces = root.child("UnstructuredGrid").children("Piece");
        const auto num_pieces = std::distance(pieces.begin(), pieces.end());
        std::size_t index = 0;
        for (const auto piece : pieces) {
            auto location = file_.name();
            if (num_pieces > 1) location += ": piece " + std::to_string(index++);
            read_piece(arrays, piece, location);
            require_both(arrays, piece, corners);
        }
        if (num_pieces > 1)
            result_.warnings.push_back(std::to_string(num_pieces) +
                                       " pieces were put one behind the other");
        collector_.finish(result_.mesh, result_.warnings);
        return std::move(result_);
    }

  private:
    void parse(const VtuText& text) {
        std::string closed_head;
        auto xml = text.head;
        if (text.is_cut) {
            closed_head = std::string(text.head) + "</AppendedData></VTKFile>";
            xml = closed_head;
        }
        const auto parsed =
            document_.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
        if (!parsed) {
            const auto line = file_.line_of(static_cast<std::size_t>(parsed.offset));
            throw InputError(file_.name() + ":" + std::to_string(line) + ": not well-formed XML (" +
                             parsed.description() + "); the file is cut short or damaged");
        }
    }

    VtkXmlEncoding encoding_of(pugi::xml_node root, const VtuText& text) const {
        const auto refuse = [&](const char* name, const std::string& allowed) {
            throw InputError(file_.name() + ": " + name + " of VTKFile is " +
                             in_quotes(root.attribute(name).value()) + "; it must be " + allowed);
        };
        VtkXmlEncoding encoding;
        const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
        if (order != "LittleEndian" && order != "BigEndian")
            refuse("byte_order", "LittleEndian or BigEndian");
        encoding.swap_bytes =
            (order == "LittleEndian") != (std::endian::native == std::endian::little);
        const std::string_view header = root.attribute("header_type").as_string("UInt32");
        if (header != "UInt32" && header != "UInt64") refuse("header_type", "UInt32 or UInt64");
        encoding.header_type = header == "UInt64" ? ScalarType::uint64 : ScalarType::uint32;
        const auto compressor = compressor_of(root.attribute("compressor").value());
        if (!compressor)
            refuse(
                "compressor",
                "vtkZLibDataCompressor, vtkLZ4DataCompressor, vtkLZMADataCompressor or left out");
        encoding.compressor = *compressor;
        const std::string_view appended =
            root.child("AppendedData").attribute("encoding").as_string("base64");
        if (appended != "raw" && appended != "base64")
            throw InputError(file_.name() + ": encoding of AppendedData is " + in_quotes(appended) +
                             "; it must be raw or base64");
        encoding.is_appended_raw = appended == "raw";
        encoding.appended = text.appended;
        if (!encoding.is_appended_raw)
            encoding.appended = text.appended.substr(0, text.appended.find('<'));
        return encoding;
    }

    void read_carrier_corners(const VtkXmlArrays& arrays, pugi::xml_node array,
                              pugi::xml_node types, pugi::xml_node diagonals) {
        constexpr std::size_t size_of_tetrahedron = 12;  // four positions
        const std::size_t size = types ? 3 * topology::max_corners : size_of_tetrahedron;
        if (arrays.num_components(array) != size)
            arrays.fail(array, "carriers need " + std::to_string(size) + " components, " +
                                   (types ? "eight" : "four") + " positions; this array has " +
                                   std::to_string(arrays.num_components(array)));
        const auto num_rows = arrays.count_attribute(array, "NumberOfTuples");
        const auto numbers = arrays.reals(array, size * num_rows);
        const auto type_of_row =
            types ? arrays.integers(types, num_rows)
                  : std::vector<std::int64_t>(num_rows, vtk_cell_type(CellKind::tetrahedron));
        const auto diagonals_of_row = diagonals ? arrays.integers(diagonals, num_rows)
                                                : std::vector<std::int64_t>(num_rows, 0);
        for (std::size_t row = 0; row < num_rows; ++row) {
            const auto kind = kind_of_vtk_cell(type_of_row[row]);
            if (!kind || *kind == CellKind::polyhedron)
                arrays.fail(types, "carrier " + std::to_string(row) + " has the type " +
                                       std::to_string(type_of_row[row]) +
                                       ", which must be 10 (tetrahedron), 12 (hexahedron), 13 "
                                       "(wedge) or 14 (pyramid)");
            std::array<Vec3, topology::max_corners> x;
            const double* at = numbers.data() + size * row;
            for (std::size_t k = 0; k < size / 3; ++k) x[k] = Vec3(at + 3 * k);
            auto& corners =
                result_.mesh.carriers.corners.emplace_back(*kind, std::span(x).first(size / 3));
            const auto bits = static_cast<std::uint16_t>(diagonals_of_row[row]);
            corners.diagonals = topology::Diagonals::of_bits(bits);
            if (bits != diagonals_of_row[row] || !corners.diagonals.fits(*kind))
                arrays.fail(diagonals, "carrier " + std::to_string(row) + " has the diagonals " +
                                           std::to_string(diagonals_of_row[row]) +
                                           ", which its kind cannot have; write the file again");
        }
    }

    /// Throws InputError if a piece has carriers and the file has no corners of them, or the other
    /// way round.
    static void require_both(const VtkXmlArrays& arrays, pugi::xml_node piece,
                             pugi::xml_node corners) {
        const auto of_cell = named(piece.child("CellData"), carrier_array);
        constexpr const char* remedy =
            "; write both, or leave out both to take each cell as an element of its own";
        if (of_cell && !corners)
            arrays.fail(of_cell, std::string("the field data has no array ") +
                                     in_quotes(carrier_corners_array) + " with the corners" +
                                     remedy);
        if (corners && !of_cell && arrays.count_attribute(piece, "NumberOfCells") > 0)
            arrays.fail(corners, std::string("the cell data has no array ") +
                                     in_quotes(carrier_array) + " that names its rows" + remedy);
    }

    void read_piece(const VtkXmlArrays& arrays, pugi::xml_node node, const std::string& location) {
        const auto num_points = arrays.count_attribute(node, "NumberOfPoints");
        const auto num_cells = arrays.count_attribute(node, "NumberOfCells");
        VtkPiece piece;
        const auto point_data = node.child("PointData");
        piece.is_frame = named(point_data, "rest_position") && named(point_data, "node_id");
        if (num_points > 0)
            piece.coordinates = arrays.reals(points_of(arrays, node), 3 * num_points);
        piece.offsets.assign(1, 0);
        if (num_cells > 0) {
            const auto cells = node.child("Cells");
            piece.types = arrays.integers(required(arrays, cells, node, "types"), num_cells);
            const auto ends = arrays.integers(required(arrays, cells, node, "offsets"), num_cells);
            piece.offsets.insert(piece.offsets.end(), ends.begin(), ends.end());
            check_offsets(piece.offsets, location);
            piece.connectivity =
                arrays.integers(required(arrays, cells, node, "connectivity"),
                                possible_count(piece.offsets.back(), "the last cell", location));
            if (std::ranges::count(piece.types, vtk_cell_type(CellKind::polyhedron)) > 0)
                read_faces(arrays, node, location, piece);
            const auto regions = named(node.child("CellData"), options_.region_array);
            if (regions) {
                if (arrays.num_components(regions) != 1)
                    arrays.fail(regions, "regions need 1 component, this array has " +
                                             std::to_string(arrays.num_components(regions)));
                piece.regions = arrays.reals(regions, num_cells);
            } else if (options_.must_have_regions()) {
                refuse_missing_regions(location, options_.region_array,
                                       whole_number_arrays(arrays, node.child("CellData")));
            }
            const auto read_numbers = [&](const char* name, const std::string& what) {
                const auto array = named(node.child("CellData"), name);
                if (!array) return std::vector<std::int64_t>();
                if (arrays.num_components(array) != 1)
                    arrays.fail(array, what + " need 1 component, this array has " +
                                           std::to_string(arrays.num_components(array)));
                return arrays.integers(array, num_cells);
            };
            piece.carriers = read_numbers(carrier_array, "carriers");
            for (std::size_t k = 0; named(node.child("CellData"), cut_faces_array(k)); ++k)
                piece.cut_faces.push_back(read_numbers(cut_faces_array(k).c_str(), "cut faces"));
            for (const auto& name : options_.vector_arrays) {
                const auto array = named(node.child("CellData"), name);
                if (!array)
                    refuse_missing_vectors(location, name,
                                           vector_arrays(arrays, node.child("CellData")));
                if (arrays.num_components(array) != 3)
                    arrays.fail(array, "vectors need 3 components, this array has " +
                                           std::to_string(arrays.num_components(array)));
                piece.vectors[name] = arrays.reals(array, 3 * num_cells);
            }
        }
        append_piece(piece, location, result_, collector_);
    }

    /// Reads the faces of polyhedra: the array `faces`, and by cell where its faces end in it, or
    /// -1.
    void read_faces(const VtkXmlArrays& arrays, pugi::xml_node node, const std::string& location,
                    VtkPiece& piece) const {
        const auto cells = node.child("Cells");
        if (!named(cells, "faces") && named(cells, "face_connectivity"))
            arrays.fail(cells,
                        "has the faces of polyhedra as VTK 9.4 writes them, which cannot be "
                        "read; write the file with VTK 9.3 or older");
        const auto ends = required(arrays, cells, node, "faceoffsets");
        piece.face_ends = arrays.integers(ends, piece.types.size());
        piece.face_begins = piece.face_ends;
        std::int64_t last = 0;
        for (std::size_t c = 0; c < piece.types.size(); ++c) {
            if (piece.types[c] != vtk_cell_type(CellKind::polyhedron)) continue;
            piece.face_begins[c] = last;
            if (piece.face_ends[c] < last)
                arrays.fail(ends, "the faces of cell " + std::to_string(c) + " end at " +
                                      std::to_string(piece.face_ends[c]) +
                                      ", before they begin at " + std::to_string(last));
            last = piece.face_ends[c];
        }
        piece.faces = arrays.integers(required(arrays, cells, node, "faces"),
                                      possible_count(last, "the last polyhedron", location));
    }

    /// Returns the end of a list. Throws InputError if a file of this size cannot hold it, which
    /// bounds the memory. LZMA has the highest compression ratio.
    std::size_t possible_count(std::int64_t end, const char* what,
                               const std::string& location) const {
        const auto most = file_.bytes.size() * max_expansion(Compressor::lzma);
        if (static_cast<std::uint64_t>(end) > most)
            throw InputError(location + ": " + what + " ends at offset " + std::to_string(end) +
                             ", more than a file of this size can hold; it is damaged");
        return static_cast<std::size_t>(end);
    }

    /// Returns the array of the rest positions: rest_position in a frame of a run, else Points.
    static pugi::xml_node points_of(const VtkXmlArrays& arrays, pugi::xml_node piece) {
        const auto rest = named(piece.child("PointData"), "rest_position");
        if (rest && arrays.num_components(rest) == 3) return rest;
        const auto points = piece.child("Points").child("DataArray");
        if (!points) arrays.fail(piece, "has no Points array");
        if (arrays.num_components(points) != 3)
            arrays.fail(points, "points need 3 components, this array has " +
                                    std::to_string(arrays.num_components(points)));
        return points;
    }

    static pugi::xml_node named(pugi::xml_node parent, const std::string& name) {
        return parent.find_child_by_attribute("DataArray", "Name", name.c_str());
    }

    /// Returns the names of the arrays with one whole number a cell.
    static std::vector<std::string> whole_number_arrays(const VtkXmlArrays& arrays,
                                                        pugi::xml_node cell_data) {
        std::vector<std::string> names;
        for (const auto array : cell_data.children("DataArray")) {
            const std::string_view type = array.attribute("type").value();
            if ((type.starts_with("Int") || type.starts_with("UInt")) &&
                arrays.num_components(array) == 1)
                names.emplace_back(array.attribute("Name").value());
        }
        return names;
    }

    static std::vector<std::string> vector_arrays(const VtkXmlArrays& arrays,
                                                  pugi::xml_node cell_data) {
        std::vector<std::string> names;
        for (const auto array : cell_data.children("DataArray"))
            if (arrays.num_components(array) == 3)
                names.emplace_back(array.attribute("Name").value());
        return names;
    }

    static pugi::xml_node required(const VtkXmlArrays& arrays, pugi::xml_node cells,
                                   pugi::xml_node piece, const char* name) {
        const auto array = named(cells, name);
        if (!array)
            arrays.fail(piece, std::string("has no ") + in_quotes(name) + " array in Cells");
        return array;
    }

    const InputFile& file_;
    const ReadOptions& options_;
    pugi::xml_document document_;
    CellCollector collector_;
    MeshFile result_;
};

}  // namespace

MeshFile read_vtu(const InputFile& file, const ReadOptions& options) {
    return VtuReader(file, options).read();
}

}  // namespace incise::io
