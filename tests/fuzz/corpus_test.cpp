// The files of the corpus, which include those that fuzzing found, are read or refused; a short
// burst of random changes to them, for machines without libFuzzer, too.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/targets.h"
#include "tests/support/mutation.h"
#include "tests/support/temporary_folder.h"

namespace incise::fuzz {
namespace {

class FuzzCorpus : public testing::TestWithParam<Target> {
  protected:
    /// In the order of their names.
    static std::vector<std::filesystem::path> files() {
        const auto folder = std::filesystem::path(INCISE_FUZZ_CORPUS) / GetParam().name;
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        return files;
    }
};

TEST_P(FuzzCorpus, IsReadOrRefused) {
    EXPECT_FALSE(files().empty());
    for (const auto& file : files()) {
        SCOPED_TRACE(file);
        EXPECT_NO_THROW(GetParam().read(support::read_text(file)));
    }
}

TEST_P(FuzzCorpus, IsReadOrRefusedIfBytesChange) {
    constexpr int num_mutations = 2000;
    const auto names = files();
    std::mt19937 random(2026);
    for (int i = 0; i < num_mutations; ++i) {
        const auto& file = names[static_cast<std::size_t>(i) % names.size()];
        SCOPED_TRACE(file.string() + ", mutation " + std::to_string(i));
        ASSERT_NO_THROW(GetParam().read(support::mutated(support::read_text(file), random)));
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, testing::ValuesIn(targets),
                         [](const auto& parameters) { return std::string(parameters.param.name); });

}  // namespace
}  // namespace incise::fuzz
