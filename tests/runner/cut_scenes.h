// Cubes of all kinds of cells, and tools that cut them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include "incise/io/mesh/mesh_writer.h"
#include "run_folder.h"
#include "support/mesh_families.h"

namespace incise::runner {

/// Through the whole cube at a slant, or down to its middle, where the mesh has no faces.
inline const std::string blade_through = R"([[tool]]
kind = "blade"
name = "knife"
edge = [[0, -0.1, 0.05], [0, 0.03, 0.053], [0, 0.2, 0.058]]
path = [{ time = 0.01, at = [-0.05, 0, 0] }, { time = 0.03, at = [0.15, 0, 0.01] }]
)";
inline const std::string blade_halfway = R"([[tool]]
kind = "blade"
name = "knife"
edge = [[0.047, -0.1, 0], [0.052, 0.2, 0.004]]
path = [{ time = 0.01, at = [0, 0, 0.12] }, { time = 0.03, at = [0, 0, 0.041] }]
)";
inline const std::string plane_cut = R"([[tool]]
kind = "cut"
time = 0.015
plane = { point = [0.05, 0.045, 0.05], normal = [0.1, 1, 0.3] }
)";
inline const std::string ball_carver = R"([[tool]]
kind = "carver"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0.02, at = [0.05, 0.05, 0.13] }, { time = 0.03, at = [0.05, 0.05, 0.08] }]
)";
inline const std::string while_falling = dynamics(0.04, "gravity = [0, 0, -9.81]\ndamping = 5\n");

/// The mesh of the cube, of other cells.
inline const std::string of_bricks =
    "[mesh]\nbox = { size = [0.1, 0.1, 0.1], cells = [3, 3, 3], element = \"hex\" }\n";
inline const std::string of_file = "[mesh]\nfile = \"cube.vtu\"\n";

/// Writes a jittered cube, of hexahedra, wedges and pyramids if no others are named.
inline void write_cube(const RunFolder& folder, test::Bricks bricks = test::Bricks::mixed,
                       std::uint64_t seed = 5) {
    topology::MeshData cube = test::brick_cube(bricks, 3, 0.1, seed);
    cube.scale(0.1);
    io::write_mesh(folder / "cube.vtu", cube);
}

struct Tools {
    std::string name, text;
    std::string mesh = {};  ///< in place of that of soft_cube
};

inline std::string scene_of(const Tools& tools) {
    return (tools.mesh.empty() ? soft_cube
                               : tools.mesh + soft_cube.substr(soft_cube.find("[[material]]"))) +
           tools.text;
}

inline std::ostream& operator<<(std::ostream& out, const Tools& tools) { return out << tools.name; }

}  // namespace incise::runner
