// Images in which every voxel has a label (segmentations).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/types.h"
#include "incise/io/files/input_file.h"

namespace incise::io {

/// An image of labels. Voxel (i, j, k), numbered from 0, is a box with edges `spacing`. Its centre
/// is origin + directions * (i spacing[0], j spacing[1], k spacing[2]). Lengths are in the unit of
/// the file, usually millimetres. The frame is that of the file; see read_label_image().
struct LabelImage {
    std::array<std::int64_t, 3> dimensions{};  ///< voxels along each axis; product below 2^31
    Vec3 spacing = Vec3::Ones();               ///< positive
    Vec3 origin = Vec3::Zero();                ///< centre of voxel (0, 0, 0)
    /// Column a is the unit vector of axis a. Not singular; may be left-handed.
    Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
    std::vector<int> labels;            ///< i fastest, then j; 0 is background
    std::vector<std::string> warnings;  ///< one sentence each, without the name of the file

    int label(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return labels[static_cast<std::size_t>(i + dimensions[0] * (j + dimensions[1] * k))];
    }
};

/// True if the name ends as those of the images that read_label_image() reads.
bool has_image_suffix(const std::filesystem::path& path);

/// Returns the name of the image format with which a file begins, or an empty text.
std::string_view image_format_of(const InputFile& file);

/// Options of read_label_image().
struct LabelImageOptions {
    /// True if the image has labels, however it looks. Else an image that looks like a scan is
    /// refused; see grey_values.h.
    bool has_labels = false;
    /// What that refusal tells the user to do. The default is for programs that use the library.
    std::string advice = "set LabelImageOptions::has_labels";
};

/// Reads NIfTI (1 and 2, .nii and .nii.gz), MetaImage (.mha, .mhd) and NRRD (.nrrd, .nhdr). The
/// contents of the file decide its format, or else its suffix.
///
/// Frames are not converted. The axes x, y and z of NIfTI point to the right, the front and the
/// head (RAS); its pose is the sform, or else the qform. Those of MetaImage usually point to the
/// left, the back and the head (LPS). Those of NRRD are usually the same; its field `space` states
/// them. Measurement frames and names of labels are not read.
///
/// Floating-point types are read if all values are whole numbers. All counts and offsets are
/// checked, as in read_mesh(). Throws InputError that names the file and the line, field or voxel,
/// the value and a remedy. The reasons, besides a missing or damaged file:
/// - other than three axes, or more than one component a voxel
/// - values that are not whole numbers in the range of int
/// - spacings that are not positive and finite, or directions that lie in a plane
/// - more than 256 different values, or values below 0, unless the options allow them
/// - an image without a label, or one that does not fit in memory
///
/// Cost: some nanoseconds a voxel. Memory: the unpacked file, and four bytes a voxel.
LabelImage read_label_image(const std::filesystem::path& path,
                            const LabelImageOptions& options = {});

}  // namespace incise::io
