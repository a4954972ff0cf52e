// FEBio models whose mesh is in another file, and what is refused about them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/febio_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "incise/base/error.h"
#include "tests/io/reader_samples.h"
#include "tests/support/temporary_folder.h"

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

class FebioFiles : public testing::Test {
  protected:
    using Files = std::map<std::string, std::string>;

    MeshFile read(const Files& files) {
        for (const auto& [name, text] : files) {
            std::filesystem::create_directories((folder_ / name).parent_path());
            std::ofstream(folder_ / name) << text;
        }
        return read_mesh(folder_ / "a.feb");
    }
    /// The message, without the folder.
    std::string refused(const Files& files) {
        try {
            read(files);
        } catch (const InputError& error) {
            std::string text = error.what();
            const auto prefix = (folder_ / "").string();
            for (auto at = text.find(prefix); at != text.npos; at = text.find(prefix))
                text.erase(at, prefix.size());
            return text;
        }
        return "not refused";
    }

    support::TemporaryFolder folder_;
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
}

}  // namespace
}  // namespace incise::io
