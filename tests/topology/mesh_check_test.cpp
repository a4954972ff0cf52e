// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_check.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <span>
#include <sstream>
#include <utility>

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
    EXPECT_TRUE(result.errors[0].starts_with("cell 1 (tetrahedron) has negative volume -0.35") &&
                result.errors[0].ends_with("; its corners run the wrong way round: take them in "
                                           "the order 0, 2, 1, 3 (counted from 0)"))
        << result.errors[0];
}

/// The order of corners that a message names, such as "in the order 0, 2, 1, 3 (counted".
std::vector<std::size_t> order_in(const std::string& message) {
    const std::string words = "take them in the order ";
    std::vector<std::size_t> order;
    const auto at = message.find(words);
    if (at == std::string::npos) return order;
    std::istringstream text(message.substr(at + words.size()));
    for (std::size_t corner = 0; text >> corner; text.ignore()) order.push_back(corner);
    return order;
}

void reorder(MeshData& data, std::size_t c, std::span<const std::size_t> order) {
    const std::vector<std::int64_t> old(data.cell(c).begin(), data.cell(c).end());
    for (std::size_t k = 0; k < old.size(); ++k) data.corners[data.offsets[c] + k] = old[order[k]];
}

/// Orders in which programs other than VTK give the corners.
std::vector<std::vector<std::size_t>> wrong_orders(CellKind kind) {
    switch (kind) {
        case CellKind::tetrahedron:
            return {{1, 0, 2, 3}};
        case CellKind::hexahedron:
            return {{0, 3, 2, 1, 4, 7, 6, 5}, {4, 5, 6, 7, 0, 1, 2, 3}, {0, 1, 3, 2, 4, 5, 7, 6},
                    {0, 3, 1, 2, 4, 7, 5, 6}, {0, 1, 2, 3, 4, 7, 6, 5}, {0, 1, 2, 3, 7, 6, 5, 4}};
        case CellKind::wedge:
            return {{0, 2, 1, 3, 5, 4}, {3, 4, 5, 0, 1, 2}, {0, 1, 2, 3, 5, 4}, {0, 1, 2, 5, 4, 3}};
        case CellKind::pyramid:
            return {{0, 3, 2, 1, 4}, {0, 1, 3, 2, 4}, {0, 3, 1, 2, 4}};
        case CellKind::polyhedron:
            break;
    }
    return {};
}

TEST(MeshCheck, NamesTheOrderThatMendsACell) {
    for (const auto& family : test::mesh_families()) {
        std::array<bool, num_cell_kinds> is_done{};
        for (std::size_t c = 0; c < family.data.num_cells(); ++c) {
            const CellKind kind = family.data.kinds[c];
            if (std::exchange(is_done[static_cast<std::size_t>(kind)], true)) continue;
            for (const auto& wrong : wrong_orders(kind)) {
                SCOPED_TRACE(family.name + ", " + testing::PrintToString(wrong));
                MeshData data = family.data;
                reorder(data, c, wrong);
                const auto errors = check(data).errors;
                ASSERT_EQ(errors.size(), 1u) << errors.back();  // nothing of its neighbours
                EXPECT_TRUE(errors[0].starts_with(data.cell_name(c))) << errors[0];
                const auto order = order_in(errors[0]);
                ASSERT_EQ(order.size(), data.cell(c).size()) << errors[0];
                reorder(data, c, order);
                EXPECT_TRUE(check(data).errors.empty());
            }
        }
    }
}

TEST(MeshCheck, SaysThatAllCellsAreInverted) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        MeshData data = family.data;
        for (std::size_t c = 0; c < data.num_cells(); ++c) {
            const auto& mirrored = traits(data.kinds[c]).mirrored;
            reorder(data, c, std::vector<std::size_t>(mirrored.begin(), mirrored.end()));
        }
        const auto errors = check(data).errors;
        ASSERT_FALSE(errors.empty());
        for (const auto& error : errors)
            EXPECT_TRUE(error.find("negative volume") != std::string::npos ||
                        error.ends_with("more cells without positive volume"))
                << error;
    }
}

/// A cell of the kind that `corners` makes of a unit cube or of a prism, with repeated corners.
MeshData collapsed(CellKind kind, std::vector<std::int64_t> corners) {
    MeshData data = box_mesh(CellKind::hexahedron, {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    const std::vector<std::int64_t> cube(data.cell(0).begin(), data.cell(0).end());
    for (auto& corner : corners) corner = cube[static_cast<std::size_t>(corner)];
    data.kinds = {kind};
    data.offsets = {0, corners.size()};
    data.corners = corners;
    return data;
}

TEST(MeshCheck, SaysWhatACellWithRepeatedCornersIs) {
    struct Case {
        CellKind kind;
        std::vector<std::int64_t> corners;
        CellKind is;
    };
    using enum CellKind;
    for (const auto& [kind, corners, is] :
         std::vector<Case>{{hexahedron, {0, 1, 2, 2, 4, 5, 6, 6}, wedge},       // two edges
                           {hexahedron, {0, 1, 2, 3, 4, 5, 4, 5}, hexahedron},  // crosswise: none
                           {hexahedron, {0, 0, 2, 3, 4, 4, 6, 7}, wedge},
                           {hexahedron, {0, 1, 2, 3, 4, 4, 7, 7}, wedge},
                           {hexahedron, {0, 1, 2, 3, 4, 4, 4, 4}, pyramid},  // a face
                           {hexahedron, {0, 0, 0, 0, 4, 5, 6, 7}, pyramid},
                           {hexahedron, {0, 1, 2, 2, 4, 4, 4, 4}, tetrahedron},
                           {wedge, {0, 2, 1, 0, 6, 5}, pyramid},  // an edge between the triangles
                           {wedge, {0, 2, 1, 4, 4, 4}, tetrahedron},
                           {pyramid, {0, 1, 2, 2, 4}, tetrahedron}}) {
        SCOPED_TRACE(testing::PrintToString(corners));
        MeshData data = collapsed(kind, corners);
        const auto errors = check(data).errors;
        ASSERT_EQ(errors.size(), 1u);
        if (is == kind) {
            EXPECT_TRUE(errors[0].ends_with("; remove the cell")) << errors[0];
            continue;
        }
        const std::string words = std::string("so that it is a ") + traits(is).name +
                                  ": write it as a " + traits(is).name + " of the points ";
        const auto at = errors[0].find(words);
        ASSERT_NE(at, std::string::npos) << errors[0];
        std::istringstream text(errors[0].substr(at + words.size()));
        std::vector<std::int64_t> points;
        for (std::int64_t point = 0; text >> point; text.ignore()) points.push_back(point);
        ASSERT_EQ(points.size(), static_cast<std::size_t>(traits(is).num_corners)) << errors[0];
        data.kinds = {is};
        data.offsets = {0, points.size()};
        data.corners = points;
        EXPECT_TRUE(check(data).errors.empty()) << check(data).errors[0];
    }
}

TEST(MeshCheck, NumbersTheCornersOfACollapsedCellAsTheFileDoes) {
    MeshData data = collapsed(CellKind::hexahedron, {0, 1, 2, 3, 4, 4, 4, 4});
    const auto apex = data.corners[4];
    for (std::size_t p = 0; p < data.points.size(); ++p)
        data.source_points.push_back(static_cast<std::int64_t>(p) + 100);
    const auto errors = check(data).errors;
    EXPECT_TRUE(
        errors[0].ends_with(", " + std::to_string(apex + 100) + " of the file, in VTK's order"))
        << errors[0];
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
