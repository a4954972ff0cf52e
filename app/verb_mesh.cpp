// incise mesh: generates a mesh from a label image.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <set>

#include "incise/app/messages.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/image/label_mesh.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/scenario/table_reader.h"
#include "incise/topology/geometry.h"

namespace incise::app {

namespace {

double parse_positive(const std::string& option, const std::string& text) {
    const auto value = io::parse_number<double>(text);
    if (value && *value > 0.0 && std::isfinite(*value)) return *value;
    throw InputError(option + ": " + scenario::in_quotes(text) +
                     " is not allowed; it must be a number above 0");
}

struct Summary {
    std::map<int, std::size_t> cells_of_region;
    double volume = 0.0;
    Vec3 box_min, box_max;
};

Summary summarize(const topology::MeshData& mesh) {
    Summary summary;
    summary.box_min = summary.box_max = mesh.points.front();
    for (const Vec3& point : mesh.points) {
        summary.box_min = summary.box_min.cwiseMin(point);
        summary.box_max = summary.box_max.cwiseMax(point);
    }
    std::array<Vec3, topology::max_corners> corners;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        std::size_t n = 0;
        for (const auto corner : mesh.cell(c))
            corners[n++] = mesh.points[static_cast<std::size_t>(corner)];
        summary.volume += topology::signed_volume(mesh.kinds[c], {corners.data(), n});
        ++summary.cells_of_region[mesh.regions[c]];
    }
    return summary;
}

void scale(topology::MeshData& mesh, double factor) {
    for (Vec3& point : mesh.points) point *= factor;
    const auto summary = summarize(mesh);
    if (!(summary.volume > 0.0 && std::isfinite(summary.volume)))
        throw InputError("--scale: " + io::shown(factor) +
                         " makes coordinates beyond the range of numbers; give one nearer to 1");
}

/// Warns of labels of the image that no cell has, because no centre of a cube has the label.
void warn_of_lost_labels(const std::string& prefix, const io::LabelImage& image,
                         const topology::MeshData& mesh) {
    std::set<int> lost(image.labels.begin(), image.labels.end());
    lost.erase(0);
    for (const int region : mesh.regions) lost.erase(region);
    for (const int label : lost)
        print_warning(prefix + "label " + std::to_string(label) +
                      " has no cell: no cube has its centre in it; give a smaller --size");
}

topology::MeshData make(const MeshOptions& options) {
    std::optional<double> size;
    if (!options.size.empty()) size = parse_positive("--size", options.size);
    const double factor = options.scale.empty() ? 1.0 : parse_positive("--scale", options.scale);

    const std::string prefix = options.in.string() + ": ";
    const auto image = io::read_label_image(
        options.in, {.has_labels = options.labels, .advice = "say so with --labels"});
    for (const auto& warning : image.warnings) print_warning(prefixed(prefix, warning));
    try {
        auto mesh = io::hex_mesh(image, size);
        if (size) warn_of_lost_labels(prefix, image, mesh);
        if (factor != 1.0) scale(mesh, factor);
        return mesh;
    } catch (const InputError& error) {
        throw InputError(prefixed(prefix, error.what()));
    }
}

void print(const std::string& out, const topology::MeshData& mesh) {
    const auto summary = summarize(mesh);
    std::printf("%s: %zu cells, %zu points; ", out.c_str(), mesh.num_cells(), mesh.points.size());
    for (const auto& [region, cells] : summary.cells_of_region)
        std::printf("region %d: %zu; ", region, cells);
    const auto &low = summary.box_min, &high = summary.box_max;
    std::printf("volume %.6g, bounding box %.6g %.6g %.6g to %.6g %.6g %.6g\n", summary.volume,
                low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
}

}  // namespace

int mesh(const MeshOptions& options) {
    io::check_writable(options.out);
    if (!options.hex)
        throw InputError(
            "tetrahedra cannot be made from images by this version yet: use --hex for hexahedra, "
            "or mesh the image with a mesher such as gmsh, saved as .msh (2 or 4.1), .vtu or .vtk");
    const auto made = make(options);
    io::write_mesh(options.out, made);
    print(options.out.string(), made);
    return done;
}

}  // namespace incise::app
