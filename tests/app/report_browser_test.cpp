// The page of a report in a browser: what it draws, what it says, and that it runs no text of the
// run. Skipped where there is no Chromium.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "in_folder.h"
#include "report_folder.h"

namespace incise::test {
namespace {

using support::read_text;
using testing::HasSubstr;
using testing::Not;

/// Collects errors from the first script on.
const std::string first_script = R"(<script>
window.errors = [];
addEventListener("error", (event) => errors.push(event.message));
addEventListener("securitypolicyviolation", (event) => errors.push(event.violatedDirective));
const warn = console.error;
console.error = (...words) => { errors.push(words.join(" ")); warn(...words); };
</script>)";

/// Writes what is on the page into an element that the test reads.
const std::string last_script = R"(<script>
function paintedPart(canvas) {
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let colored = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    const [r, g, b, alpha] = pixels.slice(i, i + 4);
    if (alpha > 128 && Math.max(r, g, b) - Math.min(r, g, b) > 60) ++colored;
  }
  return colored;
}
const rows = (id) => document.querySelectorAll(`#${id} tbody tr`).length;
const texts = (query) => Array.from(document.querySelectorAll(query), (node) => node.textContent);
async function probe() {
  const found = {
    errors, state: document.documentElement.dataset.state, title: document.title,
    plots: plots.map((plot) => ({
      series: plot.series.length - 1, points: plot.data[0].length,
      width: plot.root.querySelector("canvas").width,
      height: plot.root.querySelector("canvas").height,
      colored: paintedPart(plot.root.querySelector("canvas")),
    })),
    facts: texts(".fact"), headings: texts(".plot h3"), warnings: texts("#warning-list .box"),
    ending: texts("#ending"), pictures: Array.from(document.querySelectorAll("#picture-list img"),
      (picture) => [picture.naturalWidth, picture.naturalHeight]),
    tools: rows("tool-table"), edits: rows("edit-table"), accounts: rows("account-list"),
    first_edit: texts("#edit-table tbody tr:first-child td"), more: texts("#edit-more"),
    scenario: texts("#scenario-text"), command: texts("#commands pre"),
    wide: document.documentElement.scrollWidth > innerWidth,
  };
  const button = document.querySelectorAll("#edit-table thead button")[1];
  if (button) {
    button.click();
    button.click();
    found.sorted = texts("#edit-table tbody tr:first-child td");
  }
  const zoomed = plots[0];
  if (zoomed) {
    zoomed.setScale("x", { min: 0.05, max: 0.1 });
    await new Promise((done) => setTimeout(done, 50));
    found.zoomed = plots.map((plot) => plot.scales.x.max);
    found.can_reset = !byId("reset-zoom").hidden;
  }
  document.body.replaceChildren(element("pre", { id: "found" }, JSON.stringify(found)));
}
setTimeout(probe, 200);
</script>)";

bool has_browser() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

class ReportBrowser : public InFolder {
  protected:
    void SetUp() override {
        if (!has_browser()) GTEST_SKIP() << "no chromium: the report is not looked at";
    }

    /// Makes the report of fall.out, opens it, and returns what is on the page.
    Json look(const std::string& options = "--window-size=1280,900",
              const std::string& pictures = "--pictures 0") {
        const auto made = run("report fall.out " + pictures);
        EXPECT_EQ(made.status, 0) << made.err;
        auto page = read_text(folder_ / "fall.out/report.html");
        page.insert(page.find("<head>") + 6, first_script);
        page.insert(page.rfind("</body>"), last_script);
        write("probed.html", page);
        const auto profile = (folder_ / "profile").string();
        const auto seen =
            run("60 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage "
                "--user-data-dir='" +
                    profile +
                    "' --enable-logging=stderr "
                    "--virtual-time-budget=5000 --dump-dom " +
                    options + " 'file://" + (folder_ / "probed.html").string() + "'",
                "timeout");
        EXPECT_EQ(seen.status, 0) << seen.err;
        EXPECT_THAT(seen.err, Not(HasSubstr("CONSOLE")));
        const std::string begin = "<pre id=\"found\">";
        const auto from = seen.out.find(begin);
        if (from == seen.out.npos) {
            ADD_FAILURE() << "the page was not filled: " << seen.out.substr(0, 2000);
            return {};
        }
        const auto to = seen.out.find("</pre>", from);
        return Json::parse(plain(seen.out.substr(from + begin.size(), to - from - begin.size())));
    }

    /// Undoes what the browser escapes in the texts that it prints.
    static std::string plain(std::string html) {
        const std::pair<std::string, std::string> escapes[] = {
            {"&lt;", "<"}, {"&gt;", ">"}, {"&nbsp;", " "}, {"&amp;", "&"}};
        for (const auto& [escape, text] : escapes)
            for (auto at = html.find(escape); at != html.npos; at = html.find(escape, at + 1))
                html.replace(at, escape.size(), text);
        return html;
    }
};

TEST_F(ReportBrowser, ShowsThePicturesOfARun) {
    write("fall.toml",
          "[mesh]\nbox = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }\n"
          "[[material]]\ndensity = 1000\nyoung = 5000\npoisson = 0.3\n"
          "[dynamics]\nend_time = 0.03\n[output]\ninterval = 0.01\n");
    ASSERT_EQ(run("run fall.toml --quiet").status, 0);
    const auto found = look("--window-size=1280,900", "--pictures 3");
    EXPECT_EQ(found["errors"], Json::array());
    EXPECT_EQ(found["pictures"], Json::parse("[[960, 720], [960, 720], [960, 720]]"));

    // A picture that cannot be drawn is told of in a sentence; the rest of the page is there.
    std::filesystem::remove(folder_ / "fall.out/frames/fall_000003.vtu");
    const auto without = run("report fall.out --color displacement");
    EXPECT_EQ(without.status, 0) << without.err;
    EXPECT_THAT(without.err, HasSubstr("There are no pictures: "));
    EXPECT_THAT(without.err, HasSubstr("fall_000003.vtu"));
    EXPECT_THAT(without.err, Not(HasSubstr("looking through")));
    EXPECT_EQ(std::count(without.err.begin(), without.err.end(), '\n'), 1) << without.err;
}

TEST_F(ReportBrowser, DrawsPlotsAndFillsTables) {
    write_fall(folder_ / "fall.out");
    const auto found = look();
    EXPECT_EQ(found["errors"], Json::array());
    EXPECT_EQ(found["state"], "complete");
    EXPECT_EQ(found["title"], "A fall – Incise");
    const std::vector<std::pair<std::string, int>> plots = {
        {"Energy in J", 2},
        {"Work and loss since the start in J", 2},
        {"Energy that the account lacks in J", 1},
        {"Pieces", 1},
        {"Elements and nodes", 2},
        {"Mass in kg", 1},
        {"Volume at rest in m³", 1},
        {"Momentum in kg m/s", 3},
        {"Force of the constraint clamp in N", 3},
        {"Force of the tissue on probe in N", 3}};
    ASSERT_EQ(found["plots"].size(), plots.size()) << found["headings"];
    for (std::size_t i = 0; i < plots.size(); ++i) {
        const auto& plot = found["plots"][i];
        SCOPED_TRACE(plots[i].first + ": " + plot.dump());
        EXPECT_EQ(found["headings"][i], plots[i].first);
        EXPECT_EQ(plot["series"], plots[i].second);
        EXPECT_EQ(plot["points"], 21);
        EXPECT_GT(plot["width"], 300);
        EXPECT_GT(plot["height"], 150);
        EXPECT_GT(plot["colored"], 300);  // a line across is as long as the plot is wide
    }
    EXPECT_EQ(found["tools"], 2);
    EXPECT_EQ(found["edits"], 2);
    EXPECT_EQ(found["accounts"], 5 + 8 + 4);
    EXPECT_THAT(found["facts"].dump(), HasSubstr("Pieces1 → 2"));
    EXPECT_THAT(found["ending"][0].get<std::string>(), HasSubstr("The run finished."));
    EXPECT_EQ(found["scenario"][0], "# A fall\n[mesh]\n");
    EXPECT_EQ(found["command"][0], "incise run fall.toml");
    // A click sorts by step, another one the other way round.
    EXPECT_EQ(found["first_edit"][1], "10");
    EXPECT_EQ(found["sorted"][1], "12");
    // All plots show the same part of the time.
    for (const auto& end : found["zoomed"]) EXPECT_EQ(end, 0.1);
    EXPECT_EQ(found["can_reset"], true);
}

TEST_F(ReportBrowser, RunsNoTextOfTheRun) {
    const std::string evil =
        "</script><script>errors.push('ran')</script><img src=x onerror=\"errors.push('ran')\">";
    write_fall(folder_ / "fall.out", evil, evil);
    auto summary = summary_of("failed", evil);
    for (const char* entry : {"message", "command", "directory", "started", "version"})
        summary[entry] = evil;
    summary["warnings"] = {evil};
    write_text(folder_ / "fall.out/summary.json", summary.dump());
    const auto found = look();
    EXPECT_EQ(found["errors"], Json::array());
    EXPECT_EQ(found["state"], "complete");
    EXPECT_EQ(found["title"], evil + " – Incise");
    EXPECT_EQ(found["warnings"][0], evil);
    EXPECT_EQ(found["ending"][0], "The run failed." + evil);
    EXPECT_EQ(found["command"][0], evil);
}

TEST_F(ReportBrowser, IsQuickWithManyEdits) {
    write_fall(folder_ / "fall.out");
    std::string edits, history = history_head;
    for (int i = 0; i < 20'000; ++i) {
        edits += edit_at(i, i % 2 ? "left" : "right").dump() + "\n";
        history += history_row(i);
    }
    write_text(folder_ / "fall.out/edits.jsonl", edits);
    write_text(folder_ / "fall.out/history.csv", history);
    const auto start = std::chrono::steady_clock::now();
    const auto found = look();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 60.0);  // 13 s on two busy cores, 6 of them for a small page
    EXPECT_EQ(found["errors"], Json::array());
    EXPECT_EQ(found["edits"], 100);
    EXPECT_EQ(found["tools"], 2);
    EXPECT_THAT(found["more"][0].get<std::string>(), HasSubstr("100 of 20,000 edits shown"));
    EXPECT_EQ(found["sorted"][1], "19,999");
    EXPECT_LE(found["plots"][0]["points"], 10'100);
    EXPECT_GE(found["plots"][0]["points"], 10'000);
}

TEST_F(ReportBrowser, FitsANarrowScreenWithoutData) {
    write_fall(folder_ / "fall.out");
    EXPECT_EQ(look("--window-size=500,800")["wide"], false);
    write_text(folder_ / "fall.out/history.csv", history_head);
    write_text(folder_ / "fall.out/edits.jsonl", "");
    std::filesystem::remove(folder_ / "fall.out/summary.json");
    const auto found = look("--window-size=500,800");
    EXPECT_EQ(found["errors"], Json::array());
    EXPECT_EQ(found["state"], "complete");
    EXPECT_EQ(found["plots"].size(), 0u);
    EXPECT_THAT(found["ending"][0].get<std::string>(), HasSubstr("The run has not ended."));
}

}  // namespace
}  // namespace incise::test
