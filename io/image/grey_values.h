// Recognition of images of grey values, such as scans, that were given as label images.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

namespace incise::io {

/// An image with more different values than this is taken for a scan. Segmentations of a whole body
/// have some hundred labels, scans some thousand values.
inline constexpr std::size_t most_labels = 256;
/// So few different values are labels, however they are spread; and so few voxels tell nothing.
inline constexpr std::size_t few_labels = 20, least_voxels = 20000;

/// Returns what about the values tells an image of grey values, or nothing if they can be labels:
/// more than most_labels different values, values below 0, or more than few_labels values in
/// least_voxels or more that change from voxel to voxel.
/// Cost: a nanosecond a voxel, and more where neighbours differ.
std::optional<std::string> sign_of_grey_values(std::span<const int> values);

}  // namespace incise::io
