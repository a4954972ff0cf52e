// Derivatives carried along against differences.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/laws/dual.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/mesh_families.h"

namespace incise::physics {
namespace {

template <class T>
T every_operation(const T& a, const T& b, const T& J, const T& f) {
    using std::abs, std::exp, std::expm1, std::log, std::log1p, std::pow, std::sqrt;
    T sum = 2.0 * a - b / J + 3.0 / (1.0 + a * a) - f;
    sum += log(J) * exp(-b);
    sum -= expm1(0.5 * f) * abs(a);
    sum += log1p(0.5 * b);
    sum *= pow(J, -2.0 / 3.0);
    sum /= sqrt(J + 4.0);
    return std::max(+sum, T(-1e6)) + std::min(a, T(0.1));
}

TEST(Dual, CarriesTheDerivativesOfEveryOperation) {
    test::Random random(1);
    for (int i = 0; i < 100; ++i) {
        std::array<double, 4> x{random.uniform(-1, 1), random.uniform(-1, 1),
                                random.uniform(0.5, 2), random.uniform(-1, 1)};
        const double h = 1e-4;
        if (std::abs(x[0]) < 3 * h || std::abs(x[0] - 0.1) < 3 * h) continue;  // kinks
        const auto value = [&] { return every_operation(x[0], x[1], x[2], x[3]); };
        const Dual found = every_operation(Dual::variable(x[0], 0), Dual::variable(x[1], 1),
                                           Dual::variable(x[2], 2), Dual::variable(x[3], 3));
        EXPECT_DOUBLE_EQ(found.value, value());
        for (std::size_t k = 0; k < 4; ++k) {
            const double at = x[k];
            const auto shifted = [&](double d) {
                x[k] = at + d;
                return value();
            };
            const double difference =
                (8.0 * (shifted(h) - shifted(-h)) - (shifted(2 * h) - shifted(-2 * h))) /
                (12.0 * h);
            x[k] = at;
            EXPECT_NEAR(found.gradient[static_cast<int>(k)], difference, 1e-9);
        }
    }
}

}  // namespace
}  // namespace incise::physics
