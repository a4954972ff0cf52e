// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/loop/live_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "incise/base/error.h"
#include "incise/live/display_mesh.h"
#include "incise/topology/box_mesh.h"
#include "tests/live/soft_block.h"

namespace incise::live {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Leads tools as a test says, tick by tick.
class Hand : public Device {
  public:
    std::function<std::vector<Order>(const Session&)> act;
    std::uint64_t num_looks = 0;

    std::vector<Order> orders(const Session& session) override {
        return act ? act(session) : std::vector<Order>();
    }
    void publish(const Session&, const DisplayMesh& surface) override {
        ++num_looks;
        EXPECT_FALSE(surface.triangles().empty());
    }
    void rest() override {}
    std::vector<std::string> complaints() override { return {}; }
};

class LiveLoopTest : public testing::Test {
  protected:
    explicit LiveLoopTest(const std::string& text = soft_block)
        : folder(text),
          session(folder.scenario(), 0.002),
          recorder(session, {}, "test", folder.file("hands.jsonl")),
          server({.host = "127.0.0.1", .port = 0}),
          loop(session, recorder, server) {
        loop.on_message = [&](std::string_view level, const std::string& text_of) {
            messages.push_back(std::string(level) + ": " + text_of);
        };
        loop.add_device(hand);
    }
    void run(std::uint64_t num_looks) {
        loop.run([&] { return hand.num_looks >= num_looks; });
    }

    /// What was told, without warnings: there is one where the machine is slow.
    std::vector<std::string> errors() const {
        std::vector<std::string> found;
        for (const std::string& message : messages)
            if (message.starts_with("error: ")) found.push_back(message);
        return found;
    }

    BlockFolder folder;
    Session session;
    Recorder recorder;
    Server server;
    LiveLoop loop;
    Hand hand;
    std::vector<std::string> messages;
};

TEST_F(LiveLoopTest, TellsARefusedOrderOnceAndGoesOn) {
    hand.act = [](const Session&) { return std::vector<Order>{WithdrawTool{"nobody"}}; };
    run(20);
    EXPECT_EQ(session.num_ticks(), 20u);
    EXPECT_THAT(errors(),
                ElementsAre("error: tool 'nobody' of a device: there is no tool 'nobody' that a "
                            "hand leads"));
}

/// Loses the motion in some ticks.
class Fault : public runner::Observer {
  public:
    std::function<bool(double time)> is_lost;
    int num_losses = 0;

    void on_step(const runner::Simulation& simulation) override {
        if (!is_lost(simulation.time())) return;
        ++num_losses;
        throw PhysicsError("the motion is lost");
    }
};

TEST_F(LiveLoopTest, GoesBackByItselfAndGoesOn) {
    Fault fault;
    fault.is_lost = [&](double time) { return time > 0.05 && fault.num_losses == 0; };
    session.simulation().add_observer(fault);
    hand.act = [&](const Session& s) -> std::vector<Order> {
        if (fault.num_losses > 0) return {};
        if (s.tools().empty()) return {add_blade("knife", 0.05, -0.01, 0.03)};
        return {move("knife", 0.05, -0.01 + 0.002 * static_cast<double>(s.num_ticks()), 0.03)};
    };
    loop.run([&] { return fault.num_losses > 0 && session.world().time() > 0.08; });
    EXPECT_THAT(errors(), ElementsAre(HasSubstr("the motion is lost. The body went back to t = ")));
    for (const LedTool& tool : session.tools()) EXPECT_FALSE(tool.is_in_hand);
    // What was recorded plays to the end.
    Replay replay(folder.scenario(), read_recording(folder.file("hands.jsonl")), false);
    while (!replay.is_finished()) replay.tick();
    EXPECT_EQ(replay.first_difference(), std::nullopt);
    EXPECT_EQ(replay.session().checksum(), session.checksum());
}

TEST_F(LiveLoopTest, PausesIfItHappensAgainAndAgain) {
    Fault fault;
    fault.is_lost = [](double time) { return time > 0.05; };
    session.simulation().add_observer(fault);
    loop.run([&] { return fault.num_losses == 4 || errors().size() == 3; });
    EXPECT_EQ(fault.num_losses, 3);
    EXPECT_THAT(errors(), ElementsAre(Not(HasSubstr("it pauses")), Not(HasSubstr("it pauses")),
                                      HasSubstr("it pauses")));
}

/// What a page reads of a picture.
struct ReadPicture {
    std::uint32_t magic, flags, version, tick, num_vertices, num_triangles;
    float origin[3];
    std::uint32_t zero;
};

TEST(PictureMaker, ShowsTheSurfaceThatAFreshOneShows) {
    Session session(BlockFolder().scenario());
    PictureMaker pictures(session);
    session.execute(add_blade("knife", 0.05, -0.01, 0.03));
    for (int i = 1; i <= 9; ++i) {
        session.execute(move("knife", 0.05, -0.01 + 0.015 * i, 0.03));
        session.tick();
        const auto picture = pictures.make(session);
        PictureMaker fresh(session);
        DisplayMesh mesh(session.world().mesh());
        mesh.update(topology::BoundarySurface(session.world().mesh()), session.world().mesh());
        EXPECT_EQ(pictures.mesh().triangles().size(), mesh.triangles().size());
        EXPECT_EQ(pictures.mesh().nodes().size(), mesh.nodes().size());
        ReadPicture read;
        ASSERT_EQ(picture->head_with_topology.size(), sizeof read);
        std::memcpy(&read, picture->head_with_topology.data(), sizeof read);
        EXPECT_EQ(read.magic, 0x31434E49u);
        EXPECT_EQ(read.flags, 1u);
        EXPECT_EQ(read.tick, static_cast<std::uint32_t>(i));
        EXPECT_EQ(read.num_vertices, mesh.nodes().size());
        EXPECT_EQ(picture->topology->size(), read.num_triangles * 12 + read.num_vertices * 16);
        EXPECT_EQ(picture->moving.size(), read.num_vertices * 12);
        const auto nodes = pictures.mesh().nodes();
        for (std::size_t v = 0; v < nodes.size(); ++v) {
            float at[3];
            std::memcpy(at, picture->moving.data() + v * 12, sizeof at);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(at[k] + read.origin[k],
                            session.world().positions()[nodes[v].index()][k], 1e-7);
        }
    }
    const auto tags = pictures.mesh().tags();
    EXPECT_GT(std::ranges::count_if(tags, [](auto tag) { return tag & DisplayMesh::is_cut; }), 0);
    ASSERT_TRUE(pictures.show("von_mises"));
    EXPECT_EQ(pictures.make(session)->moving.size(), pictures.mesh().nodes().size() * 16);
    EXPECT_FALSE(pictures.show("temperature"));
}

TEST(DisplayMesh, DoublesVerticesAtLipsAndBetweenRegions) {
    // Two cells of two regions: four nodes are on both.
    topology::MeshData data =
        topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(), Vec3(2, 1, 1), {2, 1, 1});
    data.regions = {5, 9};
    const topology::Mesh mesh = topology::Mesh::build(data).mesh;
    DisplayMesh shown(mesh);
    shown.update(topology::BoundarySurface(mesh), mesh);
    EXPECT_EQ(std::vector<int>(shown.regions().begin(), shown.regions().end()),
              (std::vector<int>{5, 9}));
    EXPECT_EQ(shown.nodes().size(), 16u);
    EXPECT_EQ(shown.triangles().size(), 20u);
}

}  // namespace
}  // namespace incise::live
