// What an Abaqus or CalculiX file means, and what is refused in one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/abaqus_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string abaqus_nodes = R"(*Heading
 two tetrahedra, *NODE and all
** nodes
*Node, nset=Nall
 30, 0., 0., 0.
 10, 1., 0., 0.
 20, 0., 1., 0.
 50, 0., 0., 1.
 40, 1., 1., 1.
)";
const std::string abaqus_tetrahedra = abaqus_nodes + R"(*Element, type=C3D4, elset=Eall
7, 30, 10, 20, 50
3, 10, 20, 50, 40
)";
/// 99 elements, numbered from 1.
std::string many_tetrahedra() {
    auto text = abaqus_nodes + "*ELEMENT, TYPE=C3D4\n";
    for (int i = 1; i < 100; ++i) text += std::to_string(i) + ",30,10,20,50\n";
    return text;
}

std::vector<int> regions_behind(std::string_view more) {
    return read_bytes("a.inp", abaqus_tetrahedra + std::string(more)).mesh.regions;
}

TEST(AbaqusReader, OrdersElementsByNumberAndNodesByFile) {
    const auto file = read_bytes("a.inp", abaqus_tetrahedra);
    EXPECT_EQ(file.mesh.points[0], Vec3(0, 0, 0));
    EXPECT_EQ(file.mesh.points[4], Vec3(1, 1, 1));
    EXPECT_THAT(file.mesh.corners, ElementsAre(1, 2, 3, 4, 0, 1, 2, 3));
}

TEST(AbaqusReader, ReadsRowsAndKeywordsAsTheManualAllows) {
    const auto file = read_bytes("a.inp",
                                 "** no heading\n*ELEMENT,\n Elset = REGION_2 ,\n type=c3d8r\n"
                                 "1, 1,2,3,4,\n** a comment within\n5,6,7, 8\n"
                                 "* node, SYSTEM=R\n"
                                 "1,,,\n2,1.D0,,,\n3,+1,1.,0.\n4,0,10.e-1,0.,1.,0.,0.\n"
                                 "5,,,1\n6,1,,1\n7,1,1,1\n8,,1,1d0\n");
    EXPECT_EQ(file.mesh.points[1], Vec3(1, 0, 0));
    EXPECT_EQ(file.mesh.points[7], Vec3(0, 1, 1));
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
    EXPECT_THAT(file.mesh.regions, ElementsAre(2));
    EXPECT_THAT(file.warnings, ElementsAre());
}

TEST(AbaqusReader, TakesCoordinatesThatAreLeftOutAsZero) {
    const auto one =
        read_bytes("a.inp", replaced(abaqus_tetrahedra, "20, 0., 1., 0.", "20, 0., 1."));
    EXPECT_EQ(one.mesh.points[2], Vec3(0, 1, 0));
    EXPECT_THAT(one.warnings, Contains("node 20 has less than three coordinates; those that are "
                                       "left out are taken as 0"));
    const auto two = read_bytes("a.inp", replaced(replaced(abaqus_tetrahedra, "0., 0., 0.", ""),
                                                  "20, 0., 1., 0.", "20, , 1."));
    EXPECT_EQ(two.mesh.points[0], Vec3(0, 0, 0));
    EXPECT_EQ(two.mesh.points[2], Vec3(0, 1, 0));
    EXPECT_THAT(two.warnings, Contains(StartsWith("2 nodes, the first node 30, have less than")));
}

TEST(AbaqusReader, TakesANodeGivenTwiceAtTheSamePlaceAsOne) {
    const auto file =
        read_bytes("a.inp", abaqus_tetrahedra + "*NODE, NSET=Reference\n10, 1, 0, 0\n");
    EXPECT_THAT(file.mesh.corners, ElementsAre(1, 2, 3, 4, 0, 1, 2, 3));
}

TEST(AbaqusReader, LeavesOutTextBeforeTheFirstKeyword) {
    const auto file = read_bytes("a.inp", ">**\n** a beam\nCALC PROBLEM\n" + abaqus_tetrahedra);
    EXPECT_EQ(file.mesh.num_cells(), 2u);
    EXPECT_THAT(file.warnings,
                Contains(StartsWith("left out what comes before the first keyword")));
    EXPECT_THAT(refusal("a.txt", ">**\n" + abaqus_tetrahedra), HasSubstr("no mesh format known"));
    EXPECT_THAT(refusal("a.inp", "5 2 0 0 0\n1 0 0 0\n"), HasSubstr("no mesh format known"));
}

TEST(AbaqusReader, TurnsWedgesToFaceAway) {
    const auto file = read_bytes("a.inp",
                                 "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,1,0,1\n6,0,1,1\n"
                                 "*ELEMENT,TYPE=C3D6\n1,1,2,3,4,5,6\n");
    expect_wedge_of_unit_height(file.mesh);
}

TEST(AbaqusReader, ReadsWhatMeshioWrites) {
    const auto file = read_bytes("a.inp", R"(*HEADING
Abaqus DataFile Version 6.14
written by meshio v5.0.0
*NODE
1, 0.0000000000000000e+00, 0.0000000000000000e+00, 0.0000000000000000e+00
2, 1.0000000000000000e+00, 0.0000000000000000e+00, 0.0000000000000000e+00
3, 0.0000000000000000e+00, 1.0000000000000000e+00, 0.0000000000000000e+00
4, 0.0000000000000000e+00, 0.0000000000000000e+00, 1.0000000000000000e+00
5, 1.0000000000000000e+00, 1.0000000000000000e+00, 1.0000000000000000e+00
*ELEMENT, TYPE=STRI3
1,1,2,3
*ELEMENT, TYPE=C3D4
2,1,2,3,4
3,2,3,4,5
*ELSET, ELSET=skin
1
*ELSET, ELSET=liver
3
*NSET, NSET=clamp
1,2
)");
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.mesh.regions, ElementsAre(0, 1));
    EXPECT_THAT(file.warnings,
                ElementsAre("element sets are taken as regions: region 1 is 'LIVER'; region 0 is "
                            "in none of them",
                            HasSubstr("ignored 1 triangle:")));
}

TEST(AbaqusReader, TakesSetsWithASectionAsRegionsFirst) {
    const std::string lists = "*ELSET, ELSET=Left\n3\n*ELSET, ELSET=Right\n7,\n";
    EXPECT_THAT(regions_behind(lists), ElementsAre(1, 1));  // Eall, given with the elements
    const std::string section = "*Solid Section, elset=RIGHT, material=Soft\n1.,\n";
    EXPECT_THAT(regions_behind(lists + section), ElementsAre(0, 1));
    EXPECT_THAT(regions_behind(lists + section + "*SOLID SECTION, ELSET=left\n"),
                ElementsAre(1, 2));
    const auto bare = replaced(abaqus_tetrahedra, ", elset=Eall", "");
    EXPECT_THAT(read_bytes("a.inp", bare + lists).mesh.regions, ElementsAre(1, 2));
    const std::string skin = "*ELEMENT, TYPE=S3, ELSET=Skin\n90, 30, 10, 20\n";
    EXPECT_THAT(read_bytes("a.inp", bare + skin + lists).mesh.regions, ElementsAre(1, 2));
    EXPECT_THAT(read_bytes("a.inp", bare).mesh.regions, ElementsAre(0, 0));
    EXPECT_THAT(read_bytes("a.inp", bare + "*ELSET, ELSET=_Picked, INTERNAL\n3\n").mesh.regions,
                ElementsAre(0, 0));
}

TEST(AbaqusReader, NumbersSetsRoundTheNamesThatHaveNumbers) {
    const auto file = read_bytes("a.inp", replaced(abaqus_tetrahedra, "Eall", "Region_1") +
                                              "*ELEMENT, TYPE=C3D4, ELSET=Tumour\n"
                                              "8, 30, 10, 20, 50\n"
                                              "*ELEMENT, TYPE=C3D4, ELSET=REGION_-5\n"
                                              "9, 30, 10, 20, 50\n");
    EXPECT_THAT(file.mesh.regions, ElementsAre(1, 1, 2, -5));
    EXPECT_THAT(file.warnings,
                ElementsAre("element sets are taken as regions: region 2 is 'TUMOUR'"));
}

TEST(AbaqusReader, FillsSetsFromListsRangesAndSets) {
    const auto file =
        read_bytes("a.inp", many_tetrahedra() +
                                "*ELSET, ELSET=Inner\n1, 2, 3,\n4\n"
                                "*ELSET, ELSET=REGION_8, GENERATE\n10, 99, 10\n55, 56\n"
                                "*ELSET, ELSET=REGION_9\nOuter, 60, Inner\n"
                                "*ELSET, ELSET=Outer, GENERATE\n90, 1000000000000000000\n"
                                "*SOLID SECTION, ELSET=REGION_8\n"
                                "*SOLID SECTION, ELSET=REGION_9\n");
    std::vector<int> expected(99, 0);
    for (const std::size_t e : {10, 20, 30, 40, 50, 55, 56, 60, 70, 80, 90}) expected[e - 1] = 8;
    for (const std::size_t e : {1, 2, 3, 4, 91, 92, 93, 94, 95, 96, 97, 98, 99})
        expected[e - 1] = 9;
    EXPECT_EQ(file.mesh.regions, expected);
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("some elements are in several sets")));
}

TEST(AbaqusReader, ReadsSetsThatHoldOneAnother) {
    // Sets of sets could make work and memory grow without bound; each is gone through once.
    std::string text = many_tetrahedra() + "*ELSET, ELSET=S0\n1, S40\n";
    for (int i = 1; i <= 40; ++i) {
        const auto before = std::string("S") + std::to_string(i - 1);
        text += "*ELSET, ELSET=S" + std::to_string(i) + "\n" + before + "," + before + "," +
                before + "\n";
    }
    const auto file = read_bytes("a.inp", text + "*SOLID SECTION, ELSET=S40\n");
    EXPECT_EQ(file.mesh.regions[0], 1);
    EXPECT_EQ(file.mesh.regions[1], 0);
    EXPECT_THAT(file.warnings, testing::Contains(StartsWith(
                                   "element sets hold themselves, each the next one: 'S0', 'S40', "
                                   "'S39', 'S38', 'S37', ...; all of them")));
    const auto warnings = [](const std::string& sets) {
        return read_bytes("a.inp", abaqus_tetrahedra + sets).warnings;
    };
    const std::string section = "*SOLID SECTION, ELSET=A\n";
    EXPECT_THAT(warnings("*ELSET, ELSET=A\nB\n*ELSET, ELSET=B\nA\n" + section),
                testing::Contains("element sets hold themselves, each the next one: 'A', 'B'; all "
                                  "of them hold the same elements"));
    EXPECT_THAT(warnings("*ELSET, ELSET=A\n3, A\n" + section),
                testing::Contains("element set 'A' holds itself"));
    EXPECT_THAT(
        warnings("*ELSET, ELSET=C\n3\n*ELSET, ELSET=B\nC\n*ELSET, ELSET=A\nB, C\n" + section),
        testing::Not(testing::Contains(testing::ContainsRegex("hold(s itself| themselves)"))));
}

TEST(AbaqusReader, ReadsTheOnePartOfAnAssembly) {
    const auto part = std::string("*Part, name=Liver\n") + abaqus_tetrahedra + "*End Part\n";
    const std::string assembly =
        "*Assembly, name=Assembly\n*Instance, name=Liver-1, part=Liver\n0., 0., 0.\n"
        "*End Instance\n*Node\n 1, 5., 5., 5.\n*Elset, elset=Tip, instance=Liver-1\n 3,\n"
        "*Element, type=MASS\n1, 1\n*End Assembly\n*Material, name=Soft\n*Elastic\n1000., 0.4\n";
    const auto file = read_bytes("a.inp", part + assembly);
    EXPECT_EQ(file.mesh.points.size(), 5u);
    EXPECT_THAT(file.mesh.regions, ElementsAre(1, 1));

    // Programs may write the mesh with the instance.
    const auto own = std::string("*Part, name=Liver\n*End Part\n") +
                     replaced(assembly, "0., 0., 0.\n", "** here\n" + abaqus_tetrahedra);
    expect_same_mesh(read_bytes("a.inp", own).mesh, file.mesh);

    const std::string move = "part=Liver\n0., 0., 0.";
    expect_refusals(
        "a.inp", part + assembly,
        {
            {move, "part=Liver\n0., 0., 2.", "...*INSTANCE moves the part..."},
            {move, "part=Liver\n0., zero",
             "...expected a translation or rotation, found 'zero'..."},
            {"*End Assembly", "*Instance, name=Liver-2, part=Liver", "...second *INSTANCE..."},
            {"", part + replaced(part, "Liver", "Stone") + assembly,
             "a.inp:19: ...of a second part..."},
        });
}

TEST(AbaqusReader, LeavesOutElementsThatAreNoSolids) {
    const auto file =
        read_bytes("a.inp", abaqus_tetrahedra +
                                "*ELEMENT, TYPE=S3R, ELSET=Skin\n11, 30, 10, 20\n"
                                "*ELEMENT, TYPE=STRI65\n12, 30, 10, 20,\n 50, 40, 30\n"
                                "*ELEMENT, TYPE=SPRINGA\n13, 30, 10\n14, 10, 20\n"
                                "*ELEMENT, TYPE=D\n15, 0, 10, 20\n");
    EXPECT_EQ(file.mesh.num_cells(), 2u);
    EXPECT_THAT(file.warnings,
                ElementsAre(HasSubstr("region 1 is 'EALL'"),
                            HasSubstr("ignored 1 triangle, 1 second-order triangle, 2 springs "
                                      "and 1 network element:")));
}

const std::vector<Fault> abaqus_faults = {
    // Higher order and unknown solids.
    {"C3D4", "C3D10M",
     "a.inp:11: element 7: a second-order tetrahedron (TYPE C3D10M) cannot be used...export linear "
     "elements..."},
    {"C3D4", "C3D20R", "...second-order hexahedron..."},
    {"type=C3D4, ", "", "a.inp:10: *ELEMENT has no TYPE"},
    // Unknown nodes and numbers given twice.
    {"50, 40", "50, 927", "a.inp:12: element 3: node 927 is not one of the 5 nodes"},
    {"50, 40", "50, 0", "a.inp:12: expected a node, from 1 on, found '0'"},
    {" 40, 1.", " 10, 1.",
     "a.inp: number 10 is given to two nodes, the nodes number 2 and 5 in the order of the file; "
     "give each node one of its own"},
    {"3, 10", "7, 10", "a.inp:12: number 7 is given to two elements"},
    // Rows of the wrong length.
    {"50, 40", "50",
     "a.inp:12: element 3: has 3 of the 4 nodes of a tetrahedron; the file is cut short or "
     "damaged"},
    {"20, 50\n", "20\n", "a.inp:12: element 7: has 8 nodes; a tetrahedron has 4"},
    // What is no number.
    {"40, 1.", "40, nan", "a.inp:9: coordinate x is nan; it must be finite"},
    {"40, 1.", "40, 1.D999", "...found '1.D999', which is out of range: -1.79..."},
    {"40, 1.", "40, one", "a.inp:9: expected coordinate x, found 'one'"},
    {" 40, 1.", " 4e1, 1.", "...the number of a node..."},
    {"50, 40", "50, 99999999999999999999",
     "...expected a node, from 1 on, found '99999999999999999999', which is out of range: "
     "-9223372036854775808 to 9223372036854775807 are allowed..."},
    {"", abaqus_nodes, "a.inp: holds no cells at all..."},
};

/// Lines that take the place of the comment behind the elements.
const std::vector<Fault> abaqus_faults_behind = {
    {"** more", "*ELSET\n1\n", "a.inp:13: *ELSET has no name, ELSET=..."},
    {"** more", "*ELSET, ELSET=A\n3, B\n*NODE\n", "a.inp:14: element set 'B' is not defined"},
    {"** more", "*ELSET, ELSET=A\n3, 99999999999999999999\n",
     "a.inp:14: expected an element, found '99999999999999999999', which..."},
    {"** more", "*ELSET, ELSET=A\n-3\n", "...elements -3 to -3..."},
    {"** more", "*ELSET, ELSET=A, GENERATE\n5, 3\n", "...elements 5 to 3 by steps of 1..."},
    {"** more", "*ELSET, ELSET=A, GENERATE\n1, 3, 0\n",
     "...expected the step, from 1 on, found '0'..."},
    {"** more", "*ELSET, ELSET=A, GENERATE\n1\n", "...needs a first and a last element..."},
    {"** more", "*SOLID SECTION, ELSET=B\n", "a.inp:13: element set 'B' is not defined"},
    {"** more", "*SOLID SECTION\n", "a.inp:13: *SOLID SECTION has no ELSET"},
};

TEST(AbaqusReader, RefusesFaultyFiles) {
    expect_refusals("a.inp", abaqus_tetrahedra, abaqus_faults);
    expect_refusals("a.inp", abaqus_tetrahedra + "** more", abaqus_faults_behind);
    for (const auto* type : {"C3D7", "C3D", "SC8R", "U1", "COH3D8"})
        expect_refusals(
            "a.inp", abaqus_tetrahedra,
            {{"C3D4", type, "a.inp:10: TYPE='" + std::string(type) + "': is not known..."}});
    for (const auto* keyword :
         {"*NGEN", "*nfill", "*NCOPY", "*NMAP", "*SYSTEM", "*El Gen", "*ELCOPY", "*NODE, SYSTEM=C"})
        expect_refusals("a.inp", abaqus_tetrahedra + "** more",
                        {{"** more", std::string(keyword) + "\n1, 2\n", "a.inp:13: ...export..."}});
}

}  // namespace
}  // namespace incise::io
