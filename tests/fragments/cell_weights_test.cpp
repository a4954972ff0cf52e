// Points in hexahedra, wedges and pyramids as combinations of their corners.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/cell_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "incise/fragments/centre_division.h"
#include "tests/fragments/random_cells.h"

namespace incise::fragments {
namespace {

using topology::CellKind;

double sum_of(std::span<const double> weights) {
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    return sum;
}

Vec3 position(std::span<const double> weights, std::span<const Vec3> corners) {
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k) x += weights[k] * corners[k];
    return x;
}

/// A random point in the simplex of some points.
Vec3 point_between(std::span<const Vec3> points, test::Random& random) {
    Vec3 x = Vec3::Zero();
    double sum = 0.0;
    for (const Vec3& point : points) {
        const double weight = random.uniform();
        x += weight * point;
        sum += weight;
    }
    return x / sum;
}

TEST(CellWeights, ReproduceThePointAndSumToOne) {
    test::for_each_random_cell(20, [](auto kind, const auto& corners, test::Random& random) {
        const double size = (corners[1] - corners[0]).norm();
        constexpr auto parts = CentreDivision<kind()>::parts();
        const auto diagonals = test::random_diagonals(kind(), random);
        const auto at = CentreDivision<kind()>::points(corners, diagonals);
        for (int i = 0; i < 20; ++i) {
            const bool is_outside = i % 4 == 3;
            const auto& p = parts[random.below(parts.size())];
            const Vec3 x =
                is_outside
                    ? Vec3(corners[0] + random.vector(2.0 * size))
                    : point_between(std::array<Vec3, 4>{at[p[0]], at[p[1]], at[p[2]], at[p[3]]},
                                    random);
            const auto weights = weights_in_cell(kind(), corners, x, diagonals);
            EXPECT_NEAR(sum_of(weights), 1.0, is_outside ? 1e-13 : 1e-15);
            EXPECT_LE((position(weights, corners) - x).norm(), (is_outside ? 1e-13 : 1e-14) * size);
            for (std::size_t k = corners.size(); k < weights.size(); ++k)
                EXPECT_EQ(weights[k], 0.0);
            if (!is_outside) {
                EXPECT_GE(*std::ranges::min_element(weights), 0.0);
            }
        }
    });
}

// The field of any values at the corners is that of the tetrahedra of the division.
TEST(CellWeights, AreLinearInEachTetrahedron) {
    test::for_each_random_cell(10, [](auto kind, const auto& corners, test::Random& random) {
        using Division = CentreDivision<kind()>;
        auto moved = corners;
        for (Vec3& x : moved) x += random.vector(0.5);
        const auto diagonals = test::random_diagonals(kind(), random);
        const auto at = Division::points(corners, diagonals),
                   to = Division::points(moved, diagonals);
        for (const auto& p : Division::parts()) {
            std::array<double, 4> b;
            for (double& weight : b) weight = random.uniform(0.01, 1.0);
            const double sum = sum_of(b);
            Vec3 x = Vec3::Zero(), expected = Vec3::Zero();
            for (std::size_t k = 0; k < 4; ++k) {
                x += b[k] / sum * at[p[k]];
                expected += b[k] / sum * to[p[k]];
            }
            EXPECT_LE(
                (position(weights_in_cell(kind(), corners, x, diagonals), moved) - expected).norm(),
                1e-13);
        }
    });
}

// On a triangle they are those of its corners, as in a tetrahedron on the other side.
TEST(CellWeights, AreLinearInEachHalfOfADividedFace) {
    test::for_each_random_cell(20, [](auto kind, const auto& corners, test::Random& random) {
        const topology::CellTraits& traits = topology::traits(kind());
        const auto diagonals = test::random_diagonals(kind(), random);
        for (int f = 0; f < traits.num_faces; ++f)
            for (const int half : {0, 2}) {
                if (!diagonals.divides(f)) continue;
                std::array<double, 3> b{random.uniform(), random.uniform(), random.uniform()};
                if (random.below(3) == 0) b[1] = 0.0;  // on the diagonal
                const double sum = sum_of(b);
                Vec3 x = Vec3::Zero();
                std::array<double, topology::max_corners> expected{};
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto corner = static_cast<std::size_t>(traits.face(
                        f)[(static_cast<std::size_t>(diagonals.first_end(f) + half) + k) % 4]);
                    expected[corner] = b[k] / sum;
                    x += expected[corner] * corners[corner];
                }
                const auto weights = weights_in_cell(kind(), corners, x, diagonals);
                for (std::size_t k = 0; k < weights.size(); ++k)
                    EXPECT_NEAR(weights[k], expected[k], expected[k] == 0.0 ? 0.0 : 1e-13);
            }
    });
}

TEST(CellWeights, AreThoseOfTheEndsOnAnEdgeAndOneAtACorner) {
    test::for_each_random_cell(10, [](auto kind, const auto& corners, test::Random& random) {
        const topology::CellTraits& traits = topology::traits(kind());
        for (int e = 0; e < traits.num_edges; ++e) {
            const auto [i, j] = traits.edges[static_cast<std::size_t>(e)];
            const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
            const double along = random.uniform();
            const Vec3 x = (1.0 - along) * corners[a] + along * corners[b];
            const auto weights = weights_in_cell(kind(), corners, x);
            for (std::size_t k = 0; k < weights.size(); ++k) {
                const double expected = k == a ? 1.0 - along : k == b ? along : 0.0;
                EXPECT_NEAR(weights[k], expected, k == a || k == b ? 1e-14 : 0.0);
            }
            // Also for an end of the edge that is only near the corner.
            const Vec3 near = corners[a] + 1e-14 * (corners[b] - corners[a]);
            EXPECT_EQ(weights_in_cell(kind(), corners, near)[a], 1.0);
        }
    });
}

TEST(CellWeights, AreTheSameBitsOnBothSidesOfAFace) {
    int num_points = 0;
    test::for_each_random_cell(10, [&](auto kind, const auto& corners, test::Random& random) {
        const topology::CellTraits& traits = topology::traits(kind());
        for (int f = 0; f < traits.num_faces; ++f) {
            const auto face = traits.face(f);
            // A cell on the other side: it has the corners of the face in the opposite direction,
            // from any of them on.
            const auto other_kind = face.size() == 4 ? CellKind::hexahedron : CellKind::wedge;
            const std::size_t first = random.below(face.size());
            std::vector<Vec3> other;
            std::vector<std::size_t> of_cell;
            Vec3 centre = Vec3::Zero();
            for (const Vec3& x : corners) centre += x / static_cast<double>(corners.size());
            for (std::size_t p = 0; p < face.size(); ++p) {
                of_cell.push_back(
                    static_cast<std::size_t>(face[(first + face.size() - p) % face.size()]));
                other.push_back(corners[of_cell.back()]);
            }
            if (other_kind == CellKind::hexahedron) {  // corners 0 to 3 are its face backwards
                std::swap(other[1], other[3]);
                std::swap(of_cell[1], of_cell[3]);
            }
            Vec3 middle = Vec3::Zero();
            for (const Vec3& x : other) middle += x / static_cast<double>(face.size());
            for (std::size_t p = 0; p < face.size(); ++p)
                other.push_back(other[p] + 1.3 * (middle - centre) + random.vector(0.002));
            std::vector<Vec3> of_face(other.begin(),
                                      other.begin() + static_cast<std::ptrdiff_t>(face.size()));
            Vec3 face_centre = Vec3::Zero();
            for (const int k : face) face_centre += corners[static_cast<std::size_t>(k)];
            face_centre /= static_cast<double>(face.size());
            for (std::size_t p = 0; p < face.size(); ++p) {
                const std::array<Vec3, 3> triangle{of_face[p], of_face[(p + 1) % face.size()],
                                                   face_centre};
                for (const Vec3& x :
                     {point_between(triangle, random), Vec3(0.5 * (triangle[0] + triangle[1])),
                      Vec3(0.5 * (triangle[0] + face_centre)), triangle[0], face_centre}) {
                    const auto here = weights_in_cell(kind(), corners, x);
                    const auto there = weights_in_cell(other_kind, other, x);
                    double sum = 0.0;
                    for (std::size_t k = 0; k < face.size(); ++k) {
                        EXPECT_EQ(here[of_cell[k]], there[k]);
                        sum += here[of_cell[k]];
                    }
                    EXPECT_NEAR(sum, 1.0, 1e-15);
                    ++num_points;
                }
            }
        }
    });
    EXPECT_GT(num_points, 1000);
}

}  // namespace
}  // namespace incise::fragments
