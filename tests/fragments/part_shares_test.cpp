// Shares of the tetrahedra of a cell, from the cells of the material in it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/part_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "incise/fragments/part_volumes.h"
#include "incise/topology/box_mesh.h"
#include "tests/fragments/random_cells.h"

namespace incise::fragments {
namespace {

using topology::CellKind;
using topology::Mesh;

/// A box of bricks, which are the material in a carrier that is the whole box.
struct DividedBox {
    std::vector<Vec3> corners;
    Mesh material;
    explicit DividedBox(std::array<int, 3> bricks)
        : material(Mesh::build(topology::box_mesh(CellKind::hexahedron, Vec3(0.1, 0.2, 0.3),
                                                  {0.2, 0.1, 0.3}, bricks))
                       .mesh) {
        for (const Vec3& x : test::unit_cell<CellKind::hexahedron>())
            corners.push_back(Vec3(0.1, 0.2, 0.3) + x.cwiseProduct(Vec3(0.2, 0.1, 0.3)));
    }
    std::vector<CellId> cells_where(auto holds) const {
        std::vector<CellId> cells;
        for (const CellId cell : material.elements()) {
            Vec3 middle = Vec3::Zero();
            for (const VertexId v : material.corners(cell)) middle += material.rest_position(v) / 8;
            if (holds(middle)) cells.push_back(cell);
        }
        return cells;
    }
    std::vector<double> fractions(const std::vector<CellId>& cells) const {
        return filled_fractions(CellKind::hexahedron, corners, material, cells);
    }
    double volume_of(std::span<const double> fractions) const {
        const PartNumbers volumes = part_volumes(CellKind::hexahedron, corners);
        double sum = 0.0;
        for (std::size_t t = 0; t < fractions.size(); ++t) sum += fractions[t] * volumes[t];
        return sum;
    }
};

TEST(PartShares, AreEmptyIfTheCellsFillTheCarrier) {
    const DividedBox box({2, 3, 2});
    EXPECT_TRUE(box.fractions(box.cells_where([](const Vec3&) { return true; })).empty());
}

TEST(PartShares, AreOneOrZeroWhereTheCutMissesATetrahedron) {
    const DividedBox box({2, 1, 1});
    const auto fractions = box.fractions(box.cells_where([](const Vec3& x) { return x[0] < 0.2; }));
    ASSERT_EQ(fractions.size(), num_parts(CellKind::hexahedron));
    // The plane goes through the middle: the two faces beside it are whole and empty.
    const auto count = [&](double value) { return std::ranges::count(fractions, value); };
    EXPECT_GE(count(1.0), 4);
    EXPECT_GE(count(0.0), 4);
    EXPECT_NEAR(box.volume_of(fractions), 0.003, 1e-16);
}

// A cell with more cells inside has the same shares: faces between them do not count.
TEST(PartShares, DoNotDependOnHowTheMaterialIsDivided) {
    const auto is_inside = [](const Vec3& x) { return x[0] < 0.2 || x[1] < 0.25; };  // not convex
    const DividedBox coarse({2, 2, 1}), fine({4, 6, 3});
    const auto of_coarse = coarse.fractions(coarse.cells_where(is_inside)),
               of_fine = fine.fractions(fine.cells_where(is_inside));
    ASSERT_EQ(of_coarse.size(), of_fine.size());
    for (std::size_t t = 0; t < of_fine.size(); ++t) EXPECT_NEAR(of_coarse[t], of_fine[t], 1e-13);
    const auto rest =
        coarse.fractions(coarse.cells_where([&](const Vec3& x) { return !is_inside(x); }));
    for (std::size_t t = 0; t < rest.size(); ++t) EXPECT_NEAR(of_coarse[t] + rest[t], 1.0, 1e-13);
}

TEST(PartShares, OfPartsThatFillACellAddUpToOne) {
    std::vector<std::vector<double>> fractions{{0.25, 1.01, 0.0}, {0.5, 0.0, 0.0}};
    fit_together(fractions, std::vector<double>(fractions.front().size(), 1.0));
    EXPECT_EQ(fractions,
              (std::vector<std::vector<double>>{{1.0 / 3, 1.0, 0.5}, {2.0 / 3, 0.0, 0.5}}));
}

}  // namespace
}  // namespace incise::fragments
