// incise live: what it refuses before a session begins.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "in_folder.h"

namespace incise {
namespace {

class LiveCommand : public test::InFolder {
  protected:
    LiveCommand() {
        write("s.toml", R"([mesh]
box = { size = [1, 1, 1], cells = [2, 2, 2] }
[[material]]
density = 1060
young = 1600
poisson = 0.45
[dynamics]
end_time = 1
)");
    }
};

TEST_F(LiveCommand, RefusesToolsOfDevicesThatCannotBe) {
    const std::string live = "live s.toml --no-open --port 0 ";
    if (run(live + "--igtl 0 --tool a").err.find("no OpenIGTLink") != std::string::npos)
        GTEST_SKIP() << "built without OpenIGTLink";
    const std::map<std::string, std::string> causes = {
        {"a", "must be NAME={...}"},
        {"a=3", "must be NAME={...}"},
        {"a={}", "kind"},
        {"a={kind=\"blad\"}", "did you mean 'blade'?"},
        {"a={kind=\"blade\"}", "edge"},
        {"a={kind=\"blade\", edge=[[0,0,0],[0,0,1]], begin=0}", "begin"},
        {"a={kind=\"blade\", edge=[[0,0,0],[0,0,1]], path=[]}", "path"},
        {"a={kind=\"probe\", shape={sphere={radius=-1}}}", "radius"},
        {"a={kind=\"probe\", shpe={}}", "did you mean 'shape'?"},
        {"a={kind=\"cut\", plane={point=[0,0,0], normal=[0,0,1]}}", "a cut is not led by hand"},
        {"a={kind=\"suture\", points=[[0,0,0],[1,1,1]], stiffness=1}", "sewn, not led"},
        {"tissue={kind=\"carver\", shape={sphere={radius=1}}}", "name of the body"},
        {"a_name_of_more_than_20_letters={}", "at most 20 characters"},
    };
    for (const auto& [tool, cause] : causes) {
        const auto outcome = run(live + "--igtl 0 --tool '" + tool + "'");
        EXPECT_EQ(outcome.status, 2) << tool;
        EXPECT_NE(outcome.err.find("--tool "), std::string::npos) << tool << ": " << outcome.err;
        EXPECT_NE(outcome.err.find(cause), std::string::npos) << tool << ": " << outcome.err;
    }
    const std::string ball = "--tool 'a={kind=\"carver\", shape={sphere={radius=1}}}' ";
    EXPECT_NE(run(live + "--igtl 0 " + ball + ball).err.find("two tools"), std::string::npos);
    EXPECT_NE(run(live + ball).err.find("--igtl"), std::string::npos);
    EXPECT_NE(run(live + "--igtl 0").err.find("--tool"), std::string::npos);
}

TEST_F(LiveCommand, SaysBeforeALiveSessionWhatCannotBe) {
    const auto refused = [&](const std::string& options, const std::string& cause) {
        const auto outcome = run("live s.toml --no-open --port 0 " + options);
        EXPECT_EQ(outcome.status, 2) << options;
        EXPECT_NE(outcome.err.find(cause), std::string::npos) << outcome.err;
    };
    refused("--record nowhere/hands.jsonl", "there is no folder nowhere");
    refused("--record s.toml", "is there already");
    refused("--host 1.2.3.4", "is no address of this machine");
    refused("--host nothing", "is no address");
    refused("--tick nan", "a tick of nan s");
}

}  // namespace
}  // namespace incise
