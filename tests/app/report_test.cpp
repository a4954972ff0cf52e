// What a report makes of the files of a run, and what incise report says if it can make none.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "in_folder.h"
#include "incise/app/report/accounts.h"
#include "incise/app/report/charts.h"
#include "incise/app/report/energy_balance.h"
#include "incise/app/report/facts.h"
#include "incise/app/report/page.h"
#include "incise/app/report/page_data.h"
#include "incise/app/report/run_record.h"
#include "report_folder.h"

namespace incise::report {
namespace {

namespace fs = std::filesystem;
using support::read_text;
using support::TemporaryFolder;
using test::write_fall;
using test::write_text;
using testing::HasSubstr;
using testing::Not;

const Origin by_hand = {"incise report fall.out", "2026-11-28T01:20:00Z", ""};

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t number = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++number;
    return number;
}

std::string page_of_folder(const fs::path& folder) {
    const RunRecord run = read_run(folder);
    return page_of(run.title(), page_data(run, {}, by_hand));
}

/// The data as a browser reads them out of the page.
Json data_in(const std::string& page) {
    const std::string begin = "type=\"application/json\">";
    const auto from = page.find(begin) + begin.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST(ReportPage, HoldsAllThatItNeeds) {
    const TemporaryFolder folder;
    write_fall(folder.path());
    const auto page = page_of_folder(folder.path());
    EXPECT_THAT(page, HasSubstr("<title>A fall – Incise</title>"));
    EXPECT_THAT(page, HasSubstr("var uPlot="));
    EXPECT_THAT(page, HasSubstr("Permission is hereby granted"));
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    for (const char* loaded : {" src=\"http", "<link", "@import", "url(http", "<script src"})
        EXPECT_THAT(page, Not(HasSubstr(loaded)));
    EXPECT_THAT(page, Not(HasSubstr("{{")));
}

TEST(ReportPage, LetsNoTextOfTheRunBecomeHtml) {
    const TemporaryFolder folder;
    write_fall(folder / "plain");
    const std::string evil = "</script><script>alert('x')</script><!-- & \" ' {{page_js}} \xff";
    write_fall(folder / "evil", evil, evil);
    auto summary = test::summary_of("failed", evil);
    for (const char* entry : {"message", "command", "directory", "started", "version"})
        summary[entry] = evil;
    summary["warnings"] = {evil};
    write_text(folder / "evil/summary.json", test::json_text(summary));
    const auto plain = page_of_folder(folder / "plain"), page = page_of_folder(folder / "evil");
    for (const char* part : {"<script", "</script", "<!--", "var uPlot="})
        EXPECT_EQ(count(page, part), count(plain, part)) << part;
    EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
    EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;&lt;script&gt;alert"));
    // The texts are as they were.
    const auto start = evil.substr(0, evil.size() - 1);
    EXPECT_THAT(data_in(page)["title"].get<std::string>(), HasSubstr(start));
    EXPECT_THAT(data_in(page)["warnings"][0].get<std::string>(), HasSubstr(start));
    EXPECT_THAT(data_in(page)["edits"]["tools"][0]["tool"].get<std::string>(), HasSubstr(start));
}

TEST(ReportCharts, HaveEveryColumn) {
    const TemporaryFolder folder;
    write_fall(folder.path());
    auto history = read_run(folder.path()).history;
    history.add("column_of_later", std::vector<double>(history.num_rows(), 3.0));
    history.add("another", std::vector<double>(history.num_rows(), 0.0));
    const auto charts = charts_of(history);
    std::set<std::string> drawn;
    for (const Chart& chart : charts.charts)
        for (const Series& series : chart.series) EXPECT_TRUE(drawn.insert(series.column).second);
    for (const std::string& name : history.names)
        if (name != "time" && name != "step" && name != "contacts" && name != "another") {
            EXPECT_TRUE(drawn.contains(name)) << name;
        }
    EXPECT_THAT(charts.left_out, testing::ElementsAre("Points of contact", "another"));
}

TEST(ReportHistory, ThinnedKeepsEndsAndExtremes) {
    HistoryTable history;
    std::vector<double> time, value;
    for (int i = 0; i < 10'007; ++i) {
        time.push_back(i);
        value.push_back(i == 4321 ? 7.0 : i == 8765 ? -7.0 : 0.0);
    }
    history.add("time", time);
    history.add("value", value);
    const auto rows = rows_to_show(history, 1000);
    EXPECT_LE(rows.size(), 1004u);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    for (const std::size_t row : {0u, 4321u, 8765u, 10'006u})
        EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), row)) << row;
    EXPECT_EQ(rows_to_show(history, 20'000).size(), 10'007u);
}

TEST(ReportBalance, TakesEditsOffAtTheirRows) {
    const TemporaryFolder folder;
    write_fall(folder.path());
    const RunRecord run = read_run(folder.path());
    const auto balance = energy_balance(run);
    ASSERT_EQ(balance.removed.size(), 21u);
    EXPECT_EQ(balance.removed[9], 0.0);
    EXPECT_EQ(balance.removed[10], 0.375);
    EXPECT_EQ(balance.removed[12], 0.75);
    const double t = 0.2;
    EXPECT_NEAR(balance.lacking.back(), 2.0 * t - 0.1 * t - 0.75 - t * t - 0.5 * t, 1e-12);
}

TEST(ReportData, HasMoreEditsThanThePageShows) {
    const TemporaryFolder folder;
    write_fall(folder.path());
    std::string edits;
    for (std::size_t i = 0; i < most_edits + 5; ++i)
        edits += R"({"time":0.1,"step":10,"tool":"blade"})"
                 "\n";
    write_text(folder / "edits.jsonl", edits);
    const auto data = page_data(read_run(folder.path()), {}, by_hand)["edits"];
    EXPECT_EQ(data["count"], most_edits + 5);
    EXPECT_EQ(data["shown"], most_edits);
    EXPECT_EQ(data["columns"][0]["values"].size(), most_edits);
    // What an old run did not write is null, not zero.
    EXPECT_TRUE(data["columns"][8]["values"][0].is_null());
}

TEST(ReportData, EmbedsPictures) {
    const TemporaryFolder folder;
    write_fall(folder.path());
    write_text(folder / "fall.vtu.series", R"({"files":[{"name":"a","time":0.5}]})");
    const Pictures pictures = {{{0, "\x89PNG"}}, ""};
    const auto data = page_data(read_run(folder.path()), pictures, by_hand)["pictures"];
    EXPECT_EQ(data["items"][0]["source"], "data:image/png;base64,iVBORw==");
    EXPECT_EQ(data["items"][0]["time"], 0.5);
}

TEST(ReportEnding, SaysHowTheRunEnded) {
    const TemporaryFolder folder;
    write_fall(folder.path());
    const auto ending = [&] { return ending_of(read_run(folder.path())); };
    EXPECT_EQ(ending().kind, "finished");
    auto summary = test::summary_of("failed", "A fall");
    summary["message"] = "fall: step 7: element 3 is inverted";
    write_text(folder / "summary.json", summary.dump());
    EXPECT_EQ(ending().headline, "The run failed.");
    EXPECT_THAT(ending().text, HasSubstr("element 3 is inverted"));
    summary["status"] = "interrupted";
    summary["message"] = "stopped by a signal";
    write_text(folder / "summary.json", summary.dump());
    EXPECT_THAT(ending().text, HasSubstr("stopped by a signal. It goes on with"));
    fs::remove(folder / "summary.json");
    EXPECT_EQ(ending().kind, "unfinished");
    EXPECT_THAT(ending().text, HasSubstr("up to t = 0.2 s"));
}

/// incise report as users meet it.
class ReportCommand : public test::InFolder {
  protected:
    ReportCommand() { write_fall(folder_ / "fall.out"); }
};

TEST_F(ReportCommand, WritesThePageAndSaysWhere) {
    const auto outcome = run("report fall.out");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "fall.out/report.html\n");
    EXPECT_EQ(outcome.err, "incise: warning: The run has written no frames.\n");
    EXPECT_THAT(read_text(folder_ / "fall.out/report.html"), HasSubstr("A fall"));
    const auto elsewhere = run("report fall.out/ --out 'my page.html' --pictures 0");
    EXPECT_EQ(elsewhere.out, "my page.html\n");
    EXPECT_EQ(elsewhere.err, "");
    const auto data = data_in(read_text(folder_ / "my page.html"));
    EXPECT_EQ(data["command"]["report"],
              "incise report fall.out/ --out 'my page.html' --pictures 0");
    EXPECT_EQ(data["command"]["run"], "incise run fall.toml");
}

/// A stand-in for incise-render, and the program beside it.
class ReportPictures : public ReportCommand {
  protected:
    ReportPictures() {
        fs::create_directory(folder_ / "bin");
        fs::copy_file(INCISE_PROGRAM, folder_ / "bin/incise");
        std::string files;
        for (int i = 0; i < 31; ++i) files += (i ? "," : "") + std::string(R"({"time":0.1})");
        write_text(folder_ / "fall.out/fall.vtu.series", "{\"files\":[" + files + "]}");
    }
    void write_render(const std::string& script) {
        write("bin/incise-render", "#!/bin/sh\n" + script);
        fs::permissions(folder_ / "bin/incise-render", fs::perms::owner_all);
    }
    test::Outcome report(const std::string& options = "") {
        return run("report fall.out " + options, (folder_ / "bin/incise").string(),
                   "TMPDIR=bin PATH=/usr/bin:/bin");
    }
    Json pictures() { return data_in(read_text(folder_ / "fall.out/report.html"))["pictures"]; }
};

TEST_F(ReportPictures, AreThoseOfIncisePictureProgram) {
    write_render(R"(echo "$@" > words
for word; do case $word in --out=*) out=${word#--out=};; esac; done
mkdir "$out"; echo printed
for i in 00 06 12 18 24 30; do echo picture $i > "$out/fall_0000$i.png"; done
)");
    const auto outcome = report("--color von_mises --view=0,-1,0");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "fall.out/report.html\n");
    const auto words = read_text(folder_ / "words");
    EXPECT_THAT(words, HasSubstr("fall.out/fall.pvd --frame=0,6,12,18,24,30 --out="));
    EXPECT_THAT(words, HasSubstr("--color=von_mises --view=0,-1,0"));
    ASSERT_EQ(pictures()["items"].size(), 6u);
    EXPECT_EQ(pictures()["items"][1]["frame"], 6);
    EXPECT_EQ(pictures()["items"][1]["source"], "data:image/png;base64,cGljdHVyZSAwNgo=");
    EXPECT_EQ(support::count_entries(folder_ / "bin"), 2u);  // no file is left
}

TEST_F(ReportPictures, AreNotNeeded) {
    const auto absent = report();
    EXPECT_EQ(absent.status, 0) << absent.err;
    EXPECT_THAT(absent.err, HasSubstr("There are no pictures: incise-render: cannot be started"));
    EXPECT_THAT(pictures()["note"].get<std::string>(), HasSubstr("cannot be started"));
    write_render("echo 'incise-render: no display' >&2; exit 70\n");
    const auto broken = report();
    EXPECT_EQ(broken.status, 0) << broken.err;
    EXPECT_EQ(pictures()["note"], "There are no pictures: no display.");
    EXPECT_EQ(support::count_entries(folder_ / "bin"), 2u);
}

TEST_F(ReportPictures, RefuseWhatIncisePicturesRefuse) {
    write_render("echo \"incise-render: no field is called 'x'\" >&2; exit 2\n");
    const auto outcome = report("--color x");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err, "incise: no field is called 'x'\n");
    EXPECT_FALSE(fs::exists(folder_ / "fall.out/report.html"));
}

TEST_F(ReportCommand, NamesWhatIsWrong) {
    write("scene.toml", "[mesh]\n");
    fs::create_directory(folder_ / "empty");
    const auto history = read_text(folder_ / "fall.out/history.csv");
    const auto edits = read_text(folder_ / "fall.out/edits.jsonl");
    const auto broken = [&](const char* name, const char* file, const std::string& text) {
        write_fall(folder_ / name);
        write_text(folder_ / name / file, text);
    };
    broken("a", "history.csv", history.substr(0, history.size() - 9));
    broken("b", "history.csv", history.substr(0, history.size() - 1));
    broken("c", "history.csv", test::history_head + "0,0,8,six" + std::string(17, ',') + "\n");
    broken("d", "history.csv", "");
    broken("e", "history.csv", "a,b\n1,2\n");
    broken("f", "edits.jsonl", edits.substr(0, edits.size() - 9));
    broken("g", "edits.jsonl", edits + "[]\n");
    broken("h", "edits.jsonl", "{\"time\":1,\"step\":1}\n");
    broken("i", "summary.json", "{\"status\": ");
    broken("j", "summary.json", "[]");
    broken("k", "fall.vtu.series", "{}");
    write_fall(folder_ / "m");
    broken("l", "history.csv", history + test::history_row(3));
    fs::remove(folder_ / "fall.out/edits.jsonl");
    const std::pair<const char*, const char*> cases[] = {
        {"missing", "missing: no such folder; give the folder that incise run made"},
        {"scene.toml",
         "scene.toml: is a file; give the folder that incise run made, by default "
         "scene.out"},
        {"empty", "empty: is not the folder of a run, as it has no history.csv; give the folder"},
        {"fall.out", "fall.out/edits.jsonl: is missing, and each run writes it; restore the file"},
        {"a", "a/history.csv:22: has 19 of 21 values; remove that line if it is the last one"},
        {"b", "b/history.csv:22: the file is cut short within the line; remove that line"},
        {"c", "c/history.csv:2: column 'elements' is 'six', which is not a number; remove"},
        {"d", "d/history.csv"},
        {"e", "e/history.csv:1: begins with 'a', and the history of a run begins with"},
        {"f", "f/edits.jsonl:2: is no JSON from its byte"},
        {"g", "g/edits.jsonl:3: is not a JSON object; restore the file, or run the scenario again"},
        {"h", "h/edits.jsonl:1: has no 'tool', as each edit has; restore the file"},
        {"i", "i/summary.json: is no JSON from its byte"},
        {"j", "j/summary.json: is not the summary of a run"},
        {"k", "k/fall.vtu.series: has no list 'files'"},
        {"l", "l/history.csv:23: the time 0.03 s is before that of the line above"},
        {"m --out nowhere/page.html", "nowhere"},
        {"a --pictures -1", "--pictures"},
        {"", "DIR is required"},
    };
    for (const auto& [arguments, text] : cases) {
        const auto outcome = run(std::string("report ") + arguments);
        EXPECT_TRUE(outcome.status == 2 || outcome.status == 4) << outcome.status << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_THAT(outcome.err, testing::StartsWith("incise: ")) << arguments;
        EXPECT_THAT(outcome.err, HasSubstr(text)) << arguments;
        EXPECT_LE(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
        EXPECT_FALSE(fs::exists(folder_ / arguments / "report.html")) << arguments;
    }
}

TEST_F(ReportCommand, TakesWhatARunLeftAtItsStart) {
    fs::remove(folder_ / "fall.out/summary.json");
    write_text(folder_ / "fall.out/history.csv", test::history_head);
    write_text(folder_ / "fall.out/edits.jsonl", "");
    const auto outcome = run("report fall.out --pictures 0");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto data = data_in(read_text(folder_ / "fall.out/report.html"));
    EXPECT_EQ(data["ending"]["kind"], "unfinished");
    EXPECT_EQ(data["facts"].size(), 0u);
}

}  // namespace
}  // namespace incise::report
