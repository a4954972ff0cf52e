// Images in which every voxel has a label: segmentations.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "incise/base/types.h"

namespace incise::io {

/// Voxel (i, j, k), from 0, has its centre at origin + directions * (i, j, k) * spacing and is a
/// box of edges `spacing` about it. Lengths are in the file's unit, usually millimetres; the frame
/// is the file's own, see read_label_image().
struct LabelImage {
    std::array<std::int64_t, 3> dimensions{};  ///< voxels along each axis; product below 2^31
    Vec3 spacing = Vec3::Ones();               ///< positive
    Vec3 origin = Vec3::Zero();                ///< centre of voxel (0, 0, 0)
    /// Column a is the unit vector of axis a. Not singular; left-handed ones are left so.
    Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
    std::vector<int> labels;            ///< i fastest, then j; 0 is background
    std::vector<std::string> warnings;  ///< one sentence each, without the name of the file

    int label(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return labels[static_cast<std::size_t>(i + dimensions[0] * (j + dimensions[1] * k))];
    }
};

/// Reads NIfTI (1 and 2, .nii and .nii.gz), MetaImage (.mha, .mhd) and NRRD (.nrrd, .nhdr); the
/// format is told by the content first, by the suffix second.
///
/// Frames: NIfTI's x, y and z point to the right, the front and the head (RAS), the pose is the
/// sform, else the qform. MetaImage's and NRRD's are left as they are in the file: usually to the
/// left, the back and the head (LPS), in NRRD what the field `space` says.
///
/// Floating types are read if all values are whole numbers. The contents are trusted in nothing,
/// as in read_mesh(). Refused besides what is damaged or not there: other than three axes, more
/// than one component a voxel, values that are no whole numbers in the range of int, spacings that
/// are not positive and finite, directions in a plane, an image without a label, and what does not
/// fit in memory. Left out: measurement frames, and names of labels.
/// Throws InputError that names the file and the line, field or voxel, the value and what to do.
/// Cost: some nanoseconds a voxel; the file, unpacked, and four bytes a voxel are in memory.
LabelImage read_label_image(const std::filesystem::path& path);

}  // namespace incise::io
