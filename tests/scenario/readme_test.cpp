// What the README and the gallery show is what ships, and runs with the other scenarios.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <sstream>

#include "incise/scenario/scenario_reader.h"
#include "support/temporary_folder.h"

namespace incise::scenario {
namespace {

const std::filesystem::path data_folder = INCISE_DATA_DIR;

/// The first indented block below `heading`, without its four leading spaces.
std::string block_below(const std::string& heading, const std::string& text) {
    std::istringstream lines(text);
    std::string line, block, blank;
    while (std::getline(lines, line) && line != heading) continue;
    while (std::getline(lines, line)) {
        if (line.starts_with("    ")) {
            block += blank + line.substr(4) + "\n";
            blank.clear();
        } else if (!line.empty() && !block.empty()) {
            break;
        } else if (!block.empty()) {
            blank += "\n";
        }
    }
    return block;
}

TEST(Readme, ShowsTheBeamThatShips) {
    const auto beam = data_folder / "scenarios/beam.toml";
    const std::string readme = support::read_text(data_folder.parent_path() / "README.md");
    EXPECT_EQ(block_below("## A first scenario", readme), support::read_text(beam));
    const ScenarioReport report = read_scenario(beam);
    EXPECT_EQ(report.errors, std::vector<std::string>{});
    EXPECT_EQ(report.warnings, std::vector<std::string>{});
    EXPECT_FALSE(report.scenario.expect.empty());  // that it is parted
}

TEST(Gallery, NamesEveryScenarioThatShips) {
    const std::string gallery = support::read_text(data_folder.parent_path() / "docs/gallery.md");
    for (const auto& entry : std::filesystem::directory_iterator(data_folder / "scenarios")) {
        const std::string name = entry.path().filename().string();
        SCOPED_TRACE(name);
        EXPECT_NE(gallery.find("`" + name + "`"), std::string::npos);
        const ScenarioReport report = read_scenario(entry.path());
        EXPECT_EQ(report.errors, std::vector<std::string>{});
        EXPECT_FALSE(report.scenario.expect.empty());  // it is a test as well
    }
}

TEST(Gallery, HasThePicturesThatItShows) {
    const auto docs = data_folder.parent_path() / "docs";
    const std::string text = support::read_text(docs / "gallery.md"), ending = ".png)";
    int num_pictures = 0, num_scenarios = 0;
    for (auto end = text.find(ending); end != text.npos; end = text.find(ending, end + 1)) {
        const std::size_t start = text.rfind('(', end) + 1;
        const std::string picture = text.substr(start, end + 4 - start);
        EXPECT_TRUE(std::filesystem::exists(docs / picture)) << picture;
        ++num_pictures;
    }
    for (auto at = text.find("\n## "); at != text.npos; at = text.find("\n## ", at + 1))
        ++num_scenarios;
    EXPECT_GE(num_pictures, num_scenarios);
}

}  // namespace
}  // namespace incise::scenario
