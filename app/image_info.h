// What incise info and incise check say about a label image.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "incise/io/image/label_image.h"

namespace incise::app {

/// A label image and what is in it.
struct ImageInfo {
    io::LabelImage image;
    std::map<int, std::size_t> voxels_of_label;  ///< with those of the background, 0
    std::string command;  ///< that makes a mesh of it, with a size for a first try

    Vec3 extent() const;  ///< along the axes of the image, in the unit of the file
    double voxel_volume() const;
};

/// Reads a label image. Throws InputError as io::read_label_image() does.
ImageInfo image_info(const std::filesystem::path& path);

/// Returns lines about the image, for people.
std::string text_of(const ImageInfo& info);
/// Returns the same as one JSON object.
std::string json_of(const ImageInfo& info);
/// Returns the same in short: "label image of 64 x 64 x 32 voxels, ...".
std::string summary_of(const ImageInfo& info);

}  // namespace incise::app
