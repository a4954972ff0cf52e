// A world goes back to moments: body, tools and time have the bits that they had.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/fragments/validate.h"
#include "incise/sim/edit_log.h"
#include "incise/sim/undo_point.h"
#include "incise/sim/world.h"
#include "incise/topology/boundary_surface.h"
#include "incise/topology/validate.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

using ::testing::HasSubstr;

struct Moment {
    int step;
    UndoPoint point;
    std::string bytes;
};

/// The triangles of a surface that has followed all edits, and whether they are on a cut.
std::vector<std::pair<std::array<VertexId, 3>, std::uint8_t>> triangles_of(
    const topology::BoundarySurface& surface) {
    std::vector<std::pair<std::array<VertexId, 3>, std::uint8_t>> all;
    for (std::size_t i = 0; i < surface.triangles().size(); ++i)
        all.emplace_back(surface.triangles()[i], surface.is_cut()[i]);
    std::ranges::sort(all);
    return all;
}

void expect_sound(World& world) {
    EXPECT_EQ(topology::validate(world.mesh()), std::vector<std::string>{});
    EXPECT_EQ(fragments::validate(world.model().fragments(), world.mesh()),
              std::vector<std::string>{});
    EXPECT_EQ(triangles_of(world.surface()), triangles_of(topology::BoundarySurface(world.mesh())));
}

// Moments in all phases of a stroke: before it, while the blade is in the tissue, after it; with
// grasps and loads that came or went since. From the last one to the first, each is gone back to
// twice: the second time from a body that was cut anew.
TEST(Undo, GoesBackToTheBitsOfBefore) {
    for (const auto& [name, body, mode] : resumable_cuts()) {
        SCOPED_TRACE(name);
        Session session(held(World(body())), scalpel(mode));
        session.world().surface();
        std::vector<Moment> moments;
        for (int i = 0; i < Session::num_steps; ++i) {
            if (i % 7 == 0 || i == 34 || i == 35)
                moments.push_back({i, session.world().undo_point(), session.world().save()});
            session.run(i, i + 1);
        }
        EXPECT_GE(topology::components(session.world().mesh()).count, 2);
        const std::string end = session.world().save();
        for (; !moments.empty(); moments.pop_back()) {
            const Moment& moment = moments.back();
            SCOPED_TRACE(moment.step);
            for (int time = 0; time < 2; ++time) {
                session.undo(moment.point);
                ASSERT_TRUE(session.world().save() == moment.bytes);
                expect_sound(session.world());
                session.run(moment.step, Session::num_steps);
                ASSERT_TRUE(session.world().save() == end);
            }
        }
    }
}

// Contact remembers pairs, impulses and what jaws hold; a probe presses on a cut.
TEST(Undo, GoesBackWithContact) {
    WorldDef def = soft_body();
    def.gravity = Vec3::Zero();
    def.contact = {.enabled = true, .friction = 0.3};
    World world = held(World(std::move(def)));
    const ToolId ball = world.add_tool({"ball", cutting::Probe{cutting::Sphere{0.02}, 0.3}});
    world.place_tool(ball, at({0.05, 0.05, size + 0.021}));
    std::size_t most_points = 0;
    const auto press = [&](int from, int to) {
        for (int i = from; i < to; ++i) {
            StepInputs inputs;
            if (i == 60) inputs = cut_along(world, {0.05, 0.05, 0.07}, {0.1, 0.05, 1.0});
            if (i == 100) inputs = cut_along(world, {0.05, 0.05, 0.05}, {1.0, 0.05, 0.1});
            inputs.move(ball, at({0.05 + 2e-5 * i, 0.05, size + 0.021 - 6e-5 * i}));
            world.step(0.8 * world.stable_step(), inputs);
            most_points = std::max(most_points, world.report().contact.num_points);
        }
    };
    std::vector<Moment> moments;
    for (const int step : {0, 40, 60, 61, 99, 120}) {
        if (!moments.empty()) press(moments.back().step, step);
        moments.push_back({step, world.undo_point(), world.save()});
    }
    press(moments.back().step, 160);
    EXPECT_GT(most_points, 10u);
    const std::string end = world.save();
    for (; !moments.empty(); moments.pop_back()) {
        SCOPED_TRACE(moments.back().step);
        world.undo(moments.back().point);
        ASSERT_TRUE(world.save() == moments.back().bytes);
        press(moments.back().step, 160);
        ASSERT_TRUE(world.save() == end);
    }
}

TEST(Undo, RefusesMomentsThatAreNotItsOwn) {
    World world = held_world(), other = held_world();
    const UndoPoint start = world.undo_point();
    EXPECT_THAT(input_error_of([&] { other.undo(start); }), HasSubstr("another world"));
    world.step(0.5 * world.stable_step(), cut_along(world, {0.05, 0.05, 0.05}, {1, 0, 0.1}));
    const UndoPoint later = world.undo_point();
    const ToolId knife = world.add_tool(scalpel());
    world.undo(start);
    EXPECT_THAT(input_error_of([&] { world.undo(later); }), HasSubstr("taken back"));
    EXPECT_THAT(input_error_of([&] { world.place_tool(knife, Pose()); }), HasSubstr("restored"));
    // A tool that comes after it is another one, though it has the same place in the list.
    const ToolId next = world.add_tool(scalpel());
    EXPECT_NE(next, knife);
    EXPECT_NE(input_error_of([&] { world.place_tool(knife, Pose()); }), "");
    world.restore(world.save());
    EXPECT_THAT(input_error_of([&] { world.undo(start); }), HasSubstr("restored"));
}

// A force law of a custom kind, or too long a step, may lose the motion: going back mends it.
TEST(Undo, BringsAWorldBackThatHasFailed) {
    World world = held_world();
    run_until(world, 0.02);
    const UndoPoint before = world.undo_point();
    const std::string bytes = world.save();
    world.step(0.5 * world.stable_step(), cut_along(world, {0.05, 0.05, 0.05}, {1, 0, 0.1}));
    world.add_load(
        {.name = "blow",
         .kind = physics::NodalLoad{
             physics::VertexSet(nodes_where(world, [](const Vec3& x) { return x.z() == size; })),
             {1e9, 0, 0}}});
    EXPECT_ANY_THROW(for (int i = 0; i < 1000; ++i) world.step(0.5 * world.stable_step()));
    EXPECT_TRUE(world.has_failed());
    world.undo(before);
    EXPECT_FALSE(world.has_failed());
    EXPECT_TRUE(world.save() == bytes);
}

// As much as the lists of the edit, of which the shapes of polyhedra are the largest.
TEST(Undo, CountsTheMemoryOfEdits) {
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron}) {
        WorldDef def = soft_body();
        def.mesh = topology::box_mesh(kind, Vec3::Zero(), Vec3::Constant(size), {6, 6, 6});
        World world(std::move(def));
        const auto& edits = world
                                .step(0.5 * world.stable_step(),
                                      cut_along(world, {0.05, 0.05, 0.05}, {1, 0.2, 0.1}))
                                .edits;
        ASSERT_EQ(edits.size(), 1u);
        ArchiveWriter ar;
        ar(edits[0].body.material, edits[0].body.physics.mesh);
        const auto serialized = ar.bytes().size();
        EditLog log;
        const std::size_t counted = log.append(edits[0].body)->num_bytes();
        EXPECT_GT(counted, serialized);
        EXPECT_LT(counted, 2 * serialized);
    }
}

// What nobody can go back to is not kept.
TEST(Undo, KeepsTheEditsSinceTheOldestMomentOnly) {
    Session session(held_world());
    session.run(0, 12);
    std::optional<UndoPoint> first = session.world().undo_point();
    session.run(12, 40);
    const UndoPoint second = session.world().undo_point();
    EXPECT_GT(second.num_bytes_since(*first), 10'000u);
    EXPECT_EQ(second.num_bytes_since(second), 0u);
    first.reset();
    session.run(40, 60);
    session.undo(second);
}

}  // namespace
}  // namespace incise::sim
