// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_check.h"

#include <gtest/gtest.h>

#include <limits>

#include "incise/base/error.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh.h"
#include "support/mesh_families.h"

namespace incise::topology {
namespace {

MeshData two_by_a_face() { return test::mesh_families()[1].data; }

void expect_refused(const MeshData& data, const std::string& reason) {
    const MeshCheck result = check(data);
    ASSERT_FALSE(result.errors.empty());
    EXPECT_EQ(result.errors[0], reason);
    EXPECT_THROW(Mesh::build(data), InputError);
}

TEST(MeshCheck, AcceptsEveryFamily) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        EXPECT_TRUE(check(family.data).errors.empty());
    }
}

TEST(MeshCheck, RefusesNothingVolumetric) {
    expect_refused(MeshData{},
                   "holds no tetrahedra, hexahedra, wedges or pyramids: a volume mesh is needed");
}

TEST(MeshCheck, RefusesIndicesOutOfRange) {
    MeshData data = two_by_a_face();
    data.corners[5] = 927;
    expect_refused(data, "cell 1 (tetrahedron): node index 927 is out of range (5 points)");
    data.corners[5] = -1;
    expect_refused(data, "cell 1 (tetrahedron): node index -1 is out of range (5 points)");
}

TEST(MeshCheck, RefusesRepeatedCorners) {
    MeshData data = two_by_a_face();
    data.corners[7] = 3;
    expect_refused(data,
                   "cell 1 (tetrahedron): point 3 stands at two of its corners; remove the cell");
}

TEST(MeshCheck, NamesCellsAndPointsAsTheirSourceDoes) {
    MeshData data = two_by_a_face();
    data.source_cells = {17, 12};
    data.source_points = {1, 2, 3, 4, 5};
    data.corners[7] = 3;
    expect_refused(data,
                   "cell 1 (tetrahedron, number 12 in the file): point 3 (number 4 in the file) "
                   "stands at two of its corners; remove the cell");
    data = two_by_a_face();
    data.points.emplace_back(2, 2, 2);
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{3, 1, 2, 5});
    data.source_cells = {17, 12, 14};
    expect_refused(data,
                   "cells 0, 1 and 2 (in the file 17, 12 and 14) all share one face; a face joins "
                   "two cells at the most: remove the others");
}

TEST(MeshCheck, RefusesZeroAndNegativeVolume) {
    MeshData data = two_by_a_face();
    data.points[4] = (data.points[1] + data.points[2]) / 2;
    expect_refused(data, "cell 1 (tetrahedron) has zero volume; remove it or remesh");
    data = two_by_a_face();
    std::swap(data.corners[4], data.corners[5]);
    const MeshCheck result = check(data);
    ASSERT_FALSE(result.errors.empty());
    EXPECT_NE(result.errors[0].find("cell 1 (tetrahedron) has negative volume -0.35"),
              std::string::npos)
        << result.errors[0];
}

TEST(MeshCheck, RefusesCornersTurnedInsideOut) {
    MeshData data = box_mesh(CellKind::hexahedron, {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    data.points[0] = {0.7, 0.7, 0.7};  // the volume stays positive
    expect_refused(
        data,
        "cell 0 (hexahedron) is turned inside out or flat at its corner 0, point 0; remesh it");
}

TEST(MeshCheck, RefusesDuplicateElements) {
    MeshData data = two_by_a_face();
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{1, 2, 0, 3});
    const MeshCheck result = check(data);
    ASSERT_FALSE(result.errors.empty());
    bool is_named = false;
    for (const auto& error : result.errors)
        is_named = is_named || error.find("share one face") != std::string::npos ||
                   error.find("have the same nodes") != std::string::npos;
    EXPECT_TRUE(is_named);
    data = test::mesh_families()[0].data;
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{1, 2, 0, 3});
    expect_refused(data,
                   "cell 0 (tetrahedron) and cell 1 (tetrahedron) have the same nodes; remove one "
                   "of them");
}

TEST(MeshCheck, RefusesFacesSharedByThree) {
    MeshData data = two_by_a_face();
    data.points.emplace_back(2, 2, 2);
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{3, 1, 2, 5});
    expect_refused(data,
                   "cells 0, 1 and 2 all share one face; a face joins two cells at the most: "
                   "remove the others");
}

TEST(MeshCheck, NamesFirstOfManyCellsAtOneFace) {
    MeshData data = two_by_a_face();
    for (std::int64_t point = 5; point < 1000; ++point) {
        data.points.emplace_back(2, 2, 2);
        data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{3, 1, 2, point});
    }
    expect_refused(data,
                   "cells 0, 1, 2, 3, 4 and 992 more all share one face; a face joins two cells at "
                   "the most: remove the others");
}

TEST(MeshCheck, RefusesNeighboursOnTheSameSide) {
    MeshData data = test::mesh_families()[0].data;
    data.points.emplace_back(0.1, 0.1, 2);
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{0, 1, 2, 4});
    expect_refused(data,
                   "cell 0 (tetrahedron) and cell 1 (tetrahedron) lie on the same side of the face "
                   "that they share, so they overlap; remove one of them");
}

TEST(MeshCheck, RefusesCoordinatesThatAreNotFinite) {
    MeshData data = two_by_a_face();
    data.points[2].y() = std::numeric_limits<double>::quiet_NaN();
    expect_refused(data, "point 2 is not finite: (0, nan, 0)");
}

TEST(MeshCheck, ListsAFewAndCountsTheRest) {
    MeshData data = box_mesh(CellKind::tetrahedron, {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        std::swap(data.corners[4 * c], data.corners[4 * c + 1]);
    const MeshCheck result = check(data);
    ASSERT_EQ(result.errors.size(), 6u);
    EXPECT_EQ(result.errors.back(), "and 43 more cells without positive volume");
}

}  // namespace
}  // namespace incise::topology
