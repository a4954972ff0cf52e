// incise info: describes a mesh, a surface or a label image, as text or as JSON.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <array>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "incise/app/image_info.h"
#include "incise/app/messages.h"
#include "incise/app/surface_info.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/cutting/rest/body_measures.h"
#include "incise/io/image/label_image.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/scenario/remedies.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::app {

namespace {

struct MeshInfo {
    std::size_t num_points = 0, num_cells = 0;
    int num_components = 0;
    topology::MeshMetrics metrics;
    /// By kind, the cells as they were before any cut of which polyhedra are parts.
    std::array<std::size_t, topology::num_cell_kinds> cut_cells{};
    std::optional<cutting::FragmentCounts> fragments;  ///< of a body that was cut
    std::vector<std::string> warnings, joins;

    double min_dihedral_degrees() const {
        return metrics.min_dihedral_angle * 180.0 / std::numbers::pi;
    }
};

constexpr auto polyhedron = static_cast<std::size_t>(topology::CellKind::polyhedron);

/// Returns by kind how many cells a cut has divided into polyhedra, or given other faces.
std::array<std::size_t, topology::num_cell_kinds> cut_cells_of(const topology::MeshData& mesh) {
    std::vector<bool> is_cut(mesh.carriers.corners.size(), false);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        if (mesh.kinds[c] == topology::CellKind::polyhedron)
            is_cut[static_cast<std::size_t>(mesh.carriers.of_cell[c])] = true;
    std::array<std::size_t, topology::num_cell_kinds> count{};
    for (std::size_t row = 0; row < is_cut.size(); ++row)
        if (is_cut[row]) ++count[static_cast<std::size_t>(mesh.carriers.corners[row].kind())];
    return count;
}

MeshInfo look_at(const InfoOptions& options) {
    auto file = read_input(options.mesh, options.input);
    weld_input(file, options.input);
    MeshInfo info;
    info.num_points = num_points(file.mesh);
    info.num_cells = file.mesh.num_cells();
    info.warnings = std::move(file.warnings);
    try {
        const auto built = topology::Mesh::build(file.mesh, scenario::weld_advice());
        info.warnings.insert(info.warnings.end(), built.warnings.begin(), built.warnings.end());
        info.joins = built.joins;
        info.num_components = topology::components(built.mesh).count;
        info.metrics = topology::measure(file.mesh);
        info.cut_cells = cut_cells_of(file.mesh);
        if (!file.mesh.carriers.is_empty())
            info.fragments = cutting::counts_of(built.mesh, fragments::FragmentMesh(built.mesh));
    } catch (const InputError& error) {
        throw InputError(prefixed(options.mesh.string() + ": ", error.what()));
    }
    return info;
}

nlohmann::ordered_json as_json(const MeshInfo& info) {
    const auto& m = info.metrics;
    nlohmann::ordered_json json;
    json["points"] = info.num_points;
    constexpr const char* keys[] = {"tets", "hexes", "wedges", "pyramids", "polyhedra"};
    for (std::size_t kind = 0; kind < std::size(keys); ++kind)
        json[keys[kind]] = m.num_of_kind[kind];
    if (m.num_of_kind[polyhedron] > 0)
        for (std::size_t kind = 0; kind < info.cut_cells.size(); ++kind)
            json["polyhedra_are_parts_of"][keys[kind]] = info.cut_cells[kind];
    json["components"] = info.num_components;
    if (!info.joins.empty()) json["joins"] = info.joins;
    json["volume"] = m.volume;
    json["surface_area"] = m.surface_area;
    json["bounding_box"] = {{"min", {m.box_min.x(), m.box_min.y(), m.box_min.z()}},
                            {"max", {m.box_max.x(), m.box_max.y(), m.box_max.z()}}};
    json["regions"] = nlohmann::ordered_json::object();
    for (const auto& [region, cells] : m.cells_of_region)
        json["regions"][std::to_string(region)] = cells;
    json["min_altitude"] = m.min_altitude;
    json["min_dihedral_deg"] = info.min_dihedral_degrees();
    json["edge_length"] = {
        {"min", m.min_edge_length}, {"mean", m.mean_edge_length}, {"max", m.max_edge_length}};
    if (info.fragments) {
        json["fragments"] = info.fragments->fragments;
        json["ghost_nodes"] = info.fragments->ghost_nodes;
        json["smallest_share"] = info.fragments->smallest_share;
    }
    json["warnings"] = info.warnings;
    return json;
}

/// Returns a text such as "54 hexahedra, 1 wedge".
std::string list_of(const std::array<std::size_t, topology::num_cell_kinds>& counts) {
    std::string text;
    for (std::size_t kind = 0; kind < counts.size(); ++kind) {
        if (counts[kind] == 0) continue;
        const auto& traits = topology::cell_traits[kind];
        text += (text.empty() ? "" : ", ") + std::to_string(counts[kind]) + " " +
                (counts[kind] == 1 ? traits.name : traits.plural);
    }
    return text;
}

void print_text(const MeshInfo& info) {
    const auto& m = info.metrics;
    std::printf("points           %zu\n", info.num_points);
    for (std::size_t kind = 0; kind < m.num_of_kind.size(); ++kind)
        if (m.num_of_kind[kind] > 0)
            std::printf(
                "%-16s %zu%s\n", topology::cell_traits[kind].plural, m.num_of_kind[kind],
                kind == polyhedron ? (", parts of " + list_of(info.cut_cells)).c_str() : "");
    for (const auto& [region, cells] : m.cells_of_region)
        std::printf("region %-9d %zu %s\n", region, cells, cells == 1 ? "cell" : "cells");
    for (const std::string& line : info.joins) std::printf("%s\n", line.c_str());
    std::printf("components       %d\n", info.num_components);
    std::printf("bounding box     %.6g %.6g %.6g to %.6g %.6g %.6g\n", m.box_min.x(), m.box_min.y(),
                m.box_min.z(), m.box_max.x(), m.box_max.y(), m.box_max.z());
    std::printf("volume           %.6g\n", m.volume);
    std::printf("surface area     %.6g\n", m.surface_area);
    std::printf("edge length      %.4g to %.4g, mean %.4g\n", m.min_edge_length, m.max_edge_length,
                m.mean_edge_length);
    if (info.fragments)
        std::printf("fragments        %zu, ghost nodes %zu, smallest share %.4g\n",
                    info.fragments->fragments, info.fragments->ghost_nodes,
                    info.fragments->smallest_share);
    std::printf("least altitude   %.4g\n", m.min_altitude);
    // Polyhedra have no part in it.
    if (m.num_of_kind[polyhedron] < info.num_cells)
        std::printf("least dihedral   %.4g degrees\n", info.min_dihedral_degrees());
}

/// Prints what is known about a surface or an image.
int print(const InfoOptions& options, const auto& info, const std::vector<std::string>& warnings) {
    if (options.json) {
        std::cout << json_of(info) << '\n';
        return done;
    }
    for (const auto& warning : warnings)
        print_warning(prefixed(options.mesh.string() + ": ", warning));
    std::cout << text_of(info);
    return done;
}

}  // namespace

int info(const InfoOptions& options) {
    if (io::has_surface_suffix(options.mesh)) {
        const auto surface = surface_info(options.mesh);
        return print(options, surface, surface.warnings);
    }
    if (io::has_image_suffix(options.mesh)) {
        const auto image = image_info(options.mesh);
        return print(options, image, image.image.warnings);
    }
    const auto info = look_at(options);
    if (options.json) {
        // Warnings may quote names from the file, which can have any encoding.
        std::cout << as_json(info).dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                  << '\n';
        return done;
    }
    for (const auto& warning : info.warnings)
        print_warning(prefixed(options.mesh.string() + ": ", warning));
    print_text(info);
    return done;
}

}  // namespace incise::app
