// Tetrahedra of label images: a region a label, in the frame of the image.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "made_mesh.h"

namespace incise {
namespace {

/// A block of 12 x 8 x 6 voxels of 1 x 1 x 2 in a margin of one voxel: label 4 below x = 8, else 2.
std::string block_image() {
    std::string text =
        "NRRD0004\ntype: short\ndimension: 3\nspace: LPS\nsizes: 14 10 8\n"
        "space directions: (0,1,0) (1,0,0) (0,0,2)\nspace origin: (10,20,30)\n"
        "encoding: text\n\n";
    for (int k = 0; k < 8; ++k)
        for (int j = 0; j < 10; ++j)
            for (int i = 0; i < 14; ++i) {
                const bool is_inside =
                    i % 13 != 0 && j % 9 != 0 && k % 7 != 0;  // not in the margin
                text += !is_inside ? "0 " : i < 8 ? "4 " : "2 ";
            }
    return text + "\n";
}

using ImageMesh = test::MakesTetrahedra;

TEST_F(ImageMesh, HasARegionForEachLabel) {
    write("block.nrrd", block_image());
    const auto made = make("block.nrrd out.vtu --size 1.5");
    EXPECT_EQ(made.err.find("warning"), std::string::npos) << made.err;
    EXPECT_EQ(made.num_components, 1);  // the regions share faces
    ASSERT_EQ(made.volumes.size(), 2u);
    EXPECT_NEAR(made.volume(4), 7 * 8 * 12, 0.06 * 7 * 8 * 12);  // edges are rounded off
    EXPECT_NEAR(made.volume(2), 5 * 8 * 12, 0.06 * 5 * 8 * 12);
    // The first axis of the image is y; the block begins half a voxel before its first centre.
    const Box box(made.metrics.box_min, made.metrics.box_max);
    EXPECT_TRUE(box.min().isApprox(Vec3(10.5, 20.5, 31), 0.01)) << box.min().transpose();
    EXPECT_TRUE(box.max().isApprox(Vec3(18.5, 32.5, 43), 0.01)) << box.max().transpose();
}

TEST_F(ImageMesh, ScalesToTheUnitOfItsSizes) {
    write("block.nrrd", block_image());
    const auto made = make("block.nrrd out.vtu --size 0.004 --size-surface 0.002 --scale 0.001");
    EXPECT_NEAR(made.metrics.volume, 12 * 8 * 12e-9, 0.1 * 12 * 8 * 12e-9);
}

TEST_F(ImageMesh, RefusesWhatItCannotMesh) {
    write("block.nrrd", block_image());
    auto empty = block_image();
    for (std::size_t i = empty.find("\n\n"); i < empty.size(); ++i)
        if (empty[i] == '4' || empty[i] == '2') empty[i] = '0';
    write("empty.nrrd", empty);
    EXPECT_THAT(refusal("empty.nrrd out.vtu --size 1"), testing::HasSubstr("all are 0"));
    EXPECT_THAT(refusal("block.nrrd out.vtu --size 1 --features 30"),
                testing::HasSubstr("a label image has no sharp edges to keep"));
    EXPECT_EQ(
        refusal("block.nrrd ball.stl out.vtu --size 1"),
        "incise: block.nrrd: is no surface (.stl, .ply, .off, .obj), and of several files all "
        "must be; mesh one label image alone\n");
    EXPECT_THAT(refusal("block.nrrd out.vtu --size 1e-4"), testing::HasSubstr("a larger one"));
}

}  // namespace
}  // namespace incise
