// How many random cases a test goes through.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace incise::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// All of them; under sanitizers, with which each takes ten times as long, an eighth.
constexpr int num_cases(int all) { return is_sanitized ? std::max(all / 8, 1) : all; }

/// The first so many of an array of cases, which must outlive the result.
template <class Cases>
constexpr auto some_of(const Cases& cases) {
    const std::span all(cases);
    return all.first(static_cast<std::size_t>(num_cases(static_cast<int>(all.size()))));
}

}  // namespace incise::test
