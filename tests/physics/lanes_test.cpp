// The functions of lanes against those of the C library.
// SPDX-License-Identifier: LGPL-3.0-or-later
#define INCISE_PROCESSOR lanes_under_test
#include "incise/physics/simd/lanes.h"

#include <gtest/gtest.h>

#include "support/mesh_families.h"

namespace incise::physics {
namespace {

using lanes_under_test::Lanes;

template <class Number>
class LanesOf : public testing::Test {};
using Numbers = testing::Types<double, float>;
TYPED_TEST_SUITE(LanesOf, Numbers, );

/// Calls check(lanes, l) for each lane l of many numbers whose logarithms lie between the bounds.
template <class Number, class Check>
void for_many_lanes(double lowest_log, double highest_log, Check check) {
    test::Random random(1);
    for (int i = 0; i < 2000; ++i) {
        Lanes<Number> x = 0.0;
        for (int l = 0; l < Lanes<Number>::size; ++l)
            x.v[l] = static_cast<Number>(std::exp(random.uniform(lowest_log, highest_log)));
        for (int l = 0; l < Lanes<Number>::size; ++l) check(x, l);
    }
}

TYPED_TEST(LanesOf, HaveTheFunctionsThatTheyState) {
    using Number = TypeParam;
    using L = Lanes<Number>;
    constexpr bool is_single = sizeof(Number) == sizeof(float);
    constexpr double widest = is_single ? 80.0 : 600.0, of_root = is_single ? 3e-7 : 4e-16,
                     of_others = is_single ? 3e-7 : 1e-15;
    const auto check = [&](const L& x, int l) {
        const double at = x.v[l], root = 1.0 / std::sqrt(at), ln = std::log(at);
        EXPECT_NEAR(reciprocal_sqrt(x).v[l], root, of_root * root) << at;
        EXPECT_EQ(sqrt(x).v[l], std::sqrt(x.v[l])) << at;
        EXPECT_NEAR(log(x).v[l], ln, of_others * std::max(1.0, std::abs(ln))) << at;
    };
    for_many_lanes<Number>(-widest, widest, check);
    for_many_lanes<Number>(-0.1, 0.1, check);
    for (const double sign : {1.0, -1.0})
        for_many_lanes<Number>(
            -10.0, std::log(L::Format::largest_exponent), [&](const L& x, int l) {
                const double at = sign * x.v[l];
                EXPECT_NEAR(exp(sign * x).v[l], std::exp(at), of_others * std::exp(at)) << at;
            });
    // A relative error of the logarithm grows with the exponent.
    for_many_lanes<Number>(-1.0, 1.0, [&](const L& x, int l) {
        const double power = std::pow(double{x.v[l]}, -4.0 / 3.0);
        EXPECT_NEAR(pow(x, -4.0 / 3.0).v[l], power, 4.0 * of_others * power);
    });
}

// Close to zero, where what is added or taken away would hide them.
TYPED_TEST(LanesOf, TellSmallExponentialsAndLogarithmsFromNothing) {
    using L = Lanes<TypeParam>;
    constexpr bool is_single = sizeof(TypeParam) == sizeof(float);
    constexpr double tolerance = is_single ? 6e-7 : 2e-15, least = is_single ? -60.0 : -600.0;
    for (const double sign : {1.0, -1.0})
        for (const auto& [low, high] : {std::pair{least, 0.0}, {-3.0, std::log(80.0)}})
            for_many_lanes<TypeParam>(low, high, [&](const L& x, int l) {
                const double at = sign * x.v[l], exponential = std::expm1(at);
                EXPECT_NEAR(expm1(sign * x).v[l], exponential, tolerance * std::abs(exponential))
                    << at;
                if (at < -0.99) return;
                const double logarithm = std::log1p(at);
                EXPECT_NEAR(log1p(sign * x).v[l], logarithm, tolerance * std::abs(logarithm)) << at;
            });
    EXPECT_EQ(expm1(L(0.0)).v[0], 0);
    EXPECT_EQ(log1p(L(0.0)).v[0], 0);
}

TYPED_TEST(LanesOf, FindCosinesOfAThirdOfAnAngle) {
    using L = Lanes<TypeParam>;
    const double tolerance = sizeof(TypeParam) == sizeof(float) ? 3e-7 : 4e-16;
    for (int i = 0; i <= 1000; ++i) {
        const double cosine = i / 1000.0;
        const double expected = std::cos(std::acos(double{static_cast<TypeParam>(cosine)}) / 3.0);
        EXPECT_NEAR(cosine_of_third(L(cosine)).v[0], expected, tolerance) << cosine;
        EXPECT_NEAR(cosine_of_third(L(-cosine)).v[0], -expected, tolerance) << cosine;
    }
}

TYPED_TEST(LanesOf, PassOnWhatIsNotANumber) {
    using L = Lanes<TypeParam>;
    for (const double x : {0.0, -0.5, -1.0, std::nan(""), double{INFINITY}})
        EXPECT_TRUE(std::isnan(log(L(x)).v[0])) << x;
    EXPECT_TRUE(std::isnan(exp(L(std::nan(""))).v[0]));
    EXPECT_TRUE(std::isnan(expm1(L(std::nan(""))).v[0]));
    for (const double x : {-1.0, -2.0, std::nan("")})
        EXPECT_TRUE(std::isnan(log1p(L(x)).v[0])) << x;
    EXPECT_TRUE(std::isnan(cosine_of_third(L(std::nan(""))).v[0]));
    EXPECT_TRUE(std::isfinite(reciprocal_sqrt(L(0.0)).v[0]));
}

}  // namespace
}  // namespace incise::physics
