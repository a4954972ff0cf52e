// All random cuts of drawn-out bars.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/sim/strained_cuts.h"

namespace incise::sim {
namespace {

TEST(StrainedCuts, AllOfTwoHundredStayStable) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        StrainedCut c = strained_cut(seed);
        const std::string what = describe(c);
        const auto failure = failure_in_a_world(std::move(c));
        EXPECT_FALSE(failure) << "seed " << seed << ", " << what << failure.value_or("");
    }
}

}  // namespace
}  // namespace incise::sim
