// How many random cases a test goes through.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>

namespace incise::test {

/// All of them; under sanitizers, with which each takes ten times as long, a quarter.
constexpr int num_cases(int all) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return std::max(all / 4, 1);
#else
    return all;
#endif
}

}  // namespace incise::test
