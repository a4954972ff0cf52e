// What a Gmsh file means, and what is refused in one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/gmsh_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string version_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
30 0 0 0
10 1 0 0
20 0 1 0
50 0 0 1
40 1 1 1
$EndNodes
$Elements
3
1 15 2 9 1 30
2 4 2 7 1 30 10 20 50
3 4 0 10 20 50 40
$EndElements
)";

const std::string version_1 = R"($NOD
5
30 0 0 0
10 1 0 0
20 0 1 0
50 0 0 1
40 1 1 1
$ENDNOD
$ELM
3
1 15 9 1 1 30
2 4 7 2 4 30 10 20 50
3 4 0 2 4 10 20 50 40
$ENDELM
)";

/// Version 2 with the nodes on a point, a curve, a surface and in a volume.
const std::string parametric =
    replaced(replaced(replaced(version_2, "$Nodes\n5\n30 0 0 0\n10 1 0 0\n20 0 1 0\n50 0 0 1\n",
                               "$ParametricNodes\n5\n30 0 0 0 0 1\n10 1 0 0 1 2 0.5\n"
                               "20 0 1 0 2 3 0.5 0.25\n50 0 0 1 3 4\n"),
                      "40 1 1 1\n", "40 1 1 1 3 4\n"),
             "$EndNodes", "$EndParametricNodes");

const std::string version_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
0 0 0 2
1 0 0 0 1 1 1 2 7 8 0
2 0 0 0 1 1 1 0 0
$EndEntities
$Nodes
1 5 1 5
3 1 0 5
1
2
3
4
5
0 0 0
1 0 0
0 1 0
0 0 1
1 1 1
$EndNodes
$Elements
2 2 1 2
3 1 4 1
1 1 2 3 4
3 2 4 1
2 2 3 4 5
$EndElements
)";

TEST(GmshReader, NumbersPointsInTheOrderOfTheFile) {
    const auto file = read_bytes("a.msh", version_2);
    EXPECT_EQ(file.mesh.points[0], Vec3(0, 0, 0));
    EXPECT_EQ(file.mesh.points[4], Vec3(1, 1, 1));
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("ignored 1 point element:")));
}

TEST(GmshReader, TakesPhysicalGroupsAsRegions) {
    EXPECT_THAT(read_bytes("a.msh", version_2).mesh.regions, ElementsAre(7, 0));
    const auto file = read_bytes("a.msh", version_4);
    EXPECT_THAT(file.mesh.regions, ElementsAre(7, 0));
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("1 volumes are in several physical groups")));
}

TEST(GmshReader, ReadsVersionOne) {
    const auto expected = read_bytes("a.msh", version_2);
    // Early files name the section of the nodes NOE.
    const auto early = replaced(replaced(version_1, "$NOD", "$NOE"), "$ENDNOD", "$ENDNOE");
    for (const auto& text : {version_1, early}) {
        const auto file = read_bytes("a.msh", text);
        expect_same_mesh(file.mesh, expected.mesh);
        EXPECT_EQ(file.warnings, expected.warnings);
    }
}

const std::vector<Fault> gmsh_1_faults = {
    {"3 4 0 2 4", "3 4 0 2 5", "a.msh:13: element 3: has 5 nodes; a tetrahedron has 4"},
    {"3 4 0 2 4", "3 77 0 2 4", "a.msh:13: element type 77 is not known..."},
    {"10 20 50 40", "10 20 50 41", "a.msh:13: element 3: node tag 41 is not one of the 5 nodes..."},
    {"$NOD\n5", "$NOD\n4", "a.msh:7: expected $ENDNOD, found '40'..."},
    {"$NOD\n5", "$NOD\n500", "a.msh:2: the number of nodes is 500, more than can be..."},
    {"$ENDNOD\n", "", "...section 'NOD' has no '$ENDNOD' before ..."},
    {"$ELM\n3", "$ELM\n2", "a.msh:13: expected $ENDELM, found '3'..."},
    {"", "$NOD\n1\n1 0 0 0\n$ENDNOD\n", "a.msh: has no $ELM section"},
    {"", version_1.substr(version_1.find("$ELM")),
     "a.msh:1: the elements come before the nodes..."},
    {"", version_1 + version_2, "a.msh:15: $MeshFormat comes behind sections of version 1..."},
    {"", version_2 + version_1, "a.msh:18: $NOD belongs to version 1..."},
};

const std::vector<Fault> gmsh_2_faults = {
    // Sections that are not closed.
    {"$EndElements\n", "",
     "a.msh:16: section 'Elements' has no '$EndElements' before the end of the file; ..."},
    // Unknown nodes.
    {"10 20 50 40", "10 20 50 927", "a.msh:16: element 3: node tag 927 is not one of the 5 nodes"},
    {"40 1 1 1", "10 1 1 1",
     "a.msh: node tag 10 is given to two nodes, the nodes number 2 and 5 in the order of the file; "
     "give each node one of its own"},
    // Counts that the file cannot hold.
    {"$Nodes\n5", "$Nodes\n4000000000",
     "a.msh:5: the number of nodes is 4000000000...more than can be in the remaining..."},
    {"$Nodes\n5", "$Nodes\n4", "a.msh:10: expected $EndNodes, found '40'..."},
    {"3 4 0 10", "3 4 -1 10", "...the number of tags is -1; it must be 0 or more..."},
    // What cannot be read.
    {"2.2 0 8", "4 0 8", "a.msh:2: version '4' cannot be read..."},
    {"2.2 0 8", "2.2 3 8", "...file type is 3..."},
    {"2.2 0 8", "2.2 0 16", "...data size is 16..."},
    {"", "$Nodes\n1\n", "...before $MeshFormat..."},
    {"", version_2.substr(0, version_2.find("$Elements")), "...has no $Elements section..."},
    {"", "$PhysicalNames\n1\n3 5 \"$EndPhysicalNames\"\n",
     "a.msh:1: section 'PhysicalNames' has no '$EndPhysicalNames'..."},
    {"", "$Comments\nhello\n", "a.msh:1: section 'Comments' has no '$EndComments'..."},
    {"3 4 0 10", "3 11 0 10",
     "a.msh:16: element 3: a second-order tetrahedron (Gmsh element type 11)..."},
    {"3 4 0 10", "3 77 0 10", "...element type 77 is not known..."},
    {"10 1 0 0", "10 1 zero 0", "a.msh:7: expected a y coordinate, found 'zero'..."},
    {"10 1 0 0", "10 1 nan 0", "a.msh:7: a y coordinate is nan; it must be finite"},
    {"2 4 2 7", "2 5 2 7", "...element 2: node tag 3 is not one of the 5 nodes..."},
    // Numbers out of range.
    {"10 1 0 0", "4000000000 1 0 0",
     "a.msh:7: expected a node tag, found '4000000000', which is out of range: -2147483648 to "
     "2147483647 are allowed"},
    {"10 1 0 0", "10 1e999 0 0", "...found '1e999', which is out of range: -1.79..."},
};

const std::vector<Fault> parametric_faults = {
    // Parameters that do not suit the entity.
    {"30 0 0 0 0 1", "30 0 0 0 4 1", "a.msh:6: the dimension of an entity is 4; it must be 0 to 3"},
    {"40 1 1 1 3 4", "40 1 1 1 2 4 0.5",
     "a.msh:11: expected a parameter of a node, found '$EndParametri..."},
    // The section where it does not belong, or not closed.
    {"", parametric.substr(parametric.find("$ParametricNodes")),
     "a.msh:1: $ParametricNodes comes before $MeshFormat..."},
    {"2.2 0 8", "4.1 0 8", "a.msh:4: $ParametricNodes belongs to version 2; save the mesh ..."},
    {"$EndParametricNodes\n", "",
     "a.msh:11: section 'ParametricNodes' has no '$EndParametricNodes' before '$Elements'; the "
     "file is damaged: save the mesh anew, or add that line"},
};

const std::vector<Fault> gmsh_4_faults = {
    // Sections that are not closed.
    {"$EndEntities\n", "", "...no '$EndEntities' before '$Nodes'..."},
    // Unknown nodes.
    {"2 2 3 4 5", "2 2 3 4 0", "a.msh:28: element 2: node tag 0 is not one of the 5 nodes"},
    // Counts that the file cannot hold.
    {"1 5 1 5", "1 400000000000 1 5", "...the number of nodes is 400000000000, more than..."},
    {"3 1 0 5", "3 1 0 99999", "...number of nodes in a block is 99999, more than..."},
    {"1 1 1 2 7 8 0", "1 1 1 99999 7 8 0", "...number of physical groups is 99999, more than..."},
    {"1 5 1 5", "1 6 1 5", "...hold 5 nodes, but 6 are announced..."},
    {"2 2 1 2", "2 3 1 2", "...hold 2 elements, but 3..."},
};

TEST(GmshReader, RefusesFaultyFiles) {
    expect_refusals("a.msh", version_1, gmsh_1_faults);
    expect_refusals("a.msh", version_2, gmsh_2_faults);
    expect_refusals("a.msh", parametric, parametric_faults);
    expect_refusals("a.msh", version_4, gmsh_4_faults);
}

TEST(GmshReader, TurnsPrismsIntoWedges) {
    // The triangle 1, 2, 3 faces 4, 5, 6; in the mesh it faces away.
    const auto file = read_bytes("a.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 0 1
6 0 1 1
$EndNodes
$Elements
1
1 6 2 1 1 1 2 3 4 5 6
$EndElements
)");
    expect_wedge_of_unit_height(file.mesh);
}

TEST(GmshReader, SkipsSectionsWhoseNamesQuoteTheirEnd) {
    const std::string names =
        "$PhysicalNames\n1\n3 5 \"liver $EndPhysicalNames\"\n$EndPhysicalNames \r\n";
    for (const std::string& text :
         {replaced(version_2, "$Nodes", names + "$Nodes"),
          replaced(version_2, "$Nodes", "$Comments\nhello $EndComments\n$Nodes"),
          replaced(version_2, "$Nodes", "$Comments\nhello\n  $EndComments\n$Nodes")})
        EXPECT_EQ(read_bytes("a.msh", text).mesh.num_cells(),
                  read_bytes("a.msh", version_2).mesh.num_cells());
}

TEST(GmshReader, QuotesAndShortensNamesOfSections) {
    const auto message = refusal("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$\x1b[31m" +
                                              std::string(1, '\0') + std::string(5000, 'a') + "\n");
    EXPECT_LT(message.size(), 200u);
    EXPECT_EQ(message, printable(message));
    EXPECT_THAT(message, HasSubstr("the file is cut short"));
}

TEST(GmshReader, RefusesEntitiesBehindTheirElements) {
    const auto begin = version_4.find("$Entities"), end = version_4.find("$Nodes");
    const auto entities = version_4.substr(begin, end - begin);
    EXPECT_THAT(refusal("a.msh", replaced(version_4, entities, "") + entities),
                AllOf(StartsWith("a.msh:25: the entities come behind $Elements"),
                      HasSubstr("put $Elements last")));
}

TEST(GmshReader, RefusesBinaryCountsThatTheFileCannotHold) {
    for (const auto& sample : gmsh_samples()) {
        if (sample.name.starts_with("ascii") || sample.name.find("-4") == std::string::npos)
            continue;
        SCOPED_TRACE(sample.name);
        auto bytes = sample.bytes;
        const std::string mark = "$Nodes\n";
        // The second of the 8-byte numbers: how many nodes there are.
        bytes.replace(bytes.find(mark) + mark.size() + 8, 8, std::string(8, '\x11'));
        EXPECT_THAT(refusal("a.msh", bytes),
                    AllOf(StartsWith("a.msh: byte "),
                          HasSubstr("the number of nodes is 1229782938247303441")));
    }
}

}  // namespace
}  // namespace incise::io
