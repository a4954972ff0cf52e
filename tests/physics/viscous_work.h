// Where the work done on a viscous element goes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/physics/test_bodies.h"

namespace incise::physics {

using Series = std::vector<PronyTerm>;
using Memory = std::vector<double>;

inline const Series two_terms{{0.3, 0.2}, {0.4, 5.0}};

/// On a way through flat states and back, in so many steps: the growth of the energy, and what
/// advance() says that viscosity took, less the work done, over the sum of its absolute values.
/// @param memory  of an element without a past
template <class Kernel>
double missing_work(Kernel kernel, Memory memory, int num_steps) {
    test::Random random(34);
    const Tetrahedron X = random_tetrahedron(random);
    const auto e = kernel.precompute(X);
    const Mat3 shear = random_deformation(random, {0.95, 1.0, 1.05});
    kernel.begin_step(1.0 / num_steps);
    Tetrahedron before = X;
    auto f = kernel.forces(e, before, memory);
    double missing = 0.0, way = 0.0;
    for (int i = 1; i <= num_steps; ++i) {
        const double t = static_cast<double>(i) / num_steps;
        const double flat = std::pow(std::sin(std::numbers::pi * t), 2);
        const Mat3 F =
            (1.0 - flat) * Mat3::Identity() + flat * (shear * Vec3(1.1, 1.05, -0.3).asDiagonal());
        const Tetrahedron x = deformed(X, F);
        missing += kernel.energy(e, x) - kernel.energy(e, before);
        missing += kernel.advance(e, before, x, memory);
        const auto g = kernel.forces(e, x, memory);
        for (std::size_t k = 0; k < 4; ++k) {
            const double work = -0.5 * (f[k] + g[k]).dot(x[k] - before[k]);
            missing -= work;
            way += std::abs(work);
        }
        before = x;
        f = g;
    }
    return std::abs(missing) / way;
}

}  // namespace incise::physics
