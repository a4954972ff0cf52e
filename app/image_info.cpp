// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/image_info.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "incise/app/surface_info.h"

namespace incise::app {

namespace {

template <class... Values>
std::string printed(const char* format, Values... values) {
    std::array<char, 256> line;
    std::snprintf(line.data(), line.size(), format, values...);
    return line.data();
}

bool is_left_handed(const io::LabelImage& image) { return image.directions.determinant() < 0.0; }

std::string voxels_text(const io::LabelImage& image) {
    const auto [x, y, z] = image.dimensions;
    return std::to_string(x) + " x " + std::to_string(y) + " x " + std::to_string(z);
}

nlohmann::ordered_json json_vector(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

}  // namespace

Vec3 ImageInfo::extent() const {
    Vec3 extent;
    for (int a = 0; a < 3; ++a)
        extent[a] =
            image.spacing[a] * static_cast<double>(image.dimensions[static_cast<std::size_t>(a)]);
    return extent;
}

double ImageInfo::voxel_volume() const {
    return image.spacing.prod() * std::abs(image.directions.determinant());
}

ImageInfo image_info(const std::filesystem::path& path) {
    ImageInfo info;
    info.image =
        io::read_label_image(path, {.has_labels = false, .advice = "mesh it with --labels"});
    for (const int label : info.image.labels) ++info.voxels_of_label[label];
    info.command = command_for_mesh(path, Box(Vec3::Zero(), info.extent()));
    return info;
}

std::string text_of(const ImageInfo& info) {
    const io::LabelImage& image = info.image;
    const auto three = [](const char* name, const Vec3& x) {
        return printed("%-16s %.6g %.6g %.6g\n", name, x.x(), x.y(), x.z());
    };
    std::string text = "voxels           " + voxels_text(image) + "\n";
    text += three("spacing", image.spacing) + three("extent", info.extent()) +
            three("first centre", image.origin);
    constexpr const char* axes[] = {"first axis", "second axis", "third axis"};
    for (int a = 0; a < 3; ++a) text += three(axes[a], image.directions.col(a));
    if (is_left_handed(image)) text += "handedness       left\n";
    for (const auto& [label, voxels] : info.voxels_of_label)
        text += printed("label %-10d %zu %s", label, voxels, voxels == 1 ? "voxel" : "voxels") +
                (label == 0 ? std::string(", background\n")
                            : printed(", volume %.6g\n",
                                      static_cast<double>(voxels) * info.voxel_volume()));
    return text + "an image is no body; to make one: " + info.command + "\n";
}

std::string json_of(const ImageInfo& info) {
    const io::LabelImage& image = info.image;
    nlohmann::ordered_json json;
    json["dimensions"] = image.dimensions;
    json["spacing"] = json_vector(image.spacing);
    json["extent"] = json_vector(info.extent());
    json["origin"] = json_vector(image.origin);
    json["directions"] = nlohmann::ordered_json::array();
    for (int a = 0; a < 3; ++a)
        json["directions"].push_back(json_vector(Vec3(image.directions.col(a))));
    json["left_handed"] = is_left_handed(image);
    json["voxel_volume"] = info.voxel_volume();
    json["labels"] = nlohmann::ordered_json::object();
    for (const auto& [label, voxels] : info.voxels_of_label)
        json["labels"][std::to_string(label)] = voxels;
    json["command"] = info.command;
    json["warnings"] = image.warnings;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string summary_of(const ImageInfo& info) {
    const std::size_t num_labels = info.voxels_of_label.size() - info.voxels_of_label.count(0);
    const Vec3 extent = info.extent();
    return "label image of " + voxels_text(info.image) + " voxels with " +
           std::to_string(num_labels) + (num_labels == 1 ? " label" : " labels") +
           printed(", extent %.6g x %.6g x %.6g", extent.x(), extent.y(), extent.z()) +
           "; to make a body of it: " + info.command;
}

}  // namespace incise::app
