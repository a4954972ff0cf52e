// The headers of image files: what they say about the voxels, and where their values lie.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/types.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/scalar_type.h"

namespace incise::io {

/// Three axes, one value a voxel, x fastest. Lengths and frame are those of the file.
struct ImageHeader {
    enum class Encoding : std::uint8_t {
        raw,
        text,  ///< numbers, parted by blanks
        hex,   ///< two digits a byte
        zlib_or_gzip
    };

    std::array<std::int64_t, 3> dimensions{};
    Vec3 spacing = Vec3::Ones();
    Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();  ///< column a: unit vector of axis a
    Vec3 origin = Vec3::Zero();                                ///< centre of the first voxel

    ScalarType type = ScalarType::uint8;
    bool swap_bytes = false;
    double slope = 1.0, intercept = 0.0;  ///< value = slope * stored + intercept

    Encoding encoding = Encoding::raw;
    std::optional<std::filesystem::path> data_file;  ///< none: the file of the header
    std::size_t data_begin = 0;  ///< bytes, then lines before the values as they are stored
    std::size_t skip_lines = 0;
    std::size_t skip_bytes = 0;  ///< bytes before the values, once unpacked
    bool is_at_end = false;      ///< in place of these: the values are the last of their file
    std::optional<double> packed_size;  ///< bytes of the values as they are packed, if stated

    std::vector<std::string> warnings;

    /// Spacing and directions from the steps from voxel to voxel, one a column.
    void set_steps(const Eigen::Matrix3d& steps);
};

/// Whether the file begins as the format does.
bool begins_as_nifti(const InputFile& file);
bool begins_as_meta_image(const InputFile& file);
bool begins_as_nrrd(const InputFile& file);

/// NIfTI 1 and 2 in one file, also packed by gzip. The pose is the sform, else the qform, else
/// the voxel sizes alone, with a warning.
/// These three throw InputError that names the file, the field, its value and what to do; they
/// refuse images of fewer or more than three axes and of several components. Positive numbers of
/// voxels are checked here, the rest of the figures by read_label_image().
ImageHeader read_nifti_header(const InputFile& file);
/// MetaImage, the data in the same file or in another.
ImageHeader read_meta_image_header(const InputFile& file);
/// NRRD, the data in the same file or in another.
ImageHeader read_nrrd_header(const InputFile& file);

/// Dimensions from the numbers of a header. Throws InputError unless there are three, all positive
/// and of a product below 2^31.
std::array<std::int64_t, 3> image_dimensions(const InputFile& file,
                                             const std::vector<std::int64_t>& numbers);

/// The path of the data file that line `line` of a header names, which lies relative to the header.
/// Throws InputError for what can be no name of a file, and for the header itself.
std::filesystem::path data_file_path(const InputFile& file, std::string_view name,
                                     std::size_t line);

}  // namespace incise::io
