// Strokes of a blade along the same wound, deeper and deeper, in tissue that sways.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "incise/topology/geometry.h"
#include "soft_world.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::sim {
namespace {

using test::Bricks;

constexpr double body_size = 0.025;  // of the body, m

WorldDef swaying_body(Bricks bricks, double jitter, std::uint64_t seed) {
    WorldDef def;
    topology::MeshData data = test::brick_cube(bricks, 5, jitter, seed);
    for (Vec3& x : data.points) x *= body_size;
    def.mesh = std::move(data);
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{3571.0, 14286.0}}}};
    def.gravity = {0.3, 0, -2.0};
    def.damping = 30.0;
    return def;
}

enum class End {
    stops,      // the blade is taken out at the end of its stroke
    goes_back,  // it goes out the way it came
};

/// The plane of the strokes.
struct StrokePlane {
    double place;       // at the top, as a share of the size of the body
    double tilt, turn;  // 0 for a plane across x; the turn in m
};

/// Parts the body in five strokes: three of one depth, one that is deeper, one right through.
/// Returns the shares of its pieces in the volume, the largest first.
std::vector<double> shares_after_strokes(WorldDef def, End end, const StrokePlane& plane) {
    const auto [place, tilt, turn] = plane;
    World world(std::move(def));
    world.add_constraint({.name = "floor",
                          .nodes = physics::VertexSet(
                              nodes_where(world, [](const Vec3& x) { return x.z() < 1e-9; }))});
    const Vec3 top(place * body_size, 0, 1.1 * body_size);
    const auto stroke_to = [&](double z) {
        const ToolId blade = world.add_tool(
            {"blade",
             Blade{{{-turn, -0.2 * body_size, 0}, {turn, 1.2 * body_size, 0}}, CutMode::split}});
        const auto move = [&](const Vec3& from, const Vec3& to) {
            constexpr double duration = 0.03;
            const double begin = world.time();
            while (world.time() < begin + duration) {
                const double part = std::min(1.0, (world.time() - begin) / (0.95 * duration));
                world.step(0.8 * world.stable_step(),
                           StepInputs().move(blade, at(from + part * (to - from))));
            }
        };
        const Vec3 bottom(top.x() + tilt * (top.z() - z), 0, z);
        move(top, bottom);
        if (end == End::goes_back) move(bottom, top);
        world.step(0.8 * world.stable_step(), StepInputs().withdraw(blade));
        run_until(world, world.time() + 0.005);
    };
    for (const double depth : {0.53, 0.53, 0.53, 0.27, -0.1}) stroke_to(depth * body_size);
    const topology::Components pieces = topology::components(world.mesh());
    std::vector<double> shares(static_cast<std::size_t>(pieces.count), 0.0);
    for (const CellId e : world.mesh().elements())
        shares[static_cast<std::size_t>(pieces.of_element[e.index()])] +=
            topology::rest_volume(world.mesh(), e) / (body_size * body_size * body_size);
    std::ranges::sort(shares, std::greater());
    return shares;
}

/// Expects two pieces. Where the wound has swayed by more than the tolerance of a cut, a stroke
/// takes slices off it.
void expect_two_pieces(End end, bool is_plane_of_mesh) {
    for (const auto& [name, bricks, jitter] :
         {std::tuple("hexahedra", Bricks::hexahedra, 0.0),
          std::tuple("wedges", Bricks::wedges, 0.0), std::tuple("pyramids", Bricks::pyramids, 0.0),
          std::tuple("mixed", Bricks::mixed, 0.0), std::tuple("joined", Bricks::joined, 0.0),
          std::tuple("jittered hexahedra", Bricks::hexahedra, 0.15)})
        for (std::uint64_t seed = 0; seed < 2; ++seed) {
            SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
            test::Random random(seed);
            StrokePlane plane{0.52, random.uniform(-0.05, 0.05),
                              body_size * random.uniform(-0.1, 0.1)};
            if (is_plane_of_mesh) plane = {0.4 + 0.2 * static_cast<double>(seed), 0.0, 0.0};
            const std::vector<double> shares =
                shares_after_strokes(swaying_body(bricks, jitter, 7 + seed), end, plane);
            ASSERT_GE(shares.size(), 2u);
            // The nodes are in the plane, but for those of the body that is jittered.
            const double most_lost = !is_plane_of_mesh ? 0.0 : jitter == 0.0 ? 1e-5 : 1e-3;
            EXPECT_GT(shares[1], 0.4 - most_lost);
            EXPECT_GT(shares[0] + shares[1], 1.0 - 1e-5);
        }
}

TEST(StrokesAgain, ThatStopPartSwayingTissueInTwo) { expect_two_pieces(End::stops, false); }
TEST(StrokesAgain, ThatGoBackPartSwayingTissueInTwo) { expect_two_pieces(End::goes_back, false); }
TEST(StrokesAgain, ThatStopPartItAlongPlanesOfTheMesh) { expect_two_pieces(End::stops, true); }
TEST(StrokesAgain, ThatGoBackPartItAlongPlanesOfTheMesh) {
    expect_two_pieces(End::goes_back, true);
}

}  // namespace
}  // namespace incise::sim
