// incise convert: a mesh from one format to another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <iostream>

#include "app/messages.h"
#include "app/verbs.h"
#include "io/mesh_reader.h"
#include "io/mesh_writer.h"

namespace incise::app {

int convert(const ConvertOptions& options) {
    io::check_writable(options.out);
    const auto file = io::read_mesh(options.in, {options.region_array});
    for (const auto& warning : file.warnings) print_warning(options.in.string() + ": " + warning);
    io::write_mesh(options.out, file.mesh);
    std::cout << options.out.string() << ": " << file.mesh.points.size() << " points, "
              << file.mesh.num_cells() << " cells\n";
    return done;
}

}  // namespace incise::app
