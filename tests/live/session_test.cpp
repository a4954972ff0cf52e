// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "incise/base/error.h"
#include "incise/topology/component_count.h"
#include "tests/live/soft_block.h"

namespace incise::live {
namespace {

using testing::HasSubstr;

std::string refusal_of(Session& session, const Order& order) {
    try {
        session.execute(order);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(Session, EndsEachTickExactlyAtItsTime) {
    Session session(BlockFolder().scenario());
    for (int i = 1; i <= 7; ++i) {
        session.tick();
        EXPECT_EQ(session.world().time(), i * usual_tick);
    }
}

TEST(Session, LetsToolsOfTheScenarioFollowTheirPaths) {
    Session session(BlockFolder().scenario());
    const std::size_t num_elements = session.world().mesh().num_elements();
    for (int i = 0; i < 8; ++i) session.tick();
    EXPECT_LT(session.world().mesh().num_elements(), num_elements);
}

TEST(Session, PartsTheBodyWhereABladeIsLed) {
    Session session(BlockFolder().scenario());
    session.execute(add_blade("knife", 0.05, -0.01, 0.03));
    for (int i = 1; i <= 8; ++i) {
        session.execute(move("knife", 0.05, -0.01 + 0.015 * i, 0.03));
        session.tick();
    }
    session.execute(order(R"({"withdraw":"knife"})"));
    EXPECT_TRUE(session.find("knife")->is_in_hand);
    session.tick();
    EXPECT_FALSE(session.find("knife")->is_in_hand);
    EXPECT_FALSE(session.world().is_tool_present(session.find("knife")->id));
    EXPECT_GT(session.world().ledger().num_edits(), 0u);
    EXPECT_THAT(refusal_of(session, move("knife", 0, 0, 0)), HasSubstr("not in the hand any more"));
}

TEST(Session, LeadsToolsEvenlyWithinATick) {
    Session session(BlockFolder().scenario());
    session.execute(add_ball("probe", "ball", 0.05, 0.05, 0.2));
    session.tick();
    session.execute(move("ball", 0.05, 0.05, 0.15));
    class Watch : public runner::Observer {
      public:
        std::vector<double> heights;
        void on_step(const runner::Simulation& simulation) override {
            heights.push_back(
                simulation.world().tool_pose(simulation.world().tools()[1]).position.z());
        }
    } watch;
    session.simulation().add_observer(watch);
    session.tick();
    ASSERT_GT(watch.heights.size(), 2u);
    const auto n = static_cast<double>(watch.heights.size());
    for (std::size_t i = 0; i < watch.heights.size(); ++i)
        EXPECT_NEAR(watch.heights[i], 0.2 - 0.05 * static_cast<double>(i + 1) / n, 1e-12);
    EXPECT_EQ(watch.heights.back(), 0.15);
}

TEST(Session, FeelsWhatAGrasperHolds) {
    Session session(BlockFolder().scenario());
    session.execute(add_ball("grasper", "jaws", 0.02, 0.02, 0.05));
    EXPECT_TRUE(session.execute(order(R"({"close":"jaws"})")).empty());
    for (int i = 1; i <= 10; ++i) {
        session.execute(move("jaws", 0.02, 0.02, 0.05 + 0.001 * i));
        session.tick();
    }
    EXPECT_LT(session.tool_forces().of(session.find("jaws")->id).force.z(), 0.0);
    session.execute(order(R"({"open":"jaws"})"));
    session.tick();
    EXPECT_EQ(session.tool_forces().of(session.find("jaws")->id).force.norm(), 0.0);
}

TEST(Session, WarnsOfJawsAndThreadsThatHoldNothing) {
    Session session(BlockFolder().scenario());
    session.execute(add_ball("grasper", "jaws", 1, 1, 1));
    EXPECT_THAT(session.execute(order(R"({"close":"jaws"})")).at(0), HasSubstr("on nothing"));
    EXPECT_THAT(session
                    .execute(order(R"({"add":"thread","tool":{"kind":"suture","stiffness":100,
                        "points":[[1,1,1],[2,2,2]]},"at":[0,0,0]})"))
                    .at(0),
                HasSubstr("holds nothing"));
    session.tick();
}

TEST(Session, RefusesOrdersAndChangesNothing) {
    Session session(BlockFolder().scenario()), other(BlockFolder().scenario());
    session.execute(add_blade("knife", 0.05, -0.05, 0.03));
    other.execute(add_blade("knife", 0.05, -0.05, 0.03));
    EXPECT_THAT(refusal_of(session, add_blade("knife", 0, 0, 0)), HasSubstr("already"));
    EXPECT_THAT(refusal_of(session, add_blade("carver_1", 0, 0, 0)), HasSubstr("already"));
    EXPECT_THAT(refusal_of(session, move("spoon", 0, 0, 0)), HasSubstr("no tool 'spoon'"));
    EXPECT_THAT(refusal_of(session, move("carver_1", 0, 0, 0)), HasSubstr("no tool 'carver_1'"));
    EXPECT_THAT(refusal_of(session, order(R"({"close":"knife"})")), HasSubstr("no jaws"));
    EXPECT_THAT(refusal_of(session, order(R"({"draw":"knife","length":1})")), HasSubstr("suture"));
    EXPECT_THAT(refusal_of(session, MoveTool{"knife", {Eigen::Quaterniond(0, 0, 0, 0), {}}}),
                HasSubstr("not sound"));
    EXPECT_THAT(refusal_of(session, order(R"({"add":"x","tool":{"kind":"blade"},"at":[0,0,0]})")),
                HasSubstr("edge"));
    EXPECT_THAT(refusal_of(session, move("knife", 0, 0, 1e30)), HasSubstr("1000 times the size"));
    EXPECT_THAT(refusal_of(session, order(R"({"add":"x","at":[0,0,0],
                    "tool":{"kind":"blade","edge":[[0,0,1e300],[0,0,-1e300]]}})")),
                HasSubstr("1000 times as large"));
    for (const char* large : {R"({"kind":"scissors","length":1e200})",
                              R"({"kind":"carver","shape":{"sphere":{"radius":1e30}}})"})
        EXPECT_THAT(refusal_of(session, order(R"({"add":"x","at":[0,0,0],"tool":)" +
                                              std::string(large) + "}")),
                    HasSubstr("1000 times as large"));
    session.tick();
    other.tick();
    EXPECT_EQ(session.checksum(), other.checksum());
    EXPECT_EQ(session.world().save(), other.world().save());
}

TEST(Session, RefusesTouchingToolsThatJump) {
    Session session(BlockFolder().scenario());
    session.execute(add_ball("probe", "ball", 0.05, 0.05, 0.2));
    EXPECT_THAT(refusal_of(session, move("ball", 0.05, 0.05, 100.0)), HasSubstr("more slowly"));
    session.execute(move("ball", 0.05, 0.05, 1.0));
    session.tick();
}

TEST(Session, MakesEveryMoveThatItHasNotRefused) {
    // Thin, long and turning probes, as far as they may go in a tick.
    for (const double angle : {0.0, 1.0, 3.0})
        for (const double step : {0.02, 0.2, 2.0, 20.0}) {
            Session session(BlockFolder().scenario());
            session.execute(order(R"({"add":"rod","tool":{"kind":"probe","shape":{"capsule":
                {"from":[0,0,0],"to":[0.4,0,0],"radius":0.002}}},"at":[0,0,0.3]})"));
            const MoveTool moved{"rod",
                                 {Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ())),
                                  {0.0, 0.0, 0.3 + step}}};
            if (refusal_of(session, moved) != "none") continue;
            EXPECT_NO_THROW(session.tick());
        }
}

TEST(Session, DrawsAThreadEvenlyWithinATick) {
    Session session(BlockFolder().scenario());
    session.execute(order(R"({"add":"thread","tool":{"kind":"suture","stiffness":5,
        "points":[[0.03,0.05,0.05],[0.07,0.05,0.05]]},"at":[0,0,0]})"));
    const LedTool& thread = *session.find("thread");
    const double before = session.world().suture_length(thread.id);
    session.execute(order(R"({"draw":"thread","length":0.02})"));
    EXPECT_EQ(session.world().suture_length(thread.id), before);
    class Watch : public runner::Observer {
      public:
        std::vector<double> lengths;
        void on_step(const runner::Simulation& simulation) override {
            lengths.push_back(simulation.world().suture_length(simulation.world().tools()[1]));
        }
    } watch;
    session.simulation().add_observer(watch);
    session.tick();
    ASSERT_GT(watch.lengths.size(), 2u);
    const auto n = static_cast<double>(watch.lengths.size());
    for (std::size_t i = 0; i < watch.lengths.size(); ++i)
        EXPECT_NEAR(watch.lengths[i], before + (0.02 - before) * static_cast<double>(i + 1) / n,
                    1e-12);
    EXPECT_EQ(watch.lengths.back(), 0.02);
    EXPECT_THAT(refusal_of(session, order(R"({"draw":"thread","length":-1})")),
                HasSubstr("0 or more"));
    EXPECT_THAT(refusal_of(session, order(R"({"withdraw":"thread"})")), HasSubstr("untied"));
}

TEST(Session, GivesUpATickWhenAskedTo) {
    Session session(BlockFolder().scenario());
    session.tick();
    const Session::UndoPoint moment = session.undo_point();
    int num_steps = 0;
    EXPECT_FALSE(session.tick([&] { return ++num_steps == 2; }));
    EXPECT_EQ(session.num_ticks(), 1u);
    session.undo(moment);
    EXPECT_TRUE(session.tick());
}

TEST(Session, GoesOnInTheSameBitsAfterItWentBack) {
    Session session(BlockFolder().scenario());
    const auto stroke = [&] {
        std::vector<std::uint64_t> sums;
        session.execute(add_blade("knife", 0.05, -0.01, 0.03));
        for (int i = 1; i <= 5; ++i) {
            session.execute(move("knife", 0.05, -0.01 + 0.01 * i, 0.03));
            session.tick();
            sums.push_back(session.checksum());
        }
        return sums;
    };
    session.execute(add_ball("grasper", "jaws", 0.02, 0.02, 0.05));
    session.execute(order(R"({"close":"jaws"})"));
    session.execute(move("jaws", 0.02, 0.02, 0.055));
    session.tick();
    const Session::UndoPoint moment = session.undo_point();
    const auto first = stroke();
    session.undo(moment);
    EXPECT_EQ(session.num_ticks(), 1u);
    EXPECT_EQ(session.find("knife"), nullptr);
    ASSERT_NE(session.find("jaws"), nullptr);
    EXPECT_EQ(stroke(), first);
}

TEST(Session, OfStaticsTakesALoadStepATick) {
    std::string text = soft_block;
    text.replace(text.find("damping = 8"), 11, "mode = \"static\"\nsteps = 7");
    text += "[contact]\nenabled = false\n";
    Session session(BlockFolder(text).scenario());
    session.tick();
    EXPECT_EQ(session.simulation().num_steps(), 1u);
    EXPECT_THAT(refusal_of(session, add_ball("probe", "ball", 0, 0, 1)),
                HasSubstr("touches tissue, but"));
}

TEST(OrderText, KeepsAllBits) {
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
    const MoveTool moved{"knife", {turned, {0.1, 1.0 / 3.0, -1e-17}}};
    const auto back = std::get<MoveTool>(order_from_json(to_json(moved)));
    EXPECT_EQ(back.name, moved.name);
    EXPECT_EQ(back.pose.position, moved.pose.position);
    EXPECT_EQ(back.pose.rotation.coeffs(), moved.pose.rotation.coeffs());
}

TEST(OrderText, SaysWhatIsWrong) {
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            order_from_json(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_THAT(refusal("rubbish"), HasSubstr("no JSON object"));
    EXPECT_THAT(refusal("[1,2]"), HasSubstr("no JSON object"));
    EXPECT_THAT(refusal("\xff\xfe"), HasSubstr("no JSON object"));
    EXPECT_THAT(refusal(R"({"fly":"away"})"), HasSubstr("no order"));
    EXPECT_THAT(refusal(R"({"move":3,"at":[0,0,0]})"), HasSubstr("'move': must be a text"));
    EXPECT_THAT(refusal(R"({"move":"a"})"), HasSubstr("'at': is missing"));
    EXPECT_THAT(refusal(R"({"move":"a","at":[0,0]})"), HasSubstr("three numbers"));
    EXPECT_THAT(refusal(R"({"move":"a","at":[0,0,1e999]})"), HasSubstr("JSON"));
    EXPECT_THAT(refusal(R"({"move":"a","at":[0,0,0],"rotation":[0,0,0,0]})"),
                HasSubstr("unit length"));
    EXPECT_THAT(refusal(R"({"add":"a","tool":null,"at":[0,0,0]})"), HasSubstr("null"));
    EXPECT_THAT(refusal(R"({"add":"a","tool":)" + std::string(30, '[') + std::string(30, ']') +
                        R"(,"at":[0,0,0]})"),
                HasSubstr("nested too deeply"));
}

TEST(Session, HasNoEndHoweverShortItsStepsAre) {
    std::string stiff = soft_block;
    const auto at = stiff.find("young = ");
    stiff.replace(at, stiff.find('\n', at) - at, "young = 1e10");
    Session session(BlockFolder(stiff).scenario(), 1e-4);
    session.tick();
    EXPECT_LT(session.simulation().time_step(), 1e-5);
    EXPECT_DOUBLE_EQ(session.world().time(), 1e-4);
}

}  // namespace
}  // namespace incise::live
