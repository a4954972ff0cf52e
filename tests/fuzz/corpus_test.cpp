// The files of the corpus, which include those that fuzzing found, are read or refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/fuzz/targets.h"
#include "tests/support/temporary_folder.h"

namespace incise::fuzz {
namespace {

class FuzzCorpus : public testing::TestWithParam<Target> {};

TEST_P(FuzzCorpus, IsReadOrRefused) {
    const auto folder = std::filesystem::path(INCISE_FUZZ_CORPUS) / GetParam().name;
    int num_files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path());
        EXPECT_NO_THROW(GetParam().read(support::read_text(entry.path())));
        ++num_files;
    }
    EXPECT_GT(num_files, 0);
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, testing::ValuesIn(targets),
                         [](const auto& parameters) { return std::string(parameters.param.name); });

}  // namespace
}  // namespace incise::fuzz
