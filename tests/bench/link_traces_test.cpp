// The matrices of the paper, and that they measure the strain.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/comparators/link_traces.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/physics/test_materials.h"

namespace incise::bench {
namespace {

using namespace physics;

// The C_k solve: C is linear in the squared lengths l_k = e_k . C e_k of the rest edges e_k, so
// that C_k has length 1 along e_k and 0 along the others. With the gradients g of the corners'
// weights that is -(g_i g_j^T + g_j g_i^T) / 2 of the edge from i to j.
TEST(LinkTraces, AreThoseOfTheLinkTensors) {
    constexpr std::array<std::array<std::size_t, 2>, 6> ends{
        {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}, {3, 1}}};
    test::Random random(9);
    for (int i = 0; i < 100; ++i) {
        const Tetrahedron X = random_tetrahedron(random);
        const LinkTraces traces = link_traces(link_element(X));
        std::array<Vec3, 4> g;
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 &a = X[(k + 1) % 4], &b = X[(k + 2) % 4], &c = X[(k + 3) % 4];
            const Vec3 normal = (b - a).cross(c - a);
            g[k] = normal / normal.dot(X[k] - a);
        }
        std::array<Mat3, 6> C;
        for (std::size_t k = 0; k < 6; ++k) {
            const Mat3 product = g[ends[k][0]] * g[ends[k][1]].transpose();
            C[k] = -0.5 * (product + product.transpose());
            for (std::size_t m = 0; m < 6; ++m) {
                const Vec3 edge = X[ends[m][1]] - X[ends[m][0]];
                EXPECT_NEAR(edge.dot(C[k] * edge), k == m ? 1.0 : 0.0,
                            1e-12 * C[k].norm() * edge.squaredNorm());
            }
        }
        for (int k = 0; k < 6; ++k) {
            const Mat3& Ck = C[static_cast<std::size_t>(k)];
            EXPECT_NEAR(traces.vtr[k], Ck.trace(), 1e-11 * traces.vtr.norm());
            for (int m = 0; m < 6; ++m)
                EXPECT_NEAR(traces.Mtr(k, m), (Ck * C[static_cast<std::size_t>(m)]).trace(),
                            1e-11 * traces.Mtr.norm());
        }
        EXPECT_EQ(traces.Mtr, traces.Mtr.transpose());
    }
}

TEST(LinkTraces, MeasureTheInvariantsOfStrain) {
    test::Random random(10);
    for (int i = 0; i < 100; ++i) {
        const Tetrahedron X = random_tetrahedron(random);
        const Mat3 F = random_deformation(random, random.vector(2.0));
        const LinkElement element = link_element(X);
        const LinkTraces traces = link_traces(element);
        const Vec6 dl = squared_links(deformed(X, F)) - element.rest_links;
        const Mat3 twice_E = F.transpose() * F - Mat3::Identity();
        const double scale = 1e-12 * (1.0 + twice_E.squaredNorm());
        EXPECT_NEAR(traces.vtr.dot(dl), twice_E.trace(), 10.0 * scale);
        EXPECT_NEAR(dl.dot(traces.Mtr * dl), (twice_E * twice_E).trace(), 10.0 * scale);
    }
}

}  // namespace
}  // namespace incise::bench
