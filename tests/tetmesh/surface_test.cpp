// Tetrahedra of closed surfaces: volumes, regions, edges that are kept, sizes, the report.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <sstream>

#include "made_mesh.h"

namespace incise {
namespace {

using test::box_surface;
using test::icosphere;
using test::joined;

constexpr double ball = 4.0 / 3.0 * std::numbers::pi;

/// A ring round the z axis, of radii 1 and 0.2.
topology::SurfaceData ring() {
    constexpr int around = 40, across = 16;
    topology::SurfaceData surface;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2.0 * std::numbers::pi * i / around;
            const double v = 2.0 * std::numbers::pi * j / across;
            const double radius = 1.0 + 0.2 * std::cos(v);
            surface.points.emplace_back(radius * std::cos(u), radius * std::sin(u),
                                        0.2 * std::sin(v));
        }
    const auto point = [](int i, int j) { return std::int64_t{i % around} * across + j % across; };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            surface.triangles.push_back({point(i, j), point(i + 1, j), point(i + 1, j + 1)});
            surface.triangles.push_back({point(i, j), point(i + 1, j + 1), point(i, j + 1)});
        }
    return surface;
}

class SurfaceMesh : public test::MakesTetrahedra {
  protected:
    void SetUp() override { write_surface("ball.stl", icosphere({1, 2, 3}, 1.0, 4)); }
};

TEST_F(SurfaceMesh, FillsABallAndReportsIt) {
    const auto made = make("ball.stl out.vtu --size 0.2");
    EXPECT_NEAR(made.volume(1), ball, 0.03 * ball);
    EXPECT_EQ(made.volumes.size(), 1u);
    EXPECT_EQ(made.num_components, 1);
    EXPECT_NEAR(made.metrics.mean_edge_length, 0.2, 0.02);
    EXPECT_EQ(made.err.find("warning"), std::string::npos) << made.err;
    std::ostringstream report;
    report << "out.vtu: " << made.data.num_cells() << " tetrahedra, " << made.data.points.size()
           << " nodes\nregion 1: " << made.data.num_cells() << " tetrahedra, volume "
           << made.volume(1) << "\n";
    EXPECT_EQ(made.out.find(report.str()), 0u) << made.out;
    for (const auto* words : {"bounding box ", "least altitude ", "least dihedral angle "})
        EXPECT_THAT(made.out, testing::HasSubstr(words));
}

TEST_F(SurfaceMesh, HasTheSameBytesEachTime) {
    ASSERT_EQ(run("mesh ball.stl a.vtu --size 0.3 --size-surface 0.2").status, 0);
    ASSERT_EQ(run("mesh ball.stl b.vtu --size 0.3 --size-surface 0.2").status, 0);
    EXPECT_EQ(support::read_text(folder_ / "a.vtu"), support::read_text(folder_ / "b.vtu"));
}

TEST_F(SurfaceMesh, MakesRegionsOfNestedParts) {
    const auto inner = icosphere({1.2, 2, 3}, 0.5, 3);
    write_surface("nested.stl", joined(icosphere({1, 2, 3}, 1.0, 4), inner));
    const auto made = make("nested.stl out.vtu --size 0.2");
    EXPECT_NEAR(made.volume(1), ball * 7 / 8, 0.03 * ball);
    EXPECT_NEAR(made.volume(2), ball / 8, 0.01 * ball);
    EXPECT_EQ(made.num_components, 1);

    write_surface("hollow.stl", joined(icosphere({1, 2, 3}, 1.0, 4), test::turned(inner)));
    const auto hollow = make("hollow.stl out.vtu --size 0.2");
    EXPECT_NEAR(hollow.volume(1), ball * 7 / 8, 0.03 * ball);
    EXPECT_EQ(hollow.volumes.size(), 1u);
}

TEST_F(SurfaceMesh, FindsSmallPartsFarAway) {
    write_surface("two.stl", joined(icosphere({0, 0, 0}, 1.0, 3), icosphere({9, 0, 0}, 0.2, 3)));
    const auto made = make("two.stl out.vtu --size 0.0004 --size-surface 0.0001 --scale 0.001");
    EXPECT_EQ(made.num_components, 2);
    EXPECT_NEAR(made.volume(2) / (ball * 0.008e-9), 1.0, 0.1);
}

TEST_F(SurfaceMesh, FillsARingWhoseCentreIsOutside) {
    write_surface("ring.stl", ring());
    const auto made = make("ring.stl out.vtu --size 0.1");
    const double volume = 2.0 * std::numbers::pi * std::numbers::pi * 0.04;
    // The triangles of the surface cut off 3 % of the ring, and the tetrahedra as much again.
    EXPECT_NEAR(made.volume(1), volume, 0.08 * volume);
    EXPECT_EQ(made.num_components, 1);
    EXPECT_EQ(made.err.find("warning"), std::string::npos) << made.err;
}

TEST_F(SurfaceMesh, FillsATetrahedronAtAnySize) {
    write_surface("a.stl", {{{1, 0, -1}, {-1, 0, -1}, {0, 1, 1}, {0, -1, 1}},
                            {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}});
    for (const auto* size : {"0.5", "0.3", "0.2", "0.1"}) {
        const auto made = make(std::string("a.stl out.vtu --size ") + size);
        EXPECT_NEAR(made.volume(1), 4.0 / 3.0, 0.3) << size;
    }
}

TEST_F(SurfaceMesh, SharesFacesOfSurfacesThatTouch) {
    // The upper box is narrower and stands askew: its edges cross those of the lower one.
    write_surface("low.stl", box_surface(Box(Vec3(0, 0, 0), Vec3(2, 2, 1))));
    write_surface("high.stl", box_surface(Box(Vec3(0.5, 0.5, 1), Vec3(2.5, 1.5, 2))));
    const auto made = make("low.stl high.stl out.vtu --size 0.3 --features 30");
    EXPECT_NEAR(made.volume(1), 4.0, 1e-3);
    EXPECT_NEAR(made.volume(2), 2.0, 1e-3);
    EXPECT_EQ(made.num_components, 1);
    EXPECT_NEAR(made.metrics.surface_area, 16.0 + 10.0 - 2.0 * 1.5, 0.01);
}

TEST_F(SurfaceMesh, KeepsSharpEdgesOnRequest) {
    write_surface("box.stl", box_surface(Box(Vec3(0, 0, 0), Vec3(1, 2, 0.5))));
    const auto sharp = make("box.stl out.vtu --size 0.15 --features 30");
    EXPECT_NEAR(sharp.volume(1), 1.0, 1e-3);
    EXPECT_NEAR(sharp.metrics.surface_area, 7.0, 1e-3);
    const auto blunt = make("box.stl out.vtu --size 0.15");
    EXPECT_LT(blunt.volume(1), sharp.volume(1));
    EXPECT_NEAR(blunt.volume(1), 1.0, 0.03);
}

TEST_F(SurfaceMesh, GrowsFromTheSurfaceInwards) {
    const auto fine = make("ball.stl out.vtu --size 0.1");
    const auto graded = make("ball.stl out.vtu --size 0.4 --size-surface 0.1");
    EXPECT_LT(graded.data.num_cells(), fine.data.num_cells() / 2);
    EXPECT_NEAR(graded.volume(1), fine.volume(1), 0.002 * ball);
    EXPECT_GT(graded.metrics.max_edge_length, 0.3);
}

TEST_F(SurfaceMesh, WarnsOfVolumeThatIsLost) {
    EXPECT_THAT(make("ball.stl out.vtu --size 1").err,
                testing::StartsWith("incise: warning: ball.stl: region 1 has a volume of "));
}

}  // namespace
}  // namespace incise
