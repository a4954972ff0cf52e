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
    std::istringstream words(support::read_text(docs / "gallery.md"));
    int pictures = 0;
    for (std::string word; words >> word;) {
        const std::size_t start = word.rfind('('), end = word.find(".png)");
        if (start == std::string::npos || end == std::string::npos) continue;
        const std::string picture = word.substr(start + 1, end + 3 - start);
        EXPECT_TRUE(std::filesystem::exists(docs / picture)) << picture;
        ++pictures;
    }
    EXPECT_GE(pictures, 9);
}

}  // namespace
}  // namespace incise::scenario
