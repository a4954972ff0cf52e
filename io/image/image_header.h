// The headers of image files: the form of the voxels, and where their values are in the file.
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

/// The header of an image with three axes and one value a voxel, x fastest. Lengths are in the unit
/// of the file, and positions in its frame.
struct ImageHeader {
    enum class Encoding : std::uint8_t {
        raw,
        text,  ///< numbers, separated by blanks
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
    std::size_t data_begin = 0;                      ///< bytes to skip in the stored data
    std::size_t skip_lines = 0;                      ///< lines to skip after these bytes
    std::size_t skip_bytes = 0;  ///< bytes to skip after these lines, in the unpacked data
    bool is_at_end = false;      ///< true if the values are the last bytes; replaces skip_bytes
    std::optional<double> packed_size;  ///< bytes of the packed values, if the header has it

    std::vector<std::string> warnings;

    /// Sets spacing and directions. Column a of `steps` is the vector from a voxel to the next one
    /// along axis a.
    void set_steps(const Eigen::Matrix3d& steps);
};

/// True if the file begins as a NIfTI image does.
bool begins_as_nifti(const InputFile& file);
/// True if the file begins as a MetaImage does.
bool begins_as_meta_image(const InputFile& file);
/// True if the file begins as a NRRD image does.
bool begins_as_nrrd(const InputFile& file);

/// Reads the header of NIfTI 1 or 2 in one file, which may be packed by gzip. The pose is the
/// sform, or else the qform, or else the voxel sizes alone, with a warning.
///
/// This function and the next two throw InputError that names the file, the field, its value and a
/// remedy. They refuse images with other than three axes or with several components. They check the
/// numbers of voxels; read_label_image() checks the other numbers.
ImageHeader read_nifti_header(const InputFile& file);
/// Reads the header of a MetaImage, with the data in the same file or in another.
ImageHeader read_meta_image_header(const InputFile& file);
/// Reads the header of a NRRD image, with the data in the same file or in another.
ImageHeader read_nrrd_header(const InputFile& file);

/// Returns the dimensions that a header gives as numbers. Throws InputError unless there are three,
/// all are positive, and their product is below 2^31.
std::array<std::int64_t, 3> image_dimensions(const InputFile& file,
                                             const std::vector<std::int64_t>& numbers);

/// Returns the path of the data file that line `line` of a header names. The name is relative to
/// the folder of the header. Throws InputError if the name is no valid file name, or if it is that
/// of the header itself.
std::filesystem::path data_file_path(const InputFile& file, std::string_view name,
                                     std::size_t line);

}  // namespace incise::io
