// Cells of the hybrid mass-spring system that tests go through, one by one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "incise/physics/elements/hybmss_kernel.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {

using Cell = HybmssKernel::Corners;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double shear_modulus = 4000.0;

inline HybridSprings hybrid_springs(double poisson, double ratio) {
    return {shear_modulus, shear_modulus * (4.0 * poisson - 1.0) / (1.0 - 2.0 * poisson), ratio};
}

inline Cell box(const Vec3& edges, const Mat3& turn = Mat3::Identity(),
                const Vec3& at = Vec3::Zero()) {
    Cell X;
    for (std::size_t k = 0; k < X.size(); ++k) {
        const auto& side = BoxFrame::sides[k];
        X[k] = at + turn * (0.5 * edges.cwiseProduct(Vec3(side[0], side[1], side[2])));
    }
    return X;
}

inline Cell shaken(Cell x, test::Random& random, double by) {
    for (Vec3& corner : x) corner += random.vector(by);
    return x;
}

struct NamedCell {
    std::string name;
    HybmssKernel kernel;
    Cell rest;
};

/// Cubes and boxes, turned, of all ratios of springs and of Poisson.
inline std::vector<NamedCell> cells() {
    std::vector<NamedCell> all;
    test::Random random(3);
    for (const double poisson : {0.0, 0.25, 0.3, 0.499})
        for (const double ratio : {0.0, 0.5, 1.0, 7.0, infinity})
            for (const Vec3& edges : {Vec3(1, 1, 1), Vec3(0.5, 0.5, 0.5), Vec3(1, 1.2, 0.9),
                                      Vec3(1.4, 1, 1), Vec3(1.4, 1.4, 1)}) {
                if (ratio == 0.0 && edges.maxCoeff() != edges.minCoeff()) continue;
                std::ostringstream name;
                name << "nu " << poisson << ", A " << ratio << ", edges " << edges.transpose();
                all.push_back({name.str(), HybmssKernel{hybrid_springs(poisson, ratio)},
                               box(edges, random_rotation(random), random.vector(1.0))});
            }
    return all;
}

template <class Visit>
void for_each_cell(Visit visit) {
    for (const NamedCell& cell : cells()) {
        SCOPED_TRACE(cell.name);
        ASSERT_EQ(why_no_cell(cell.kernel.material, cell.rest), std::nullopt);
        visit(cell.kernel, cell.rest, cell.kernel.precompute(cell.rest));
        if (testing::Test::HasFailure()) return;
    }
}

inline double sum_of_norms(const Cell& f) {
    double sum = 0.0;
    for (const Vec3& force : f) sum += force.norm();
    return sum;
}

/// Forces of this size are to be expected.
inline double force_scale(const HybmssKernel& kernel, const HybmssKernel::Element& e) {
    return kernel.stiffness_energy(e) / std::cbrt(e.volume);
}

}  // namespace incise::physics
