// Unstructured grids in VTK's XML format (.vtu).
// Source: "VTK XML Formats", VTK wiki.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/vtu_reader.h"

#include <bit>
#include <iterator>
#include <pugixml.hpp>
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
        const auto corners =
            named(root.child("UnstructuredGrid").child("FieldData"), carrier_corners_array);
        if (corners) read_carrier_corners(arrays, corners);
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

    void read_carrier_corners(const VtkXmlArrays& arrays, pugi::xml_node array) {
        constexpr std::size_t size = 12;  // four positions
        if (arrays.num_components(array) != size)
            arrays.fail(array, "carriers need 12 components, four positions; this array has " +
                                   std::to_string(arrays.num_components(array)));
        const auto num_rows = arrays.count_attribute(array, "NumberOfTuples");
        const auto numbers = arrays.reals(array, size * num_rows);
        for (std::size_t i = 0; i < numbers.size(); i += size) {
            auto& row = result_.mesh.carriers.corners.emplace_back();
            for (std::size_t k = 0; k < 4; ++k) row[k] = Vec3(numbers.data() + i + 3 * k);
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
            // Bounds the allocation below. LZMA has the highest compression ratio.
            const auto most = file_.bytes.size() * max_expansion(Compressor::lzma);
            if (static_cast<std::uint64_t>(piece.offsets.back()) > most)
                throw InputError(location + ": the last cell ends at offset " +
                                 std::to_string(piece.offsets.back()) +
                                 ", more than a file of this size can hold; it is damaged");
            piece.connectivity = arrays.integers(required(arrays, cells, node, "connectivity"),
                                                 static_cast<std::size_t>(piece.offsets.back()));
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
            piece.cut_faces = read_numbers(cut_faces_array, "cut faces");
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
