// Reports of real runs: finished, stopped, killed, failed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>

#include "run_process.h"

namespace incise::test {
namespace {

using testing::HasSubstr;

class ReportOfRun : public Run {
  protected:
    nlohmann::ordered_json report() {
        const auto outcome = incise({"report", "scene.out", "--pictures", "0"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.out, "scene.out/report.html\n");
        const auto page = read_text(folder_ / "scene.out/report.html");
        const std::string begin = "type=\"application/json\">";
        const auto from = page.find(begin) + begin.size();
        return nlohmann::ordered_json::parse(
            page.substr(from, page.find("</script>", from) - from));
    }
    static double value(const nlohmann::ordered_json& account, const std::string& label) {
        for (const auto& row : account["rows"])
            if (row["label"] == label) return row["values"][0].get<double>();
        ADD_FAILURE() << "no line " << label;
        return 0.0;
    }
};

TEST_F(ReportOfRun, AgreesWithItsSummary) {
    write("scene.toml", "title = 'A carved block'\n" + scene +
                            "[expect]\nelements = { max = 47 }\nedits = { min = 99 }\n");
    ASSERT_EQ(run({"scene.toml", "--quiet", "--set", "material[0].young=2000"}).status, 1);
    const auto data = report();
    EXPECT_EQ(data["title"], "A carved block");
    EXPECT_EQ(data["ending"]["kind"], "finished");
    EXPECT_EQ(data["command"]["run"], "incise run scene.toml --set 'material[0].young=2000'");
    EXPECT_EQ(data["command"]["directory"], fs::canonical(folder_.path()).string());
    EXPECT_EQ(data["started"].get<std::string>().size(),
              std::string("2026-11-28T01:10:00Z").size());
    EXPECT_EQ(data["edits"]["count"], summary()["edits"]);
    const auto& mass = data["accounts"][0];
    EXPECT_NEAR(value(mass, "− taken away by tools"), summary()["mass_removed"].get<double>(),
                1e-6);
    const auto& energy = data["accounts"][1];
    EXPECT_NEAR(value(energy, "lacking, of the sum of the lines above"),
                100.0 * summary()["energy_error"].get<double>(), 1e-6);  // seven digits
    EXPECT_GT(summary()["energy_error"].get<double>(), 1e-6);
    ASSERT_EQ(data["expectations"].size(), 2u);
    EXPECT_EQ(data["expectations"][0]["met"], true);
    EXPECT_EQ(data["expectations"][1]["met"], false);
    EXPECT_THAT(data["scenario"].get<std::string>(), HasSubstr("young = 2000"));
}

TEST_F(ReportOfRun, HasItsWarnings) {
    write("scene.toml", scene);
    // The carver passes beside the block.
    ASSERT_EQ(run({"scene.toml", "--quiet", "--set", "tool[0].path[0].at=[9, 9, 9]", "--set",
                   "tool[0].path[1].at=[9, 9, 8]"})
                  .status,
              0);
    const auto data = report();
    // That it misses the body is known before; that it has cut nothing, at the end.
    ASSERT_EQ(data["warnings"].size(), 2u);
    EXPECT_THAT(data["warnings"][1].get<std::string>(), HasSubstr("has cut nothing"));
    EXPECT_EQ(data["edits"]["count"], 0);
}

TEST_F(ReportOfRun, TellsThatItWasStoppedOrKilled) {
    for (const int signal : {SIGINT, SIGKILL}) {
        write("scene.toml", endless);
        const pid_t child = start({"scene.toml", "--end-time", "50", "--quiet", "--force"});
        wait_for_frame(3);
        ::kill(child, signal);
        finish(child);
        const auto data = report();
        EXPECT_EQ(data["ending"]["kind"], signal == SIGINT ? "interrupted" : "unfinished");
        EXPECT_THAT(data["ending"]["text"].get<std::string>(), HasSubstr("--resume"));
        EXPECT_GT(data["plots"]["rows"].get<int>(), 2);
        // A killed run has recorded no command, but it has kept its scenario.
        EXPECT_EQ(data["command"]["run"],
                  signal == SIGINT ? "incise run scene.toml --end-time 50" : "");
        EXPECT_EQ(data["command"]["rerun"], "incise run scene.out/scene.toml --out again");
        fs::remove_all(folder_ / "scene.out");
    }
}

TEST_F(ReportOfRun, TellsWhyItFailed) {
    write("scene.toml", scene + "[expect]\nelements = { max = 47 }\n");
    const auto failed = run({"scene.toml", "--quiet", "--set", "dynamics.gravity=[0, 0, -1e9]"});
    ASSERT_EQ(failed.status, 3) << failed.err;
    const auto data = report();
    EXPECT_EQ(data["ending"]["kind"], "failed");
    EXPECT_EQ(data["ending"]["text"], summary()["message"]);
    EXPECT_EQ(data["expectations"].size(), 0u);  // they are about the end
    EXPECT_THAT(failed.err, HasSubstr(data["ending"]["text"].get<std::string>().substr(0, 40)));
}

}  // namespace
}  // namespace incise::test
