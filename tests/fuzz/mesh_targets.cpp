// The readers of volume meshes, and the building of the mesh from what they read.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <string>

#include "incise/fragments/fragment_mesh.h"
#include "incise/fragments/validate.h"
#include "incise/io/mesh/abaqus_reader.h"
#include "incise/io/mesh/febio_reader.h"
#include "incise/io/mesh/gmsh_reader.h"
#include "incise/io/mesh/medit_reader.h"
#include "incise/io/mesh/tetgen_reader.h"
#include "incise/io/mesh/usda_reader.h"
#include "incise/io/vtk/legacy_vtk_reader.h"
#include "incise/io/vtk/vtu_reader.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_repair.h"
#include "tests/fuzz/findings.h"
#include "tests/fuzz/targets.h"
#include "tests/support/mesh_consistency.h"

namespace incise::fuzz {

namespace {

void build(const topology::MeshData& mesh) {
    try {
        const topology::Mesh built = topology::Mesh::build(mesh).mesh;
        for (const auto& fault : fragments::validate(fragments::FragmentMesh(built), built))
            require_none(fault);
    } catch (const InputError&) {
        // Parts that fit one another may still make no mesh.
    }
}

/// What verbs do next with what was read.
void use(topology::MeshData mesh) {
    require_none(support::inconsistency_of(mesh));
    build(mesh);
    topology::turn_inverted_cells(mesh);
    topology::weld(mesh);
    build(mesh);
}

using Reader = io::MeshFile (*)(const io::InputFile&, const io::ReadOptions&);

void read_mesh(Reader reader, const char* name, std::string_view bytes) {
    const io::InputFile file{name, std::string(bytes)};
    for (const bool linear : {false, true})
        read_or_refuse(name, [&] { use(reader(file, {.linear = linear}).mesh); });
}

}  // namespace

void vtu(std::string_view bytes) { read_mesh(io::read_vtu, "fuzz.vtu", bytes); }
void legacy_vtk(std::string_view bytes) { read_mesh(io::read_legacy_vtk, "fuzz.vtk", bytes); }
void gmsh(std::string_view bytes) { read_mesh(io::read_gmsh, "fuzz.msh", bytes); }
void medit(std::string_view bytes) { read_mesh(io::read_medit, "fuzz.mesh", bytes); }
void abaqus(std::string_view bytes) { read_mesh(io::read_abaqus, "fuzz.inp", bytes); }
void febio(std::string_view bytes) { read_mesh(io::read_febio, "fuzz.feb", bytes); }
void usda(std::string_view bytes) { read_mesh(io::read_usda, "fuzz.usda", bytes); }

void tetgen(std::string_view bytes) {
    constexpr std::string_view divider = "----\n";
    const auto end = std::min(bytes.find(divider), bytes.size());
    const auto rest = bytes.substr(std::min(end + divider.size(), bytes.size()));
    const io::InputFile nodes{"fuzz.node", std::string(bytes.substr(0, end))};
    const io::InputFile elements{"fuzz.ele", std::string(rest)};
    read_or_refuse("fuzz.", [&] { use(io::read_tetgen_pair(nodes, elements).mesh); });
}

}  // namespace incise::fuzz
