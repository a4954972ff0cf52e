// The progress line and the lines where there is no terminal.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/progress.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace incise::app {
namespace {

TEST(Progress, WritesDurationsAsOnAClock) {
    EXPECT_EQ(duration_text(0.4), "0:00");
    EXPECT_EQ(duration_text(59.6), "1:00");
    EXPECT_EQ(duration_text(725.0), "12:05");
    EXPECT_EQ(duration_text(3.0 * 3600 + 4.0 * 60 + 5.0), "3:04:05");
}

TEST(Progress, LineShowsShareAndTimeLeft) {
    EXPECT_EQ(progress_line("run", 0.25, 30.0, "7 elements", 0), "run 25 %, 1:30 left, 7 elements");
    EXPECT_EQ(progress_line("run", 0.25, 30.0, "", 100),
              "run [######..................] 25 %, 1:30 left");
    EXPECT_EQ(progress_line("run", 0.0, 30.0, "", 0), "run 0 %") << "nothing to estimate from";
    EXPECT_EQ(progress_line("run", 1.0, 61.0, "", 0), "run 100 %, took 1:01");
}

TEST(Progress, LineFitsTheTerminal) {
    EXPECT_EQ(progress_line("run", 0.5, 1.0, std::string(200, 'x'), 60).size(), 59u);
}

TEST(Progress, WithoutTerminalReportsEveryTenthOnce) {
    testing::internal::CaptureStderr();
    {
        Progress progress(1.0, "run", false);
        for (int i = 1; i <= 1000; ++i) progress.update(i / 1000.0);
        progress.finish();
    }
    const auto text = testing::internal::GetCapturedStderr();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10) << text;
    EXPECT_EQ(text.substr(0, 8), "run 10 %");
    EXPECT_NE(text.find("run 100 %, took 0:00\n"), std::string::npos);
    EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Progress, IsSilentWhenQuiet) {
    testing::internal::CaptureStderr();
    {
        Progress progress(1.0, "run", true);
        progress.update(0.5);
        progress.finish();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace incise::app
