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
#include "tests/io/refusals.h"
#include "tests/io/surface_samples.h"
#include "tests/support/mutation.h"
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

std::string surface_refusal(const std::string& name, std::string_view bytes) {
    return refusal_by([](const auto& path) { read_surface(path); }, name, bytes);
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

const std::vector<Fault> stl_faults = {
    {"facet", "facets", "a.stl:2: expected 'facet' or 'endsolid', found 'facets'..."},
    {"normal", "n", "a.stl:2: expected 'normal', found 'n'..."},
    {"outer", "o", "a.stl:3: expected 'outer loop', found 'o'..."},
    {"vertex 0 0 0", "endloop",
     "a.stl:4: expected 'vertex' (a facet has three), found 'endloop'..."},
    {"endloop", "vertex", "...'endloop' (a facet has three vertices)..."},
    {"vertex 0 0 0", "vertex 0 zero 0", "a.stl:4: expected coordinate y, found 'zero'..."},
};

TEST(StlReader, RefusesFaultyFiles) {
    const auto text = ascii_stl(tetrahedron().triangulated());
    expect_refusals(surface_refusal, "a.stl", text, stl_faults);
    const auto bytes = binary_stl(cube().triangulated());
    auto many = bytes;
    many.replace(80, 4, "\xFF\xFF\xFF\xFF");
    expect_refusals(
        surface_refusal, "a.stl", "",
        {
            {"", text.substr(0, text.rfind("endsolid")),
             "...the file ends where 'facet' or 'endsolid' was expected..."},
            {"", text + "v 0 0 0\n",
             "a.stl:31: expected 'solid' or the end of the file, found 'v'..."},
            // Binary files of the wrong size.
            {"", bytes.substr(0, 683),
             "a.stl: byte 80: the number of triangles is 12, for which a binary file has 684 "
             "bytes; this one has 683...cut short..."},
            {"", bytes + "x", "...this one has 685...something behind the triangles..."},
            {"", binary_stl(cube().triangulated(), "solid") + "x", "...this one has 685..."},
            {"", "sol", "a.stl: byte 0: is no STL file..."},
            {"", many, "...the number of triangles is 4294967295..."},
        });
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

const std::vector<Fault> obj_faults = {
    // Wrong statements and coordinates.
    {"", "v 0 0 0\nsurf 0 1 0 1\n",
     "a.obj:2: 'surf' is not a statement known here; export polygons..."},
    {"", "v 0 0\n", "a.obj:1: point 0 has 2 coordinates; it must have 3..."},
    {"", "v 0 0 x\n", "a.obj:1: expected coordinate z, found 'x'..."},
    {"", "v 0 1e999 0\n", "a.obj:1: expected coordinate y, found '1e999'..."},
    {"", "v 0 0 0\nv 0 0 -1e101\n", "a.obj:2: coordinate z of point 1 is -1e+101; it must be..."},
    // Wrong indices.
    {"f 1 2 3", "f 1 2 3\nf 1 2 4\nf 1 2 3",
     "a.obj:5: point index 4 is out of range (3 points, numbered from 1)..."},
    {"f 1 2 3", "f 1 2 0", "a.obj:4: point index 0 is out of range (3 points..."},
    {"f 1 2 3", "f 1 2 -4", "a.obj:4: point index -4 is out of range (3 poi..."},
    {"f 1 2 3", "f 1 2 9223372036854775807", "...9223372036854775807 is out of..."},
    {"f 1 2 3", "f 1 2 -9223372036854775808", "...-9223372036854775808 is out..."},
    {"f 1 2 3", "f 1 2 99999999999999999999",
     "a.obj:4: expected a point index, found '99999999999999999999'..."},
    {"f 1 2 3", "f 1 2 /3", "...expected a point index, found '/3'..."},
    {"f 1 2 3", "f 1 2.5 3", "...expected a point index, found '2.5'..."},
    {"f 1 2 3", "f 1 2", "a.obj:4: a face has 2 corners; it must have at le..."},
};

TEST(ObjReader, RefusesFaultyFiles) {
    expect_refusals(surface_refusal, "a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", obj_faults);
}

// --- OFF

TEST(OffReader, AcceptsCountsBehindTheKeywordWithoutEdges) {
    const std::string body = "\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    for (const std::string head : {"OFF 3 1 0", "OFF3 1 0", "OFF\n3 1", "off\n3 1 7 # edges"})
        EXPECT_EQ(read("a.off", head + body).surface.triangles.size(), 1u) << head;
}

const std::vector<Fault> off_faults = {
    {"OFF", "ON", "a.off:1: expected OFF, found 'ON'..."},
    {"OFF", "4OFF", "a.off:1: '4OFF' cannot be read; save as OFF..."},
    {"OFF", "OFF BINARY", "a.off:1: is binary OFF..."},
    {"3 1 0", "3", "a.off:2: expected the numbers of points, faces..."},
    {"3 1 0", "-3 1 0", "...expected the number of points, found '-3'..."},
    {"3 1 0", "3000000000 1 0",
     "a.off:2: the number of points is 3000000000, more than can be...cut short or damaged..."},
    {"3 1 0", "3 99 0", "...the number of faces is 99, more than..."},
    {"1 0 0\n", "1 0\n", "a.off:4: point 1 has 2 coordinates..."},
    {"3 0 1 2", "3 0 1 3", "a.off:6: point index 3 is out of range (3 points, numbered from 0)..."},
    {"3 0 1 2", "3 0 1 -1", "...point index -1 is out of range..."},
    {"3 0 1 2", "3 0 1 b", "...expected a point index, found 'b'..."},
    {"3 0 1 2", "4 0 1 2", "a.off:6: a face has 4 corners, but its line has 3 numbers for them..."},
    {"3 0 1 2", "2 0 1 2", "a.off:6: a face has 2 corners; it must..."},
    {"3 0 1 2", "x 0 1 2", "...number of corners of a face, found 'x'..."},
    {"3 0 1 2\n", "3 0 1 2\n3 0 2 1\n",
     "a.off:7: expected the end of the file behind 1 faces, found '3'..."},
    {"", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0 1 1 1 1 1 1\n",
     "...the file ends where a point was expected; it is cut short..."},
};

TEST(OffReader, RefusesFaultyFiles) {
    expect_refusals(surface_refusal, "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                    off_faults);
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

TEST(PlyReader, ReadsPlainFilesAndWholeCoordinates) {
    EXPECT_EQ(read("a.ply", triangle_ply).surface.triangles.size(), 1u);
    const auto file = read("a.ply", replaced(triangle_ply, "property float y", "property short y"));
    EXPECT_EQ(file.surface.points[2], Vec3(0, 1, 0));
}

const std::vector<Fault> ply_faults = {
    // Wrong headers.
    {"ply", "ply 1", "a.ply:1: expected 'ply' alone..."},
    {"format ascii 1.0\n", "", "...has no line 'format'..."},
    {"ascii", "text",
     "a.ply:2: expected ascii, binary_little_endian or binary_big_endian, found 'text'..."},
    {"1.0", "2.0", "a.ply:2: version '2.0' cannot be read..."},
    {"1.0\n", "1.0\nformat ascii 1.0\n", "a.ply:3: the header has a second line 'format'..."},
    {"element vertex 3", "element vertex",
     "a.ply:3: expected 'element <name> <count>', found 2 words..."},
    {"vertex 3", "vertex -3", "a.ply:3: expected a count of elements, found '-3'..."},
    {"element vertex 3\n", "", "a.ply:3: a property comes before the first element..."},
    {"float x", "half x", "a.ply:4: type 'half' is not one of: char, int8, uchar..."},
    {"uchar int", "float int", "a.ply:8: the length of list 'vertex_index' has type 'float'..."},
    {"list uchar", "list", "...found 4 words..."},
    {"end_header", "done", "a.ply:9: 'done' is not a keyword..."},
    // Headers without a surface.
    {"element vertex", "element point",
     "a.ply:9: the header has 0 elements 'vertex'; it must have 1..."},
    {"element face 1", "element vertex 1", "...has 2 elements 've..."},
    {"element face", "element tristrips", "...0 elements 'face'..."},
    {"float y", "float u", "...'vertex' has no property 'y'..."},
    {"float y", "float x", "...'vertex' has a second property 'x'..."},
    {"float y", "list int int y",
     "...property 'y' of element 'vertex' must be a number, not a list..."},
    {"list uchar int", "int",
     "...'vertex_index' of element 'face' must be a list of whole numbers..."},
    {"list uchar int", "list uchar float", "...must be a list of..."},
    {"vertex_index", "corners", "...element 'face' has no property 'vertex_indices'..."},
    // Wrong data.
    {"vertex 3", "vertex 3000000000",
     "...the number of elements 'vertex' is 3000000000, more than can be..."},
    {"face 1", "face 18446744073709551615", "...more than can be..."},
    {"vertex 3", "vertex 2", "...a face has 0 corners..."},
    {"1 0 0", "1 a 0", "a.ply:11: expected coordinate y, found 'a'..."},
    {"3 0 1 2", "3 0 1 3",
     "a.ply:13: point index 3 is out of range (3 points, numbered from 0)..."},
    {"3 0 1 2", "3 0 1 -2", "...point index -2 is out of range..."},
    {"3 0 1 2", "3 0 1 1.5", "...a point index, found '1.5'..."},
    {"3 0 1 2", "256 0 1 2", "...length of a list, found '256'..."},
    {"3 0 1 2", "200 0 1 2", "a.ply:13: the length of a list is 200, more than can be..."},
    {"3 0 1 2", "2 0 1", "a.ply:13: a face has 2 corners..."},
    {"3 0 1 2", "3 0 1", "...where a point index was expected..."},
    {"3 0 1 2", "3 0 1 2 5",
     "...2 bytes follow the last element; the counts of the header are wrong..."},
    {"", triangle_ply.substr(0, triangle_ply.find("end_header")),
     "...the file ends before 'end_header'; it is cut short..."},
};

TEST(PlyReader, RefusesFaultyFiles) {
    expect_refusals(surface_refusal, "a.ply", triangle_ply, ply_faults);
    expect_refusals(surface_refusal, "a.ply", replaced(triangle_ply, "uchar", "char"),
                    {{"3 0 1 2", "-3 0 1 2",
                      "...the length of list 'vertex_index' is -3; it must be 0 or more..."}});
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
    for (const auto& sample : surface_samples(cube())) {
        std::mt19937 random(12345);
        int num_refused = 0;
        for (int m = 0; m < num_mutations; ++m) {
            SCOPED_TRACE(sample.name + ", mutation " + std::to_string(m));
            num_refused +=
                is_refused({sample.name, support::mutated(sample.bytes, random)}) ? 1 : 0;
        }
        EXPECT_GT(num_refused, 0) << sample.name;
        EXPECT_LT(num_refused, num_mutations) << sample.name;
    }
}

}  // namespace
}  // namespace incise::io
