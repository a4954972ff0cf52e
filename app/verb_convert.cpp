// incise convert: converts a mesh from one format to another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <iostream>
#include <string_view>
#include <utility>

#include "incise/app/messages.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/scenario/diagnostics.h"
#include "incise/scenario/remedies.h"
#include "incise/scenario/table_reader.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_repair.h"
#include "incise/topology/tetrahedral_division.h"

namespace incise::app {

namespace {

constexpr std::string_view kinds_of_cells[] = {"polyhedra", "tetrahedra"};

/// Throws InputError with the problems of the mesh, if it has any.
void require_sound(const topology::MeshData& mesh, const std::string& prefix) {
    const auto errors = topology::check(mesh).errors;
    if (!errors.empty()) throw InputError(prefixed(prefix, joined(errors)));
}

/// Divides all cells that are no tetrahedra, and warns if a cell is turned inside out somewhere.
/// Throws InputError with the problems of the mesh.
void divide(topology::MeshData& mesh, const std::string& prefix) {
    require_sound(mesh, prefix);
    if (topology::has_only_tetrahedra(mesh)) return;
    topology::TetrahedralDivision division = topology::divide_into_tetrahedra(mesh);
    if (const std::size_t count = division.inverted.size(); count > 0)
        print_warning(prefix + mesh.cell_name(division.inverted.front()) +
                      (count == 1 ? "" : " and " + std::to_string(count - 1) + " more") +
                      " cannot be divided without tetrahedra that are turned inside out: the faces "
                      "lie on each other or cross; `incise check` refuses such a file");
    mesh = std::move(division.mesh);
}

/// Welds the mesh and returns a report. Throws InputError with the problems of the welded mesh.
std::string weld(topology::MeshData& mesh, const std::string& prefix) {
    std::string report = topology::weld_report(topology::weld(mesh));
    require_sound(mesh, prefix);
    topology::drop_welded_points(mesh);
    return report;
}

}  // namespace

int convert(const ConvertOptions& options) {
    io::check_writable(options.out);
    if (const auto complaint = scenario::complaint(options.cells, {kinds_of_cells});
        complaint && !options.cells.empty())
        throw InputError("--cells: " + scenario::in_quotes(options.cells) + " " + *complaint);
    auto file = read_input(options.in, options.input);
    const std::string prefix = options.in.string() + ": ";
    for (const auto& warning : file.warnings) print_warning(prefix + warning);
    std::string report;
    if (options.input.weld) report = "; " + weld(file.mesh, prefix);
    if (options.cells == kinds_of_cells[1]) divide(file.mesh, prefix);
    if (const auto warning = topology::coincidence_warning(
            file.mesh, scenario::weld_advice()))  // gaps, after welding
        print_warning(prefix + *warning);
    if (const auto loss = io::loss_in_format(options.out, file.mesh)) print_warning(*loss);
    io::write_mesh(options.out, file.mesh);
    std::cout << options.out.string() << ": " << file.mesh.points.size() << " points, "
              << file.mesh.num_cells() << (file.mesh.num_cells() == 1 ? " cell" : " cells")
              << report << '\n';
    return done;
}

}  // namespace incise::app
