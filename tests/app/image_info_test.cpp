// incise info and incise check on label images: what they say, and how other images are named.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "in_folder.h"

namespace incise {
namespace {

using testing::HasSubstr;

/// Voxels with edges of 2, 3 and 4; the first axis points back along y, the second one along x.
const std::string header =
    "NRRD0005\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 2 3\n"
    "space directions: (0,-2,0) (3,0,0) (0,0,4)\nspace origin: (1,2,3)\nencoding: text\n\n";

class ImageFiles : public test::InFolder {
  protected:
    void SetUp() override { write("organ.nrrd", header + "0 0 0 5 5 5 5 0 0 2 0 0\n"); }
};

TEST_F(ImageFiles, AreDescribedByInfo) {
    const auto outcome = run("info organ.nrrd");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out,
              "voxels           2 x 2 x 3\nspacing          2 3 4\nextent           4 6 12\n"
              "first centre     1 2 3\nfirst axis       0 -1 0\nsecond axis      1 0 0\n"
              "third axis       0 0 1\n"
              "label 0          7 voxels, background\nlabel 2          1 voxel, volume 24\n"
              "label 5          4 voxels, volume 96\n"
              "an image is no body; to make one: incise mesh organ.nrrd organ.vtu --size 6e-04 "
              "--scale 0.001\n");
    write("mirrored.nrrd",
          std::string(header).replace(header.find("-2"), 2, "2") + "0 0 0 5 5 5 5 0 0 2 0 0\n");
    const auto said = nlohmann::json::parse(run("info mirrored.nrrd --json").out);
    EXPECT_EQ(said["dimensions"], nlohmann::json({2, 2, 3}));
    EXPECT_EQ(said["directions"], nlohmann::json({{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(said["left_handed"], true);
    EXPECT_EQ(said["labels"], nlohmann::json({{"0", 7}, {"2", 1}, {"5", 4}}));
    EXPECT_EQ(said["voxel_volume"], 24);
}

TEST_F(ImageFiles, AreCheckedForLabels) {
    EXPECT_EQ(run("check organ.nrrd").out,
              "organ.nrrd: OK, label image of 2 x 2 x 3 voxels with 2 labels, extent 4 x 6 x 12; "
              "to make a body of it: incise mesh organ.nrrd organ.vtu --size 6e-04 --scale "
              "0.001\n");
    write("scan.nrrd", header + "0 0 0 -5 5 5 5 0 0 2 0 0\n");
    for (const std::string verb : {"check", "info"}) {
        const auto outcome = run(verb + " scan.nrrd");
        EXPECT_EQ(outcome.status, 2);
        EXPECT_THAT(outcome.err, HasSubstr("looks like a scan, an image of grey values"));
    }
}

TEST_F(ImageFiles, OfOtherKindsAreNamed) {
    write("image.dat", header + "0 0 0 5 5 5 5 0 0 2 0 0\n");
    write("photo.png", "\x89PNG\r\n\x1a\n");
    write("slice.dcm", std::string(128, '\0') + "DICM");
    for (const auto& [file, name] :
         {std::pair("image.dat", "is an image (NRRD); a body is made of"),
          std::pair("photo.png", "is a picture (PNG); a body can be made of"),
          std::pair("slice.dcm", "is an image of DICOM; a body can be made of")}) {
        const auto outcome = run(std::string("info ") + file);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_THAT(outcome.err, HasSubstr(std::string(file) + ": " + name));
    }
}

}  // namespace
}  // namespace incise
