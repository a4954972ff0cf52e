// Surfaces in STL (.stl), ascii and binary.
// Source: 3D Systems, "StereoLithography Interface Specification" (1989).
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/surface/stl_reader.h"

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "incise/io/files/scalar_type.h"
#include "incise/io/files/scanner.h"
#include "incise/io/surface/surface_collector.h"

namespace incise::io {

namespace {

constexpr bool must_swap = std::endian::native == std::endian::big;
constexpr std::size_t title_size = 80;
constexpr std::size_t head_size = title_size + sizeof(std::uint32_t);
constexpr std::size_t triangle_size = 50;  // normal, three points, two unused bytes

bool is_text_stl(const InputFile& file) {
    // A binary file of the wrong size may also begin with "solid", but no text has zero bytes.
    return !is_binary_stl(file) && Scanner(file).accept("solid") &&
           file.bytes.find('\0') == std::string::npos;
}

class StlReader {
  public:
    explicit StlReader(const InputFile& file)
        : file_(file), scanner_(file), collector_(file, scanner_) {}

    SurfaceFile read() {
        is_text_stl(file_) ? read_text() : read_binary();
        collector_.merge_equal_points();
        return collector_.finish();
    }

  private:
    void read_text() {
        while (scanner_.accept("solid")) {
            scanner_.rest_of_line();  // the name: any text
            while (scanner_.accept("facet")) read_facet();
            expect("endsolid", "'facet' or 'endsolid'");
            scanner_.rest_of_line();
        }
        if (!scanner_.at_end())
            scanner_.fail_expected("'solid' or the end of the file", scanner_.token("'solid'"));
    }

    void read_facet() {
        expect("normal", "'normal'");
        // Not parsed, since the normal of a triangle without area may be any text, such as "nan".
        for (int i = 0; i < 3; ++i) scanner_.token("a component of the normal");
        expect("outer", "'outer loop'");
        expect("loop", "'outer loop'");
        for (int i = 0; i < 3; ++i) {
            expect("vertex", "'vertex' (a facet has three)");
            add_point<double>();
        }
        expect("endloop", "'endloop' (a facet has three vertices)");
        expect("endfacet", "'endfacet'");
        add_triangle();
    }

    void expect(std::string_view word, std::string_view what) {
        if (!scanner_.accept(word)) scanner_.fail_expected(what, scanner_.token(what));
    }

    void read_binary() {
        scanner_.set_binary(true, must_swap);
        const auto size = file_.bytes.size();
        if (size < head_size)
            scanner_.fail("is no STL file: has neither 'solid' and facets, as text, nor the " +
                          std::to_string(head_size) + " bytes with which binary files begin, but " +
                          std::to_string(size) + " bytes");
        scanner_.take(title_size, "the title");
        const auto num_triangles = scanner_.value<std::uint32_t>("the number of triangles");
        const auto expected_size = head_size + std::uint64_t{triangle_size} * num_triangles;
        if (size != expected_size)
            scanner_.fail("the number of triangles is " + std::to_string(num_triangles) +
                          ", for which a binary file has " + std::to_string(expected_size) +
                          " bytes; this one has " + std::to_string(size) +
                          (size < expected_size ? ", it is cut short or no STL file"
                                                : ", there is something behind the triangles"));
        for (std::uint32_t t = 0; t < num_triangles; ++t) {
            scanner_.take(3 * sizeof(float), "a normal");
            for (int i = 0; i < 3; ++i) add_point<float>();
            scanner_.take(sizeof(std::uint16_t), "the last two bytes of a triangle");
            add_triangle();
        }
    }

    template <class Real>
    void add_point() {
        const double x = scanner_.value<Real>("coordinate x");
        const double y = scanner_.value<Real>("coordinate y");
        const double z = scanner_.value<Real>("coordinate z");
        collector_.add_point({x, y, z});
    }

    void add_triangle() {
        const auto end = static_cast<std::int64_t>(collector_.num_points());
        collector_.add_polygon(std::array{end - 3, end - 2, end - 1});
    }

    const InputFile& file_;
    Scanner scanner_;
    SurfaceCollector collector_;
};

}  // namespace

bool is_binary_stl(const InputFile& file) {
    if (file.bytes.size() < head_size) return false;
    const auto num_triangles =
        load_scalar<std::uint32_t>(file.bytes.data() + title_size, must_swap);
    return file.bytes.size() == head_size + std::uint64_t{triangle_size} * num_triangles;
}

SurfaceFile read_stl(const InputFile& file) { return StlReader(file).read(); }

}  // namespace incise::io
