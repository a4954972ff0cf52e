// A small surface in every format and encoding that the readers of surfaces know.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "tests/io/surface_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "incise/io/files/number_text.h"

namespace incise::io {

using topology::SurfaceData;

SurfaceData Polygons::triangulated() const {
    SurfaceData result{points, {}};
    for (const auto& polygon : polygons)
        for (std::size_t i = 2; i < polygon.size(); ++i)
            result.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    return result;
}

Polygons tetrahedron() {
    return {{{0, 0, 0}, {0, 1.5, 0}, {1e-3f, 0, 0}, {-0.25, 0, 1e6}},
            {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
}

Polygons cube() {
    return {
        {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
        {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 3, 5, 4}, {1, 7, 6, 2}, {0, 4, 7, 1}, {3, 2, 6, 5}}};
}

namespace {

std::string text_of(const Vec3& point) {
    return shown(point.x()) + " " + shown(point.y()) + " " + shown(point.z());
}

template <class T>
void append_bytes(std::string& bytes, T value, bool is_big = false) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (is_big != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

/// Points and faces among other properties and elements of many types.
class PlyText {
  public:
    explicit PlyText(std::string encoding) : encoding_(std::move(encoding)) {}

    std::string of(const Polygons& surface, bool are_faces_first) {
        bytes_ = "ply\nformat " + encoding_ + " 1.0\ncomment made by hand\nobj_info x\n";
        const std::string points =
            "element vertex " + std::to_string(surface.points.size()) +
            "\nproperty uchar red\nproperty float x\nproperty list uchar short other\n"
            "property double y\nproperty float32 z\n";
        const std::string faces =
            "element face " + std::to_string(surface.polygons.size()) +
            "\nproperty int8 flag\nproperty list uint16 int32 vertex_indices\nproperty double q\n";
        bytes_ += "element camera 2\nproperty float f\nproperty list int uint other\n";
        bytes_ += are_faces_first ? faces + points : points + faces;
        bytes_ += "element nothing 4000000000\nelement edge 1\nproperty ushort a\nend_header\n";
        for (int i = 0; i < 2; ++i) {
            put(1.5f);
            put<std::int32_t>(i);
            for (int j = 0; j < i; ++j) put<std::uint32_t>(9);
            end_line();
        }
        if (are_faces_first) put_faces(surface);
        for (const auto& point : surface.points) {
            put<std::uint8_t>(255);
            put(static_cast<float>(point.x()));
            put<std::uint8_t>(2);
            put<std::int16_t>(-10);
            put<std::int16_t>(10);
            put(point.y());
            put(static_cast<float>(point.z()));
            end_line();
        }
        if (!are_faces_first) put_faces(surface);
        put<std::uint16_t>(3);
        end_line();
        return bytes_;
    }

  private:
    void put_faces(const Polygons& surface) {
        for (const auto& polygon : surface.polygons) {
            put<std::int8_t>(-1);
            put(static_cast<std::uint16_t>(polygon.size()));
            for (const auto corner : polygon) put(static_cast<std::int32_t>(corner));
            put(0.125);
            end_line();
        }
    }
    template <class T>
    void put(T value) {
        if (!is_ascii())
            append_bytes(bytes_, value, encoding_ == "binary_big_endian");
        else
            bytes_ += shown(static_cast<double>(value)) + " ";
    }
    void end_line() {
        if (is_ascii()) bytes_ += "\n";
    }
    bool is_ascii() const { return encoding_ == "ascii"; }

    std::string encoding_;
    std::string bytes_;
};

}  // namespace

std::string ascii_stl(const SurfaceData& surface) {
    std::string text = "solid a name\n";
    for (const auto& triangle : surface.triangles) {
        text += "  facet normal -nan(ind) 0 1\n    outer loop\n";
        for (const auto corner : triangle)
            text +=
                "      vertex " + text_of(surface.points[static_cast<std::size_t>(corner)]) + "\n";
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid a name\n";
}

std::string binary_stl(const SurfaceData& surface, std::string title) {
    std::string bytes = std::move(title);
    bytes.resize(80, ' ');
    append_bytes(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
    for (const auto& triangle : surface.triangles) {
        for (int i = 0; i < 3; ++i) append_bytes(bytes, std::nanf(""));
        for (const auto corner : triangle)
            for (const double x : surface.points[static_cast<std::size_t>(corner)])
                append_bytes(bytes, static_cast<float>(x));
        append_bytes(bytes, std::uint16_t{7});
    }
    return bytes;
}

std::string obj(const Polygons& surface) {
    std::string text = "# made by hand\nmtllib a.mtl\no part\n";
    for (const auto& point : surface.points) text += "v " + text_of(point) + " 1 0 0\n";
    text += "vt 0 0\nvn 0 0 1\ng a b\nusemtl red\ns off\nl 1 2\n";
    const std::array<const char*, 4> forms = {"", "/1", "//1", "/1/1"};
    for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
        const bool is_last = p + 1 == surface.polygons.size();
        text += "f";
        for (const auto corner : surface.polygons[p])
            text += ' ' +
                    std::to_string(is_last ? corner - std::ssize(surface.points) : corner + 1) +
                    forms[p % forms.size()];
        text += "  # a face\n";
    }
    return text;
}

std::string off(const Polygons& surface, const std::string& keyword) {
    std::string text = "# made by hand\n" + keyword + "\n# counts\n" +
                       std::to_string(surface.points.size()) + " " +
                       std::to_string(surface.polygons.size()) + " 0\n\n";
    for (const auto& point : surface.points) text += text_of(point) + " 0.5 0.5 0.5 1 # a point\n";
    for (const auto& polygon : surface.polygons) {
        text += std::to_string(polygon.size());
        for (const auto corner : polygon) text += ' ' + std::to_string(corner);
        text += "  255 0 0\n";
    }
    return text;
}

std::string ply(const Polygons& surface, const std::string& encoding, bool are_faces_first) {
    return PlyText(encoding).of(surface, are_faces_first);
}

std::vector<Sample> surface_samples(const Polygons& surface) {
    const auto triangulated = surface.triangulated();
    std::vector<Sample> samples = {{"ascii.stl", ascii_stl(triangulated)},
                                   {"binary.stl", binary_stl(triangulated)},
                                   {"solid.stl", binary_stl(triangulated, "solid like ascii")},
                                   {"ascii.obj", obj(surface)},
                                   {"ascii.off", off(surface)},
                                   {"ascii-colours.off", off(surface, "STCNOFF")}};
    for (const std::string encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
        for (const bool are_faces_first : {false, true})
            samples.push_back({encoding + (are_faces_first ? "-faces-first" : "") + ".ply",
                               ply(surface, encoding, are_faces_first)});
    return samples;
}

}  // namespace incise::io
