// Properties of generated cases. What fails is shrunk to a short case that fails too, and told in
// words.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck/Assertions.h>
#include <rapidcheck/Check.h>
#include <rapidcheck/gen/Container.h>
#include <rapidcheck/gen/Numeric.h>
#include <rapidcheck/gen/Transform.h>

#include <functional>
#include <string>
#include <vector>

namespace incise::test {

/// What the expectations of `check` that fail have to say; nothing if none does.
std::string failures_of(const std::function<void()>& check);

/// Runs a property of RapidCheck on so many cases and fails with the shortest counterexample. They
/// are the same ones every time, unless RC_PARAMS in the environment names another seed.
void expect_property(int num_cases, const std::function<void()>& property);

/// Up to so many of them, as many as the size of the case allows; each as large as can be.
template <class T>
rc::Gen<std::vector<T>> up_to(int most, const rc::Gen<T>& one) {
    constexpr int largest_size = 100;  // of RapidCheck's cases
    return rc::gen::scale(double{1} * most / largest_size,
                          rc::gen::container<std::vector<T>>(rc::gen::resize(largest_size, one)));
}

/// Expects that `check`, with the expectations of GoogleTest, holds for so many generated cases.
/// @param Case  printed by its operator<<
/// @param generator  its cases grow with the number of the case
template <class Case, class Check>
void expect_for_all(int num_cases, const rc::Gen<Case>& generator, Check check) {
    expect_property(num_cases, [&] {
        const Case one = *generator;
        const std::string failures = failures_of([&] { check(one); });
        if (!failures.empty()) RC_FAIL(failures);
    });
}

}  // namespace incise::test
