// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/mesh_report.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "incise/base/error.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::tetmesh {

namespace {

std::map<int, double> volumes_of(const topology::MeshData& mesh) {
    std::map<int, double> volumes;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        std::array<Vec3, 4> x;
        for (std::size_t k = 0; k < 4; ++k)
            x[k] = mesh.points[static_cast<std::size_t>(mesh.cell(c)[k])];
        volumes[mesh.regions[c]] += topology::signed_volume(mesh.kinds[c], x);
    }
    return volumes;
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
    std::array<char, 512> line;
    std::snprintf(line.data(), line.size(), format, values...);
    return line.data();
}

}  // namespace

std::string report_of(const std::string& name, const topology::MeshData& mesh) {
    const auto metrics = topology::measure(mesh);
    std::string text =
        name + formatted(": %zu tetrahedra, %zu nodes\n", mesh.num_cells(), mesh.points.size());
    for (const auto& [region, volume] : volumes_of(mesh))
        text += formatted("region %d: %zu tetrahedra, volume %.6g\n", region,
                          metrics.cells_of_region.at(region), volume);
    const auto &low = metrics.box_min, &high = metrics.box_max;
    text += formatted("volume %.6g, bounding box %.6g %.6g %.6g to %.6g %.6g %.6g\n",
                      metrics.volume, low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
    text += formatted("mean edge %.4g, least altitude %.4g, least dihedral angle %.4g degrees\n",
                      metrics.mean_edge_length, metrics.min_altitude,
                      metrics.min_dihedral_angle * 180.0 / std::numbers::pi);
    return text;
}

void refuse_other_volume(const topology::MeshData& mesh, const std::map<int, double>& volumes) {
    constexpr double most = 0.25;
    double wanted = 0.0, found = 0.0;
    for (const auto& [region, volume] : volumes) wanted += volume;
    for (const auto& [region, volume] : volumes_of(mesh)) found += volume;
    if (std::abs(found - wanted) <= most * wanted) return;
    throw InputError(formatted(
        "the mesh would have a volume of %.4g, and the input has %.4g, a difference of %.0f %%; at "
        "most 25 %% are allowed. The body, or a gap of it, is thinner than the edges: give a "
        "smaller "
        "--size or --size-surface",
        found, wanted, 100.0 * std::abs(found / wanted - 1.0)));
}

std::vector<std::string> losses_of(const topology::MeshData& mesh,
                                   const std::map<int, double>& volumes) {
    constexpr double much = 0.1;
    const auto made = volumes_of(mesh);
    std::vector<std::string> warnings;
    for (const auto& [region, volume] : volumes) {
        const auto found = made.find(region);
        if (found == made.end()) {
            warnings.push_back("region " + std::to_string(region) +
                               " has no tetrahedron; give a smaller --size");
            continue;
        }
        if (std::abs(found->second - volume) <= much * volume) continue;
        warnings.push_back(
            "region " + std::to_string(region) +
            formatted(" has a volume of %.4g in the mesh and of %.4g in the input, "
                      "more than 10 %% apart; give a smaller --size or --size-surface",
                      found->second, volume));
    }
    return warnings;
}

}  // namespace incise::tetmesh
