// *INCLUDE in Abaqus and CalculiX decks: what it reads, and what is refused about it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/abaqus_includes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/mesh_folder.h"

namespace incise::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string five_nodes =
    "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 1, 1\n";

class AbaqusInclude : public MeshFolder {
  protected:
    AbaqusInclude() : MeshFolder("a.inp") {}
};

TEST_F(AbaqusInclude, ReadsFilesInPlaceOfTheLine) {
    const auto file =
        read({{"a.inp",
               "** deck\n*include, input=nodes.txt\n*ELEMENT, TYPE=C3D4, ELSET=A\n"
               "*INCLUDE, INPUT = parts/more.inp\n2, 2, 3, 4, 5\n"},
              {"nodes.txt", five_nodes.substr(0, five_nodes.size() - 1)},  // no line feed
              {"parts/more.inp", "1, 1, 2, 3,\n4\n"}});
    EXPECT_EQ(file.mesh.points.size(), 5u);
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.mesh.regions, ElementsAre(1, 1));
}

TEST_F(AbaqusInclude, TakesNamesFromTheFolderOfTheDeck) {
    const auto file = read(
        {{"a.inp", "*INCLUDE,\n** a comment\nINPUT=\"parts/all of it.inp\"\n"},
         {"parts/all of it.inp", "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"},
         {"nodes.inp", five_nodes}});
    EXPECT_EQ(file.mesh.num_cells(), 1u);
}

TEST_F(AbaqusInclude, MayComeTwice) {
    const auto file =
        read({{"a.inp", five_nodes + "*ELEMENT, TYPE=C3D4\n*INCLUDE, INPUT=one.inp\n*ELSET, "
                                     "ELSET=A\n*INCLUDE, INPUT=set.inp\n*ELSET, ELSET=B\n"
                                     "*INCLUDE, INPUT=set.inp\n"},
              {"one.inp", "1, 1, 2, 3, 4\n"},
              {"set.inp", "1\n"}});
    EXPECT_THAT(file.mesh.regions, ElementsAre(1));
}

TEST_F(AbaqusInclude, NamesTheFileAndLineOfAFault) {
    const std::string deck =
        five_nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n*INCLUDE, INPUT=b.inp\n3, 2, 3, 4, 5\n";
    EXPECT_THAT(refused({{"a.inp", deck}, {"b.inp", "** more\n2, 2, 3, 4, 9\n"}}),
                StartsWith("b.inp:2: element 2: node 9 is not one of the 5 nodes"));
    EXPECT_THAT(refused({{"a.inp", deck}, {"b.inp", "2, 2, x, 4, 5\n"}}),
                StartsWith("b.inp:1: expected a node, from 1 on, found 'x'"));
    EXPECT_THAT(refused({{"a.inp", deck + "4, 2, 3, 4, 9\n"}, {"b.inp", "2, 2, 3, 4, 5\n"}}),
                StartsWith("a.inp:11: element 4: node 9"));
    EXPECT_THAT(refused({{"a.inp", deck}, {"b.inp", "\n3, 2, 3, 4, 5\n"}}),
                StartsWith("a.inp:10: number 3 is given to two elements"));
}

TEST_F(AbaqusInclude, RefusesFilesThatCannotBeRead) {
    EXPECT_EQ(refused({{"a.inp", "** deck\n*INCLUDE, INPUT=b.inp\n"}}),
              "a.inp:2: *INCLUDE: b.inp: no such file; check the path");
    EXPECT_EQ(refused({{"a.inp", "*INCLUDE, INPUT=c.inp\n"}, {"c.inp", ""}}),
              "a.inp:1: *INCLUDE: c.inp: the file is empty");
    EXPECT_EQ(refused({{"a.inp", "*INCLUDE\n"}}),
              "a.inp:1: *INCLUDE names no file: write INPUT= and the name of the file to include");
    EXPECT_EQ(refused({{"a.inp", "*INCLUDE, INPUT=d.inp\n"}, {"d.inp", "\n*INCLUDE, INPUT=\n"}}),
              "d.inp:2: *INCLUDE names no file: write INPUT= and the name of the file to include");
}

TEST_F(AbaqusInclude, RefusesCircles) {
    EXPECT_THAT(refused({{"a.inp", "*INCLUDE, INPUT=a.inp\n"}}),
                AllOf(StartsWith("a.inp:1: *INCLUDE: 'a.inp' is the file of this line, or"),
                      HasSubstr("take the line out")));
    EXPECT_THAT(refused({{"a.inp", "*INCLUDE, INPUT=b.inp\n"},
                         {"b.inp", "**\n*INCLUDE, INPUT=c.inp\n"},
                         {"c.inp", "**\n**\n*INCLUDE, INPUT=./b.inp\n"}}),
                StartsWith("c.inp:3: *INCLUDE: './b.inp' is the file of this line, or includes"));
}

TEST_F(AbaqusInclude, BoundsTheNumberOfFiles) {
    Files files;
    for (int i = 0; i < 20; ++i) {
        const std::string line = "*INCLUDE, INPUT=" + std::to_string(i + 1) + ".inp\n";
        files[(i == 0 ? "a" : std::to_string(i)) + ".inp"] = line + line;
    }
    files["20.inp"] = "**\n";
    EXPECT_THAT(refused(files), HasSubstr("more than 1000 files are included"));
}

TEST_F(AbaqusInclude, ReadsRowsOfNodesAndElementsInOtherFiles) {
    const auto file =
        read({{"a.inp",
               "*Node,\n** in parts\n nset=all, input=nodes.csv\n5, 1, 1, 1\n*ELEMENT, "
               "INPUT=parts/all.csv, TYPE=C3D4, ELSET=A\n2, 2, 3, 4, 5\n"},
              {"nodes.csv", "1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"},
              {"parts/all.csv", "1, 1, 2, 3,\n4"}});
    EXPECT_EQ(file.mesh.points.size(), 5u);
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.mesh.regions, ElementsAre(1, 1));
}

TEST_F(AbaqusInclude, NamesTheKeywordThatNamesAFile) {
    EXPECT_EQ(refused({{"a.inp", "** deck\n*NODE,\nINPUT=b.csv\n"}}),
              "a.inp:2: *NODE: b.csv: no such file; check the path");
    EXPECT_EQ(refused({{"a.inp", "*Element, TYPE=C3D4, INPUT=\n"}}),
              "a.inp:1: *ELEMENT names no file: write INPUT= and the name of the file to include");
    EXPECT_EQ(refused({{"a.inp", "*NODE,\nINPUT=c.csv\n1, x\n"}, {"c.csv", "2, 0, 0, 0\n"}}),
              "a.inp:3: expected coordinate x, found 'x'");
    EXPECT_EQ(refused({{"a.inp", "*NODE,\nINPUT=c.csv\n"}, {"c.csv", "\n2, x, 0, 0\n"}}),
              "c.csv:2: expected coordinate x, found 'x'");
}

}  // namespace
}  // namespace incise::io
