// The same as the quick test, for more bodies and blades.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/num_cases.h"
#include "tests/sim/cuts_at_rest.h"

namespace incise::sim {
namespace {

TEST(CutsAtRest, OfManyProgramsExertNoForce) {
    for (std::uint64_t seed = 100; seed < 100 + test::num_cases(200); ++seed) expect_rest(seed);
}

}  // namespace
}  // namespace incise::sim
