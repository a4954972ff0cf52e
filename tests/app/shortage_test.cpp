// What the commands do where the system gives no more threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "run_process.h"

namespace incise::test {

namespace {

using Shortage = Run;

// TBB makes its threads from one another, where nobody can catch an exception.
TEST_F(Shortage, EndsWithOneMessageWhicheverThreadIsRefused) {
    write("scene.toml", scene);
    int status = 5, num_refused = 0;
    for (long at = 1; status == 5; ++at, ++num_refused) {
        const auto outcome =
            run({"scene.toml", "--quiet", "--threads", "4", "--end-time", "0.05"},
                {{"LD_PRELOAD", INCISE_FAULTS}, {"INCISE_FAULT_THREADS", std::to_string(at)}});
        status = outcome.status;
        ASSERT_TRUE(status == 5 || status == 0) << at << outcome.err;
        if (status == 0) break;
        EXPECT_EQ(outcome.err.find("incise: out of memory or of processes: "), 0u) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    EXPECT_GE(num_refused, 6);  // three are tried before TBB makes its own
}

TEST_F(Shortage, StartsNoThreadThatIsNotNeeded) {
    write("scene.toml", scene);
    const Environment none{{"LD_PRELOAD", INCISE_FAULTS}, {"INCISE_FAULT_THREADS", "1"}};
    EXPECT_EQ(run({"scene.toml", "--quiet", "--threads", "4", "--dry-run"}, none).status, 0);
    EXPECT_EQ(run({"scene.toml", "--quiet", "--threads", "1"}, none).status, 0);
    EXPECT_EQ(incise({"check", "scene.toml"}, none).status, 0);
    const std::string mesh = "scene.out/frames/scene_000001.vtu";
    EXPECT_EQ(incise({"info", mesh}, none).status, 0);
    EXPECT_EQ(incise({"convert", mesh, "copy.vtu"}, none).status, 0);
    EXPECT_EQ(incise({"cut", mesh, "--out", "cut.vtu", "--plane", "0.05,0,0,1,0,0"}, none).status,
              0);
}

}  // namespace

}  // namespace incise::test
