// Points that are not joined and cells that are wound the wrong way round, over all families.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "incise/topology/box_mesh.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"
#include "support/mesh_families.h"

namespace incise::topology {
namespace {

/// Two tetrahedra that share a face, as soup: points 0 to 3 and 4 to 7.
MeshData two_apart() { return test::soup_of(test::mesh_families()[1].data); }

std::size_t num_points_used(const MeshData& data) {
    return std::set(data.corners.begin(), data.corners.end()).size();
}

MeshData mirrored(MeshData data) {
    for (Vec3& x : data.points) x.x() = -x.x();
    return data;
}

double volume_of(const MeshData& data, std::size_t c) {
    std::vector<Vec3> x;
    for (const std::int64_t p : data.cell(c)) x.push_back(data.points[static_cast<std::size_t>(p)]);
    return signed_volume(data.kinds[c], x);
}

TEST(Coincidence, WarnsOnceOfEverySoup) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        EXPECT_EQ(coincidence_warning(family.data), std::nullopt);
        const MeshData soup = test::soup_of(family.data);
        const auto num_doubles = soup.points.size() - num_points_used(family.data);
        if (num_doubles == 0) continue;
        const auto warnings = check(soup).warnings;
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_EQ(warnings[0].substr(0, warnings[0].find(" point")), std::to_string(num_doubles));
    }
}

TEST(Coincidence, NamesPointsPositionCellsAndRemedies) {
    MeshData soup = two_apart();
    soup.source_cells = {7, 9};
    EXPECT_EQ(coincidence_warning(soup),
              "3 points are not joined to others at the same position, so the cells do not hang "
              "together there: point 3 of cell 0 (tetrahedron, number 7 in the file) and point 4 "
              "of cell 1 (tetrahedron, number 9 in the file) are both at (0, 0, 1); join them with "
              "topology::weld(); if they are meant to be apart, as the faces of a cut are, set "
              "MeshData::points_may_coincide");
    const auto advised = coincidence_warning(soup, {"glue them", "say so"});
    ASSERT_TRUE(advised);
    EXPECT_TRUE(advised->ends_with(
        "(0, 0, 1); glue them; if they are meant to be apart, as the faces of a cut are, say so"));
}

/// The cells of both, each with its own points.
MeshData beside(MeshData data, const MeshData& other) {
    const auto offset = static_cast<std::int64_t>(data.points.size());
    data.points.insert(data.points.end(), other.points.begin(), other.points.end());
    for (std::size_t c = 0; c < other.num_cells(); ++c) {
        std::vector<std::int64_t> corners(other.cell(c).begin(), other.cell(c).end());
        for (auto& corner : corners) corner += offset;
        data.add_cell(other.kinds[c], corners);
    }
    return data;
}

/// A box from `origin` on, of size 1, 2 and 2, with `cells` bricks along y and along z.
MeshData brick_box(CellKind kind, const Vec3& origin, int cells) {
    return box_mesh(kind, origin, {1, 2, 2}, {1, cells, cells});
}

std::string tail_of_warning(const MeshData& data) {
    const auto warning = coincidence_warning(data);
    if (!warning) return "no warning";
    return warning->substr(warning->find("); ") + 3);
}

const std::string or_apart =
    ", or, if they are meant to be apart, as the faces of a cut are, set "
    "MeshData::points_may_coincide";

TEST(Coincidence, OffersWeldingOfQuadrilateralsToTriangles) {
    auto both = beside(brick_box(CellKind::hexahedron, {0, 0, 0}, 2),
                       brick_box(CellKind::tetrahedron, {1, 0, 0}, 2));
    EXPECT_TRUE(tail_of_warning(both).starts_with("join them with topology::weld(); if they "));
    EXPECT_EQ(weld(both), 9u);
    const auto built = Mesh::build(both);
    EXPECT_EQ(components(built.mesh).count, 1);
    EXPECT_EQ(built.warnings, std::vector<std::string>{});
}

TEST(Coincidence, OffersNoWeldingOfUnlikeFaces) {
    // Of two tetrahedra on each quadrilateral, the first.
    MeshData halves = brick_box(CellKind::tetrahedron, {1, 0, 0}, 2), some;
    some.points = halves.points;
    std::vector<bool> is_taken(2 * 2, false);
    for (std::size_t c = 0; c < halves.num_cells(); ++c) {
        Vec3 centre = Vec3::Zero();
        int num_there = 0;
        for (const std::int64_t p : halves.cell(c)) {
            const Vec3& x = halves.points[static_cast<std::size_t>(p)];
            if (x.x() == 1.0) ++num_there, centre += x / 3.0;
        }
        if (num_there != 3) continue;
        const auto brick =
            static_cast<std::size_t>(centre.y()) + 2 * static_cast<std::size_t>(centre.z());
        if (!is_taken[brick]) some.add_cell(CellKind::tetrahedron, halves.cell(c));
        is_taken[brick] = true;
    }
    ASSERT_EQ(some.num_cells(), 4u);
    const auto text = tail_of_warning(beside(brick_box(CellKind::hexahedron, {0, 0, 0}, 2), some));
    EXPECT_TRUE(
        text.starts_with("welding does not join the cells, since no faces there have the "
                         "same corners, such as the quadrilateral of cell "))
        << text;
    EXPECT_NE(text.find(" (hexahedron) and the triangle of cell "), std::string::npos) << text;
    EXPECT_TRUE(
        text.ends_with(" (tetrahedron) on it: let two triangles, which share one of its "
                       "diagonals, cover each such quadrilateral" +
                       or_apart))
        << text;
}

TEST(Coincidence, OffersNoWeldingOfUnmatchedGrids) {
    for (const auto kind : {CellKind::hexahedron, CellKind::tetrahedron})
        EXPECT_EQ(
            tail_of_warning(beside(brick_box(kind, {0, 0, 0}, 2), brick_box(kind, {1, 0, 0}, 1))),
            "welding does not join the cells, since no faces there have the same corners: let the "
            "meshes match where they meet" +
                or_apart);
}

TEST(Coincidence, ReportsHowManyPointsWeldingLeavesLoose) {
    // Of two boxes at one face, and of a third at another whose grid is finer.
    const auto three = beside(beside(brick_box(CellKind::hexahedron, {0, 0, 0}, 1),
                                     brick_box(CellKind::hexahedron, {1, 0, 0}, 1)),
                              brick_box(CellKind::hexahedron, {-1, 0, 0}, 2));
    const auto text = tail_of_warning(three);
    EXPECT_TRUE(
        text.starts_with("join them with topology::weld(), which joins no cells at 4 of them, "
                         "since no faces there have the same corners; if they "))
        << text;
}

TEST(Coincidence, OffersNoWeldingThatLeavesNoSoundMesh) {
    MeshData data = test::mesh_families()[1].data;
    data.points.emplace_back(2, 2, 2);
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{3, 1, 2, 5});
    EXPECT_EQ(
        tail_of_warning(test::soup_of(data)),
        "welding them leaves no sound mesh (cells 0, 1 and 2 all share one face; a face joins "
        "two cells at the most: remove the others): remesh" +
            or_apart);
}

TEST(Coincidence, IsReportedForGapsThatAreHardlyMeant) {
    for (const double gap : {1e-3, 5e-3}) {
        SCOPED_TRACE(gap);
        for (const auto kind : {CellKind::hexahedron, CellKind::tetrahedron}) {
            auto both =
                beside(brick_box(kind, {0, 0, 0}, 2), brick_box(kind, {1.0 + gap, 0, 0}, 2));
            const auto warnings = check(both).warnings;
            ASSERT_EQ(warnings.size(), 1u);
            EXPECT_TRUE(warnings[0].starts_with(
                "9 points are within 0.01 of the shortest edge of others and not joined, so the "
                "cells do not hang together there: point "))
                << warnings[0];
            EXPECT_NE(warnings[0].find(" apart; move them onto each other where the mesh is made, "
                                       "since welding joins only points within 0.0001 of it, or, "
                                       "if the gap is meant, set MeshData::"),
                      std::string::npos)
                << warnings[0];
            both.points_may_coincide = true;
            EXPECT_TRUE(check(both).warnings.empty());
        }
    }
    const auto wide = beside(brick_box(CellKind::hexahedron, {0, 0, 0}, 2),
                             brick_box(CellKind::hexahedron, {1.02, 0, 0}, 2));
    EXPECT_TRUE(check(wide).warnings.empty());
}

TEST(Coincidence, IsNoMatterOfConnectedThinCells) {
    // Two flat tetrahedra on both sides of a face, whose tips are near each other.
    MeshData data;
    data.points = {{0, 0, 0},         {1, 0, 0},     {0, 1, 0},     {0.3, 0.3, 1e-3},
                   {0.3, 0.3, -1e-3}, {0.3, 0.3, 1}, {0.3, 0.3, -1}};
    const auto add = [&](std::vector<std::int64_t> corners) {
        data.add_cell(CellKind::tetrahedron, corners);
    };
    add({0, 1, 2, 3});
    add({0, 2, 1, 4});
    for (const auto& [tip, top] : {std::pair(3, 5), std::pair(4, 6)})
        for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)})
            tip == 3 ? add({a, b, tip, top}) : add({b, a, tip, top});
    ASSERT_TRUE(check(data).errors.empty()) << check(data).errors[0];
    EXPECT_EQ(check(data).warnings, std::vector<std::string>{});
}

TEST(Coincidence, IsNoMatterWhereItIsMeant) {
    MeshData soup = two_apart();
    soup.points_may_coincide = true;
    EXPECT_EQ(check(soup).warnings, std::vector<std::string>{});
}

TEST(Coincidence, IsNoMatterOfPointsWithoutCells) {
    MeshData data = test::mesh_families()[1].data;
    data.points.push_back(data.points[0]);
    EXPECT_EQ(coincidence_warning(data), std::nullopt);
}

TEST(Weld, MakesEverySoupTheMeshItWas) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        const auto whole = Mesh::build(family.data);
        MeshData soup = test::soup_of(family.data);
        const auto num_points = num_points_used(family.data);
        EXPECT_EQ(weld(soup), soup.points.size() - num_points);
        const auto welded = Mesh::build(soup);
        EXPECT_EQ(welded.mesh.num_nodes(), whole.mesh.num_nodes());
        EXPECT_EQ(components(welded.mesh).count, components(whole.mesh).count);
        EXPECT_EQ(boundary_faces(welded.mesh), boundary_faces(whole.mesh));

        drop_welded_points(soup);
        EXPECT_EQ(soup.points.size(), num_points);
        const auto compact = Mesh::build(soup).mesh;
        EXPECT_EQ(boundary_faces(compact), boundary_faces(whole.mesh));
        EXPECT_EQ(weld(soup), 0u);
    }
}

TEST(Weld, LetsEveryLabelFindItsNode) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        MeshData soup = test::soup_of(family.data);
        weld(soup);
        const Mesh mesh = Mesh::build(soup).mesh;
        ASSERT_EQ(mesh.num_source_points(), soup.points.size());
        for (std::size_t p = 0; p < soup.points.size(); ++p) {
            const auto nodes = mesh.nodes_with_label(static_cast<std::int64_t>(p));
            ASSERT_FALSE(nodes.empty());
            for (const VertexId n : nodes) {
                EXPECT_TRUE(mesh.is_alive(n));
                EXPECT_EQ(mesh.rest_position(n), soup.points[p]);
            }
            const auto lowest =
                soup.welded_to.empty() ? static_cast<std::int64_t>(p) : soup.welded_to[p];
            EXPECT_EQ(mesh.label(nodes.front()), lowest);
            EXPECT_EQ(nodes, mesh.nodes_with_label(lowest));
        }
    }
}

TEST(Weld, JoinsWhatRoundingAloneHasParted) {
    for (const double shift : {1e-8, 0.2 * weld_tolerance, 3.0 * weld_tolerance}) {
        SCOPED_TRACE(shift);
        const MeshData cube = box_mesh(CellKind::hexahedron, {5, 6, 7}, {3, 3, 3}, {3, 3, 3});
        MeshData soup = test::soup_of(cube);
        std::mt19937 random(3);
        for (Vec3& x : soup.points)
            for (double& coordinate : x) coordinate += random() % 2 == 0 ? shift : 0.0;
        weld(soup);
        const auto num_left = num_points_used(soup);
        if (shift < weld_tolerance)
            EXPECT_EQ(num_left, cube.points.size());
        else
            EXPECT_GT(num_left, cube.points.size());
    }
}

TEST(Weld, LeavesNothingToWeldAgain) {
    // Chains of points, each within reach of the next one and of no other.
    for (const double step : {0.4, 0.6, 0.95, 1.05}) {
        SCOPED_TRACE(step);
        MeshData data;
        for (const int order : {3, 0, 4, 1, 2}) {
            const double x = order * step * weld_tolerance;
            const auto first = static_cast<std::int64_t>(data.points.size());
            const double side = order % 2 == 0 ? 1.0 : -1.0;
            for (const Vec3& corner : {Vec3(x, 0, 0), Vec3(side, 2.0 * order + 2, 0),
                                       Vec3(0, 2.0 * order + 2, side), Vec3(0, 0, 9.0 + order)})
                data.points.push_back(corner);
            data.add_cell(CellKind::tetrahedron,
                          std::vector<std::int64_t>{first, first + 1, first + 2, first + 3});
        }
        const auto num_points = num_points_used(data);
        const auto num_joined = weld(data);
        EXPECT_EQ(num_points_used(data), num_points - num_joined);
        for (std::size_t p = 0; p < data.points.size(); ++p)
            EXPECT_EQ(data.welded_to.empty() || !data.is_welded(p),
                      std::ranges::find(data.corners, static_cast<std::int64_t>(p)) !=
                          data.corners.end());
        drop_welded_points(data);
        EXPECT_EQ(weld(data), 0u);
        const auto warning = coincidence_warning(data);
        EXPECT_TRUE(!warning || warning->find("within 0.01") != std::string::npos) << *warning;
    }
}

TEST(Weld, TakesBothZerosForOnePosition) {
    MeshData soup = two_apart();
    for (std::size_t p = 4; p < soup.points.size(); ++p)
        for (double& x : soup.points[p])
            if (x == 0.0) x = -0.0;
    EXPECT_EQ(weld(soup), 3u);
}

TEST(Weld, KeepsToEqualPositionsWhereSquaresFail) {
    for (const double scale : {1e-200, 1e200}) {
        SCOPED_TRACE(scale);
        MeshData soup = two_apart();
        for (Vec3& x : soup.points) x *= scale;
        EXPECT_EQ(weld(soup), 3u);
    }
}

TEST(Weld, TakesLittleTimeForPointsAllAlike) {
    MeshData data;
    data.points.assign(400'000, Vec3::Zero());
    for (std::int64_t p = 0; p < std::ssize(data.points); p += 4)
        data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{p, p + 1, p + 2, p + 3});
    EXPECT_EQ(weld(data), 399'999u);
}

TEST(Weld, LeavesCellsThatItFlattensToTheCheck) {
    MeshData soup = two_apart();
    soup.points[6] = soup.points[5];
    weld(soup);
    const auto errors = check(soup).errors;
    ASSERT_FALSE(errors.empty());
    EXPECT_EQ(errors[0],
              "cell 1 (tetrahedron): point 1 stands at two of its corners after welding; remove "
              "the cell");
}

TEST(Weld, LeavesFacesOfThreeCellsToTheCheck) {
    MeshData data = test::mesh_families()[1].data;
    data.points.emplace_back(2, 2, 2);
    data.add_cell(CellKind::tetrahedron, std::vector<std::int64_t>{3, 1, 2, 5});
    MeshData soup = test::soup_of(data);
    weld(soup);
    const auto errors = check(soup).errors;
    ASSERT_FALSE(errors.empty());
    EXPECT_EQ(errors[0],
              "cells 0, 1 and 2 all share one face; a face joins two cells at the most: remove the "
              "others");
}

TEST(Weld, IsReportedInWords) {
    EXPECT_EQ(weld_report(0), "no two points are at the same position: none was joined");
    EXPECT_EQ(weld_report(1), "1 point was joined to another at the same position");
    EXPECT_EQ(weld_report(2), "2 points were joined to others at the same position");
}

TEST(CellTraits, MirroredCellsKeepTheirFacesTurned) {
    for (const CellTraits& cell : cell_traits) {
        SCOPED_TRACE(cell.name);
        // A face as it runs from its lowest corner on, backwards if wanted.
        const auto run_of = [](std::vector<int> corners, bool is_backwards) {
            if (is_backwards) std::ranges::reverse(corners);
            std::ranges::rotate(corners, std::ranges::min_element(corners));
            return corners;
        };
        std::multiset<std::vector<int>> faces, backwards;
        for (int f = 0; f < cell.num_faces; ++f) {
            const auto face = cell.face(f);
            faces.insert(run_of({face.begin(), face.end()}, false));
            std::vector<int> turned;
            for (const int corner : face)
                turned.push_back(cell.mirrored[static_cast<std::size_t>(corner)]);
            backwards.insert(run_of(turned, true));
        }
        EXPECT_EQ(backwards, faces);
    }
}

TEST(TurnedCells, MakeEveryMirrorImageSound) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        MeshData data = family.data;
        EXPECT_EQ(turn_inverted_cells(data).num_cells, 0u);
        data = mirrored(data);
        ASSERT_FALSE(check(data).errors.empty());
        EXPECT_EQ(turn_inverted_cells(data).num_cells, data.num_cells());
        EXPECT_TRUE(check(data).errors.empty());
        EXPECT_EQ(check(data).shared_faces.size(), check(family.data).shared_faces.size());
        EXPECT_EQ(data.regions, family.data.regions);
        for (std::size_t c = 0; c < data.num_cells(); ++c) {
            EXPECT_DOUBLE_EQ(volume_of(data, c), volume_of(family.data, c));
            std::vector<std::int64_t> now(data.cell(c).begin(), data.cell(c).end()),
                before(family.data.cell(c).begin(), family.data.cell(c).end());
            EXPECT_TRUE(std::ranges::is_permutation(now, before));
        }
        EXPECT_EQ(turn_inverted_cells(data).num_cells, 0u);
    }
}

TEST(TurnedCells, LeaveTheFlatOneToTheCheck) {
    const MeshData sound = box_mesh(CellKind::tetrahedron, {5, 6, 7}, {3, 3, 3}, {2, 2, 2});
    for (const double height : {0.0, 1e-16}) {
        SCOPED_TRACE(height);
        MeshData data = mirrored(sound);
        const auto first = static_cast<std::int64_t>(data.points.size());
        for (const Vec3& x : {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0), Vec3(2, 2, height)})
            data.points.push_back(x);
        data.add_cell(CellKind::tetrahedron,
                      std::vector<std::int64_t>{first, first + 1, first + 2, first + 3});
        EXPECT_EQ(turn_inverted_cells(data).num_cells, sound.num_cells());
        const auto errors = check(data).errors;
        ASSERT_EQ(errors.size(), 1u);
        EXPECT_TRUE(errors[0].starts_with("cell 48 (tetrahedron) ")) << errors[0];
        EXPECT_TRUE(errors[0].ends_with("; remove it or remesh")) << errors[0];
    }
}

TEST(TurnedCells, AreOfTheKindThatIsInverted) {
    for (const auto& family : test::mesh_families())
        for (const CellKind kind : std::set(family.data.kinds.begin(), family.data.kinds.end())) {
            SCOPED_TRACE(family.name + ", " + traits(kind).name);
            MeshData data = family.data;
            std::size_t count = 0;
            for (std::size_t c = 0; c < data.num_cells(); ++c) {
                if (data.kinds[c] != kind) continue;
                ++count;
                for (std::size_t k = 0; k < data.cell(c).size(); ++k)
                    data.corners[data.offsets[c] + k] =
                        family.data.cell(c)[static_cast<std::size_t>(traits(kind).mirrored[k])];
            }
            const TurnedCells turned = turn_inverted_cells(data);
            EXPECT_EQ(turned.kinds, std::vector{kind});
            EXPECT_EQ(turned.num_cells, count);
            EXPECT_EQ(data.corners, family.data.corners);
        }
}

TEST(TurnedCells, AreNoneWhereSomeAreSound) {
    for (const auto& family : test::mesh_families()) {
        if (std::ranges::count(family.data.kinds, family.data.kinds.back()) !=
                static_cast<std::ptrdiff_t>(family.data.num_cells()) ||
            family.data.num_cells() < 2)
            continue;
        SCOPED_TRACE(family.name);
        MeshData data = mirrored(family.data);
        // One cell is wound the right way round.
        const auto& order = traits(data.kinds.back()).mirrored;
        const std::vector<std::int64_t> old(data.cell(data.num_cells() - 1).begin(),
                                            data.cell(data.num_cells() - 1).end());
        for (std::size_t k = 0; k < old.size(); ++k)
            data.corners[data.offsets[data.num_cells() - 1] + k] =
                old[static_cast<std::size_t>(order[k])];
        const auto corners = data.corners;
        EXPECT_EQ(turn_inverted_cells(data).num_cells, 0u);
        EXPECT_EQ(data.corners, corners);
    }
}

}  // namespace
}  // namespace incise::topology
