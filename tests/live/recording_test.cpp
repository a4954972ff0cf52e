// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "incise/base/error.h"
#include "tests/live/soft_block.h"

namespace incise::live {
namespace {

using testing::HasSubstr;

/// Hands that do things at random, and now and then go back.
class RandomHands {
  public:
    explicit RandomHands(unsigned seed) : random_(seed) {}

    void play(Session& session, Recorder& recorder, int num_ticks) {
        std::vector<Session::UndoPoint> marks = {session.undo_point()};
        for (int i = 0; i < num_ticks; ++i) {
            act(session);
            session.tick();
            recorder.note_tick(session);
            if (one_in(6)) act(session);  // what is done before a moment belongs to it
            if (one_in(6)) marks.push_back(session.undo_point());
            if (one_in(12)) {
                session.undo(marks[below(marks.size())]);
                recorder.note_return(session);
                std::erase_if(
                    marks, [&](const auto& mark) { return mark.num_ticks > session.num_ticks(); });
            }
        }
        session.tick();  // it may have gone back to the start
        recorder.note_tick(session);
    }

  private:
    std::size_t below(std::size_t n) {
        return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
    }
    bool one_in(std::size_t n) { return below(n) == 0; }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    void give(Session& session, const Order& order) {
        try {
            session.execute(order);
        } catch (const InputError&) {
            // A refused order changes nothing, and is not recorded.
        }
    }
    void act(Session& session) {
        const double x = between(0.0, 0.1), y = between(0.0, 0.1), z = between(0.02, 0.07);
        if (one_in(3)) {
            const std::string name = "tool_" + std::to_string(++count_);
            switch (below(5)) {
                case 0:
                    give(session, add_blade(name, x, y, z));
                    break;
                case 1:
                    give(session, add_ball("carver", name, x, y, 0.06));
                    break;
                case 2:
                    give(session, add_ball("probe", name, x, y, 0.07));
                    break;
                case 3:
                    give(session, add_ball("grasper", name, x, y, 0.05));
                    give(session, CloseTool{name});
                    break;
                default:
                    give(session, add_suture(name, x, y));
            }
        }
        for (const LedTool& tool : session.tools()) {
            if (!tool.is_in_hand) continue;
            const std::string name = tool.name;
            if (tool.kind == "suture") {
                if (one_in(4)) give(session, DrawSuture{name, between(0.5, 1.0) * tool.length});
                if (one_in(20)) give(session, UntieSuture{name});
                continue;
            }
            const Vec3 at =
                tool.pose.position +
                Vec3(between(-0.005, 0.005), between(-0.005, 0.005), between(-0.004, 0.003));
            const Eigen::Quaterniond turn(Eigen::AngleAxisd(between(-0.1, 0.1), Vec3::UnitX()));
            give(session, MoveTool{name, {tool.pose.rotation * turn, at}});
            if (one_in(8)) give(session, WithdrawTool{name});
            if (tool.kind == "grasper" && one_in(8)) give(session, OpenTool{name});
        }
    }

    std::mt19937 random_;
    int count_ = 0;
};

TEST(Recording, PlaysToTheSameBitsInEveryTick) {
    const BlockFolder folder;
    std::size_t num_edits = 0, num_sutures = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto file = folder.file("hands.jsonl");
        Session session(folder.scenario());
        {
            Recorder recorder(session, {}, "test", file);
            RandomHands(seed).play(session, recorder, 40);
            EXPECT_EQ(recorder.text(), support::read_text(file));
        }
        Replay replay(folder.scenario(), read_recording(file), false);
        replay.session().simulation().set_num_threads(static_cast<int>(seed % 4) + 1);
        while (!replay.is_finished()) replay.tick();
        EXPECT_EQ(replay.first_difference(), std::nullopt);
        EXPECT_EQ(replay.session().checksum(), session.checksum());
        EXPECT_EQ(replay.session().num_ticks(), session.num_ticks());
        EXPECT_EQ(replay.session().simulation().edits().size(),
                  session.simulation().edits().size());
        num_edits += session.simulation().edits().size();
        num_sutures +=
            static_cast<std::size_t>(std::ranges::count(session.tools(), "suture", &LedTool::kind));
    }
    EXPECT_GT(num_edits, 50u);
    EXPECT_GT(num_sutures, 5u);
}

class RecordedStroke : public testing::Test {
  protected:
    RecordedStroke() {
        Session session(folder.scenario());
        Recorder recorder(session, {"material[0].young=3000"}, "test", std::nullopt);
        session.execute(add_blade("knife", 0.05, -0.01, 0.03));
        for (int i = 1; i <= 4; ++i) {
            session.execute(move("knife", 0.05, -0.01 + 0.01 * i, 0.03));
            session.tick();
            recorder.note_tick(session);
        }
        text = recorder.text();
    }
    Recording read(const std::string& changed) const {
        std::ofstream(folder.file("hands.jsonl")) << changed;
        return read_recording(folder.file("hands.jsonl"));
    }
    std::string refusal_of(const std::string& changed) const {
        try {
            read(changed);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }

    BlockFolder folder;
    std::string text;
};

TEST_F(RecordedStroke, IsWholeUpToWhereAKillCutItOff) {
    for (std::size_t size = text.find('\n') + 1; size <= text.size(); ++size) {
        const std::string begun = text.substr(0, size);
        const auto lines = static_cast<std::uint64_t>(std::ranges::count(begun, '\n'));
        EXPECT_EQ(read(begun).num_ticks, lines - 1);
    }
}

TEST_F(RecordedStroke, SaysFromWhichTickTheBitsDiffer) {
    std::string changed = text;
    const auto at = changed.find("-0.02");  // of the edge, below the origin
    ASSERT_NE(at, std::string::npos);
    changed.replace(at, 5, "-0.01");
    Replay replay(folder.scenario(), read(changed), false);
    while (!replay.is_finished()) replay.tick();
    ASSERT_TRUE(replay.first_difference().has_value());
    EXPECT_LT(*replay.first_difference(), 4u);
}

TEST_F(RecordedStroke, KnowsItsScenario) {
    const Recording recording = read(text);
    EXPECT_EQ(recording.scenario.overrides, std::vector<std::string>{"material[0].young=3000"});
    EXPECT_EQ(recording.scenario.name, "block");
    scenario::Scenario other = folder.scenario();
    other.hash = "0123456789abcdef";
    EXPECT_THROW(Replay(other, recording, false), InputError);
    Replay(other, recording, true);
    scenario::Scenario finer = folder.scenario();
    std::get<scenario::BoxMeshSpec>(finer.mesh.source).cells = {4, 4, 3};
    EXPECT_THROW(Replay(finer, recording, false), InputError);
}

TEST_F(RecordedStroke, IsRefusedWithFileLineAndProblem) {
    EXPECT_THAT(refusal_of("rubbish\n"), HasSubstr("hands.jsonl:1: this is no JSON object"));
    EXPECT_THAT(refusal_of("{}\n"), HasSubstr("no recording of incise live"));
    EXPECT_THAT(refusal_of(R"({"incise_recording":99})"), HasSubstr("has format 99"));
    const std::string header = text.substr(0, text.find('\n') + 1);
    EXPECT_THAT(refusal_of(header + "{\"tick\":3}\n"), HasSubstr("lines are missing"));
    EXPECT_THAT(refusal_of(header + "{\"back_to\":3}\n"), HasSubstr("yet to come"));
    const std::string deep = std::string(200000, '[') + std::string(200000, ']');
    EXPECT_THAT(refusal_of("{\"incise_recording\":" + deep + "}\n"),
                HasSubstr("nested too deeply"));
    EXPECT_THAT(refusal_of(header + "{\"tick\":0,\"orders\":" + deep + "}\n"),
                HasSubstr("nested too deeply"));
    EXPECT_THAT(refusal_of(header + "{\"tick\":0,\"orders\":[{\"fly\":1}],\"state\":\"0\"}\n"),
                HasSubstr(":2: this is no order"));
    EXPECT_THAT(refusal_of(header + "{\"tick\":0,\"state\":\"what\"}\n"), HasSubstr("no checksum"));
}

TEST_F(RecordedStroke, MayBeWrittenByHandWithoutChecksums) {
    const std::string header = text.substr(0, text.find('\n') + 1);
    const Recording recording = read(header + "{\"tick\":0}\n{\"tick\":1}\n");
    EXPECT_EQ(recording.num_ticks, 2u);
    EXPECT_TRUE(recording.checksums.empty());
}

TEST_F(RecordedStroke, OfAnotherScenarioIsRefusedByItsName) {
    scenario::Scenario other = folder.scenario();
    other.name = "slab";
    other.hash = "0123456789abcdef";
    try {
        Replay(other, read(text), false);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "the recording is of block, and this is slab");
    }
}

TEST_F(RecordedStroke, OfNothingIsRefusedInWords) {
    try {
        Replay(folder.scenario(), read(text.substr(0, text.find('\n') + 1)), false);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("no tick"));
    }
}

TEST_F(RecordedStroke, SaysAtTheStartIfTheDiskIsFull) {
    Session session(folder.scenario());
    const auto full = std::filesystem::path("/dev/full");
    if (!std::filesystem::exists(full)) GTEST_SKIP();
    EXPECT_THROW(Recorder(session, {}, "test", full), OutputError);
}

TEST_F(RecordedStroke, NamesTheTickOfAnOrderThatIsRefused) {
    std::string changed = text;
    changed.replace(changed.find("\"move\":\"knife\""), 14, "\"move\":\"spoon\"");
    Replay replay(folder.scenario(), read(changed), false);
    try {
        replay.tick();
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("tick 0 of the recording: there is no tool 'spoon'"));
    }
}

}  // namespace
}  // namespace incise::live
