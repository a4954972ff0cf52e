// Cuts that cross each other in a body at rest exert no force.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "tests/sim/cuts_at_rest.h"

#include "support/num_cases.h"

namespace incise::sim {
namespace {

TEST(CutsAtRest, ThatCrossExertNoForce) {
    for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) expect_rest(seed);
}

}  // namespace
}  // namespace incise::sim
