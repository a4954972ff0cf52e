// What the pages on laws say of the code is so: docs/adding-a-law.md and the laws of
// docs/theory.md. SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "incise/scenario/material_catalog.h"
#include "support/temporary_folder.h"

namespace incise::scenario {
namespace {

const std::filesystem::path root = std::filesystem::path(INCISE_DATA_DIR).parent_path();

/// A block of code, and the file that the text before it names last, as `folder/file`.
struct Example {
    std::string file, code;
};

bool has_file(const std::string& name) {
    return name.find('/') != name.npos && std::filesystem::is_regular_file(root / name);
}

std::vector<Example> examples_of(const std::string& page) {
    std::vector<Example> examples;
    std::istringstream lines(page);
    std::string line, file;
    while (std::getline(lines, line)) {
        if (line == "```cpp") {
            Example example{file, ""};
            while (std::getline(lines, line) && line != "```") example.code += line + "\n";
            examples.push_back(std::move(example));
        }
        for (auto at = line.find('`'); at != line.npos; at = line.find('`', at)) {
            const auto end = line.find('`', at + 1);
            if (end == line.npos) break;
            if (const auto name = line.substr(at + 1, end - at - 1); has_file(name)) file = name;
            at = end + 1;
        }
    }
    return examples;
}

TEST(AddingALaw, ShowsCodeOfTheFilesItNames) {
    const auto examples = examples_of(support::read_text(root / "docs/adding-a-law.md"));
    std::set<std::string> files;
    for (const Example& example : examples) {
        SCOPED_TRACE(example.file + " should have\n" + example.code);
        ASSERT_FALSE(example.file.empty());
        files.insert(example.file);
        const std::string text = support::read_text(root / example.file);
        EXPECT_NE(text.find(example.code), text.npos);
    }
    EXPECT_EQ(files, (std::set<std::string>{"physics/laws/law.h", "scenario/material_catalog.cpp",
                                            "tests/physics/test_materials.h",
                                            "tests/physics/textbook_energies.h"}));
    EXPECT_GE(examples.size(), 6u);
}

// Tests that the page promises are there: names of suites and tests in backquotes.
TEST(AddingALaw, PromisesTestsThatThereAre) {
    std::string page = support::read_text(root / "docs/adding-a-law.md");
    page.erase(page.find("## A law with fibres"));
    std::string tests;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "tests"))
        if (entry.path().extension() == ".cpp") tests += support::read_text(entry.path());
    std::string suite;
    int num_promised = 0;
    for (std::size_t at = page.find("| what | test |"); (at = page.find('`', at)) != page.npos;) {
        const auto end = page.find('`', at + 1);
        ASSERT_NE(end, page.npos);
        const std::string name = page.substr(at + 1, end - at - 1);
        at = end + 1;
        const auto dot = name.find('.');
        const bool is_test = dot == 0 || std::isupper(static_cast<unsigned char>(name[0]));
        if (dot == name.npos || !is_test) continue;
        if (dot > 0) suite = name.substr(0, dot);
        const std::string test = name.substr(dot + 1);
        ++num_promised;
        const std::string head = "(" + suite + ", " + (test == "*" ? "" : test + ")");
        EXPECT_NE(tests.find("TEST" + head), tests.npos) << name;
    }
    EXPECT_GE(num_promised, 15);
}

TEST(Theory, HasTheFormulaOfEachLaw) {
    std::istringstream page(support::read_text(root / "docs/theory.md"));
    std::string line, table;
    while (std::getline(page, line) && line != "## Laws") continue;
    while (std::getline(page, line) && !line.starts_with("|")) continue;
    for (; line.starts_with("|"); std::getline(page, line)) table += line + "\n";
    for (const MaterialModel& model : laws()) {
        const auto name = table.find("`" + std::string(model.key) + "`");
        ASSERT_NE(name, table.npos) << model.key;
        const auto formula = table.find(" | $", name);
        EXPECT_LT(formula, table.find('\n', name)) << model.key << " has no energy";
    }
}

}  // namespace
}  // namespace incise::scenario
