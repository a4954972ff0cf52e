// Reading of volume meshes from files. A new format needs a file and a row of `read_formats`.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/mesh_reader.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "incise/base/error.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/scanner.h"
#include "incise/io/image/label_image.h"
#include "incise/io/mesh/abaqus_reader.h"
#include "incise/io/mesh/febio_reader.h"
#include "incise/io/mesh/gmsh_reader.h"
#include "incise/io/mesh/medit_reader.h"
#include "incise/io/mesh/mesh_text.h"
#include "incise/io/mesh/tetgen_reader.h"
#include "incise/io/mesh/usda_reader.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/io/vtk/frame_index.h"
#include "incise/io/vtk/legacy_vtk_reader.h"
#include "incise/io/vtk/vtu_reader.h"
#include "incise/topology/mesh_repair.h"

namespace incise::io {

namespace {

struct ReadFormat {
    const char* name;
    const char* suffix;
    std::string_view magic;  ///< beginning of its text, in lower case; empty: suffix only
    MeshFile (*read)(const InputFile& file, const ReadOptions& options);
};

// clang-format off
constexpr ReadFormat read_formats[] = {
    {"VTU", ".vtu", "<", read_vtu},
    {"legacy VTK", ".vtk", "# vtk datafile", read_legacy_vtk},
    {"Gmsh", ".msh", "$", read_gmsh},
    {"MEDIT", ".mesh", "meshversionformatted", read_medit},
    {"TetGen", ".node", "", read_tetgen},
    {"TetGen", ".ele", "", read_tetgen},
    {"Abaqus", ".inp", "*", read_abaqus},
    {"FEBio", ".feb", "<febio_spec", read_febio},
    {"USD as text", ".usda", "#usda", read_usda},
};
// clang-format on

/// Mesh formats of other programs, recognized by the beginning of their text. It is in lower case,
/// with each sequence of blanks as one blank.
struct ForeignFormat {
    const char* name;
    std::string_view magic;
    const char* remedy = "convert it, with Gmsh or meshio for instance, to one of: ";
};
constexpr const char* usd_remedy =
    "turn it into text, for instance by 'usdcat --flatten IN -o OUT.usda', or convert it to one "
    "of: ";
constexpr ForeignFormat foreign_formats[] = {
    {"a mesh of ANSYS Fluent", "("},
    {"an archive of ANSYS Mechanical", "/com"},
    {"an archive of ANSYS Mechanical", "/prep7"},
    {"a mesh of LS-DYNA", "*keyword"},
    {"a mesh of Netgen", "mesh3d"},
    {"a mesh of GiD", "mesh dimension"},
    {"a mesh of GiD", "mesh \""},
    {"a neutral file of GAMBIT", "control info"},
    {"a neutral file of FEMAP", "-1 100 "},
    {"a universal file (UNV) of I-DEAS", "-1 "},
    {"a mesh of SU2", "ndime="},
    {"an HDF5 file, as of Fluent (.msh.h5), CGNS and MED", "\x89hdf"},
    {"a NetCDF file, as of Exodus", "cdf"},
    {"a legacy VTK file without the blank behind '#' in its first line", "#vtk datafile",
     "write '# vtk DataFile' there, or convert it to one of: "},
    {"a binary file of USD (.usdc or .usd)", "pxr-usdc", usd_remedy},
    {"a packed archive, as of USD (.usdz)", "pk\x03\x04", usd_remedy},
};

/// Images that have no labels.
struct Picture {
    const char* name;
    std::size_t offset;  ///< of the mark
    std::string_view magic;
};
constexpr Picture pictures[] = {
    {"an image of DICOM", 128, "DICM"},      {"a picture (PNG)", 0, "\x89PNG"},
    {"a picture (JPEG)", 0, "\xff\xd8\xff"}, {"a picture (GIF)", 0, "GIF8"},
    {"a picture (TIFF)", 0, {"II*\0", 4}},   {"a picture (TIFF)", 0, {"MM\0*", 4}},
};

constexpr std::size_t head_size = 128;  // longer than any magic

/// Returns the beginning of the text, in lower case, with each sequence of blanks as one blank.
std::string head_of(std::string_view text) {
    std::string head;
    for (const char c : text.substr(0, head_size))
        if (!is_blank(c))
            head += c;
        else if (!head.ends_with(' '))
            head += ' ';
    return lower_case(head);
}

std::string known_formats() {
    std::string known;
    for (const auto& row : read_formats)
        known += std::string(known.empty() ? "" : ", ") + row.name + " (" + row.suffix + ")";
    return known;
}

/// Returns the format of XML, by its first element, or else by the suffix of the file. Both readers
/// report other XML.
const ReadFormat* format_of_xml(std::string_view text, std::string_view suffix) {
    const bool is_of_febio =
        begins_as_febio(text) || (suffix == ".feb" && text.find("<VTKFile") == text.npos);
    const auto read = is_of_febio ? read_febio : read_vtu;
    return std::ranges::find(read_formats, read, &ReadFormat::read);
}

/// Returns the format with whose mark the text begins, or null.
const ReadFormat* marked_format_of(const std::string& head) {
    for (const auto& format : read_formats)
        if (!format.magic.empty() && head.starts_with(format.magic) &&
            !head.substr(format.magic.size()).starts_with('\0'))  // no text has zero bytes
            return &format;
    return nullptr;
}

std::string_view behind_blanks(std::string_view text) {
    return {std::find_if_not(text.begin(), text.end(), is_blank), text.end()};
}

/// True if the text begins as a mesh of FreeFEM does: with a line of three counts, of points, cells
/// and boundary elements. Other formats begin so too, so that the suffix must be checked as well.
bool begins_like_freefem(std::string_view text) {
    text = trimmed(text.substr(0, text.find('\n')));
    int num_counts = 0;
    while (!text.empty()) {
        const auto end = std::find_if(text.begin(), text.end(), is_blank);
        if (!parse_number<std::uint64_t>({text.begin(), end})) return false;
        text = behind_blanks({end, text.end()});
        ++num_counts;
    }
    return num_counts == 3;
}

/// True if one of the first lines is a keyword of Abaqus. Some decks begin with other text.
bool has_abaqus_keyword(std::string_view text) {
    constexpr std::size_t longest_beginning = 4000;
    text = text.substr(0, longest_beginning);
    return text.find("\n*") != text.npos && text.find('\0') == text.npos;
}

/// Returns the format of the file, or null if it is not known. Throws InputError for an index of
/// other files or a mesh of another program.
const ReadFormat* read_format_of(const InputFile& file) {
    std::string_view text = file.bytes;
    const auto suffix = lower_case(file.path.extension().string());
    while (true) {
        text = behind_blanks(text);
        const auto head = head_of(text);
        for (const auto& format : foreign_formats)
            if (head.starts_with(format.magic))
                throw InputError(file.name() + ": is " + format.name + ", which cannot be read; " +
                                 format.remedy + known_formats());
        if (text.starts_with('<')) return format_of_xml(text, suffix);
        if (const auto* format = marked_format_of(head)) return format;
        if (!text.starts_with('#')) break;  // MEDIT and TetGen files may begin with comments
        text.remove_prefix(std::min(text.find('\n'), text.size()));
    }
    if (suffix == ".series")
        refuse_series(file);
    else if (const auto files = files_of_series(file); !files.empty())
        refuse_index(file, files);
    if (suffix == ".msh" && begins_like_freefem(text))
        throw InputError(file.name() +
                         ": begins with three counts and has no $MeshFormat, so it is a mesh of "
                         "FreeFEM and not of Gmsh; FreeFEM writes MEDIT, which can be read, where "
                         "the name ends so: savemesh(Th, \"NAME.mesh\")");
    for (const auto& format : read_formats)
        if (suffix == format.suffix &&
            (format.magic.empty() || (format.read == read_abaqus && has_abaqus_keyword(text))))
            return &format;
    return nullptr;
}

/// Returns the warning that cells were turned.
std::string warning_of_turned(const topology::MeshData& mesh, const topology::TurnedCells& turned) {
    const auto num_of = [&](topology::CellKind kind) {
        return static_cast<std::size_t>(std::ranges::count(mesh.kinds, kind));
    };
    std::size_t num_of_kinds = 0;
    std::string names;
    for (const auto kind : turned.kinds) {
        num_of_kinds += num_of(kind);
        names += (names.empty() ? "" : " and ") + std::string(topology::traits(kind).plural);
    }
    const std::size_t num_flat = num_of_kinds - turned.num_cells;
    const bool is_whole_mesh = num_of_kinds == mesh.num_cells();
    const std::string which = is_whole_mesh ? "cells" : names;
    const std::string text =
        (num_of_kinds == 1
             ? "the only " +
                   std::string(is_whole_mesh ? "cell" : topology::traits(turned.kinds[0]).name) +
                   " has"
         : num_flat > 0
             ? "all " + which + " but " + std::to_string(num_flat) + " without volume have"
             : "all " + std::to_string(num_of_kinds) + " " + which + " have") +
        " negative volume by VTK's order of corners: the order was reversed";
    return is_whole_mesh
               ? text + "; make sure that the body is not the mirror image of what is meant"
               : text + "; the other cells have their corners in that order";
}

/// Completes the mesh of any format: recognizes the coincidence mark and turns cells of a kind that
/// is inverted.
void finish(const InputFile& file, MeshFile& result) {
    constexpr std::size_t longest_head = 500;  // the mark is in one of the first lines
    if (std::string_view(file.bytes).substr(0, longest_head).find(coincidence_mark) !=
        std::string_view::npos)
        result.mesh.points_may_coincide = true;
    const auto turned = topology::turn_inverted_cells(result.mesh);
    if (turned.num_cells > 0) result.warnings.push_back(warning_of_turned(result.mesh, turned));
}

/// Returns what a file that is no mesh is, and what to do with it.
std::string remedy_for_other(const InputFile& file) {
    constexpr const char* remedy =
        "; a body is made of a surface or a label image by `incise mesh`; see incise mesh --help";
    if (const auto image = image_format_of(file); !image.empty())
        return "is an image (" + std::string(image) + ")" + remedy;
    if (has_surface_suffix(file.path)) return std::string("is a surface") + remedy;
    for (const auto& picture : pictures)
        if (file.bytes.size() > picture.offset &&
            std::string_view(file.bytes).substr(picture.offset).starts_with(picture.magic))
            return std::string("is ") + picture.name +
                   "; a body can be made of a segmentation in NIfTI, MetaImage or NRRD";
    return "begins like no mesh format known here; convert it to one of: " + known_formats();
}

}  // namespace

bool begins_like_a_mesh(std::string_view text) {
    return marked_format_of(head_of(behind_blanks(text))) != nullptr;
}

MeshFile read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
    const auto file = load_input_file(path);
    const auto* format = read_format_of(file);
    if (format == nullptr) throw UnknownFormat(file.name() + ": " + remedy_for_other(file));
    MeshFile result = format->read(file, options);
    for (const auto& name : options.vector_arrays)
        if (!result.cell_vectors.contains(name))
            throw InputError(file.name() + ": has no cell array " + in_quotes(name) +
                             ": none is read from meshes of the format " + format->name +
                             "; use VTU or legacy VTK");
    finish(file, result);
    return result;
}

}  // namespace incise::io
