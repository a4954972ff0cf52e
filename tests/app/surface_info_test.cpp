// incise info and incise check on surfaces: what they say, and the command that they name.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "in_folder.h"
#include "support/surfaces.h"

namespace incise {
namespace {

class SurfaceFiles : public test::InFolder {
  protected:
    void SetUp() override {
        auto box = test::box_surface(Box(Vec3(0, 0, 0), Vec3(1, 2, 4)));
        write("box.stl", test::stl_text(box));
        box.triangles.pop_back();
        write("open box.stl", test::stl_text(box));
    }
};

TEST_F(SurfaceFiles, AreDescribedByInfo) {
    const auto outcome = run("info box.stl");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out,
              "triangles        12\npoints           8\nclosed           yes\n"
              "components       1\nbounding box     0 0 0 to 1 2 4\nvolume           8\n"
              "surface area     28\n"
              "a surface is no body; to make one: incise mesh box.stl box.vtu --size 0.2\n");
    const auto said = nlohmann::json::parse(run("info 'open box.stl' --json").out);
    EXPECT_EQ(said["closed"], false);
    EXPECT_EQ(said["open_edges"], 3);
    EXPECT_EQ(said["components"], 1);
    EXPECT_EQ(said["volume"], nullptr);
    EXPECT_EQ(said["command"], "incise mesh 'open box.stl' 'open box.vtu' --size 0.2");
}

TEST_F(SurfaceFiles, AreCheckedForAnInside) {
    const auto outcome = run("check box.stl 'open box.stl'");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(
        outcome.out,
        "box.stl: OK, surface with 12 triangles, 1 component, closed, volume 8, extent 1 x 2 "
        "x 4; to make a body of it: incise mesh box.stl box.vtu --size 0.2\n"
        "open box.stl: OK, surface with 11 triangles, 1 component, not closed, extent 1 x 2 x "
        "4; to make a body of it: incise mesh 'open box.stl' 'open box.vtu' --size 0.2\n");
    EXPECT_EQ(outcome.err.find("incise: warning: open box.stl: the surface is open at 3 edges, the "
                               "first at ("),
              0u)
        << outcome.err;
    write("bad.stl", "solid s\n");
    EXPECT_EQ(run("check bad.stl").status, 2);
}

}  // namespace
}  // namespace incise
