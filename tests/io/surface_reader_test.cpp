// Surfaces: every format gives the same one; what is refused; damaged files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/surface/surface_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/surface/obj_reader.h"
#include "incise/io/surface/off_reader.h"
#include "incise/io/surface/ply_reader.h"
#include "incise/io/surface/stl_reader.h"
#include "tests/io/reader_samples.h"
#include "tests/io/surface_samples.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using topology::SurfaceData;

SurfaceFile read(const std::string& name, std::string_view bytes) {
    const support::TemporaryFolder folder;
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return read_surface(folder / name);
}

/// The message with which the bytes are refused, without the folder.
std::string surface_refusal(const std::string& name, std::string_view bytes) {
    const support::TemporaryFolder folder;
    std::ofstream(folder / name, std::ios::binary) << bytes;
    try {
        read_surface(folder / name);
    } catch (const InputError& error) {
        const std::string message = error.what();
        const auto prefix = folder.path().string() + "/";
        EXPECT_TRUE(message.starts_with(prefix + name + ":")) << message;
        return message.substr(std::min(prefix.size(), message.size()));
    }
    ADD_FAILURE() << name << " was not refused";
    return {};
}

// --- What all formats share

void expect_same_surface(const SurfaceData& actual, const SurfaceData& expected) {
    EXPECT_EQ(actual.points, expected.points);
    EXPECT_EQ(actual.triangles, expected.triangles);
}

TEST(SurfaceReader, ReadsTheSameSurfaceFromEveryFormat) {
    for (const auto& surface : {tetrahedron(), cube()})
        for (const auto& sample : surface_samples(surface)) {
            SCOPED_TRACE(sample.name);
            const auto file = read(sample.name, sample.bytes);
            expect_same_surface(file.surface, surface.triangulated());
            EXPECT_THAT(file.warnings, IsEmpty());
        }
}

TEST(SurfaceReader, RecognizesFormatsByContentWhateverTheSuffix) {
    for (auto sample : surface_samples(cube())) {
        SCOPED_TRACE(sample.name);
        if (sample.name.ends_with(".obj")) continue;  // a text of any kind
        if (sample.name.ends_with(".off"))            // a comment tells nothing, nor do prefixes
            sample.bytes = sample.bytes.substr(sample.bytes.find("OFF"));
        expect_same_surface(read("surface.obj", sample.bytes).surface, cube().triangulated());
    }
}

TEST(SurfaceReader, AcceptsByteOrderMarksAndWindowsLineEnds) {
    for (const auto& sample : surface_samples(cube())) {
        if (!sample.name.starts_with("ascii")) continue;
        SCOPED_TRACE(sample.name);
        std::string bytes = "\xEF\xBB\xBF\r\n \r\n";
        for (const char c : sample.bytes) {
            if (c == '\n') bytes += '\r';
            bytes += c;
        }
        expect_same_surface(read(sample.name, bytes).surface, cube().triangulated());
    }
}

TEST(SurfaceReader, LeavesOutTrianglesWithoutAreaWithAWarning) {
    auto surface = tetrahedron();
    surface.points.push_back(surface.points[3] + surface.points[3]);
    surface.polygons.push_back({0, 0, 2});
    surface.polygons.push_back({0, 3, 4});  // in line
    auto expected = tetrahedron().triangulated();
    expected.points = surface.points;
    for (const auto& sample : surface_samples(surface)) {
        SCOPED_TRACE(sample.name);
        const auto file = read(sample.name, sample.bytes);
        expect_same_surface(file.surface, expected);
        EXPECT_THAT(
            file.warnings,
            ElementsAre("left out 2 of 6 triangles, which have repeated corners or no area"));
    }
}

TEST(SurfaceReader, RefusesSurfacesWithoutTriangles) {
    for (const auto& sample : surface_samples({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}})) {
        SCOPED_TRACE(sample.name);
        // OFF and STL may be empty; OBJ and PLY have points nonetheless.
        EXPECT_THAT(surface_refusal(sample.name, sample.bytes),
                    StartsWith(sample.name + ": holds no triangles"));
    }
    for (const auto& sample : surface_samples({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}})) {
        SCOPED_TRACE(sample.name);
        EXPECT_THAT(
            surface_refusal(sample.name, sample.bytes),
            StartsWith(sample.name + ": none of the 1 triangles has three corners and an area"));
    }
}

TEST(SurfaceReader, RefusesCoordinatesThatAreNoNumbers) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        auto surface = cube();
        surface.points[6].y() = bad;
        for (const auto& sample : surface_samples(surface)) {
            SCOPED_TRACE(sample.name);
            EXPECT_THAT(surface_refusal(sample.name, sample.bytes),
                        AllOf(HasSubstr("coordinate y of point "), HasSubstr(" is " + shown(bad)),
                              HasSubstr("it must be a number from -1e100 to 1e100")));
        }
    }
    EXPECT_THAT(surface_refusal("a.obj", "v 0 0 0\nv 0 0 -1e101\n"),
                StartsWith("a.obj:2: coordinate z of point 1 is -1e+101; it must be"));
    EXPECT_THAT(surface_refusal("a.obj", "v 0 1e999 0\n"),
                StartsWith("a.obj:1: expected coordinate y, found '1e999'"));
}

TEST(SurfaceReader, RefusesWhatIsNoSurfaceFile) {
    EXPECT_THAT(surface_refusal("notes.txt", "Dear diary,\n"),
                AllOf(HasSubstr("convert it to one of: STL (.stl), PLY (.ply), OFF (.off), OBJ")));
    EXPECT_THAT(surface_refusal("a.stl", ""), HasSubstr("the file is empty"));
    EXPECT_THROW(read_surface("no_such_folder/a.stl"), InputError);
}

// --- STL

TEST(StlReader, MergesEqualPointsWhateverTheSignOfZero) {
    const auto file = read("a.stl",
                           "solid\n"
                           "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0\n"
                           "endloop endfacet\nendsolid\n"
                           "Solid second\n"
                           "FACET NORMAL 0 0 1 OUTER LOOP VERTEX 1 -0 0 VERTEX 1 1 0\n"
                           "VERTEX -0.0 1e0 -0 ENDLOOP ENDFACET\nENDSOLID");
    expect_same_surface(file.surface,
                        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}});
    for (const auto& point : file.surface.points)
        for (const double x : point) EXPECT_FALSE(std::signbit(x));
}

TEST(StlReader, RefusesBinaryFilesOfTheWrongSize) {
    const auto bytes = binary_stl(cube().triangulated());
    EXPECT_THAT(surface_refusal("a.stl", bytes.substr(0, 683)),
                AllOf(StartsWith("a.stl: byte 80: the number of triangles is 12, for which a "
                                 "binary file has 684 bytes; this one has 683"),
                      HasSubstr("cut short")));
    EXPECT_THAT(surface_refusal("a.stl", bytes + "x"),
                AllOf(HasSubstr("this one has 685"), HasSubstr("something behind the triangles")));
    EXPECT_THAT(surface_refusal("a.stl", binary_stl(cube().triangulated(), "solid") + "x"),
                HasSubstr("this one has 685"));
    EXPECT_THAT(surface_refusal("a.stl", "sol"), HasSubstr("a.stl: byte 0: is no STL file"));
    auto many = bytes;
    many.replace(80, 4, "\xFF\xFF\xFF\xFF");
    EXPECT_THAT(surface_refusal("a.stl", many), HasSubstr("the number of triangles is 4294967295"));
}

TEST(StlReader, RefusesWrongWords) {
    const auto text = ascii_stl(tetrahedron().triangulated());
    const auto refused = [&](std::string_view from, std::string_view to) {
        return surface_refusal("a.stl", replaced(text, from, to));
    };
    EXPECT_THAT(refused("facet", "facets"),
                StartsWith("a.stl:2: expected 'facet' or 'endsolid', found 'facets'"));
    EXPECT_THAT(refused("normal", "n"), StartsWith("a.stl:2: expected 'normal', found 'n'"));
    EXPECT_THAT(refused("outer", "o"), StartsWith("a.stl:3: expected 'outer loop', found 'o'"));
    EXPECT_THAT(refused("vertex 0 0 0", "endloop"),
                StartsWith("a.stl:4: expected 'vertex' (a facet has three), found 'endloop'"));
    EXPECT_THAT(refused("endloop", "vertex"), HasSubstr("'endloop' (a facet has three vertices)"));
    EXPECT_THAT(refused("vertex 0 0 0", "vertex 0 zero 0"),
                StartsWith("a.stl:4: expected coordinate y, found 'zero'"));
    EXPECT_THAT(surface_refusal("a.stl", text.substr(0, text.rfind("endsolid"))),
                HasSubstr("the file ends where 'facet' or 'endsolid' was expected"));
    EXPECT_THAT(surface_refusal("a.stl", text + "v 0 0 0\n"),
                StartsWith("a.stl:31: expected 'solid' or the end of the file, found 'v'"));
}

// --- OBJ

TEST(ObjReader, ReadsFacesBeforeTheirPointsAndContinuedLines) {
    const auto file = read("a.obj", "f 1 2 \\\r\n 3 \\\n4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0");
    EXPECT_THAT(file.surface.triangles, ElementsAre(std::array<std::int64_t, 3>{0, 1, 2},
                                                    std::array<std::int64_t, 3>{0, 2, 3}));
    // The backslash of a comment continues nothing; the last line may.
    EXPECT_EQ(
        read("a.obj", "# C:\\\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1 \\").surface.points.size(),
        3u);
}

TEST(ObjReader, RefusesWrongIndices) {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    const auto refused = [&](const std::string& face) {
        return surface_refusal("a.obj", points + face + "\n");
    };
    EXPECT_THAT(refused("f 1 2 3\nf 1 2 4\nf 1 2 3"),
                StartsWith("a.obj:5: point index 4 is out of range (3 points, numbered from 1)"));
    EXPECT_THAT(refused("f 1 2 0"), StartsWith("a.obj:4: point index 0 is out of range (3 points"));
    EXPECT_THAT(refused("f 1 2 -4"), StartsWith("a.obj:4: point index -4 is out of range (3 poi"));
    EXPECT_THAT(refused("f 1 2 9223372036854775807"), HasSubstr("9223372036854775807 is out of"));
    EXPECT_THAT(refused("f 1 2 -9223372036854775808"), HasSubstr("-9223372036854775808 is out"));
    EXPECT_THAT(refused("f 1 2 99999999999999999999"),
                StartsWith("a.obj:4: expected a point index, found '99999999999999999999'"));
    EXPECT_THAT(refused("f 1 2 /3"), HasSubstr("expected a point index, found '/3'"));
    EXPECT_THAT(refused("f 1 2.5 3"), HasSubstr("expected a point index, found '2.5'"));
    EXPECT_THAT(refused("f 1 2"), StartsWith("a.obj:4: a face has 2 corners; it must have at le"));
}

TEST(ObjReader, RefusesWrongStatements) {
    EXPECT_THAT(surface_refusal("a.obj", "v 0 0 0\nsurf 0 1 0 1\n"),
                StartsWith("a.obj:2: 'surf' is not a statement known here; export polygons"));
    EXPECT_THAT(surface_refusal("a.obj", "v 0 0\n"),
                StartsWith("a.obj:1: point 0 has 2 coordinates; it must have 3"));
    EXPECT_THAT(surface_refusal("a.obj", "v 0 0 x\n"),
                StartsWith("a.obj:1: expected coordinate z, found 'x'"));
}

// --- OFF

TEST(OffReader, AcceptsCountsBehindTheKeywordWithoutEdges) {
    const std::string body = "\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    for (const std::string head : {"OFF 3 1 0", "OFF3 1 0", "OFF\n3 1", "off\n3 1 7 # edges"})
        EXPECT_EQ(read("a.off", head + body).surface.triangles.size(), 1u) << head;
}

TEST(OffReader, RefusesWhatItCannotRead) {
    const std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const auto refused = [&](std::string_view from, std::string_view to) {
        return surface_refusal("a.off", replaced(text, from, to));
    };
    EXPECT_THAT(refused("OFF", "ON"), StartsWith("a.off:1: expected OFF, found 'ON'"));
    EXPECT_THAT(refused("OFF", "4OFF"), StartsWith("a.off:1: '4OFF' cannot be read; save as OFF"));
    EXPECT_THAT(refused("OFF", "OFF BINARY"), StartsWith("a.off:1: is binary OFF"));
    EXPECT_THAT(refused("3 1 0", "3"),
                StartsWith("a.off:2: expected the numbers of points, faces"));
    EXPECT_THAT(refused("3 1 0", "-3 1 0"), HasSubstr("expected the number of points, found '-3'"));
    EXPECT_THAT(refused("3 1 0", "3000000000 1 0"),
                AllOf(StartsWith("a.off:2: the number of points is 3000000000, more than can be"),
                      HasSubstr("cut short or damaged")));
    EXPECT_THAT(refused("3 1 0", "3 99 0"), HasSubstr("the number of faces is 99, more than"));
    EXPECT_THAT(refused("1 0 0\n", "1 0\n"), StartsWith("a.off:4: point 1 has 2 coordinates"));
    EXPECT_THAT(refused("3 0 1 2", "3 0 1 3"),
                StartsWith("a.off:6: point index 3 is out of range (3 points, numbered from 0)"));
    EXPECT_THAT(refused("3 0 1 2", "3 0 1 -1"), HasSubstr("point index -1 is out of range"));
    EXPECT_THAT(refused("3 0 1 2", "3 0 1 b"), HasSubstr("expected a point index, found 'b'"));
    EXPECT_THAT(refused("3 0 1 2", "4 0 1 2"),
                StartsWith("a.off:6: a face has 4 corners, but its line has 3 numbers for them"));
    EXPECT_THAT(refused("3 0 1 2", "2 0 1 2"),
                StartsWith("a.off:6: a face has 2 corners; it must"));
    EXPECT_THAT(refused("3 0 1 2", "x 0 1 2"), HasSubstr("number of corners of a face, found 'x'"));
    EXPECT_THAT(refused("3 0 1 2\n", "3 0 1 2\n3 0 2 1\n"),
                StartsWith("a.off:7: expected the end of the file behind 1 faces, found '3'"));
    EXPECT_THAT(surface_refusal("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0 1 1 1 1 1 1\n"),
                HasSubstr("the file ends where a point was expected; it is cut short"));
}

// --- PLY

const std::string triangle_ply = R"(ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_index
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2
)";

std::string ply_refusal(std::string_view from, std::string_view to) {
    return surface_refusal("a.ply", replaced(triangle_ply, from, to));
}

TEST(PlyReader, ReadsPlainFilesAndWholeCoordinates) {
    EXPECT_EQ(read("a.ply", triangle_ply).surface.triangles.size(), 1u);
    const auto file = read("a.ply", replaced(triangle_ply, "property float y", "property short y"));
    EXPECT_EQ(file.surface.points[2], Vec3(0, 1, 0));
}

TEST(PlyReader, RefusesWrongHeaders) {
    EXPECT_THAT(ply_refusal("ply", "ply 1"), StartsWith("a.ply:1: expected 'ply' alone"));
    EXPECT_THAT(ply_refusal("format ascii 1.0\n", ""), HasSubstr("has no line 'format'"));
    EXPECT_THAT(ply_refusal("ascii", "text"),
                StartsWith("a.ply:2: expected ascii, binary_little_endian or binary_big_endian, "
                           "found 'text'"));
    EXPECT_THAT(ply_refusal("1.0", "2.0"), StartsWith("a.ply:2: version '2.0' cannot be read"));
    EXPECT_THAT(ply_refusal("1.0\n", "1.0\nformat ascii 1.0\n"),
                StartsWith("a.ply:3: the header has a second line 'format'"));
    EXPECT_THAT(ply_refusal("element vertex 3", "element vertex"),
                StartsWith("a.ply:3: expected 'element <name> <count>', found 2 words"));
    EXPECT_THAT(ply_refusal("vertex 3", "vertex -3"),
                StartsWith("a.ply:3: expected a count of elements, found '-3'"));
    EXPECT_THAT(ply_refusal("element vertex 3\n", ""),
                StartsWith("a.ply:3: a property comes before the first element"));
    EXPECT_THAT(ply_refusal("float x", "half x"),
                AllOf(StartsWith("a.ply:4: type 'half' is not one of: char, int8, uchar")));
    EXPECT_THAT(ply_refusal("uchar int", "float int"),
                StartsWith("a.ply:8: the length of list 'vertex_index' has type 'float'"));
    EXPECT_THAT(ply_refusal("list uchar", "list"), HasSubstr("found 4 words"));
    EXPECT_THAT(ply_refusal("end_header", "done"), StartsWith("a.ply:9: 'done' is not a keyword"));
    EXPECT_THAT(surface_refusal("a.ply", triangle_ply.substr(0, triangle_ply.find("end_header"))),
                HasSubstr("the file ends before 'end_header'; it is cut short"));
}

TEST(PlyReader, RefusesHeadersWithoutASurface) {
    EXPECT_THAT(ply_refusal("element vertex", "element point"),
                StartsWith("a.ply:9: the header has 0 elements 'vertex'; it must have 1"));
    EXPECT_THAT(ply_refusal("element face 1", "element vertex 1"), HasSubstr("has 2 elements 've"));
    EXPECT_THAT(ply_refusal("element face", "element tristrips"), HasSubstr("0 elements 'face'"));
    EXPECT_THAT(ply_refusal("float y", "float u"), HasSubstr("'vertex' has no property 'y'"));
    EXPECT_THAT(ply_refusal("float y", "float x"), HasSubstr("'vertex' has a second property 'x'"));
    EXPECT_THAT(ply_refusal("float y", "list int int y"),
                HasSubstr("property 'y' of element 'vertex' must be a number, not a list"));
    EXPECT_THAT(ply_refusal("list uchar int", "int"),
                HasSubstr("'vertex_index' of element 'face' must be a list of whole numbers"));
    EXPECT_THAT(ply_refusal("list uchar int", "list uchar float"), HasSubstr("must be a list of"));
    EXPECT_THAT(ply_refusal("vertex_index", "corners"),
                HasSubstr("element 'face' has no property 'vertex_indices'"));
}

TEST(PlyReader, RefusesWrongData) {
    EXPECT_THAT(ply_refusal("vertex 3", "vertex 3000000000"),
                HasSubstr("the number of elements 'vertex' is 3000000000, more than can be"));
    EXPECT_THAT(ply_refusal("face 1", "face 18446744073709551615"), HasSubstr("more than can be"));
    EXPECT_THAT(ply_refusal("vertex 3", "vertex 2"), HasSubstr("a face has 0 corners"));
    EXPECT_THAT(ply_refusal("1 0 0", "1 a 0"),
                StartsWith("a.ply:11: expected coordinate y, found 'a'"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "3 0 1 3"),
                StartsWith("a.ply:13: point index 3 is out of range (3 points, numbered from 0)"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "3 0 1 -2"), HasSubstr("point index -2 is out of range"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "3 0 1 1.5"), HasSubstr("a point index, found '1.5'"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "256 0 1 2"), HasSubstr("length of a list, found '256'"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "200 0 1 2"),
                StartsWith("a.ply:13: the length of a list is 200, more than can be"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "2 0 1"), StartsWith("a.ply:13: a face has 2 corners"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "3 0 1"), HasSubstr("where a point index was expected"));
    EXPECT_THAT(ply_refusal("3 0 1 2", "3 0 1 2 5"),
                HasSubstr("2 bytes follow the last element; the counts of the header are wrong"));
    EXPECT_THAT(surface_refusal("a.ply", replaced(replaced(triangle_ply, "uchar", "char"),
                                                  "3 0 1 2", "-3 0 1 2")),
                HasSubstr("the length of list 'vertex_index' is -3; it must be 0 or more"));
}

TEST(PlyReader, NamesBytesOfBinaryFiles) {
    const auto bytes = ply(cube(), "binary_big_endian", false);
    EXPECT_THAT(surface_refusal("a.ply", bytes.substr(0, bytes.size() - 1)),
                StartsWith("a.ply: byte " + std::to_string(bytes.size() - 2) +
                           ": the file ends within a property: 2 bytes were expected, 1 are left"));
    EXPECT_THAT(surface_refusal("a.ply", bytes + "xy"), HasSubstr("2 bytes follow the last"));
}

// --- Damaged files are read or refused, never more: no crash, no other exception.

void expect_consistent(const SurfaceFile& file) {
    const auto& [points, triangles] = file.surface;
    EXPECT_FALSE(triangles.empty());
    EXPECT_LE(file.warnings.size(), 1u);
    for (const auto& point : points) ASSERT_TRUE(point.allFinite());
    for (const auto& triangle : triangles)
        for (const auto corner : triangle) ASSERT_TRUE(corner >= 0 && corner < std::ssize(points));
}

/// Whether the file was refused; anything else than a surface or a refusal fails the test.
bool is_refused(const Sample& sample) {
    static const std::map<std::string, SurfaceFile (*)(const InputFile&)> readers = {
        {".stl", read_stl}, {".obj", read_obj}, {".off", read_off}, {".ply", read_ply}};
    const InputFile file{sample.name, sample.bytes};
    try {
        expect_consistent(readers.at(file.path.extension().string())(file));
        return false;
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string_view(error.what()).starts_with(sample.name + ":")) << error.what();
    } catch (const std::exception& error) {
        ADD_FAILURE() << error.what();
    }
    return true;
}

TEST(MutatedSurfaceFile, IsReadOrRefusedIfCutShort) {
    for (const auto& surface : {tetrahedron(), cube()})
        for (const auto& sample : surface_samples(surface))
            for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
                SCOPED_TRACE(sample.name + " cut to " + std::to_string(size));
                const bool was_refused = is_refused({sample.name, sample.bytes.substr(0, size)});
                // A text may lack its last digits, colour or name unnoticed; OBJ does not say how
                // many faces it has.
                const std::size_t unnoticed = sample.name.starts_with("ascii") ? 16 : 0;
                EXPECT_TRUE(was_refused || sample.name.ends_with(".obj") ||
                            size + unnoticed >= sample.bytes.size());
            }
}

TEST(MutatedSurfaceFile, IsReadOrRefusedIfBytesChange) {
    constexpr int num_mutations = 3000;  // of each sample
    constexpr std::string_view usual = "0123456789-.e \n/#\\";
    for (const auto& sample : surface_samples(cube())) {
        std::mt19937 random(12345);
        const auto below = [&](std::size_t n) { return random() % n; };
        int num_refused = 0;
        for (int m = 0; m < num_mutations; ++m) {
            SCOPED_TRACE(sample.name + ", mutation " + std::to_string(m));
            auto bytes = sample.bytes;
            const auto num_changes = 1 + below(4);
            for (std::size_t i = 0; i < num_changes; ++i) {
                char& byte = bytes[below(bytes.size())];
                const bool is_flip = below(2) == 0;
                byte = is_flip ? static_cast<char>(byte ^ (1 << below(8)))
                               : usual[below(usual.size())];
            }
            num_refused += is_refused({sample.name, bytes}) ? 1 : 0;
        }
        EXPECT_GT(num_refused, 0) << sample.name;
        EXPECT_LT(num_refused, num_mutations) << sample.name;
    }
}

}  // namespace
}  // namespace incise::io
