// The header of MetaImage files (.mha, and .mhd with the data in another file).
// Source: the MetaIO documentation. The rows of TransformMatrix are the directions of the axes, as
// in itkMetaImageIO.cxx of ITK.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <bit>
#include <map>

#include "incise/base/error.h"
#include "incise/io/files/line_words.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/scanner.h"
#include "incise/io/image/image_header.h"

namespace incise::io {

namespace {

struct Entry {
    std::string_view value;
    std::size_t line = 0;
};

class Entries {
  public:
    /// Reads the entries. By definition ElementDataFile is the last one.
    explicit Entries(const InputFile& file) : file_(file) {
        const std::string_view bytes = file.bytes;
        std::size_t line = 1;
        for (std::size_t begin = 0; begin < bytes.size(); ++line) {
            const auto end = std::min(bytes.find('\n', begin), bytes.size());
            const auto text = bytes.substr(begin, end - begin);
            begin = end + 1;
            if (trimmed(text).empty()) continue;
            const auto sign = text.find('=');
            if (sign == text.npos)
                throw InputError(file.name() + ":" + std::to_string(line) +
                                 ": expected KEY = VALUE, found " + in_quotes(text));
            const auto key = std::string(trimmed(text.substr(0, sign)));
            entries_[key] = {trimmed(text.substr(sign + 1)), line};
            if (key == "ElementDataFile") {
                data_begin_ = std::min(begin, bytes.size());
                return;
            }
        }
        throw InputError(file.name() +
                         ": its header has no ElementDataFile, which ends it; get it anew");
    }

    std::size_t data_begin() const { return data_begin_; }

    const Entry* find(std::initializer_list<const char*> names) const {
        for (const auto* name : names)
            if (const auto found = entries_.find(name); found != entries_.end())
                return &found->second;
        return nullptr;
    }
    const Entry& need(const char* name) const {
        if (const auto* entry = find({name})) return *entry;
        throw InputError(file_.name() + ": its header has no " + name +
                         "; is it a MetaImage? Get it anew");
    }
    bool flag(std::initializer_list<const char*> names, bool usual) const {
        const auto* entry = find(names);
        if (!entry) return usual;
        const auto first = entry->value.empty() ? ' ' : entry->value.front();
        return first == 'T' || first == 't' || first == '1';
    }
    template <class T>
    std::vector<T> numbers(const Entry& entry, std::size_t count) const {
        std::vector<std::string_view> words;
        append_words(entry.value, words);
        if (words.size() != count)
            fail(entry,
                 "expected " + std::to_string(count) + " numbers, found " + in_quotes(entry.value));
        std::vector<T> numbers;
        for (const auto word : words) {
            const auto number = parse_number<T>(word);
            if (!number) fail(entry, "expected a number, found " + in_quotes(word));
            numbers.push_back(*number);
        }
        return numbers;
    }
    [[noreturn]] void fail(const Entry& entry, const std::string& message) const {
        throw InputError(file_.name() + ":" + std::to_string(entry.line) + ": " + message);
    }

  private:
    const InputFile& file_;
    std::map<std::string, Entry> entries_;
    std::size_t data_begin_ = 0;
};

ScalarType type_of(const Entries& entries, const Entry& entry) {
    constexpr std::pair<std::string_view, ScalarType> types[] = {
        {"MET_CHAR", ScalarType::int8},       {"MET_UCHAR", ScalarType::uint8},
        {"MET_SHORT", ScalarType::int16},     {"MET_USHORT", ScalarType::uint16},
        {"MET_INT", ScalarType::int32},       {"MET_UINT", ScalarType::uint32},
        {"MET_LONG", ScalarType::int32},      {"MET_ULONG", ScalarType::uint32},
        {"MET_LONG_LONG", ScalarType::int64}, {"MET_ULONG_LONG", ScalarType::uint64},
        {"MET_FLOAT", ScalarType::float32},   {"MET_DOUBLE", ScalarType::float64},
    };
    for (const auto& [name, type] : types)
        if (entry.value == name) return type;
    entries.fail(entry, "ElementType " + in_quotes(entry.value) +
                            " is not one number a voxel; give an image of one label a voxel");
}

void set_pose(ImageHeader& header, const Entries& entries) {
    const auto vector = [&](const Entry& entry) {
        const auto n = entries.numbers<double>(entry, 3);
        return Vec3(n[0], n[1], n[2]);
    };
    if (const auto* spacing = entries.find({"ElementSpacing", "ElementSize"}))
        header.spacing = vector(*spacing);
    else
        header.warnings.push_back("states no ElementSpacing; 1 is taken");
    if (const auto* origin = entries.find({"Offset", "Position", "Origin"}))
        header.origin = vector(*origin);
    if (const auto* matrix = entries.find({"TransformMatrix", "Rotation", "Orientation"})) {
        const auto n = entries.numbers<double>(*matrix, 9);
        header.directions = Eigen::Map<const Eigen::Matrix3d>(n.data());  // rows become columns
    }
}

void set_place(ImageHeader& header, const InputFile& file, const Entries& entries) {
    const auto& data = entries.need("ElementDataFile");
    const auto word = data.value.substr(0, data.value.find_first_of(" \t"));
    if (word == "LIST" || data.value.find('%') != data.value.npos)
        entries.fail(data, "data in a list of files are not read; save the image as one .mha file");
    if (data.value == "LOCAL" || data.value == "Local" || data.value == "local")
        header.data_begin = entries.data_begin();
    else
        header.data_file = data_file_path(file, data.value, data.line);
    if (const auto* skip = entries.find({"HeaderSize"})) {
        const auto bytes = entries.numbers<std::int64_t>(*skip, 1)[0];
        if (bytes < -1) entries.fail(*skip, "HeaderSize cannot be " + std::to_string(bytes));
        header.is_at_end = bytes == -1;
        // HeaderSize counts from the beginning of the file, also if the data are local.
        if (bytes > 0) header.data_begin = static_cast<std::size_t>(bytes);
    }
}

}  // namespace

bool begins_as_meta_image(const InputFile& file) {
    const auto begin = file.bytes.find_first_not_of(" \t\r\n");
    if (begin == file.bytes.npos) return false;
    const auto head = std::string_view(file.bytes).substr(begin);
    return head.starts_with("ObjectType") || head.starts_with("NDims");
}

ImageHeader read_meta_image_header(const InputFile& file) {
    const Entries entries(file);
    if (const auto* object = entries.find({"ObjectType"}); object && object->value != "Image")
        entries.fail(*object, "ObjectType is " + in_quotes(object->value) + ", not an image");
    const auto& rank = entries.need("NDims");
    const auto num_axes = entries.numbers<std::int64_t>(rank, 1)[0];
    if (num_axes < 1 || num_axes > 10)
        entries.fail(rank, "NDims cannot be " + std::to_string(num_axes));

    ImageHeader header;
    header.dimensions = image_dimensions(
        file,
        entries.numbers<std::int64_t>(entries.need("DimSize"), static_cast<std::size_t>(num_axes)));
    if (const auto* channels = entries.find({"ElementNumberOfChannels"}))
        if (const auto count = entries.numbers<std::int64_t>(*channels, 1)[0]; count != 1)
            entries.fail(*channels, "has more than one component a voxel (" +
                                        std::to_string(count) +
                                        "); give an image of one label a voxel");
    header.type = type_of(entries, entries.need("ElementType"));
    const bool is_big = entries.flag({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, false);
    header.swap_bytes = is_big != (std::endian::native == std::endian::big);
    if (!entries.flag({"BinaryData"}, true))
        header.encoding = ImageHeader::Encoding::text;
    else if (entries.flag({"CompressedData"}, false))
        header.encoding = ImageHeader::Encoding::zlib_or_gzip;
    const auto* packed_size = entries.find({"CompressedDataSize"});
    if (packed_size && header.encoding == ImageHeader::Encoding::zlib_or_gzip)
        header.packed_size = entries.numbers<double>(*packed_size, 1)[0];
    set_pose(header, entries);
    set_place(header, file, entries);
    return header;
}

}  // namespace incise::io
