// make_organs FOLDER: makes the organ meshes that the project ships, FOLDER/<organ>.vtu.
// Licence: GPL-3.0-or-later, as it is built on CGAL's Mesh_3. The meshes are not derived from CGAL
// and are LGPL-3.0-or-later, like the project.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <exception>
#include <filesystem>

#include "data/organs/mesh_quality.h"
#include "data/organs/mesh_smoothing.h"
#include "data/organs/organ_shapes.h"
#include "data/organs/tetrahedral_mesher.h"
#include "incise/base/error.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/topology/mesh.h"
#include "incise/topology/validate.h"

namespace {

using namespace incise;

/// Smallest altitude to reach, over the element size at the surface. The regular tetrahedron of
/// that size has 1.33; above 0.6 the search takes many times as long and wins little.
constexpr double altitude_aim = 0.55;

/// The mesh in the order of its elements along a space-filling curve. Throws InputError unless it
/// is one piece, valid and without pinches or unused points.
topology::MeshData checked(const std::string& name, const topology::MeshData& made) {
    auto [mesh, complaints] = topology::Mesh::build(made);
    for (const auto& violation : topology::validate(mesh)) complaints.push_back(violation);
    if (const int pieces = topology::components(mesh).count; pieces != 1)
        complaints.push_back("it has " + std::to_string(pieces) + " pieces, not 1");
    if (!complaints.empty()) {
        std::string text = name + " was meshed badly; change its element sizes:";
        for (const auto& complaint : complaints) text += "\n  " + complaint;
        throw InputError(text);
    }
    return topology::to_mesh_data(mesh, mesh.rest_positions());
}

/// Rounds to multiples of 2^-20 m, a micrometre: nothing to the shape, and half the file.
void round_points(topology::MeshData& mesh) {
    constexpr double steps = 1 << 20;
    for (Vec3& p : mesh.points) p = (p * steps).array().round() / steps;
}

void print(const std::string& name, const topology::MeshData& mesh) {
    const auto q = organs::measure(mesh);
    std::printf("%s\n  nodes %zu, tetrahedra %zu\n", name.c_str(), mesh.points.size(),
                mesh.num_cells());
    for (const auto& [region, volume] : q.volume_of_region)
        std::printf("  volume of region %d: %.1f cm3\n", region, volume * 1e6);
    for (int axis = 0; axis < 3; ++axis)
        std::printf("  %c from %.1f to %.1f mm\n", "xyz"[axis], q.box.min()[axis] * 1e3,
                    q.box.max()[axis] * 1e3);
    std::printf("  edges: mean %.2f mm, shortest %.2f mm\n", q.mean_edge * 1e3, q.min_edge * 1e3);
    std::printf("  smallest altitude %.3f mm (%.2f of the mean edge)\n", q.min_altitude * 1e3,
                q.min_altitude / q.mean_edge);
    std::printf("  dihedral angles from %.1f to %.1f degrees\n", q.min_dihedral, q.max_dihedral);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_organs FOLDER\n");
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        for (const auto& organ : organs::all_organs()) {
            auto made = organs::tetrahedralise(organ);
            organs::raise_altitudes(made, organ, altitude_aim * organ.surface_size);
            round_points(made);
            const auto mesh = checked(organ.name, made);
            io::write_mesh(folder / (organ.name + ".vtu"), mesh);
            print(organ.name, mesh);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_organs: %s\n", error.what());
        return 1;
    }
}
