// Writes a mesh and reads it, in a build of the library's sources without VTK.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <incise/base/error.h>
#include <incise/io/mesh/mesh_reader.h>
#include <incise/io/mesh/mesh_writer.h>
#include <incise/io/vtk/vtu_writer.h>
#include <incise/topology/box_mesh.h>
#include <incise/topology/mesh.h>

#include <cstdio>
#include <string_view>

int main() {
    using namespace incise;
    const auto box =
        topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2});
    io::write_mesh("box.msh", box);
    const auto read = topology::Mesh::build(io::read_mesh("box.msh").mesh).mesh;
    std::printf("%zu elements\n", read.num_elements());
    try {
        io::write_vtu("box.vtu", {}, io::Compression::none);
    } catch (const OutputError& error) {
        std::printf("%s\n", error.what());
        const bool tells_why = std::string_view(error.what()).find("VTK") != std::string_view::npos;
        return read.num_elements() == 48 && tells_why ? 0 : 1;
    }
    return 1;
}
