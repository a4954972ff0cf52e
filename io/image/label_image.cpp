// Reading of label images. The readers of VTK 9.1 are not used. If a MetaImage is cut short or has
// no data, VTK returns labels from uninitialized memory, without an error. It also ignores the
// directions. For NRRD, it takes the first of three axes for components.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/image/label_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/files/memory.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/scanner.h"
#include "incise/io/files/unpack.h"
#include "incise/io/image/grey_values.h"
#include "incise/io/image/image_header.h"

namespace incise::io {

namespace {

struct Format {
    const char* name;
    std::array<const char*, 2> suffixes;
    bool (*begins)(const InputFile&);
    ImageHeader (*read)(const InputFile&);
};

constexpr Format formats[] = {
    {"NIfTI", {".nii", ".nii.gz"}, begins_as_nifti, read_nifti_header},
    {"MetaImage", {".mha", ".mhd"}, begins_as_meta_image, read_meta_image_header},
    {"NRRD", {".nrrd", ".nhdr"}, begins_as_nrrd, read_nrrd_header},
};

const Format* format_by_suffix(const std::filesystem::path& path) {
    const auto name = lower_case(path.filename().string());
    for (const auto& format : formats)
        for (const auto* suffix : format.suffixes)
            if (name.ends_with(suffix)) return &format;
    return nullptr;
}

const Format& format_of(const InputFile& file) {
    for (const auto& format : formats)
        if (format.begins(file)) return format;
    if (const auto* format = format_by_suffix(file.path)) return *format;
    std::string known;
    for (const auto& format : formats)
        known += std::string(known.empty() ? "" : ", ") + format.name + " (" + format.suffixes[0] +
                 ", " + format.suffixes[1] + ")";
    throw InputError(file.name() +
                     ": begins like no image format known here; convert an image to one of: " +
                     known + ", and a surface to STL, PLY, OFF or OBJ");
}

/// Checks spacing, origin and directions, and normalizes the columns of the directions. If a column
/// has not the length 1, its length multiplies the spacing.
void settle_pose(const InputFile& file, ImageHeader& header) {
    constexpr double rounding = 1e-4;  // of the length of a direction, which should be 1
    constexpr double flattest = 1e-6;  // least volume of the box of the three directions
    for (int a = 0; a < 3; ++a) {
        const auto axis = "along axis " + std::to_string(a + 1);
        double& spacing = header.spacing[a];
        if (!(spacing > 0.0 && std::isfinite(spacing)))
            throw InputError(file.name() + ": the spacing of voxels " + axis + " is " +
                             shown(spacing) + "; it must be above 0 and finite");
        if (!std::isfinite(header.origin[a]))
            throw InputError(file.name() + ": the origin has " + shown(header.origin[a]) +
                             "; it must be finite");
        const double length = header.directions.col(a).norm();
        if (!(length > 0.0 && std::isfinite(length)))
            throw InputError(file.name() + ": the direction " + axis + " has the length " +
                             shown(length) + "; it must be 1");
        if (std::abs(length - 1.0) > rounding) spacing *= length;
        header.directions.col(a) /= length;
    }
    if (!(std::abs(header.directions.determinant()) > flattest))
        throw InputError(file.name() +
                         ": the directions of its three axes lie in a plane; correct its header");
}

class LabelDecoder {
  public:
    LabelDecoder(const InputFile& file, ImageHeader& header) : file_(file), header_(header) {
        const auto [x, y, z] = header.dimensions;
        num_voxels_ = static_cast<std::size_t>(x * y * z);
    }

    /// Returns the labels. `stored` is the contents of the file after data_begin and skip_lines.
    std::vector<int> decode(std::string_view stored) {
        using enum ImageHeader::Encoding;
        if (header_.encoding == text) return from_text(stored);
        const auto size = num_voxels_ * size_of(header_.type);
        if (header_.encoding == raw) return from_bytes(values_in(stored, size));
        if (header_.encoding == hex) return from_bytes(values_in(from_hex(stored), size));
        return from_bytes(values_unpacked_from(stored, size));
    }

  private:
    std::string values_unpacked_from(std::string_view packed, std::size_t size) {
        auto skip = header_.skip_bytes;
        std::optional<Unpacked> part;
        if (size <= max_unpacked(packed.size())) {
            require_image_memory(static_cast<double>(packed.size() + size));
            if (header_.is_at_end) {
                const auto whole = unpacked(packed, 0, 0);  // counts its bytes
                skip = whole ? whole->num_behind - std::min(size, whole->num_behind) : 0;
            }
            part = unpacked(packed, skip, size);
        }
        if (!part)
            throw InputError(file_.name() + ": the packed data are damaged, or end before " +
                             std::to_string(skip + size) +
                             " bytes are unpacked, as the header has it; get it anew");
        warn_of_surplus(part->num_behind);
        return std::move(part->bytes);
    }

    std::string_view values_in(std::string_view bytes, std::size_t size) {
        auto skip = header_.skip_bytes;
        if (header_.is_at_end && bytes.size() >= size) skip = bytes.size() - size;
        if (skip > bytes.size() || bytes.size() - skip < size)
            throw InputError(file_.name() + ": ends too early: its header announces " +
                             std::to_string(size) + " bytes of values, and there are " +
                             std::to_string(bytes.size() - std::min(skip, bytes.size())) +
                             "; get it anew");
        warn_of_surplus(bytes.size() - skip - size);
        return bytes.substr(skip, size);
    }

    void warn_of_surplus(std::size_t num_bytes) {
        if (num_bytes == 0) return;
        header_.warnings.push_back(file_.name() + " has " + std::to_string(num_bytes) +
                                   (num_bytes == 1 ? " byte" : " bytes") +
                                   " behind the values that its header announces, which "
                                   "are not read; check the dimensions and the type");
    }

    std::string from_hex(std::string_view text) const {
        const auto digit = [&](char c) {
            if (c >= '0' && c <= '9') return c - '0';
            if (c >= 'a' && c <= 'f') return c - 'a' + 10;
            if (c >= 'A' && c <= 'F') return c - 'A' + 10;
            throw InputError(file_.name() + ": expected hexadecimal digits, found " +
                             in_quotes(std::string_view(&c, 1)));
        };
        std::string bytes;
        int high = -1;
        for (const char c : text) {
            if (is_blank(c)) continue;
            if (high < 0) {
                high = digit(c);
            } else {
                bytes += static_cast<char>(16 * high + digit(c));
                high = -1;
            }
        }
        return bytes;
    }

    std::vector<int> from_text(std::string_view text) const {
        std::vector<int> labels;
        std::size_t end = std::min(header_.skip_bytes, text.size());
        while (labels.size() < num_voxels_) {
            auto begin = end;
            while (begin < text.size() && is_blank(text[begin])) ++begin;
            end = begin;
            while (end < text.size() && !is_blank(text[end])) ++end;
            const auto word = text.substr(begin, end - begin);
            if (word.empty())
                throw InputError(file_.name() + ": ends too early: its header announces " +
                                 std::to_string(num_voxels_) + " values, and there are " +
                                 std::to_string(labels.size()) + "; get it anew");
            const auto value = parse_number<double>(word);
            if (!value)
                throw InputError(file_.name() + ": " + voxel(labels.size()) +
                                 ": expected a number, found " + in_quotes(word));
            labels.push_back(label_of(labels.size(), *value));
        }
        return labels;
    }

    std::vector<int> from_bytes(std::string_view bytes) const {
        switch (header_.type) {
            case ScalarType::int8:
                return from<std::int8_t>(bytes);
            case ScalarType::uint8:
                return from<std::uint8_t>(bytes);
            case ScalarType::int16:
                return from<std::int16_t>(bytes);
            case ScalarType::uint16:
                return from<std::uint16_t>(bytes);
            case ScalarType::int32:
                return from<std::int32_t>(bytes);
            case ScalarType::uint32:
                return from<std::uint32_t>(bytes);
            case ScalarType::int64:
                return from<std::int64_t>(bytes);
            case ScalarType::uint64:
                return from<std::uint64_t>(bytes);
            case ScalarType::float32:
                return from<float>(bytes);
            case ScalarType::float64:
                return from<double>(bytes);
        }
        return {};
    }

    /// Throws InputError if the machine has not enough memory for the labels and `other_bytes`.
    void require_image_memory(double other_bytes) const {
        require_memory(other_bytes + 4.0 * static_cast<double>(num_voxels_),
                       file_.name() + ": the image", "crop it or make it coarser");
    }

    template <class Stored>
    std::vector<int> from(std::string_view bytes) const {
        require_image_memory(static_cast<double>(bytes.size()));
        std::vector<int> labels(num_voxels_);
        for (std::size_t v = 0; v < num_voxels_; ++v)
            labels[v] = label_of(
                v, load_scalar<Stored>(bytes.data() + v * sizeof(Stored), header_.swap_bytes));
        return labels;
    }

    template <class Stored>
    int label_of(std::size_t v, Stored stored) const {
        if constexpr (std::integral<Stored>) {
            if (header_.slope == 1.0 && header_.intercept == 0.0) {
                if (!std::in_range<int>(stored)) fail_range(v, std::to_string(stored));
                return static_cast<int>(stored);
            }
        }
        const double value = header_.slope * static_cast<double>(stored) + header_.intercept;
        if (std::trunc(value) != value || !std::isfinite(value))
            throw InputError(file_.name() + ": " + voxel(v) + " has the value " + shown(value) +
                             ", and labels are whole numbers; give a segmentation, not an image "
                             "of intensities");
        if (!(value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max()))
            fail_range(v, shown(value));
        return static_cast<int>(value);
    }

    [[noreturn]] void fail_range(std::size_t v, const std::string& value) const {
        throw InputError(file_.name() + ": " + voxel(v) + " has the label " + value +
                         ", beyond the range of 32 bits; number the labels anew");
    }

    std::string voxel(std::size_t v) const {
        const auto x = static_cast<std::size_t>(header_.dimensions[0]);
        const auto y = static_cast<std::size_t>(header_.dimensions[1]);
        return "voxel (" + std::to_string(v % x) + ", " + std::to_string(v / x % y) + ", " +
               std::to_string(v / x / y) + ")";
    }

    const InputFile& file_;
    ImageHeader& header_;  ///< not const, since warnings are added to it
    std::size_t num_voxels_;
};

/// Reads the data file of a header. Binary data have no byte order mark, so that three bytes that
/// load_input_file() removed as one are restored.
InputFile load_data_file(const InputFile& header_file, const std::filesystem::path& path) {
    try {
        auto file = load_input_file(path);
        if (file.bytes.size() < std::filesystem::file_size(path))
            file.bytes.insert(0, "\xEF\xBB\xBF");
        return file;
    } catch (const InputError& error) {
        throw InputError(header_file.name() + ": its data: " + error.what());
    }
}

/// Throws InputError if there are fewer bytes than the header states. Writers round that number to
/// six digits.
void require_packed(const InputFile& file, const ImageHeader& header, std::size_t num_stored) {
    constexpr double rounding = 1e-5;
    if (!header.packed_size) return;
    if (!(*header.packed_size <= (1.0 + rounding) * static_cast<double>(num_stored)))
        throw InputError(file.name() + ": ends too early: its header announces " +
                         shown(*header.packed_size) + " bytes of packed values, and there are " +
                         std::to_string(num_stored) + "; get it anew");
}

std::string_view without_lines(std::string_view bytes, std::size_t num_lines) {
    for (; num_lines > 0 && !bytes.empty(); --num_lines)
        bytes.remove_prefix(std::min(bytes.find('\n'), bytes.size() - 1) + 1);
    return bytes;
}

}  // namespace

bool has_image_suffix(const std::filesystem::path& path) {
    return format_by_suffix(path) != nullptr;
}

std::string_view image_format_of(const InputFile& file) {
    for (const auto& format : formats)
        if (format.begins(file)) return format.name;
    return {};
}

void ImageHeader::set_steps(const Eigen::Matrix3d& steps) {
    for (int a = 0; a < 3; ++a) {
        spacing[a] = steps.col(a).norm();
        directions.col(a) = steps.col(a) / spacing[a];
    }
}

std::array<std::int64_t, 3> image_dimensions(const InputFile& file,
                                             const std::vector<std::int64_t>& numbers) {
    if (numbers.size() != 3)
        throw InputError(file.name() + ": is an image of " + std::to_string(numbers.size()) +
                         (numbers.size() == 1 ? " axis" : " axes") +
                         "; a mesh takes one of three, with one label a voxel");
    std::array<std::int64_t, 3> dimensions{};
    double product = 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
        dimensions[a] = numbers[a];
        if (numbers[a] < 1)
            throw InputError(file.name() + ": has " + std::to_string(numbers[a]) +
                             " voxels along axis " + std::to_string(a + 1) +
                             "; its header is damaged");
        product *= static_cast<double>(numbers[a]);
    }
    if (product > std::numeric_limits<std::int32_t>::max())
        throw InputError(file.name() + ": has more than 2147483647 voxels; crop it");
    return dimensions;
}

std::filesystem::path data_file_path(const InputFile& file, std::string_view name,
                                     std::size_t line) {
    constexpr std::size_t longest = 1000;
    const auto refuse = [&](const std::string& message) {
        throw InputError(file.name() + ":" + std::to_string(line) + ": " + message);
    };
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; };
    if (name.empty()) refuse("names no file for the data");
    if (name.size() > longest || std::ranges::any_of(name, is_control))
        refuse("the name of the data file, " + in_quotes(name) +
               ", is too long or has control characters; the header is damaged");
    auto path = file.path.parent_path() / std::string(name);
    std::error_code error;  // if a file does not exist, the files are not the same
    if (std::filesystem::equivalent(path, file.path, error))
        refuse("names itself as the file of the data; name the file that has the values");
    return path;
}

LabelImage read_label_image(const std::filesystem::path& path, const LabelImageOptions& options) {
    const auto file = load_input_file(path);
    auto header = format_of(file).read(file);
    settle_pose(file, header);

    const auto data = header.data_file ? load_data_file(file, *header.data_file) : InputFile{};
    const auto& data_file = header.data_file ? data : file;
    const auto stored = std::string_view(data_file.bytes)
                            .substr(std::min(header.data_begin, data_file.bytes.size()));
    require_packed(data_file, header, stored.size());
    LabelImage image;
    image.labels = LabelDecoder(data_file, header).decode(without_lines(stored, header.skip_lines));
    if (std::ranges::all_of(image.labels, [](int label) { return label == 0; }))
        throw InputError(file.name() + ": no voxel with a label: all are 0");
    const auto grey = options.has_labels ? std::nullopt : sign_of_grey_values(image.labels);
    if (grey)
        throw InputError(file.name() + ": looks like a scan, an image of grey values: it has " +
                         *grey + "; give a segmentation of it, or, if each value is a label, " +
                         options.advice);
    image.dimensions = header.dimensions;
    image.spacing = header.spacing;
    image.origin = header.origin;
    image.directions = header.directions;
    image.warnings = std::move(header.warnings);
    return image;
}

}  // namespace incise::io
