// What a legacy VTK file means, and what is refused in one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/legacy_vtk_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/reader_samples.h"

namespace incise::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string old_layout = R"(# vtk DataFile Version 3.0
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0  1 0 0  0 1 0
0 0 1  1 1 1
# a comment
CELLS 2 10
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 2
10 10
CELL_DATA 2
SCALARS temperature float
LOOKUP_TABLE default
37 38
SCALARS region int 1
LOOKUP_TABLE default
5 -6
FIELD more 2
my%20region 1 2 double
7 8
fibre 3 2 float
1 0 0 1 0 0
POINT_DATA 5
NORMALS n float
0 0 1 0 0 1 0 0 1 0 0 1 0 0 1
)";

const std::string new_layout = R"(# vtk DataFile Version 5.1
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
0 0 0 1 0 0 0 1 0 0 0 1 1 1 1
CELLS 3 8
OFFSETS vtktypeint64
0 4 8
CONNECTIVITY vtktypeint64
0 1 2 3 1 2 3 4
CELL_TYPES 2
10
10
)";

std::string old_refusal_with(std::string_view from, std::string_view to) {
    return refusal("liver.vtk", replaced(old_layout, from, to));
}
std::string new_refusal_with(std::string_view from, std::string_view to) {
    return refusal("liver.vtk", replaced(new_layout, from, to));
}

TEST(LegacyVtkReader, ReadsBothLayoutsOfCells) {
    const auto file = read_bytes("a.vtk", old_layout);
    auto expected = read_bytes("a.vtk", new_layout).mesh;
    EXPECT_THAT(expected.regions, ElementsAre(0, 0));
    EXPECT_THAT(expected.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    expected.regions = {5, -6};
    expect_same_mesh(file.mesh, expected);
    EXPECT_THAT(file.warnings, ElementsAre());
}

TEST(LegacyVtkReader, TakesTheNamedArrayAsRegions) {
    EXPECT_THAT(read_bytes("a.vtk", old_layout, {.region_array = "my region"}).mesh.regions,
                ElementsAre(7, 8));
    EXPECT_THAT(refusal("liver.vtk", old_layout, {.region_array = "fibre"}),
                StartsWith("liver.vtk:24: array 'fibre': regions need 1 component, "
                           "this array has 3"));
    EXPECT_THAT(refusal("liver.vtk", replaced(old_layout, "37 38", "37 38.5"),
                        {.region_array = "temperature"}),
                HasSubstr("cell 1: region 38.5 is not a whole number"));
}

TEST(LegacyVtkReader, RefusesAFileWithoutTheRegionsAskedFor) {
    EXPECT_EQ(refusal("liver.vtk", old_layout, {.region_array = "organ"}),
              "liver.vtk: has no cell array 'organ' to take the regions from; its cell arrays of "
              "whole numbers: 'region'");
    EXPECT_EQ(refusal("liver.vtk", replaced(old_layout, "1 2 double", "1 2 long"),
                      {.region_array = "n"}),  // that of the points
              "liver.vtk: has no cell array 'n' to take the regions from; its cell arrays of whole "
              "numbers: 'region', 'my region'");
    EXPECT_EQ(refusal("liver.vtk", new_layout, {.region_array = "organ"}),
              "liver.vtk: has no cell array 'organ' to take the regions from, nor another of whole "
              "numbers; without a name all regions are 0");
}

TEST(LegacyVtkReader, StartsFromTheRestPositionsOfAFrame) {
    const auto file = read_bytes("a.vtk", old_layout +
                                              "VECTORS rest_position double\n"
                                              "0 0 0 2 0 0 0 2 0 0 0 2 2 2 2\n");
    EXPECT_EQ(file.mesh.points[4], Vec3(2, 2, 2));
    EXPECT_FALSE(file.mesh.points_may_coincide);
}

TEST(LegacyVtkReader, LetsThePointsOfAFrameCoincide) {
    const auto file = read_bytes("a.vtk", old_layout +
                                              "VECTORS rest_position double\n"
                                              "0 0 0 2 0 0 0 2 0 0 0 2 2 2 2\n"
                                              "SCALARS node_id int\n0 1 2 3 4\n");
    EXPECT_TRUE(file.mesh.points_may_coincide);
}

TEST(LegacyVtkReader, RefusesIndexOutOfRange) {
    EXPECT_EQ(old_refusal_with("4 1 2 3 4", "4 1 2 3 927"),
              "liver.vtk: cell 1: node index 927 is out of range (5 points)");
    EXPECT_EQ(new_refusal_with("0 1 2 3 1", "0 1 -2 3 1"),
              "liver.vtk: cell 0: node index -2 is out of range (5 points)");
}

TEST(LegacyVtkReader, RefusesCoordinatesOfCellsThatAreNotFinite) {
    EXPECT_EQ(old_refusal_with("0 0 1  1 1 1", "0 0 1  1 1 inf"),
              "liver.vtk: cell 1: its node 4 has a coordinate that is not finite");
}

TEST(LegacyVtkReader, RefusesCountsThatTheFileCannotHold) {
    EXPECT_THAT(old_refusal_with("POINTS 5", "POINTS 4000000000"),
                AllOf(StartsWith("liver.vtk:5: "), HasSubstr("4000000000"),
                      HasSubstr("more than can be in the remaining")));
    EXPECT_THAT(old_refusal_with("CELLS 2 10", "CELLS 2 4000000000"), HasSubstr("4000000000"));
    EXPECT_THAT(old_refusal_with("POINTS 5", "POINTS -5"),
                HasSubstr("expected the number of points, found '-5'"));
    EXPECT_THAT(old_refusal_with("fibre 3 2", "fibre 4294967295 4294967295"),
                HasSubstr("remaining"));
    for (const auto& sample : legacy_vtk_samples()) {
        SCOPED_TRACE(sample.name);
        EXPECT_THAT(refusal("liver.vtk", replaced(sample.bytes, "POINTS 12", "POINTS 99999")),
                    AllOf(StartsWith("liver.vtk:"), HasSubstr("is 99999, more than")));
    }
}

TEST(LegacyVtkReader, RefusesCellListsThatDoNotAddUp) {
    EXPECT_THAT(old_refusal_with("4 1 2 3 4", "9 1 2 3 4"),
                StartsWith("liver.vtk: cell 1: has 9 nodes; the cell list has 5 of its 10 entries "
                           "left"));
    EXPECT_THAT(old_refusal_with("4 0 1 2 3", "-4 0 1 2 3"), HasSubstr("cell 0: has -4 nodes"));
    EXPECT_THAT(old_refusal_with("CELLS 2 10", "CELLS 3 10"), HasSubstr("cell 2: is missing"));
    EXPECT_THAT(old_refusal_with("CELLS 2 10", "CELLS 1 10"),
                HasSubstr("has 10 entries, but its 1 cells fill 5"));
    EXPECT_THAT(new_refusal_with("CELL_TYPES 2\n10\n10", "CELL_TYPES 1\n10"),
                HasSubstr("has 1 CELL_TYPES for 2 CELLS"));
    EXPECT_THAT(old_refusal_with("CELL_TYPES 2\n10 10", "CELL_TYPES 1\n10"),
                HasSubstr("array 'region' has 2 values for 1 cells"));
    EXPECT_THAT(new_refusal_with("0 4 8", "0 8 4"), HasSubstr("cell 1: ends at offset 4"));
    EXPECT_THAT(new_refusal_with("0 4 8", "1 4 8"), HasSubstr("do not begin with 0"));
    EXPECT_THAT(new_refusal_with("0 4 8", "0 4 9"),
                HasSubstr("ends at offset 9, but the connectivity has 8 entries"));
}

TEST(LegacyVtkReader, RefusesWhatItCannotRead) {
    EXPECT_THAT(old_refusal_with("UNSTRUCTURED_GRID", "POLYDATA"),
                StartsWith("liver.vtk:4: holds a dataset of kind 'POLYDATA', a surface; save it"));
    EXPECT_THAT(old_refusal_with("UNSTRUCTURED_GRID", "STRUCTURED_POINTS"),
                HasSubstr("'STRUCTURED_POINTS', an image; save a segmentation as NIfTI"));
    EXPECT_THAT(old_refusal_with("UNSTRUCTURED_GRID", "RECTILINEAR_GRID"),
                HasSubstr("'RECTILINEAR_GRID'; only UNSTRUCTURED_GRID"));
    EXPECT_THAT(old_refusal_with("Version 3.0", "Version 9.0"), HasSubstr("from 1.0 to 5.x"));
    EXPECT_THAT(old_refusal_with("ASCII", "ASKII"),
                StartsWith("liver.vtk:3: expected ASCII or BINARY, found 'ASKII'"));
    EXPECT_THAT(old_refusal_with("1 1 1\n", "1 1 one\n"),
                StartsWith("liver.vtk:7: expected the points, found 'one'"));
    EXPECT_THAT(old_refusal_with("1 1 1\n", "1 1 1 1\n"),
                StartsWith("liver.vtk:7: '1' is not a section"));
    EXPECT_THAT(old_refusal_with("fibre 3 2 float", "fibre 3 2 quaternion"),
                HasSubstr("type 'quaternion' is not known"));
    EXPECT_THAT(old_refusal_with("region int 1", "region string 1"), HasSubstr("must be numbers"));
    EXPECT_THAT(old_refusal_with("10 10", "10 25"),
                HasSubstr("cell 1: a quadratic hexahedron (VTK cell type 25)"));
    EXPECT_THAT(old_refusal_with("10 10", "5 5"), HasSubstr("cell 0: a triangle has 3 nodes"));
    EXPECT_THAT(refusal("liver.vtk", old_layout.substr(0, old_layout.find("CELL_TYPES"))),
                HasSubstr("has no CELL_TYPES section"));
}

TEST(LegacyVtkReader, KeepsTheVectorsAskedFor) {
    const ReadOptions options{.vector_arrays = {"fibre"}};
    const auto expected = ElementsAre(Vec3(1, 0, 0), Vec3(0, -2, 0.5));
    const auto as_field = replaced(old_layout, "\n1 0 0 1 0 0\n", "\n1 0 0 0 -2 0.5\n");
    EXPECT_THAT(read_bytes("a.vtk", as_field, options).cell_vectors.at("fibre"), expected);
    const auto as_vectors = new_layout + "CELL_DATA 2\nVECTORS fibre double\n1 0 0 0 -2 0.5\n";
    EXPECT_THAT(read_bytes("a.vtk", as_vectors, options).cell_vectors.at("fibre"), expected);
    EXPECT_EQ(refusal("liver.vtk", old_layout, {.vector_arrays = {"n"}}),  // of the points
              "liver.vtk: has no cell array 'n' of three components; its cell arrays of three "
              "components: 'fibre'");
    EXPECT_EQ(
        refusal("liver.vtk", new_layout, options),
        "liver.vtk: has no cell array 'fibre' of three components, nor another; add it to the "
        "file's cell data");
    EXPECT_THAT(refusal("liver.vtk", old_layout,
                        {
                            .vector_arrays = {"region"},
                        }),
                testing::AnyOf(HasSubstr("vectors need 3 components, this array has 1"),
                               HasSubstr("has no cell array 'region'")));
    EXPECT_THAT(refusal("liver.vtk", replaced(old_layout, "fibre 3 2", "fibre 3 1"), options),
                HasSubstr("array 'fibre' has 1 values for 2 cells"));
}

}  // namespace
}  // namespace incise::io
