// incise mesh: makes hexahedra of a label image, or starts incise-tetmesh, which makes tetrahedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "incise/app/companion.h"
#include "incise/app/messages.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/image/label_mesh.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/io/surface/surface_reader.h"
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

void scale(io::LabelImage& image, double factor) {
    image.spacing *= factor;
    image.origin *= factor;
    const double volume = image.spacing.prod();
    if (!(volume > 0.0 && std::isfinite(volume) && image.origin.allFinite()))
        throw InputError("--scale: " + io::shown(factor) +
                         " makes coordinates beyond the range of numbers; give one nearer to 1");
}

topology::MeshData make_hexahedra(const std::string& in, const MeshOptions& options) {
    std::optional<double> size;
    if (!options.size.empty()) size = parse_positive("--size", options.size);
    const double factor = options.scale.empty() ? 1.0 : parse_positive("--scale", options.scale);

    const std::string prefix = in + ": ";
    auto image =
        io::read_label_image(in, {.has_labels = options.labels, .advice = "say so with --labels"});
    for (const auto& warning : image.warnings) print_warning(prefixed(prefix, warning));
    try {
        scale(image, factor);
        auto mesh = io::hex_mesh(image, size);
        if (size) warn_of_lost_labels(prefix, image, mesh);
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

/// Makes hexahedra of an image. Throws InputError for what is only for tetrahedra.
int mesh_of_hexahedra(const MeshOptions& options) {
    const std::string &in = options.files.front(), &out = options.files.back();
    if (options.files.size() > 2 || io::has_surface_suffix(in))
        throw InputError("--hex makes cubes of one label image, and " + options.files[0] +
                         (options.files.size() > 2 ? " is not the only file" : " is a surface") +
                         "; leave --hex out for tetrahedra");
    for (const auto& [name, value] : {std::pair("--size-surface", options.size_surface),
                                      std::pair("--features", options.features)})
        if (!value.empty())
            throw InputError(std::string(name) +
                             " is for tetrahedra, and cubes are all alike; leave it or --hex out");
    io::check_writable(out);
    const auto made = make_hexahedra(in, options);
    io::write_mesh(out, made);
    print(out, made);
    return done;
}

/// Lets incise-tetmesh make tetrahedra. Throws InputError for options that it would refuse too, so
/// that the message is the same where the program is not there.
int mesh_of_tetrahedra(const MeshOptions& options) {
    if (options.size.empty())
        throw InputError(
            "--size is required for tetrahedra: give the length of their edges, in the unit of the "
            "mesh; or --hex for one cube a voxel");
    std::vector<std::string> words = options.files;
    for (const auto& [name, value] :
         {std::pair("--size", options.size), std::pair("--size-surface", options.size_surface),
          std::pair("--features", options.features), std::pair("--scale", options.scale)}) {
        if (value.empty()) continue;
        parse_positive(name, value);
        words.push_back(name + ("=" + value));
    }
    if (options.labels) words.push_back("--labels");
    io::check_writable(options.files.back());
    return run_companion("incise-tetmesh", words,
                         "it is built together with incise where CGAL's mesh generator is "
                         "(libcgal-dev, CMake option INCISE_TETMESH); without it, --hex makes "
                         "hexahedra of label images");
}

}  // namespace

int mesh(const MeshOptions& options) {
    if (options.files.size() < 2)
        throw InputError("OUT is required: name the files to read, then the file to write");
    return options.hex ? mesh_of_hexahedra(options) : mesh_of_tetrahedra(options);
}

}  // namespace incise::app
