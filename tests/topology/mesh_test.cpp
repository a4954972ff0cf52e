// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "incise/topology/box_mesh.h"
#include "incise/topology/geometry.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"

namespace incise::topology {
namespace {

double volume_of(const MeshData& data) {
    double sum = 0.0;
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        std::vector<Vec3> x;
        for (const std::int64_t p : data.cell(c))
            x.push_back(data.points[static_cast<std::size_t>(p)]);
        sum += signed_volume(data.kinds[c], x);
    }
    return sum;
}

TEST(CellKind, FacesRunAnticlockwiseAndCloseEveryCell) {
    for (const CellTraits& t : cell_traits) {
        SCOPED_TRACE(t.name);
        std::multiset<std::pair<int, int>> sides;
        for (int f = 0; f < t.num_faces; ++f) {
            const auto face = t.face(f);
            for (std::size_t p = 0; p < face.size(); ++p)
                sides.emplace(face[p], face[(p + 1) % face.size()]);
        }
        EXPECT_EQ(sides.size(), 2u * static_cast<std::size_t>(t.num_edges));
        for (const auto& [from, to] : sides) EXPECT_EQ(sides.count({to, from}), 1u);
        std::set<std::pair<int, int>> edges;
        for (int k = 0; k < t.num_edges; ++k) {
            const auto [i, j] = t.edges[static_cast<std::size_t>(k)];
            EXPECT_EQ(sides.count({i, j}), 1u);
            edges.insert(std::minmax(i, j));
        }
        EXPECT_EQ(edges.size(), static_cast<std::size_t>(t.num_edges));
    }
}

TEST(Geometry, VolumesOfTheReferenceCells) {
    const std::vector<Vec3> hexahedron = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                          {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    const std::vector<Vec3> wedge = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0},
                                     {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
    const std::vector<Vec3> pyramid = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5, .5, 1}};
    const std::vector<Vec3> tetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_DOUBLE_EQ(signed_volume(CellKind::hexahedron, hexahedron), 1.0);
    EXPECT_DOUBLE_EQ(signed_volume(CellKind::wedge, wedge), 0.5);
    EXPECT_DOUBLE_EQ(signed_volume(CellKind::pyramid, pyramid), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(signed_volume(CellKind::tetrahedron, tetrahedron), 1.0 / 6.0);
}

TEST(BoxMesh, FillsTheBoxAndFitsTogether) {
    for (const CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
        const MeshData data = box_mesh(kind, {1, 2, 3}, {0.4, 0.3, 2.0}, {3, 2, 5});
        EXPECT_EQ(data.num_cells(), kind == CellKind::tetrahedron ? 180u : 30u);
        EXPECT_NEAR(volume_of(data), 0.24, 1e-15);
        const BuiltMesh built = Mesh::build(data);
        EXPECT_TRUE(built.warnings.empty());
        const double outer_faces = 2.0 * (3 * 2 + 2 * 5 + 3 * 5);
        EXPECT_EQ(boundary_faces(built.mesh).size(), static_cast<std::size_t>(outer_faces) *
                                                         (kind == CellKind::tetrahedron ? 2u : 1u));
    }
}

TEST(BoxMesh, EndsExactlyAtItsSize) {
    for (const double size : {0.1, 0.3, 1.0 / 3.0, 0.7})
        for (int n = 1; n < 50; ++n) {
            const MeshData data =
                box_mesh(CellKind::hexahedron, {0, 0, 0}, {size, 1, 2 * size}, {n, 1, n});
            EXPECT_EQ(data.points.back(), Vec3(size, 1, 2 * size)) << n;
        }
}

TEST(Mesh, IsValidForEveryFamily) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        const BuiltMesh built = Mesh::build(family.data);
        EXPECT_EQ(validate(built.mesh), std::vector<std::string>());
        EXPECT_EQ(built.mesh.num_elements(), family.data.num_cells());
        EXPECT_NEAR(volume_of(to_mesh_data(built.mesh, built.mesh.rest_positions())),
                    volume_of(family.data), 1e-12 * volume_of(family.data));
    }
}

TEST(Mesh, ConnectivityIsThatOfEachElement) {
    test::Random random(3);
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        Mesh mesh = Mesh::build(family.data).mesh;
        for (int i = 0; i < 3; ++i) {
            const Mesh::Connectivity all = mesh.connectivity();
            ASSERT_EQ(all.epoch, mesh.epoch());
            ASSERT_EQ(all.kinds.size(), mesh.element_capacity());
            for (std::size_t k = 0; k < all.kinds.size(); ++k) {
                const CellId e(k);
                ASSERT_EQ(all.is_alive[k] != 0, mesh.is_alive(e));
                ASSERT_EQ(all.kinds[k], mesh.kind(e));
                ASSERT_EQ(all.regions[k], mesh.region(e));
                if (mesh.is_polyhedron(e)) continue;
                ASSERT_TRUE(std::ranges::equal(
                    all.corners.subspan(all.corner_begin[k],
                                        all.corner_begin[k + 1] - all.corner_begin[k]),
                    mesh.corners(e)));
                for (int f = 0; f < mesh.num_faces(e); ++f)
                    ASSERT_EQ(all.neighbors[all.face_begin[k] + static_cast<std::size_t>(f)],
                              mesh.neighbor({e, f}));
            }
            if (mesh.num_elements() < 3) break;
            test::random_edit(mesh, random);
        }
    }
}

TEST(Mesh, LabelsAreTheNumbersOfTheSource) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        const BuiltMesh built = Mesh::build(family.data);
        const Mesh& mesh = built.mesh;
        for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
            const CellId e(i);
            const auto cell = family.data.cell(static_cast<std::size_t>(mesh.label(e)));
            ASSERT_EQ(mesh.region(e), family.data.regions[static_cast<std::size_t>(mesh.label(e))]);
            const auto whole = mesh.whole_cell(e);
            ASSERT_TRUE(whole);
            for (std::size_t k = 0; k < cell.size(); ++k) {
                const VertexId n = whole->corners()[k];
                const auto named = mesh.nodes_with_label(cell[k]);
                ASSERT_NE(std::find(named.begin(), named.end(), n), named.end());
                ASSERT_EQ(mesh.rest_position(n),
                          family.data.points[static_cast<std::size_t>(cell[k])]);
            }
        }
    }
}

TEST(Mesh, NumbersNeighboursNearEachOther) {
    const BuiltMesh built =
        Mesh::build(box_mesh(CellKind::tetrahedron, {0, 0, 0}, {1, 1, 1}, {16, 16, 16}));
    // Most neighbours are within a cache's reach of each other, though a box is numbered row by
    // row in its file.
    std::size_t near = 0, all = 0;
    for (std::size_t i = 0; i < built.mesh.num_elements(); ++i)
        for (int f = 0; f < 4; ++f) {
            const FaceId other = built.mesh.neighbor({CellId(i), f});
            if (!other.is_valid()) continue;
            ++all;
            near += std::max(i, other.cell.index()) - std::min(i, other.cell.index()) < 64;
        }
    EXPECT_GT(near, all * 7 / 10);
}

TEST(Mesh, DividesPinchedNodesAndSaysSo) {
    const auto& families = test::mesh_families();
    const auto by_edge = std::find_if(families.begin(), families.end(), [](const auto& family) {
        return family.name == "two by an edge";
    });
    const BuiltMesh built = Mesh::build(by_edge->data);
    EXPECT_EQ(built.mesh.num_nodes(), 8u);
    EXPECT_EQ(components(built.mesh).count, 2);
    ASSERT_EQ(built.warnings.size(), 2u);
    EXPECT_NE(built.warnings[0].find("point 0 joins cells that share no face"), std::string::npos);
    EXPECT_EQ(built.mesh.nodes_with_label(0).size(), 2u);
    EXPECT_EQ(built.mesh.nodes_with_label(2).size(), 1u);
}

TEST(Mesh, WarnsOncePerPinchedNode) {
    MeshData data;
    data.points = {{0, 0, 0}};
    for (int i = 0; i < 4; ++i) {  // tetrahedra in different quadrants about the origin
        const Vec3 x(i % 2 == 0 ? 1 : -1, 0, 0), y(0, i < 2 ? 1 : -1, 0), z(0, 0, 1);
        const auto first = static_cast<std::int64_t>(data.points.size());
        for (const Vec3& corner : {Vec3(x + y), Vec3(2 * x + y), Vec3(x + y + z)})
            data.points.push_back(corner);
        const bool is_mirrored = i == 1 || i == 2;
        data.add_cell(CellKind::tetrahedron,
                      std::vector<std::int64_t>{0, first + (is_mirrored ? 0 : 1),
                                                first + (is_mirrored ? 1 : 0), first + 2});
    }
    const BuiltMesh built = Mesh::build(data);
    EXPECT_EQ(built.mesh.nodes_with_label(0).size(), 4u);
    ASSERT_EQ(built.warnings.size(), 1u);
    EXPECT_NE(built.warnings[0].find("point 0 joins cells"), std::string::npos);
}

TEST(Mesh, LeavesUnusedPointsOut) {
    MeshData data = test::mesh_families().front().data;
    data.points.insert(data.points.begin() + 1, Vec3(9, 9, 9));
    for (std::int64_t& corner : data.corners) corner += corner >= 1;
    const BuiltMesh built = Mesh::build(data);
    EXPECT_EQ(built.mesh.num_nodes(), 4u);
    EXPECT_EQ(validate(built.mesh), std::vector<std::string>());
    ASSERT_EQ(built.warnings.size(), 1u);
    EXPECT_EQ(built.warnings[0], "point 1 belongs to no cell and is left out");
    for (const VertexId n : built.mesh.nodes_with_label(1)) EXPECT_FALSE(built.mesh.is_alive(n));
}

TEST(Mesh, StarsHoldExactlyTheElementsOfANode) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        const BuiltMesh built = Mesh::build(family.data);
        std::vector<CellId> star;
        for (std::size_t n = 0; n < built.mesh.node_capacity(); ++n) {
            std::vector<CellId> expected;
            for (std::size_t i = 0; i < built.mesh.element_capacity(); ++i) {
                const auto corners = built.mesh.corners(CellId(i));
                if (std::find(corners.begin(), corners.end(), VertexId(n)) != corners.end())
                    expected.emplace_back(i);
            }
            built.mesh.star(VertexId(n), star);
            ASSERT_EQ(star, expected);
        }
    }
}

}  // namespace
}  // namespace incise::topology
