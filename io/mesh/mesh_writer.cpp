// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/mesh_writer.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/mesh/mesh_text.h"
#include "incise/io/vtk/vtu_writer.h"

namespace incise::io {

namespace {

struct WrittenFormat {
    const char* suffix;
    std::string (*text)(const topology::MeshData&);
    bool has_carriers = false;
    bool has_polyhedra = false;
    bool has_other_kinds = true;  ///< cells that are no tetrahedra
};

std::string plain_vtu_text(const topology::MeshData& mesh) {
    Frame frame;
    frame.mesh = mesh;
    std::string text = vtu_text(frame);
    if (mesh.points_may_coincide)  // after the XML declaration
        text.insert(text.find('\n') + 1, "<!-- " + std::string(coincidence_mark) + " -->\n");
    return text;
}

constexpr std::array<WrittenFormat, 6> written_formats = {{
    {".inp", abaqus_text},
    {".mesh", medit_text},
    {".msh", gmsh_text},
    {".usda", usda_text, false, false, false},
    {".vtk", legacy_vtk_text, false, true},
    {".vtu", plain_vtu_text, true, true},
}};

const WrittenFormat& written_format_of(const std::filesystem::path& path) {
    auto suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const auto& format : written_formats)
        if (suffix == format.suffix) return format;

    std::string known;
    for (const auto& format : written_formats)
        known += (known.empty() ? "" : ", ") + std::string(format.suffix);
    const auto what = suffix.empty() ? "a name without a suffix tells no format"
                                     : "meshes cannot be written as '" + suffix + "'";
    throw InputError(path.string() + ": " + what + "; use one of " + known);
}

/// Returns why a format has no place for the cells of a mesh; empty if it has.
std::string fault_of_cells(const WrittenFormat& format, const topology::MeshData& mesh) {
    const std::string remedy =
        "; write .vtu, or tetrahedra: `incise convert IN OUT --cells tetrahedra` makes them";
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        if (!format.has_other_kinds && mesh.kinds[c] != topology::CellKind::tetrahedron)
            return "the format holds tetrahedra alone, and " + mesh.cell_name(c) + " is none" +
                   remedy;
        if (!format.has_polyhedra && mesh.kinds[c] == topology::CellKind::polyhedron)
            return "the format has no polyhedra, and " + mesh.cell_name(c) +
                   " is one, which a cut has made" + remedy;
    }
    return {};
}

}  // namespace

ReorderedCell with_wedges_facing_inwards(const topology::MeshData& mesh, std::size_t cell) {
    const auto corners = mesh.cell(cell);
    ReorderedCell out{{}, corners.size()};
    const bool is_wedge = mesh.kinds[cell] == topology::CellKind::wedge;
    const auto& mirrored = topology::traits(mesh.kinds[cell]).mirrored;
    for (std::size_t k = 0; k < corners.size(); ++k)
        out.corners[k] = corners[is_wedge ? static_cast<std::size_t>(mirrored[k]) : k];
    return out;
}

void append_point(std::string& text, const Vec3& point, char separator) {
    append_number(text, point.x());
    text += separator;
    append_number(text, point.y());
    text += separator;
    append_number(text, point.z());
}

void write_mesh(const std::filesystem::path& path, const topology::MeshData& mesh) {
    const auto& format = written_format_of(path);
    if (const std::string fault = fault_of_cells(format, mesh); !fault.empty())
        throw InputError(path.string() + ": " + fault);
    write_file(path, format.text(mesh));
}

std::optional<std::string> loss_in_format(const std::filesystem::path& path,
                                          const topology::MeshData& mesh) {
    const auto& format = written_format_of(path);
    if (mesh.carriers.is_empty() || format.has_carriers || !fault_of_cells(format, mesh).empty())
        return std::nullopt;
    if (std::ranges::count(mesh.kinds, topology::CellKind::polyhedron) > 0)
        return path.string() +
               ": the format has no place for the carriers of a body that was cut, without which "
               "polyhedra have no forces: programs can show the file, and `incise run` will refuse "
               "it; write .vtu to keep them";
    return path.string() +
           ": the format has no place for the carriers of a body that was cut: each part of an "
           "element will be read as an element of its own; write .vtu to keep them";
}

void check_writable(const std::filesystem::path& path) {
    written_format_of(path);
    require_writable(path);
}

std::vector<std::string> writable_suffixes() {
    std::vector<std::string> suffixes;
    suffixes.reserve(std::size(written_formats));
    for (const auto& format : written_formats) suffixes.emplace_back(format.suffix);
    return suffixes;
}

}  // namespace incise::io
