// The header of NRRD files (.nrrd, and .nhdr with the data in another file).
// Source: G. Kindlmann, Definition of the NRRD file format, teem.sourceforge.net/nrrd/format.html
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <map>

#include "incise/base/error.h"
#include "incise/io/files/line_words.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/scanner.h"
#include "incise/io/image/image_header.h"

namespace incise::io {

namespace {

struct HeaderField {
    std::string_view value;
    std::size_t line = 0;
};

class NrrdFields {
  public:
    explicit NrrdFields(const InputFile& file) : file_(file) {
        const std::string_view bytes = file.bytes;
        std::size_t line = 1;
        for (std::size_t begin = 0; begin < bytes.size(); ++line) {
            const auto end = std::min(bytes.find('\n', begin), bytes.size());
            auto text = bytes.substr(begin, end - begin);
            begin = end + 1;
            data_begin_ = std::min(begin, bytes.size());
            if (text.ends_with('\r')) text.remove_suffix(1);
            if (text.empty()) return;  // end of the header
            if (line == 1 || text.front() == '#') continue;
            const auto colon = text.find(':');
            if (colon == text.npos)
                throw InputError(file.name() + ":" + std::to_string(line) +
                                 ": expected FIELD: VALUE, found " + in_quotes(text));
            if (text.substr(colon).starts_with(":=")) continue;  // a key of the user, not a field
            fields_[lower_case(text.substr(0, colon))] = {trimmed(text.substr(colon + 1)), line};
        }
    }

    std::size_t data_begin() const { return data_begin_; }

    const HeaderField* find(std::initializer_list<const char*> names) const {
        for (const auto* name : names)
            if (const auto found = fields_.find(name); found != fields_.end())
                return &found->second;
        return nullptr;
    }
    const HeaderField& need(const char* name) const {
        if (const auto* field = find({name})) return *field;
        throw InputError(file_.name() + ": its header has no field '" + name +
                         "'; is it a NRRD image? Get it anew");
    }
    template <class T>
    T number(const HeaderField& field, std::string_view text) const {
        const auto number = parse_number<T>(trimmed(text));
        if (!number) fail(field, "expected a number, found " + in_quotes(text));
        return *number;
    }
    std::vector<std::string_view> words(const HeaderField& field, std::size_t count) const {
        std::vector<std::string_view> words;
        append_words(field.value, words);
        if (words.size() != count)
            fail(field,
                 "expected " + std::to_string(count) + " values, found " + in_quotes(field.value));
        return words;
    }
    template <class T>
    std::vector<T> numbers(const HeaderField& field, std::size_t count) const {
        std::vector<T> numbers;
        for (const auto word : words(field, count)) numbers.push_back(number<T>(field, word));
        return numbers;
    }
    /// Returns vectors that are written as (x,y,z).
    std::vector<Vec3> vectors(const HeaderField& field, std::size_t count) const {
        std::vector<Vec3> vectors;
        auto rest = field.value;
        while (!(rest = trimmed(rest)).empty()) {
            const auto end = rest.find(')');
            if (rest.front() != '(' || end == rest.npos)
                fail(field, "expected vectors as (x,y,z), found " + in_quotes(rest));
            vectors.push_back(vector(field, rest.substr(1, end - 1)));
            rest.remove_prefix(end + 1);
        }
        if (vectors.size() != count)
            fail(field, "expected " + std::to_string(count) + " vectors, found " +
                            std::to_string(vectors.size()));
        return vectors;
    }
    [[noreturn]] void fail(const HeaderField& field, const std::string& message) const {
        throw InputError(file_.name() + ":" + std::to_string(field.line) + ": " + message);
    }

  private:
    Vec3 vector(const HeaderField& field, std::string_view text) const {
        Vec3 vector;
        for (int i = 0; i < 3; ++i) {
            const auto comma = std::min(text.find(','), text.size());
            if ((comma == text.size()) != (i == 2))
                fail(field, "expected vectors of three numbers, found " + in_quotes(field.value));
            vector[i] = number<double>(field, text.substr(0, comma));
            text.remove_prefix(std::min(comma + 1, text.size()));
        }
        return vector;
    }

    const InputFile& file_;
    std::map<std::string, HeaderField> fields_;
    std::size_t data_begin_ = 0;
};

ScalarType type_of(const NrrdFields& fields) {
    constexpr std::pair<std::string_view, ScalarType> types[] = {
        {"signed char", ScalarType::int8},
        {"int8", ScalarType::int8},
        {"int8_t", ScalarType::int8},
        {"uchar", ScalarType::uint8},
        {"unsigned char", ScalarType::uint8},
        {"uint8", ScalarType::uint8},
        {"uint8_t", ScalarType::uint8},
        {"short", ScalarType::int16},
        {"short int", ScalarType::int16},
        {"signed short", ScalarType::int16},
        {"signed short int", ScalarType::int16},
        {"int16", ScalarType::int16},
        {"int16_t", ScalarType::int16},
        {"ushort", ScalarType::uint16},
        {"unsigned short", ScalarType::uint16},
        {"unsigned short int", ScalarType::uint16},
        {"uint16", ScalarType::uint16},
        {"uint16_t", ScalarType::uint16},
        {"int", ScalarType::int32},
        {"signed int", ScalarType::int32},
        {"int32", ScalarType::int32},
        {"int32_t", ScalarType::int32},
        {"uint", ScalarType::uint32},
        {"unsigned int", ScalarType::uint32},
        {"uint32", ScalarType::uint32},
        {"uint32_t", ScalarType::uint32},
        {"longlong", ScalarType::int64},
        {"long long", ScalarType::int64},
        {"long long int", ScalarType::int64},
        {"signed long long", ScalarType::int64},
        {"signed long long int", ScalarType::int64},
        {"int64", ScalarType::int64},
        {"int64_t", ScalarType::int64},
        {"ulonglong", ScalarType::uint64},
        {"unsigned long long", ScalarType::uint64},
        {"unsigned long long int", ScalarType::uint64},
        {"uint64", ScalarType::uint64},
        {"uint64_t", ScalarType::uint64},
        {"float", ScalarType::float32},
        {"double", ScalarType::float64},
    };
    const auto& field = fields.need("type");
    for (const auto& [name, type] : types)
        if (field.value == name) return type;
    fields.fail(field, "type " + in_quotes(field.value) +
                           " is not one number a voxel; give an image of one label a voxel");
}

/// Throws InputError for axes that are not spatial: colours, vectors, segments, time.
void require_axes_of_space(const NrrdFields& fields, std::size_t num_axes) {
    const auto refuse = [&](const HeaderField& field, std::string_view kind) {
        fields.fail(field, "has an axis " + in_quotes(kind) +
                               " that is not of space, that is more than one component a voxel; "
                               "give an image of one label a voxel");
    };
    if (const auto* kinds = fields.find({"kinds"}))
        for (const auto kind : fields.words(*kinds, num_axes))
            if (kind != "domain" && kind != "space" && kind != "???" && kind != "none")
                refuse(*kinds, kind);
    if (const auto* directions = fields.find({"space directions"}))
        if (directions->value.find("none") != std::string_view::npos) refuse(*directions, "none");
}

void set_encoding(ImageHeader& header, const NrrdFields& fields) {
    using enum ImageHeader::Encoding;
    constexpr std::pair<std::string_view, ImageHeader::Encoding> encodings[] = {
        {"raw", raw}, {"txt", text},          {"text", text},       {"ascii", text},
        {"hex", hex}, {"gzip", zlib_or_gzip}, {"gz", zlib_or_gzip},
    };
    const auto& field = fields.need("encoding");
    const auto name = lower_case(field.value);
    const auto* found = std::ranges::find(encodings, name, [](auto& row) { return row.first; });
    if (found == std::end(encodings))
        fields.fail(field, "encoding " + in_quotes(field.value) +
                               " is not read here; save the image as raw or gzip");
    header.encoding = found->second;
    if (header.encoding == text || size_of(header.type) == 1) return;
    const auto& endian = fields.need("endian");
    if (endian.value != "little" && endian.value != "big")
        fields.fail(endian, "endian must be little or big, found " + in_quotes(endian.value));
    header.swap_bytes = (endian.value == "big") != (std::endian::native == std::endian::big);
}

void set_pose_by_fields(ImageHeader& header, const NrrdFields& fields) {
    if (const auto* directions = fields.find({"space directions"})) {
        const auto vectors = fields.vectors(*directions, 3);
        Eigen::Matrix3d steps;
        for (std::size_t a = 0; a < 3; ++a) steps.col(static_cast<Eigen::Index>(a)) = vectors[a];
        header.set_steps(steps);
    } else if (const auto* spacings = fields.find({"spacings"})) {
        const auto n = fields.numbers<double>(*spacings, 3);
        header.spacing = Vec3(n[0], n[1], n[2]);
    } else {
        header.warnings.push_back("states neither space directions nor spacings; 1 is taken");
    }
    if (const auto* origin = fields.find({"space origin"}))
        header.origin = fields.vectors(*origin, 1)[0];
}

void set_place(ImageHeader& header, const InputFile& file, const NrrdFields& fields) {
    if (const auto* data = fields.find({"data file", "datafile"})) {
        if (data->value.starts_with("LIST") || data->value.find('%') != data->value.npos)
            fields.fail(*data,
                        "data in a list of files are not read; save the image as one .nrrd file");
        header.data_file = data_file_path(file, data->value, data->line);
    } else {
        header.data_begin = fields.data_begin();
    }
    if (const auto* skip = fields.find({"line skip", "lineskip"}))
        header.skip_lines = fields.number<std::uint32_t>(*skip, skip->value);
    if (const auto* skip = fields.find({"byte skip", "byteskip"})) {
        header.is_at_end = skip->value == "-1";
        if (!header.is_at_end) header.skip_bytes = fields.number<std::uint32_t>(*skip, skip->value);
    }
}

}  // namespace

bool begins_as_nrrd(const InputFile& file) { return file.bytes.starts_with("NRRD000"); }

ImageHeader read_nrrd_header(const InputFile& file) {
    if (!begins_as_nrrd(file))
        throw InputError(file.name() +
                         ": does not begin as a NRRD image; check what it is, or get it anew");
    const NrrdFields fields(file);
    const auto& dimension = fields.need("dimension");
    const auto num_axes = fields.number<std::uint32_t>(dimension, dimension.value);
    if (num_axes < 1 || num_axes > 16)
        fields.fail(dimension, "dimension cannot be " + std::to_string(num_axes));
    require_axes_of_space(fields, num_axes);

    ImageHeader header;
    header.dimensions =
        image_dimensions(file, fields.numbers<std::int64_t>(fields.need("sizes"), num_axes));
    header.type = type_of(fields);
    set_encoding(header, fields);
    set_pose_by_fields(header, fields);
    set_place(header, file, fields);
    return header;
}

}  // namespace incise::io
