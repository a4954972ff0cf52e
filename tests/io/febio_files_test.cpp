// FEBio models whose mesh is in another file, and what is refused about them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/febio_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/mesh_folder.h"
#include "tests/io/reader_samples.h"

namespace incise::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string febio(const std::string& sections) {
    return "<febio_spec version=\"2.5\">\n" + sections + "\n</febio_spec>\n";
}
const std::string geometry =
    "<Geometry>\n<Nodes>\n<node id=\"1\">0,0,0</node>\n<node id=\"2\">1,0,0</node>\n"
    "<node id=\"3\">0,1,0</node>\n<node id=\"4\">0,0,1</node>\n</Nodes>\n"
    "<Elements type=\"tet4\" mat=\"3\">\n<elem id=\"1\">1,2,3,4</elem>\n</Elements>\n</Geometry>";

class FebioFiles : public MeshFolder {
  protected:
    FebioFiles() : MeshFolder("a.feb") {}
};

TEST_F(FebioFiles, ReadsTheMeshOfAnIncludedFile) {
    const auto file = read({{"a.feb", febio("<Include>globals.feb</Include>\n"
                                            "<Include>parts/mesh.feb</Include>")},
                            {"globals.feb", febio("<Globals/>")},
                            {"parts/mesh.feb", febio("<Include>inner.feb</Include>")},
                            {"parts/inner.feb", febio(geometry)}});
    EXPECT_EQ(file.mesh.num_cells(), 1u);
    EXPECT_THAT(file.mesh.regions, testing::ElementsAre(3));
}

TEST_F(FebioFiles, ReadsTheMeshThatASectionNames) {
    const auto file =
        read({{"a.feb", febio("<Geometry from=\"mesh.feb\"/>")}, {"mesh.feb", febio(geometry)}});
    EXPECT_EQ(file.mesh.num_cells(), 1u);
}

TEST_F(FebioFiles, LeavesFilesAloneIfTheModelHasTheMesh) {
    const auto file = read({{"a.feb", febio("<Include>none.feb</Include>\n" + geometry)}});
    EXPECT_EQ(file.mesh.num_cells(), 1u);
}

TEST_F(FebioFiles, NamesTheFileAndLineOfAFault) {
    const std::string model = febio("<Geometry from=\"mesh.feb\"/>");
    EXPECT_EQ(
        refused({{"a.feb", model}, {"mesh.feb", febio(replaced(geometry, "1,2,3,4", "1,2,3,9"))}}),
        "mesh.feb:10: element 1: node 9 is not one of the 4 nodes");
    EXPECT_THAT(refused({{"a.feb", model}, {"mesh.feb", febio("<Globals/>")}}),
                StartsWith("a.feb:2: Geometry is taken from the file 'mesh.feb', which has no "));
    EXPECT_THAT(refused({{"a.feb", model}, {"mesh.feb", "<other/>"}}),
                StartsWith("mesh.feb: is XML, but has no febio_spec element"));
    EXPECT_EQ(refused({{"a.feb", febio("<Geometry from=\"none.feb\"/>")}}),
              "a.feb:2: Geometry: none.feb: no such file; check the path");
    EXPECT_EQ(refused({{"a.feb", febio("\n<Include>none.feb</Include>")}}),
              "a.feb:3: Include: none.feb: no such file; check the path");
}

TEST_F(FebioFiles, RefusesSeveralMeshesAndCircles) {
    EXPECT_EQ(refused({{"a.feb", febio("<Include>b.feb</Include>\n<Include>c.feb</Include>")},
                       {"b.feb", febio(geometry)},
                       {"c.feb", febio(geometry)}}),
              "a.feb:3: Include: a second file with elements; put all nodes and elements into one "
              "file");
    EXPECT_THAT(refused({{"a.feb", febio("<Geometry from=\"a.feb\"/>")}}),
                AllOf(StartsWith("a.feb:2: Geometry: more than 20 files name each other"),
                      HasSubstr("into one file")));
    EXPECT_EQ(refused({{"a.feb", febio("<Include> </Include>")}}),
              "a.feb:2: Include: names no file");
    // Nodes of its own would be lost.
    const std::string nodes = geometry.substr(0, geometry.find("<Elements")) + "</Geometry>\n";
    EXPECT_THAT(
        refused({{"a.feb", febio(nodes + "<Include>b.feb</Include>")}, {"b.feb", febio(geometry)}}),
        AllOf(StartsWith("a.feb:2: "), HasSubstr("its elements in "), HasSubstr("into one file")));
}

TEST_F(FebioFiles, ReadsNamesOnLinesOfTheirOwn) {
    EXPECT_EQ(read({{"a.feb", febio("<Include>\n  b.feb\n</Include>")}, {"b.feb", febio(geometry)}})
                  .mesh.num_cells(),
              1u);
}

}  // namespace
}  // namespace incise::io
