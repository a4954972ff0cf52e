// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/mesh_input.h"

#include "incise/scenario/remedies.h"
#include "incise/topology/mesh_repair.h"

namespace incise::app {

io::MeshFile read_input(const std::filesystem::path& path, const MeshInput& input) {
    return io::read_mesh(path, {.region_array = input.region_array,
                                .linear = input.linear,
                                .linear_advice = scenario::linear_advice()});
}

void weld_input(io::MeshFile& file, const MeshInput& input) {
    if (input.weld) file.warnings.push_back(topology::weld_report(topology::weld(file.mesh)));
}

std::size_t num_points(const topology::MeshData& mesh) {
    std::size_t count = 0;
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
        if (!mesh.is_welded(p)) ++count;
    return count;
}

}  // namespace incise::app
