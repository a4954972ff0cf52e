// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/source_mesh.h"

#include <algorithm>
#include <set>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/memory.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/scenario/body_problems.h"
#include "incise/scenario/remedies.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_repair.h"

namespace incise::scenario {

std::string vector_text(const Vec3& v) {
    return "[" + format_number(v.x()) + ", " + format_number(v.y()) + ", " + format_number(v.z()) +
           "]";
}

namespace {

std::vector<std::string> arrays_of(const std::vector<MaterialSpec>& materials) {
    std::set<std::string> names;
    for (const MaterialSpec& material : materials)
        if (const auto* name = std::get_if<std::string>(&material.fibre)) names.insert(*name);
    return {names.begin(), names.end()};
}

/// Throws MemoryError if the machine has too little memory for the box. Without this check the
/// system would kill the process.
void require_memory_for(const BoxMeshSpec& box, const std::vector<MaterialSpec>& materials,
                        const std::string& location) {
    const bool is_tetrahedra = box.element == topology::CellKind::tetrahedron;
    const bool are_springs = std::ranges::all_of(
        materials, [](const MaterialSpec& material) { return material.method == Method::hybmss; });
    // Arrays of the mesh, elements, contact.
    const double bytes_per_element = is_tetrahedra ? 600.0 : are_springs ? 1500.0 : 4700.0;
    const double elements = (is_tetrahedra ? 6.0 : 1.0) * box.cells[0] *
                            static_cast<double>(box.cells[1]) * box.cells[2];
    if (const auto lack = io::lack_of_memory(bytes_per_element * elements))
        throw MemoryError(located(location, "key 'mesh.box.cells': makes " +
                                                format_number(elements) + " elements: that " +
                                                *lack + "; use fewer cells"));
}

/// Returns the points and cells of the mesh, welded if the scenario says so, and scaled.
io::MeshFile load_mesh(const MeshSpec& spec, const std::vector<MaterialSpec>& materials,
                       double scale) {
    if (const auto* path = std::get_if<std::filesystem::path>(&spec.source)) {
        io::MeshFile file = io::read_mesh(*path, {.region_array = spec.region_array,
                                                  .linear = spec.linear,
                                                  .linear_advice = linear_advice(),
                                                  .vector_arrays = arrays_of(materials)});
        if (spec.weld == true)
            file.warnings.push_back(topology::weld_report(topology::weld(file.mesh)));
        file.mesh.points_may_coincide = file.mesh.points_may_coincide || spec.weld == false;
        file.mesh.scale(scale);
        return file;
    }
    if (const auto* given = std::get_if<std::shared_ptr<const topology::MeshData>>(&spec.source)) {
        io::MeshFile file{**given, {}};
        file.mesh.scale(scale);
        return file;
    }
    const auto& box = std::get<BoxMeshSpec>(spec.source);
    require_memory_for(box, materials, spec.location);
    return {topology::box_mesh(box.element, scale * box.origin, scale * box.size, box.cells), {}};
}

bool can_load(const MeshSpec& spec, const std::vector<MaterialSpec>& materials) {
    try {
        load_mesh(spec, materials, 1.0);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

/// Returns the points and cells at the scale of the scenario. Throws BodyError if only the array of
/// the regions is faulty.
io::MeshFile load_mesh(const MeshSpec& spec, const std::vector<MaterialSpec>& materials) {
    try {
        return load_mesh(spec, materials, spec.scale);
    } catch (const InputError& error) {
        MeshSpec usual = spec;
        usual.region_array = io::ReadOptions::usual_region_array;
        if (spec.region_array == usual.region_array || !can_load(usual, materials)) throw;
        throw BodyError(spec.region_array_location, error.what());
    }
}

/// Returns the reason why a box is refused: rounding, or cells with too large or too small volumes.
std::string what_is_wrong_with(const BoxMeshSpec& box, double scale) {
    const Vec3 size = scale * box.size, origin = scale * box.origin;
    const Vec3 brick = size.cwiseQuotient(Vec3(box.cells[0], box.cells[1], box.cells[2]));
    const Vec3 reach = origin.cwiseAbs().cwiseMax((origin + size).cwiseAbs());
    constexpr double least_ratio = 1e-10;  // far above rounding, far below that of usual boxes
    const std::string bricks = "key 'mesh.box': its bricks of " + vector_text(brick);
    if ((brick.array() < least_ratio * reach.array()).any())
        return bricks + " are lost to rounding so far from [0, 0, 0]: bring 'origin', now " +
               vector_text(box.origin) + ", nearer to it, or make the bricks larger";
    const bool is_large = !(brick.prod() < 1.0);
    return bricks + " have a volume too " + (is_large ? "large" : "small") +
           " to compute with: use " + (is_large ? "larger" : "smaller") + " units of length";
}

}  // namespace

SourceMesh build_mesh(const MeshSpec& spec, const std::vector<MaterialSpec>& materials) {
    io::MeshFile file = load_mesh(spec, materials);
    const auto* path = std::get_if<std::filesystem::path>(&spec.source);
    const std::string prefix = path ? path->string() + ": " : "";
    try {
        topology::BuiltMesh built = topology::Mesh::build(file.mesh, weld_advice());
        file.warnings.insert(file.warnings.end(), built.warnings.begin(), built.warnings.end());
        for (std::string& warning : file.warnings) warning.insert(0, prefix);
        return {std::move(built.mesh),
                std::move(file.warnings),
                {path ? path->string() : "", std::move(file.cell_vectors)},
                std::move(built.joins)};
    } catch (const InputError& error) {
        if (spec.scale != 1.0 && topology::check(load_mesh(spec, {}, 1.0).mesh).errors.empty())
            throw BodyError(spec.scale_location,
                            "key 'mesh.scale': " + format_number(spec.scale) +
                                " makes the mesh too " + (spec.scale > 1.0 ? "large" : "small") +
                                " to compute with, which without it is sound: use a " +
                                (spec.scale > 1.0 ? "smaller" : "larger") + " one");
        if (const auto* box = std::get_if<BoxMeshSpec>(&spec.source))
            throw BodyError(spec.location, what_is_wrong_with(*box, spec.scale));
        BodyProblems problems;
        for (const std::string& line : prefixed_lines(prefix, error.what()))
            problems.add(spec.location, line);
        problems.throw_if_any();
        throw;
    }
}

}  // namespace incise::scenario
