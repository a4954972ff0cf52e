// The header of NIfTI images, versions 1 and 2.
// Source: nifti1.h and nifti2.h of the NIfTI Data Format Working Group.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/unpack.h"
#include "incise/io/image/image_header.h"

namespace incise::io {

namespace {

constexpr std::size_t size_of_1 = 348, size_of_2 = 540;

/// Returns the bytes of the header, unpacked, and no more than the longer header has.
std::string header_bytes(const InputFile& file) {
    return begins_as_gzip(file.bytes) ? unpacked_prefix(file.bytes, size_of_2)
                                      : file.bytes.substr(0, size_of_2);
}

struct Layout {
    std::size_t size;  ///< 0: not NIfTI
    bool swap;
};

Layout layout_of(std::string_view bytes) {
    if (bytes.size() < sizeof(std::int32_t)) return {0, false};
    for (const bool swap : {false, true})
        for (const auto size : {size_of_1, size_of_2})
            if (load_scalar<std::int32_t>(bytes.data(), swap) == static_cast<std::int32_t>(size))
                return {size, swap};
    return {0, false};
}

/// The fields of the header, of either version.
class NiftiFields {
  public:
    NiftiFields(std::string_view bytes, bool swap, bool is_second)
        : bytes_(bytes), swap_(swap), is_second_(is_second) {}

    std::string_view magic() const { return bytes_.substr(is_second_ ? 4 : 344, 3); }
    std::int64_t dim(std::size_t i) const {
        return is_second_ ? at<std::int64_t>(16 + 8 * i) : at<std::int16_t>(40 + 2 * i);
    }
    int datatype() const { return at<std::int16_t>(is_second_ ? 12 : 70); }
    double pixdim(std::size_t i) const { return real(76, 104, i); }
    double data_offset() const {
        return is_second_ ? static_cast<double>(at<std::int64_t>(168)) : at<float>(108);
    }
    double slope() const { return real(112, 176); }
    double intercept() const { return real(116, 184); }
    int units() const {
        return is_second_ ? at<std::int32_t>(500) : static_cast<unsigned char>(bytes_[123]);
    }
    int qform_code() const { return is_second_ ? at<std::int32_t>(344) : at<std::int16_t>(252); }
    int sform_code() const { return is_second_ ? at<std::int32_t>(348) : at<std::int16_t>(254); }
    double quaternion(std::size_t i) const { return real(256, 352, i); }
    double qoffset(std::size_t i) const { return real(268, 376, i); }
    double srow(std::size_t row, std::size_t column) const {
        return real(280, 400, 4 * row + column);
    }

  private:
    template <class T>
    T at(std::size_t offset) const {
        return load_scalar<T>(bytes_.data() + offset, swap_);
    }
    double real(std::size_t offset_1, std::size_t offset_2, std::size_t i = 0) const {
        return is_second_ ? at<double>(offset_2 + 8 * i) : at<float>(offset_1 + 4 * i);
    }

    std::string_view bytes_;
    bool swap_, is_second_;
};

ScalarType type_of(const InputFile& file, int datatype) {
    switch (datatype) {
        case 2:
            return ScalarType::uint8;
        case 4:
            return ScalarType::int16;
        case 8:
            return ScalarType::int32;
        case 16:
            return ScalarType::float32;
        case 64:
            return ScalarType::float64;
        case 256:
            return ScalarType::int8;
        case 512:
            return ScalarType::uint16;
        case 768:
            return ScalarType::uint32;
        case 1024:
            return ScalarType::int64;
        case 1280:
            return ScalarType::uint64;
        case 32:
        case 128:
        case 1792:
        case 2304:
            throw InputError(file.name() +
                             ": has more than one component a voxel (colours or complex numbers); "
                             "give an image of one label a voxel");
        default:
            throw InputError(file.name() + ": its data type " + std::to_string(datatype) +
                             " is not known; save it with a whole number of 8 to 64 bits a voxel");
    }
}

std::array<std::int64_t, 3> dimensions_of(const InputFile& file, const NiftiFields& fields) {
    const auto rank = fields.dim(0);
    if (rank < 1 || rank > 7)
        throw InputError(file.name() + ": has " + std::to_string(rank) +
                         " axes by its header, which is damaged");
    std::vector<std::int64_t> numbers;
    for (std::size_t i = 1; i <= static_cast<std::size_t>(rank); ++i) {
        if (i == 4 && fields.dim(i) > 1)
            throw InputError(file.name() + ": has " + std::to_string(fields.dim(i)) +
                             " images in time; save one of them");
        if (i > 4 && fields.dim(i) > 1)
            throw InputError(file.name() + ": has more than one component a voxel (" +
                             std::to_string(fields.dim(i)) +
                             "); give an image of one label a voxel");
        if (i <= 3) numbers.push_back(fields.dim(i));
    }
    return image_dimensions(file, numbers);
}

void set_sform(ImageHeader& header, const NiftiFields& fields) {
    Eigen::Matrix3d steps;
    for (std::size_t row = 0; row < 3; ++row) {
        const auto r = static_cast<Eigen::Index>(row);
        for (std::size_t column = 0; column < 3; ++column)
            steps(r, static_cast<Eigen::Index>(column)) = fields.srow(row, column);
        header.origin[r] = fields.srow(row, 3);
    }
    header.set_steps(steps);

    constexpr double tolerance = 0.01;  // above the rounding errors of all writers
    for (std::size_t a = 0; a < 3; ++a) {
        const double size = std::abs(fields.pixdim(a + 1));
        const double step = header.spacing[static_cast<Eigen::Index>(a)];
        if (std::abs(size - step) > tolerance * step)
            header.warnings.push_back(
                "along axis " + std::to_string(a + 1) + " the voxel size is " + shown(size) +
                ", but the sform steps by " + shown(step) + "; the sform is used");
    }
}

void set_qform(ImageHeader& header, const NiftiFields& fields) {
    const double b = fields.quaternion(0), c = fields.quaternion(1), d = fields.quaternion(2);
    const double a = std::sqrt(std::max(0.0, 1.0 - b * b - c * c - d * d));
    header.directions = Eigen::Quaterniond(a, b, c, d).normalized().toRotationMatrix();
    if (fields.pixdim(0) < 0.0) header.directions.col(2) *= -1.0;
    for (std::size_t i = 0; i < 3; ++i)
        header.origin[static_cast<Eigen::Index>(i)] = fields.qoffset(i);
}

void set_pose_by_forms(ImageHeader& header, const NiftiFields& fields) {
    for (std::size_t i = 0; i < 3; ++i)
        header.spacing[static_cast<Eigen::Index>(i)] = fields.pixdim(i + 1);
    if (fields.sform_code() > 0)
        set_sform(header, fields);
    else if (fields.qform_code() > 0)
        set_qform(header, fields);
    else
        header.warnings.push_back(
            "says nothing of where the image lies (neither sform nor qform): its first voxel is "
            "put at 0, its axes along x, y and z");
    const int length_unit = fields.units() & 7;
    if (length_unit == 1 || length_unit == 3)
        header.warnings.push_back(std::string("its lengths are in ") +
                                  (length_unit == 1 ? "metres" : "micrometres") +
                                  ", not in millimetres; they are left so");
}

}  // namespace

bool begins_as_nifti(const InputFile& file) {
    const auto bytes = header_bytes(file);
    const auto layout = layout_of(bytes);
    return layout.size != 0 && bytes.size() >= layout.size;
}

ImageHeader read_nifti_header(const InputFile& file) {
    const bool is_packed = begins_as_gzip(file.bytes);
    const auto bytes = header_bytes(file);
    const auto layout = layout_of(bytes);
    if (bytes.size() < (layout.size == 0 ? size_of_1 : layout.size))
        throw InputError(file.name() + ": ends within the header of a NIfTI image; get it anew");
    if (layout.size == 0)
        throw InputError(file.name() +
                         ": does not begin as a NIfTI image; check what it is, or get it anew");
    const NiftiFields fields(bytes, layout.swap, layout.size == size_of_2);
    if (fields.magic() != (layout.size == size_of_2 ? "n+2" : "n+1"))
        throw InputError(file.name() +
                         ": is no NIfTI image in one file (Analyze, or a pair of .hdr and .img); "
                         "save it as .nii or .nii.gz");

    ImageHeader header;
    header.dimensions = dimensions_of(file, fields);
    header.type = type_of(file, fields.datatype());
    header.swap_bytes = layout.swap;
    const double slope = fields.slope(), intercept = fields.intercept();
    if (std::isfinite(slope) && std::isfinite(intercept) && slope != 0.0) {  // 0: none
        header.slope = slope;
        header.intercept = intercept;
    }
    const double offset = fields.data_offset();
    if (!(offset >= static_cast<double>(layout.size) && offset < 0x1p40))
        throw InputError(file.name() + ": its data begin at byte " + shown(offset) +
                         " by its header, which is damaged");
    header.skip_bytes = static_cast<std::size_t>(offset);
    if (is_packed) header.encoding = ImageHeader::Encoding::zlib_or_gzip;
    set_pose_by_forms(header, fields);
    return header;
}

}  // namespace incise::io
