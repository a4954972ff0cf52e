// What incise mesh refuses to make tetrahedra of, with the file, the place and the remedy.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "made_mesh.h"

namespace incise {
namespace {

using test::box_surface;
using test::icosphere;
using testing::HasSubstr;
using testing::StartsWith;

class SurfaceRefusal : public test::MakesTetrahedra {
  protected:
    const topology::SurfaceData box_ = box_surface(Box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
};

TEST_F(SurfaceRefusal, NamesTheHoleOfAnOpenSurface) {
    auto open = icosphere({0, 0, 0}, 1.0, 2);
    open.triangles.pop_back();
    write_surface("open.stl", open);
    const auto message = refusal("open.stl out.vtu --size 0.2");
    EXPECT_THAT(message,
                StartsWith("incise: open.stl: the surface is open at 3 edges, the first at "
                           "("));
    EXPECT_THAT(message, HasSubstr("close its holes"));
    write_surface("box.stl", box_);
    EXPECT_THAT(refusal("box.stl open.stl out.vtu --size 0.2"), StartsWith("incise: open.stl: "));
}

TEST_F(SurfaceRefusal, NamesThePlaceOfACrossing) {
    // One part that passes through itself: a point of a box that is pushed out of the other side.
    auto pushed = box_;
    for (Vec3& x : pushed.points)
        if (x == Vec3(1, 1, 1)) x = Vec3(0.5, 0.5, -1);
    write_surface("pushed.stl", pushed);
    EXPECT_THAT(refusal("pushed.stl out.vtu --size 0.2"),
                StartsWith("incise: pushed.stl: the surface crosses itself at ("));
    write_surface("box.stl", box_);
    write_surface("other.stl", box_surface(Box(Vec3(0.5, 0.5, 0.5), Vec3(2, 2, 2))));
    EXPECT_THAT(refusal("box.stl other.stl out.vtu --size 0.2"),
                StartsWith("incise: box.stl: the surface crosses other.stl at ("));
    write_surface("both.stl",
                  test::joined(box_, box_surface(Box(Vec3(0.2, 0.2, -1), Vec3(0.8, 0.8, 2)))));
    EXPECT_THAT(refusal("both.stl out.vtu --size 0.2"), HasSubstr("crosses itself at ("));
}

TEST_F(SurfaceRefusal, AsksForFilesOfSurfacesThatTouch) {
    write_surface("touch.stl", test::joined(box_, box_surface(Box(Vec3(1, 0, 0), Vec3(2, 1, 1)))));
    EXPECT_THAT(refusal("touch.stl out.vtu --size 0.2"), HasSubstr("files of their own"));
}

TEST_F(SurfaceRefusal, EndsWithSizesThatCannotBe) {
    write_surface("box.stl", box_);
    EXPECT_EQ(refusal("box.stl out.vtu --size 0.1 --size-surface 0.2"),
              "incise: --size-surface: 0.2 is more than the 0.1 of --size; edges grow inwards, so "
              "give a smaller one\n");
    EXPECT_THAT(refusal("box.stl out.vtu --size 1e-6"), HasSubstr("give a larger one"));
    EXPECT_THAT(refusal("box.stl out.vtu --size 0.1 --features 200"),
                HasSubstr("it must be a number of degrees between 0 and 180"));
    EXPECT_THAT(refusal("box.stl out.vtu --size 0.1 --scale 1e-300"), HasSubstr("incise: "));
    write_surface("plate.stl", box_surface(Box(Vec3(0, 0, 0), Vec3(1, 1, 0.01))));
    EXPECT_THAT(refusal("plate.stl out.vtu --size 0.1"),
                HasSubstr("is thinner than the edges: give a smaller --size"));
    write_surface("speck.stl", icosphere({0, 0, 0}, 1e-3, 0));
    const auto outcome = run("mesh speck.stl out.vtu --size 100");
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << outcome.err;
}

}  // namespace
}  // namespace incise
