// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/properties.h"

#include <gtest/gtest-spi.h>

#include <cstdlib>
#include <sstream>

namespace incise::test {

std::string failures_of(const std::function<void()>& check) {
    testing::TestPartResultArray results;
    {
        const testing::ScopedFakeTestPartResultReporter reporter(
            testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
        check();
    }
    std::ostringstream text;
    for (int i = 0; i < results.size(); ++i)
        if (results.GetTestPartResult(i).failed()) text << results.GetTestPartResult(i) << '\n';
    return text.str();
}

void expect_property(int num_cases, const std::function<void()>& property) {
    // Else it would choose another seed at each run.
    ::setenv("RC_PARAMS", "seed=1", 0);
    auto params = rc::detail::configuration().testParams;
    params.maxSuccess = num_cases;
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    const auto result =
        rc::detail::checkTestable(property, rc::detail::TestMetadata{name, name}, params);
    if (result.is<rc::detail::SuccessResult>()) return;
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    ADD_FAILURE() << text.str();
}

}  // namespace incise::test
