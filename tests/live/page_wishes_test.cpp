// What pages say to a session, and what they hear.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <thread>

#include "incise/live/loop/live_loop.h"
#include "incise/scenario/tools/tool_kind.h"
#include "tests/live/soft_block.h"
#include "tests/live/web_client.h"

namespace incise::live {
namespace {

using testing::HasSubstr;

bool is_state(const Json& message) { return message["type"] == "state"; }
bool is_error(const Json& message) {
    return message["type"] == "message" && message["level"] == "error";
}
std::string take(const std::string& kind, double z) {
    const std::string shape = kind == "blade" ? R"("edge":[[0,0,0.03],[0,0,-0.02]])"
                                              : R"("shape":{"sphere":{"radius":0.012}})";
    return R"({"do":"take","tool":{"kind":")" + kind + "\"," + shape + R"(},"pose":{)" +
           at(0.05, 0.05, z) + "}}";
}

class PageWishes : public testing::Test {
  protected:
    PageWishes()
        : session(folder.scenario(), 0.002),
          recorder(session, {}, "test", std::nullopt),
          server({.host = "127.0.0.1", .port = 0, .downloads = {"/frame.vtu"}}),
          loop(session, recorder, server) {}

    /// Runs the loop until the pages have done their work.
    void run(const std::function<void()>& pages) {
        std::atomic<bool> is_done = false;
        std::jthread thread([&] {
            try {
                pages();
            } catch (const std::exception& error) {
                ADD_FAILURE() << error.what();
            }
            is_done = true;
        });
        loop.run([&] { return is_done.load(); });
    }

    BlockFolder folder;
    Session session;
    Recorder recorder;
    Server server;
    LiveLoop loop;
};

TEST_F(PageWishes, UndoLeadsBackToBeforeAStroke) {
    run([&] {
        WebPage page(server.address());
        EXPECT_EQ(page.wait_for("hello")["role"], "operator");
        page.say(R"({"do":"pause","on":true})");
        const Json before = page.wait_for([](const Json& m) { return is_state(m) && m["paused"]; });
        EXPECT_EQ(before["can_undo"], false);
        // Two strokes within a tick: nothing has moved between them.
        page.say(take("blade", 0.2));
        page.say(R"({"do":"drop"})");
        page.say(take("carver", 0.2));
        const auto has_carver = [](const Json& m) {
            return is_state(m) && m["tools"].size() == 2 && m["tools"][1]["kind"] == "carver";
        };
        EXPECT_EQ(page.wait_for(has_carver)["can_undo"], true);
        page.say(R"({"do":"undo"})");
        const Json undone =
            page.wait_for([](const Json& m) { return is_state(m) && m["tools"].empty(); });
        EXPECT_EQ(undone["can_undo"], false);
        EXPECT_EQ(undone["time"], before["time"]);
        page.say(R"({"do":"undo"})");
        EXPECT_THAT(page.wait_for(is_error)["text"], HasSubstr("nothing to undo"));
    });
    EXPECT_TRUE(session.tools().empty());
}

TEST_F(PageWishes, UndoTakesBackOneThreadInAPause) {
    run([&] {
        WebPage page(server.address());
        page.wait_for("hello");
        page.say(R"({"do":"pause","on":true})");
        const auto has_threads = [](std::size_t count) {
            return [count](const Json& m) {
                return is_state(m) && m["paused"] == true && m["tools"].size() == count;
            };
        };
        for (const char* y : {"0.03", "0.05", "0.07"})
            page.say(R"({"do":"sew","stiffness":20,"points":[[0.03,)" + std::string(y) +
                     R"(,0.05],[0.07,)" + y + R"(,0.05]]})");
        page.wait_for(has_threads(3));
        page.say(take("blade", 0.2));
        page.wait_for(has_threads(4));
        page.say(R"({"do":"undo"})");
        page.wait_for(has_threads(3));
        page.say(R"({"do":"undo"})");
        EXPECT_EQ(page.wait_for(has_threads(2))["can_undo"], true);
        page.say(take("blade", 0.2));
        page.wait_for(has_threads(3));
        page.say(R"({"do":"undo"})");
        page.wait_for(has_threads(2));
    });
}

TEST_F(PageWishes, UndoTakesBackWhatACutOpened) {
    run([&] {
        WebPage page(server.address());
        page.wait_for("hello");
        page.say(take("blade", 0.05));
        page.wait_for([](const Json& m) { return is_state(m) && m["tools"].size() == 1; });
        page.say(R"({"do":"move","pose":{"at":[0.05,0.09,0.05]}})");
        page.say(R"({"do":"pause","on":true})");
        for (int i = 0; i < 3; ++i) page.say(R"({"do":"step"})");
        page.wait_for([](const Json& m) { return is_state(m) && m["cut_area"] > 1e-4; });
        page.say(R"({"do":"undo"})");
        const Json undone =
            page.wait_for([](const Json& m) { return is_state(m) && m["tools"].empty(); });
        EXPECT_EQ(undone["cut_area"], 0.0);
        EXPECT_EQ(undone["edits"], 0);
    });
}

TEST_F(PageWishes, AnotherPageTakesOver) {
    run([&] {
        WebPage first(server.address());
        EXPECT_EQ(first.wait_for("hello")["role"], "operator");
        WebPage second(server.address());
        EXPECT_EQ(second.wait_for("hello")["role"], "watcher");
        first.say(take("carver", 0.2));
        const auto is_there = [](const Json& m) {
            return is_state(m) && m["tools"].size() == 1 && m["tools"][0]["present"];
        };
        second.wait_for(is_there);
        second.say(take("blade", 0.2));
        EXPECT_THAT(second.wait_for(is_error)["text"], HasSubstr("take over from it first"));
        second.say(R"({"do":"take_over"})");
        EXPECT_EQ(first.wait_for("hello")["role"], "watcher");
        EXPECT_EQ(second.wait_for("hello")["role"], "operator");
        second.wait_for([](const Json& m) { return is_state(m) && m["tools"].empty(); });
        first.say(R"({"do":"pause","on":true})");
        EXPECT_THAT(first.wait_for(is_error)["text"], HasSubstr("take over from it first"));
        second.say(take("blade", 0.2));
        second.wait_for(is_there);
    });
}

TEST_F(PageWishes, AThreadIsSewnTightenedAndUntied) {
    run([&] {
        WebPage page(server.address());
        page.wait_for("hello");
        page.say(R"({"do":"sew","stiffness":20,"points":[[0.03,0.05,0.05],[0.07,0.05,0.05]]})");
        const auto thread_of = [](const Json& m) {
            return is_state(m) && m["tools"].size() == 1 && m["tools"][0]["kind"] == "suture";
        };
        const Json state = page.wait_for(thread_of);
        const Json thread = state["tools"][0];
        const std::string name = thread["name"];
        const double length = thread["length"];
        EXPECT_NEAR(length, 0.04, 0.002);
        page.say(R"({"do":"tighten","factor":0.5,"name":")" + name + "\"}");
        page.wait_for(
            [&](const Json& m) { return thread_of(m) && m["tools"][0]["length"] < 0.51 * length; });
        page.say(R"({"do":"untie","name":")" + name + "\"}");
        page.wait_for([](const Json& m) { return is_state(m) && m["tools"].empty(); });
        page.say(R"({"do":"tighten","factor":0.5,"name":"nothing"})");
        EXPECT_THAT(page.wait_for(is_error)["text"], HasSubstr("no tool 'nothing'"));
    });
}

TEST_F(PageWishes, NestedTextsAreRefused) {
    run([&] {
        WebPage page(server.address());
        page.wait_for("hello");
        const std::string deep = std::string(30000, '[') + std::string(30000, ']');
        page.say(R"({"do":"take","tool":{"kind":"blade","edge":)" + deep +
                 R"(},"pose":{"at":[0,0,0]}})");
        EXPECT_THAT(page.wait_for(is_error)["text"], HasSubstr("nested too deeply"));
        page.say("{\"do\":" + deep);
        page.wait_for(is_error);
    });
}

TEST_F(PageWishes, LongTextsOfThoseThatLookOnAreNotRead) {
    run([&] {
        WebPage first(server.address());
        first.wait_for("hello");
        WebPage second(server.address());
        second.wait_for("hello");
        second.say(std::string(60000, '['));
        EXPECT_THAT(second.wait_for(is_error)["text"], HasSubstr("take over from it first"));
        first.say(std::string(60000, '['));
        EXPECT_THAT(first.wait_for(is_error)["text"], HasSubstr("nested too deeply"));
    });
}

TEST_F(PageWishes, ToolsOfTheScenarioAreShown) {
    run([&] {
        WebPage page(server.address());
        const Json hello = page.wait_for("hello");
        ASSERT_EQ(hello["scripted_tools"].size(), 1u);
        EXPECT_EQ(hello["scripted_tools"][0]["kind"], "carver");
        EXPECT_EQ(hello["scripted_tools"][0]["is_obstacle"], false);
        EXPECT_EQ(hello["scripted_tools"][0]["tool"]["shape"]["sphere"]["radius"], 0.02);
        // A page sees the newest state only. So the session stands where its tool is there.
        page.say(R"({"do":"pause","on":true})");
        page.say(R"({"do":"reset"})");
        for (int i = 0; i < 30; ++i) page.say(R"({"do":"step"})");
        const Json state = page.wait_for(
            [](const Json& m) { return is_state(m) && m["paused"] && m["tick"] == 30; });
        EXPECT_EQ(state["scripted"][0]["present"], true);
        EXPECT_NEAR(state["scripted"][0]["pose"]["at"][2], 0.06, 1e-6);
    });
}

TEST(DefinitionOfTool, HasAllShapesThatAPageDraws) {
    using cutting::ToolShape;
    const auto text = [](const ToolShape& shape) {
        return text_of(json_of(scenario::definition_of(shape).value()));
    };
    EXPECT_EQ(text(cutting::Blade{.edge = {Vec3(0, 0, 1), Vec3(0, 0, 2)}}),
              R"({"edge":[[0.0,0.0,1.0],[0.0,0.0,2.0]],"kind":"blade"})");
    EXPECT_EQ(text(cutting::Grasper{cutting::Cuboid{Vec3(1, 2, 3)}}),
              R"({"kind":"grasper","shape":{"box":{"size":[1.0,2.0,3.0]}}})");
    EXPECT_EQ(
        text(cutting::Probe{cutting::HalfSpace{}}),
        R"({"kind":"probe","shape":{"plane":{"normal":[0.0,0.0,1.0],"point":[0.0,0.0,0.0]}}})");
    const cutting::Solid solid{{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}}};
    EXPECT_EQ(text(cutting::Probe{solid}),
              R"({"kind":"probe","shape":{"mesh":{"points":[[0.0,0.0,0.0],[1.0,0.0,0.0],)"
              R"([0.0,1.0,0.0]],"triangles":[[0,1,2]]}}})");
    EXPECT_EQ(text(cutting::Scissors{.length = 2.0, .angle = 0.5}),
              R"({"angle":0.5,"kind":"scissors","length":2.0})");
    EXPECT_FALSE(scenario::definition_of(cutting::PlaneCut{}));
    EXPECT_FALSE(scenario::definition_of(cutting::Suture{}));
}

TEST_F(PageWishes, ManyDownloadsAtOnceAreAllAnswered) {
    run([&] {
        WebPage page(server.address());
        page.say(R"({"do":"pause","on":true})");
        page.wait_for([](const Json& m) { return is_state(m) && m["paused"]; });
        const std::string query = server.address().substr(server.address().find("?token="));
        std::vector<std::string> answers(12);
        std::vector<std::jthread> clients;
        for (std::string& answer : answers)
            clients.emplace_back([&] {
                Client client(server.port());
                client.send("GET /frame.vtu" + query + " HTTP/1.1\r\nHost: localhost:" +
                            std::to_string(server.port()) + "\r\nConnection: close\r\n\r\n");
                answer = client.read();
            });
        clients.clear();
        EXPECT_THAT(answers[0], HasSubstr("<UnstructuredGrid"));
        for (const std::string& answer : answers) EXPECT_EQ(answer, answers[0]);
    });
}

}  // namespace
}  // namespace incise::live
