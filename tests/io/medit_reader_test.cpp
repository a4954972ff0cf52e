// What a MEDIT file means, and what is refused in one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/medit_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// The layout is TetGen's (option -g): the number of dimensions on a line of its own, comments.
const std::string medit_tetrahedra = R"(MeshVersionFormatted 1

Dimension
3

# Set of mesh vertices
Vertices
5
0  0  0    0
1  0  0    7
0  1  0    0
0  0  1    0
1  1  1    0

# Set of Tetrahedra
Tetrahedra
2
    1      2      3      4  10
    2      3      4      5  -4

Corners
2
   1
   2

End
)";

TEST(MeditReader, TakesReferencesOfCellsAsRegions) {
    const auto file = read_bytes("a.mesh", medit_tetrahedra);
    EXPECT_EQ(file.mesh.points[4], Vec3(1, 1, 1));
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.mesh.regions, ElementsAre(10, -4));
    EXPECT_THAT(file.warnings, ElementsAre());
}

TEST(MeditReader, TurnsPrismsIntoWedgesOfPositiveVolume) {
    // As meshio 5.0.0 writes it. The triangle 1, 2, 3 faces 4, 5, 6; in the mesh it faces away.
    const auto file = read_bytes("a.mesh", R"(MeshVersionFormatted 2
Dimension 3

Vertices
6
0.0000000000000000e+00 0.0000000000000000e+00 0.0000000000000000e+00 1
1.0000000000000000e+00 0.0000000000000000e+00 0.0000000000000000e+00 1
0.0000000000000000e+00 1.0000000000000000e+00 0.0000000000000000e+00 1
0.0000000000000000e+00 0.0000000000000000e+00 1.0000000000000000e+00 1
1.0000000000000000e+00 0.0000000000000000e+00 1.0000000000000000e+00 1
0.0000000000000000e+00 1.0000000000000000e+00 1.0000000000000000e+00 1

Prisms
1
1 2 3 4 5 6 3

End
)");
    EXPECT_THAT(file.mesh.regions, ElementsAre(3));
    expect_wedge_of_unit_height(file.mesh);
}

TEST(MeditReader, StepsOverWhatItDoesNotNeed) {
    const std::string end = "\nEnd";
    const auto known = replaced(medit_tetrahedra, end,
                                "\nIdentifier\n\"a liver, Vertices and all\"\n"
                                "Geometry \"liver.geom\"\nNormals # unit\n1\n0 nan 1 # outwards\n"
                                "EDGES 0\nAngleOfCornerBound 44.5\nRidges 0\nTetrahedraP2 0" +
                                    end + "\nanything at all");
    EXPECT_THAT(read_bytes("a.mesh", known).warnings, ElementsAre());
    const auto unknown = replaced(medit_tetrahedra, end, "\nSpots\n1\n3" + end);
    EXPECT_THAT(read_bytes("a.mesh", unknown).warnings,
                ElementsAre("left out sections that are not known: 'Spots'"));
    const auto garbage = replaced(medit_tetrahedra, end, "\na b c d e f g" + end);
    EXPECT_THAT(read_bytes("a.mesh", garbage).warnings,
                ElementsAre("left out sections that are not known: 'a', 'b', 'c', 'd', 'e', ..."));
    const auto surface = replaced(medit_tetrahedra, end,
                                  "\nTriangles\n1\n1 2 3 1\nTrianglesP2 1\n1 2 3 4 5 1 1" + end);
    EXPECT_THAT(read_bytes("a.mesh", surface).warnings,
                ElementsAre(HasSubstr("ignored 1 triangle and 1 second-order triangle:")));
    EXPECT_THAT(read_bytes("a.mesh", replaced(medit_tetrahedra, end, "\n")).warnings,
                ElementsAre(HasSubstr("has no End")));
}

const std::vector<Fault> medit_faults = {
    // Unknown vertices.
    {"4      5", "4      927",
     "a.mesh:19: tetrahedron 2: vertex 927 is out of range (5 vertices, numbered from 1)"},
    {"4      5", "4      0", "...vertex 0 is out of range..."},
    {"4      5", "4      -1", "...vertex -1 is out of range..."},
    {"", "MeshVersionFormatted 2 Tetrahedra 1 1 2 3 4 0 Vertices 0 End",
     "...Tetrahedra comes before Vertices..."},
    {"Vertices", "Normals", "...Tetrahedra comes before Vertices..."},
    // Counts that the file cannot hold.
    {"Vertices\n5", "Vertices\n4000000000",
     "a.mesh:8: the number of vertices is 4000000000...more than can be in the remaining..."},
    {"Tetrahedra\n2", "Tetrahedra\n18446744073709551615",
     "a.mesh:17: the number of rows of Tetrahedra is 1844674407370955..."},
    {"Vertices\n5", "Vertices\n-5", "...found '-5'..."},
    {"Vertices\n5", "Vertices\n4",
     "a.mesh:13: expected a keyword behind the rows of the section before, found '1'"},
    {"Tetrahedra\n2", "Tetrahedra\n3", "a.mesh:21: expected a vertex, found 'Corners'"},
    // What is no number.
    {"0  1  0    0", "0  nan  0    0", "a.mesh:11: a y coordinate is nan; it must be finite"},
    {"0  1  0    0", "0  1  -inf    0", "...z coordinate is -inf..."},
    {"0  1  0    0", "0  1,5  0    0", "...found '1,5'..."},
    {"4  10", "4  1e10",
     "a.mesh:18: expected a reference, a whole number of 32 bits, found '1e10'"},
    {"4  10", "4  3000000000",
     "...of 32 bits, found '3000000000', which is out of range: -2147483648 to ..."},
    {"Vertices\n5", "Vertices\n18446744073709551617",
     "...expected the number of vertices, found '18446744073709551617', which is out of range: 0 "
     "to 18446744073709551615 are allowed..."},
    // What cannot be read.
    {"Formatted 1", "Formatted 5",
     "a.mesh:1: the version is 5; it must be 1 to 4: save it as version 2"},
    {"Dimension\n3", "Dimension\n2",
     "a.mesh:4: the dimension is 2; it must be 3: a volume mesh has points in space"},
    {"Tetrahedra\n2", "TetrahedraP2\n1",
     "a.mesh:17: a second-order tetrahedron (MEDIT section TetrahedraP2) cannot be used...export "
     "linear elements..."},
    {"Tetrahedra\n2", "Corners\n10", "...holds no cells at all..."},
    {"\nEnd", "\nVertices 0\nEnd", "...second section Vertices..."},
    {"", "MeshVersionFormatted 2\nEnd\n", "...has no section Vertices..."},
};

TEST(MeditReader, RefusesFaultyFiles) { expect_refusals("a.mesh", medit_tetrahedra, medit_faults); }

}  // namespace
}  // namespace incise::io
