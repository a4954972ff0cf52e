// What a FEBio file means, and what is refused in one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/febio_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

using testing::ElementsAre;

const std::string febio_4 = R"(<?xml version="1.0" encoding="ISO-8859-1"?>
<febio_spec version="4.0">
<Material><material id="1" name="Soft"/></Material>
<Mesh>
<Nodes name="all">
<node id="3">0, 0,0</node>
<node id="1">1 0 0</node>
<node id="2"> 0,1e0,0 </node>
<node id="5">0,0,1</node>
<node id="4">1,1,1</node>
</Nodes>
<Elements type="tet4" name="Liver">
<elem id="7">3,1,2,5</elem>
</Elements>
<Elements type="tet4" name="Tumour">
<elem id="6">1,2,5,4</elem>
</Elements>
<ElementSet name="Right">6</ElementSet>
</Mesh>
<MeshDomains><SolidDomain name="Liver" mat="Soft"/></MeshDomains>
</febio_spec>
)";
const std::string febio_2 =
    replaced(replaced(replaced(replaced(replaced(febio_4, "4.0", "2.5"), "<Mesh>", "<Geometry>"),
                               "</Mesh>", "</Geometry>"),
                      "name=\"Liver\"", "mat=\"4\" name=\"Liver\""),
             "type=\"tet4\" name=\"Tumour\"", "type=\"tet4\" mat=\"2\"");

TEST(FebioReader, KeepsTheOrderOfTheFile) {
    const auto file = read_bytes("a.feb", febio_4);
    EXPECT_EQ(file.mesh.points[0], Vec3(0, 0, 0));
    EXPECT_EQ(file.mesh.points[4], Vec3(1, 1, 1));
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.mesh.source_cells, ElementsAre(7, 6));
    EXPECT_THAT(file.mesh.source_points, ElementsAre(3, 1, 2, 5, 4));
}

TEST(FebioReader, TakesBlocksOrMaterialsOrSetsAsRegions) {
    const auto blocks = read_bytes("a.feb", febio_4);
    EXPECT_THAT(blocks.mesh.regions, ElementsAre(1, 2));
    EXPECT_THAT(blocks.warnings, ElementsAre("element sets are taken as regions: region 1 is "
                                             "'Liver', 2 is 'Tumour'"));
    const auto materials = read_bytes("a.feb", febio_2);
    EXPECT_THAT(materials.mesh.regions, ElementsAre(4, 2));
    EXPECT_THAT(materials.warnings, ElementsAre());
    const auto nameless =
        replaced(replaced(febio_4, "\"tet4\" name=\"Liver\"", "\"tet4\""), " name=\"Tumour\"", "");
    const auto rows = replaced(nameless, ">6</ElementSet>", "><elem id=\"6\"/></ElementSet>");
    for (const auto& text : {nameless, rows}) {
        const auto sets = read_bytes("a.feb", text);
        EXPECT_THAT(sets.mesh.regions, ElementsAre(0, 1));
        EXPECT_THAT(sets.warnings, ElementsAre("element sets are taken as regions: region 1 is "
                                               "'Right'; region 0 is in none of them"));
    }
}

TEST(FebioReader, LetsBlocksBeginTheirNumbersAnew) {
    const auto text = replaced(replaced(febio_4, "elem id=\"6\"", "elem id=\"7\""),
                               "<ElementSet name=\"Right\">6</ElementSet>", "");
    const auto file = read_bytes("a.feb", text);
    EXPECT_THAT(file.mesh.source_cells, ElementsAre(7, 7));
    EXPECT_THAT(file.mesh.regions, ElementsAre(1, 2));
}

TEST(FebioReader, TurnsPentasIntoWedges) {
    const auto file = read_bytes(
        "a.feb",
        "<febio_spec version=\"3.0\"><Mesh><Nodes><node id=\"1\">0,0,0</node><node "
        "id=\"2\">1,0,0</node><node id=\"3\">0,1,0</node><node id=\"4\">0,0,1</node><node "
        "id=\"5\">1,0,1</node><node id=\"6\">0,1,1</node></Nodes><Elements type=\"penta6\"><elem "
        "id=\"1\">1,2,3,4,5,6</elem></Elements></Mesh></febio_spec>");
    expect_wedge_of_unit_height(file.mesh);
}

const std::vector<Fault> febio_4_faults = {
    // Wrong numbers.
    {"0,0,1<", "0,0<", "a.feb:9: a node has 2 coordinates; it must have 3"},
    {"0,0,1<", "0,x,1<", "a.feb:9: expected a coordinate, found 'x'..."},
    {"0,0,1<", "0,,1<", "a.feb:9: expected a coordinate, found ''..."},
    {"0,0,1<", "0,0,inf<", "a.feb:9: a coordinate is inf; it must be finite"},
    {"node id=\"5\"", "node id=\"five\"",
     "a.feb:9: node: the id is 'five'; it must be a whole number from 1 on"},
    {"node id=\"5\"", "node", "...a.feb:9: node: the id is ''..."},
    {"node id=\"5\"", "node id=\"4\"", "a.feb: node 4 is given to two nodes..."},
    {"1,2,5,4<", "1,2,5,9<", "a.feb:16: element 6: node 9 is not one of the 5 nodes"},
    {"1,2,5,4<", "1,2,5<", "a.feb:16: element 6: has 3 nodes; a tetrahedron has 4"},
    {">6</ElementSet", ">8</ElementSet",
     "a.feb:18: element 8 of an ElementSet is not one of the 2 elements"},
    // What cannot be read.
    {"version=\"4.0\"", "version=\"1.2\"",
     "a.feb:2: version '1.2' cannot be read; save the model as..."},
    {"version=\"4.0\"", "version=\"2.5\"",
     "a.feb:2: has no section Geometry, and so no mesh; give the file of the model that has one"},
    {"type=\"tet4\"", "type=\"blob7\"",
     "a.feb:12: type 'blob7' of Elements is not known; export tet4..."},
    {"type=\"tet4\"", "type=\"tet10\"",
     "a.feb:13: element 7: a second-order tetrahedron (type tet10)...export linear elements..."},
    {"</Nodes>", "</nodes>", "a.feb:11: not well-formed XML...cut short..."},
    {" name=\"Right\"", "", "a.feb:18: ElementSet has no name..."},
    {"", "<?xml version=\"1.0\"?><other/>",
     "a.feb: is XML, but has no febio_spec element: its first element is 'other'; give the file of "
     "a model of FEBio"},
};

const std::vector<Fault> febio_2_faults = {
    {"mat=\"2\"", "mat=\"Soft\"", "a.feb:15: mat is 'Soft'; it must be the number of a material"},
    {"<Geometry>", "<Geometry><Part name=\"a\"/>",
     "a.feb:4: Part is not read; save the mesh as one..."},
};

const std::vector<Fault> xml_faults = {
    {"", "<?xml version=\"1.0\"?>\n<!-- fit -->\n<febio_optimize/>",
     "...its first element is 'febio_optimize', which tells FEBio what...give the file of the "
     "model..."},
    {"", "<other/>", "...is XML, but has no VTKFile element: its first one is 'other'..."},
};

TEST(FebioReader, RefusesFaultyFiles) {
    expect_refusals("a.feb", febio_4, febio_4_faults);
    expect_refusals("a.feb", febio_2, febio_2_faults);
    expect_refusals("a.feb", replaced(febio_4, "elem id=\"6\"", "elem id=\"7\""),
                    {{">6</ElementSet", ">7</ElementSet",
                      "a.feb:18: element 7 of an ElementSet is the number of 2 elements; give each "
                      "element a number of its own"}});
    expect_refusals("a.xml", "", xml_faults);
}

}  // namespace
}  // namespace incise::io
