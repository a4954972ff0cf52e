// incise convert: converts a mesh from one format to another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <iostream>

#include "incise/app/messages.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/scenario/remedies.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_repair.h"

namespace incise::app {

namespace {

/// Welds the mesh and returns a report. Throws InputError with the problems of the welded mesh.
std::string weld(topology::MeshData& mesh, const std::string& prefix) {
    std::string report = topology::weld_report(topology::weld(mesh));
    const auto errors = topology::check(mesh).errors;
    if (!errors.empty()) throw InputError(prefixed(prefix, joined(errors)));
    topology::drop_welded_points(mesh);
    return report;
}

}  // namespace

int convert(const ConvertOptions& options) {
    io::check_writable(options.out);
    auto file = read_input(options.in, options.input);
    const std::string prefix = options.in.string() + ": ";
    for (const auto& warning : file.warnings) print_warning(prefix + warning);
    std::string report;
    if (options.input.weld) report = "; " + weld(file.mesh, prefix);
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
