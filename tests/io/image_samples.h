// Small label images as bytes, made by hand: what their format's definition says, nothing of our
// own code.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/image/label_image.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {

/// The bytes of a number in either order.
template <class T>
std::string bytes_of(T value, bool is_big = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (is_big != (std::endian::native == std::endian::big))
        std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

template <class T>
std::string bytes_of(const std::vector<int>& values, bool is_big = false) {
    std::string bytes;
    for (const int value : values) bytes += bytes_of(static_cast<T>(value), is_big);
    return bytes;
}

/// 0, 1, ... 23, of 2 x 3 x 4 voxels.
inline std::vector<int> sample_labels() {
    std::vector<int> labels(24);
    std::iota(labels.begin(), labels.end(), 0);
    return labels;
}

inline std::string gzipped(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string packed(bytes.size() + 1000, '\0');
    auto copy = bytes;
    stream.next_in = reinterpret_cast<Bytef*>(copy.data());
    stream.avail_in = static_cast<uInt>(copy.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

/// The parts of a NIfTI image that matter. Spacing 1, 2, 3; no pose unless a code is set.
struct Nifti {
    std::vector<std::int64_t> dim = {3, 2, 3, 4};
    std::vector<double> pixdim = {1, 1, 2, 3};
    int datatype = 2;
    std::array<double, 2> scl{};
    int units = 2;
    int qform_code = 0, sform_code = 0;
    std::array<double, 6> quaternion_and_offset{};
    std::array<double, 12> srow{};
    std::string data = bytes_of<std::uint8_t>(sample_labels());
    bool is_big = false, is_second = false;

    std::string bytes() const {
        std::string bytes(is_second ? 544 : 352, '\0');
        const auto put = [&](std::size_t offset, auto value) {
            const auto part = bytes_of(value, is_big);
            std::copy(part.begin(), part.end(), bytes.data() + offset);
        };
        const auto integer = [&](std::size_t at_1, std::size_t at_2, std::int64_t value) {
            is_second ? put(at_2, static_cast<std::int32_t>(value))
                      : put(at_1, static_cast<std::int16_t>(value));
        };
        const auto real = [&](std::size_t at_1, std::size_t at_2, std::size_t i, double value) {
            is_second ? put(at_2 + 8 * i, value) : put(at_1 + 4 * i, static_cast<float>(value));
        };
        put(0, std::int32_t{is_second ? 540 : 348});
        bytes.replace(is_second ? 4 : 344, 4, is_second ? "n+2" : "n+1", 4);
        put(is_second ? 12 : 70, static_cast<std::int16_t>(datatype));
        for (std::size_t i = 0; i < dim.size(); ++i)
            is_second ? put(16 + 8 * i, dim[i])
                      : put(40 + 2 * i, static_cast<std::int16_t>(dim[i]));
        for (std::size_t i = 0; i < pixdim.size(); ++i) real(76, 104, i, pixdim[i]);
        is_second ? put(168, std::int64_t{544}) : put(108, 352.0F);
        for (std::size_t i = 0; i < 2; ++i) real(112, 176, i, scl[i]);
        is_second ? put(500, std::int32_t{units}) : put(123, static_cast<std::uint8_t>(units));
        integer(252, 344, qform_code);
        integer(254, 348, sform_code);
        for (std::size_t i = 0; i < 6; ++i) real(256, 352, i, quaternion_and_offset[i]);
        for (std::size_t i = 0; i < 12; ++i) real(280, 400, i, srow[i]);
        return bytes + data;
    }
};

/// Spacing 1, 2, 3, origin -10, 5, 7, axes along y, -x, z.
inline std::string meta_image_header(const std::string& data_file) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
           "CompressedData = False\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = -10 5 7\n"
           "CenterOfRotation = 0 0 0\nElementSpacing = 1 2 3\nDimSize = 2 3 4\n"
           "ElementType = MET_UCHAR\nElementDataFile = " +
           data_file + "\n";
}
inline std::string meta_image() {
    return meta_image_header("LOCAL") + bytes_of<std::uint8_t>(sample_labels());
}

/// The same pose.
inline std::string nrrd_header() {
    return "NRRD0005\n# a comment\ntype: unsigned char\ndimension: 3\n"
           "space: left-posterior-superior\nsizes: 2 3 4\n"
           "space directions: (0,1,0) (-2,0,0) (0, 0, 3)\nkinds: domain domain domain\n"
           "endian: little\nencoding: raw\nspace origin: (-10,5,7)\nkey:=value\n";
}
inline std::string nrrd() { return nrrd_header() + "\n" + bytes_of<std::uint8_t>(sample_labels()); }

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// Reads bytes as a file of this name, whose values are labels however they look.
inline LabelImage read_image(const std::string& name, const std::string& bytes) {
    const support::TemporaryFolder folder;
    write_bytes(folder / name, bytes);
    return read_label_image(folder / name, {.has_labels = true});
}

}  // namespace incise::io
