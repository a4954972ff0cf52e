// What a legacy VTK file means, and what is refused in one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/legacy_vtk_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

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
    EXPECT_THAT(refusal("a.vtk", old_layout, {.region_array = "fibre"}),
                StartsWith("a.vtk:24: array 'fibre': regions need 1 component, this array has 3"));
    EXPECT_THAT(
        refusal("a.vtk", replaced(old_layout, "37 38", "37 38.5"), {.region_array = "temperature"}),
        HasSubstr("cell 1: region 38.5 is not a whole number"));
}

TEST(LegacyVtkReader, RefusesAFileWithoutTheRegionsAskedFor) {
    EXPECT_EQ(refusal("a.vtk", old_layout, {.region_array = "organ"}),
              "a.vtk: has no cell array 'organ' to take the regions from; its cell arrays of whole "
              "numbers: 'region'");
    EXPECT_EQ(refusal("a.vtk", replaced(old_layout, "1 2 double", "1 2 long"),
                      {.region_array = "n"}),  // that of the points
              "a.vtk: has no cell array 'n' to take the regions from; its cell arrays of whole "
              "numbers: 'region', 'my region'");
    EXPECT_EQ(refusal("a.vtk", new_layout, {.region_array = "organ"}),
              "a.vtk: has no cell array 'organ' to take the regions from, nor another of whole "
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

const std::vector<Fault> old_layout_faults = {
    // Index out of range.
    {"4 1 2 3 4", "4 1 2 3 927", "a.vtk: cell 1: node index 927 is out of range (5 points)"},
    // Coordinates of cells that are not finite.
    {"0 0 1  1 1 1", "0 0 1  1 1 inf",
     "a.vtk: cell 1: its node 4 has a coordinate that is not finite"},
    // Counts that the file cannot hold.
    {"POINTS 5", "POINTS 4000000000",
     "a.vtk:5: ...4000000000...more than can be in the remaining..."},
    {"CELLS 2 10", "CELLS 2 4000000000", "...size of the cell list is 4000000000, more than..."},
    {"POINTS 5", "POINTS -5", "...expected the number of points, found '-5'..."},
    {"fibre 3 2", "fibre 4294967295 4294967295", "...remaining..."},
    // Cell lists that do not add up.
    {"4 1 2 3 4", "9 1 2 3 4",
     "a.vtk: cell 1: has 9 nodes; the cell list has 5 of its 10 entries left..."},
    {"4 0 1 2 3", "-4 0 1 2 3", "...cell 0: has -4 nodes..."},
    {"CELLS 2 10", "CELLS 3 10", "...cell 2: is missing..."},
    {"CELLS 2 10", "CELLS 1 10", "...has 10 entries, but its 1 cells fill 5..."},
    {"CELL_TYPES 2\n10 10", "CELL_TYPES 1\n10", "...array 'region' has 2 values for 1 cells..."},
    // What cannot be read.
    {"UNSTRUCTURED_GRID", "POLYDATA",
     "a.vtk:4: holds a dataset of kind 'POLYDATA', a surface; save it..."},
    {"UNSTRUCTURED_GRID", "STRUCTURED_POINTS",
     "...'STRUCTURED_POINTS', an image; save a segmentation as NIfTI..."},
    {"UNSTRUCTURED_GRID", "RECTILINEAR_GRID", "...'RECTILINEAR_GRID'; only UNSTRUCTURED_GRID..."},
    {"Version 3.0", "Version 9.0", "...from 1.0 to 5.x..."},
    {"ASCII", "ASKII", "a.vtk:3: expected ASCII or BINARY, found 'ASKII'..."},
    {"1 1 1\n", "1 1 one\n", "a.vtk:7: expected the points, found 'one'..."},
    {"1 1 1\n", "1 1 1 1\n", "a.vtk:7: '1' is not a section..."},
    {"fibre 3 2 float", "fibre 3 2 quaternion", "...type 'quaternion' is not known..."},
    {"region int 1", "region string 1", "...must be numbers..."},
    {"10 10", "10 25", "...cell 1: a quadratic hexahedron (VTK cell type 25)..."},
    {"10 10", "5 5", "...cell 0: a triangle has 3 nodes..."},
    {"", old_layout.substr(0, old_layout.find("CELL_TYPES")), "...has no CELL_TYPES section..."},
};

const std::vector<Fault> new_layout_faults = {
    // Index out of range.
    {"0 1 2 3 1", "0 1 -2 3 1", "a.vtk: cell 0: node index -2 is out of range (5 points)"},
    // Cell lists that do not add up.
    {"CELL_TYPES 2\n10\n10", "CELL_TYPES 1\n10", "...has 1 CELL_TYPES for 2 CELLS..."},
    {"0 4 8", "0 8 4", "...cell 1: ends at offset 4..."},
    {"0 4 8", "1 4 8", "...do not begin with 0..."},
    {"0 4 8", "0 4 9", "...ends at offset 9, but the connectivity has 8 entries..."},
};

TEST(LegacyVtkReader, RefusesFaultyFiles) {
    expect_refusals("a.vtk", old_layout, old_layout_faults);
    expect_refusals("a.vtk", new_layout, new_layout_faults);
    for (const auto& sample : legacy_vtk_samples()) {
        SCOPED_TRACE(sample.name);
        expect_refusals("a.vtk", sample.bytes,
                        {{"POINTS 12", "POINTS 99999", "a.vtk:...is 99999, more than..."}});
    }
}

TEST(LegacyVtkReader, KeepsTheVectorsAskedFor) {
    const ReadOptions options{.vector_arrays = {"fibre"}};
    const auto expected = ElementsAre(Vec3(1, 0, 0), Vec3(0, -2, 0.5));
    const auto as_field = replaced(old_layout, "\n1 0 0 1 0 0\n", "\n1 0 0 0 -2 0.5\n");
    EXPECT_THAT(read_bytes("a.vtk", as_field, options).cell_vectors.at("fibre"), expected);
    const auto as_vectors = new_layout + "CELL_DATA 2\nVECTORS fibre double\n1 0 0 0 -2 0.5\n";
    EXPECT_THAT(read_bytes("a.vtk", as_vectors, options).cell_vectors.at("fibre"), expected);
    for (const std::string name : {"n" /* of the points */, "region" /* a number a cell */})
        EXPECT_EQ(refusal("a.vtk", old_layout, {.vector_arrays = {name}}),
                  "a.vtk: has no cell array '" + name +
                      "' of three components; its cell arrays of three components: 'fibre'");
    EXPECT_EQ(refusal("a.vtk", new_layout, options),
              "a.vtk: has no cell array 'fibre' of three components, nor another; add it to the "
              "file's cell data");
    EXPECT_THAT(refusal("a.vtk", replaced(old_layout, "fibre 3 2", "fibre 3 1"), options),
                HasSubstr("array 'fibre' has 1 values for 2 cells"));
}

}  // namespace
}  // namespace incise::io
