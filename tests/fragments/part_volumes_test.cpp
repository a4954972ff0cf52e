// How much of a polyhedron is in each tetrahedron of a cell: for cells that planes cut, against the
// volume of the whole.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/part_volumes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "incise/fragments/centre_division.h"
#include "tests/fragments/polyhedra.h"
#include "tests/fragments/random_cells.h"

namespace incise::fragments {
namespace {

using test::Surface;

double sum_of(const PartNumbers& fractions, const PartNumbers& volumes) {
    return std::inner_product(fractions.begin(), fractions.end(), volumes.begin(), 0.0);
}

TEST(PartVolumes, FillTheCell) {
    test::for_each_random_cell(10, [](auto kind, const auto& corners, test::Random& random) {
        const auto diagonals = test::random_diagonals(kind(), random);
        const PartNumbers volumes = part_volumes(kind(), corners, diagonals);
        double sum = 0.0;
        for (std::size_t t = 0; t < max_parts; ++t) {
            EXPECT_EQ(volumes[t] > 0.0, t < num_parts(kind()));
            sum += volumes[t];
        }
        const test::Surface surface = test::surface_of_cell<kind()>(corners, diagonals);
        EXPECT_NEAR(sum,
                    diagonals.is_none() ? topology::signed_volume(kind(), corners)
                                        : test::volume_of(surface),
                    1e-14 * sum);
        const PartNumbers of_whole = part_fractions(kind(), corners, surface, diagonals);
        for (std::size_t t = 0; t < num_parts(kind()); ++t) EXPECT_EQ(of_whole[t], 1.0);
    });
}

TEST(PartVolumes, AddUpToThoseOfTheHalves) {
    test::for_each_random_cell(60, [](auto kind, const auto& corners, test::Random& random) {
        const auto diagonals = test::random_diagonals(kind(), random);
        const PartNumbers volumes = part_volumes(kind(), corners, diagonals);
        const double whole = std::accumulate(volumes.begin(), volumes.end(), 0.0);
        const Surface cell = test::surface_of_cell<kind()>(corners, diagonals);
        Vec3 point = Vec3::Zero();
        double weights = 0.0;
        for (const Vec3& x : corners) {
            const double weight = random.uniform();
            point += weight * x;
            weights += weight;
        }
        point /= weights;
        const Vec3 normal = random.vector(1.0).normalized();
        const Surface one = test::half_of(cell, point, normal),
                      other = test::half_of(cell, point, -normal);
        const PartNumbers a = part_fractions(kind(), corners, one, diagonals),
                          b = part_fractions(kind(), corners, other, diagonals);
        for (std::size_t t = 0; t < num_parts(kind()); ++t) {
            EXPECT_NEAR(a[t] + b[t], 1.0, 1e-13);
            EXPECT_GE(a[t], 0.0);
            EXPECT_LE(a[t], 1.0 + 1e-13);
        }
        EXPECT_NEAR(sum_of(a, volumes), test::volume_of(one), 1e-13 * whole);
        EXPECT_NEAR(sum_of(b, volumes), test::volume_of(other), 1e-13 * whole);
    });
}

// Each tetrahedron of the division, clipped by the plane by itself, is the exact answer.
TEST(PartVolumes, AreThoseOfEachTetrahedronClippedAlone) {
    test::for_each_random_cell(20, [](auto kind, const auto& corners, test::Random& random) {
        const auto diagonals = test::random_diagonals(kind(), random);
        const auto at = CentreDivision<kind()>::points(corners, diagonals);
        const Surface cell = test::surface_of_cell<kind()>(corners, diagonals);
        const bool is_through_centre = random.uniform() < 0.3;
        const Vec3 point = is_through_centre ? at.back() : Vec3(0.5 * (at[0] + at[2]));
        const Vec3 normal =
            random.uniform() < 0.3 ? Vec3(Vec3::UnitX()) : random.vector(1.0).normalized();
        const PartNumbers fractions =
            part_fractions(kind(), corners, test::half_of(cell, point, normal), diagonals);
        const PartNumbers volumes = part_volumes(kind(), corners, diagonals);
        std::size_t t = 0;
        for (const auto& p : CentreDivision<kind()>::parts()) {
            const Surface part =
                test::surface_of_tetrahedron(at[p[0]], at[p[1]], at[p[2]], at[p[3]]);
            const double expected =
                test::volume_of(test::half_of(part, point, normal)) / volumes[t];
            EXPECT_NEAR(fractions[t], expected, 1e-12);
            ++t;
        }
    });
}

// Two halves of two planes, less what they have in common: a wedge is left out of the cell.
TEST(PartVolumes, AreRightForPiecesThatAreNotConvex) {
    test::for_each_random_cell(30, [](auto kind, const auto& corners, test::Random& random) {
        const PartNumbers volumes = part_volumes(kind(), corners);
        const double whole = std::accumulate(volumes.begin(), volumes.end(), 0.0);
        const Vec3 centre = CentreDivision<kind()>::points(corners).back();
        const double size = std::cbrt(whole);
        const Vec3 point = centre + random.vector(0.1 * size);
        const Vec3 n = random.vector(1.0).normalized(), m = random.vector(1.0).normalized();
        const Surface cell = test::surface_of_cell<kind()>(corners);
        const Surface half = test::half_of(cell, point, n), rest = test::half_of(cell, point, -n);
        const Surface quarter = test::half_of(rest, point, m),
                      hole = test::half_of(rest, point, -m);
        // The surface of the union, with the faces between its pieces twice, in both directions.
        Surface both = half;
        both.insert(both.end(), quarter.begin(), quarter.end());
        const PartNumbers of_both = part_fractions(kind(), corners, both),
                          of_hole = part_fractions(kind(), corners, hole);
        for (std::size_t t = 0; t < num_parts(kind()); ++t)
            EXPECT_NEAR(of_both[t] + of_hole[t], 1.0, 1e-13);
        EXPECT_NEAR(sum_of(of_both, volumes), test::volume_of(both), 1e-13 * whole);
    });
}

TEST(PartVolumes, LeaveOutWhatReachesOutOfTheCell) {
    test::for_each_random_cell(10, [](auto kind, const auto& corners, test::Random&) {
        auto larger = corners;
        const Vec3 centre = CentreDivision<kind()>::points(corners).back();
        for (Vec3& x : larger) x = centre + 1.5 * (x - centre);
        const PartNumbers fractions =
            part_fractions(kind(), corners, test::surface_of_cell<kind()>(larger));
        for (std::size_t t = 0; t < num_parts(kind()); ++t) EXPECT_NEAR(fractions[t], 1.0, 1e-13);
        for (Vec3& x : larger) x += Vec3(10, 0, 0);
        const PartNumbers none =
            part_fractions(kind(), corners, test::surface_of_cell<kind()>(larger));
        for (const double fraction : none) EXPECT_EQ(fraction, 0.0);
    });
}

}  // namespace
}  // namespace incise::fragments
