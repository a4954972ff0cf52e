// Splitting where everything touches everything: surfaces through nodes, along edges, in faces,
// tangent to the body, a hair beside, without area. On regular meshes all answers are known.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/triangle_surface.h"
#include "incise/topology/box_mesh.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::MeshSnapshot;
using topology::CellKind;
using topology::SurfaceData;

/// Bricks along each side of the cube. All numbers here are small fractions of two: nothing is
/// rounded.
constexpr int cells_a_side = 4;

SplitBody kuhn_cube() {
    return SplitBody(topology::box_mesh(CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(),
                                        {cells_a_side, cells_a_side, cells_a_side}));
}

Vec3 flat(double, double) { return Vec3::Zero(); }

/// The same cut in several ways: along the plane, along rectangles that reach beyond the body, by
/// a blade in one step and in many.
struct NamedStroke {
    std::string name;
    Stroke stroke;
};
std::vector<NamedStroke> strokes_along(const Vec3& point, const Vec3& normal) {
    const Vec3 u = 8 * normal.cross(normal.x() != 0.0 ? Vec3(0, 0, 1) : Vec3(1, 0, 0));
    const Vec3 v = normal.cross(u);
    std::vector<NamedStroke> strokes;
    const auto add = [&](const std::string& name, auto surface) {
        strokes.push_back({name, {}});
        strokes.back().stroke.push_back(std::move(surface));
    };
    add("plane", std::make_unique<Plane>(point, normal));
    add("plane turned round", std::make_unique<Plane>(point, -normal));
    add("rectangle", std::make_unique<TriangleSurface>(sheet(point, u, v, 1, flat)));
    add("many squares", std::make_unique<TriangleSurface>(sheet(point, v, -u, 8, flat)));
    for (const int num_steps : {1, test::num_cases(8)})
        for (const int sign : {1, -1}) {
            const Polyline from = {point - u - sign * v, point - sign * v, point + u - sign * v};
            const Polyline to = {point - u + sign * v, point + sign * v, point + u + sign * v};
            strokes.push_back({std::to_string(sign * num_steps) + " steps of a blade",
                               sweep(from, to, num_steps)});
        }
    return strokes;
}

TEST(SplitOnTheGrid, InFacesOfTheMeshDividesNothing) {
    struct Case {
        Vec3 point, normal;
        std::size_t num_nodes;  // on the plane
    };
    constexpr std::size_t m = cells_a_side + 1;
    std::vector<Case> cases;
    for (int c = 0; c < 3; ++c)
        for (int i = 1; i <= test::num_cases(cells_a_side - 1); ++i)
            cases.push_back({0.25 * i * Vec3::Unit(c), Vec3::Unit(c), m * m});
    // Kuhn's tetrahedra lie between the planes in which two coordinates agree.
    for (int c = 0; c < 3; ++c)
        for (const int i : {-2, 0, 1})
            cases.push_back({0.25 * i * Vec3::Unit(c), Vec3::Unit(c) - Vec3::Unit((c + 1) % 3),
                             (m - static_cast<std::size_t>(std::abs(i))) * m});
    for (const Case& at : test::some_of(cases))
        for (const double snap : {0.0, 0.1})
            for (const auto& [name, stroke] : strokes_along(at.point, at.normal)) {
                SCOPED_TRACE(testing::Message()
                             << at.normal.transpose() << " through " << at.point.transpose()
                             << ", snap " << snap << ", " << name);
                SplitBody body = kuhn_cube();
                const std::size_t num_elements = body.mesh.num_elements();
                const std::size_t num_nodes = body.mesh.num_nodes();
                const auto report = sum(body.cut(stroke, {snap}));
                EXPECT_EQ(report.edges_divided, 0u);
                EXPECT_EQ(body.mesh.num_elements(), num_elements);
                EXPECT_EQ(body.mesh.num_nodes(), num_nodes + at.num_nodes);
                EXPECT_EQ(report.faces_opened, cut_faces(body.mesh).size());
                EXPECT_EQ(topology::components(body.mesh).count, 2);

                const MeshSnapshot once(body.mesh);
                body.cut(stroke, {snap});
                EXPECT_EQ(MeshSnapshot(body.mesh), once);
            }
}

TEST(SplitOnTheGrid, ThroughNodesAndEdgesLeavesTheTwoHalves) {
    constexpr std::array offsets{0.125, 0.0, 0.25, 0.0625};
    const std::array normals{Vec3(2, 1, -1),  Vec3(1, 1, 0), Vec3(0, 1, 1), Vec3(1, 1, 1),
                             Vec3(-1, -1, 1), Vec3(1, 2, 0), Vec3(1, -2, 1)};
    for (const Vec3& normal : test::some_of(normals))
        for (const double offset : test::some_of(offsets))
            for (const double snap : {0.0, 0.1}) {
                const Vec3 point = Vec3::Constant(0.5) + Vec3(offset, 0, 0) +
                                   (normal.x() == 0.0 ? offset : 0.0) * Vec3(0, 1, 0);
                for (const auto& [name, stroke] : strokes_along(point, normal)) {
                    SCOPED_TRACE(testing::Message()
                                 << normal.transpose() << " through " << point.transpose()
                                 << ", snap " << snap << ", " << name);
                    SplitBody body = kuhn_cube();
                    const double off = snap * longest_edge(body.mesh, body.positions);
                    const auto above = [&](double height) {
                        return volume_above(body.mesh, body.positions,
                                            point + height * normal.normalized(), normal);
                    };
                    const double least = above(off) - 1e-12, most = above(-off) + 1e-12;
                    body.cut(stroke, {snap});
                    const auto volumes = piece_volumes(body.mesh);
                    ASSERT_EQ(volumes.size(), 2u);
                    EXPECT_NEAR(volumes[0] + volumes[1], 1.0, 1e-12);
                    // The offset is towards the normal's x (or y): the piece above is the smaller.
                    const bool is_first_above =
                        (offset == 0.0) || (normal.x() < 0.0 && offset > 0.0);
                    EXPECT_GE(volumes[is_first_above ? 0 : 1], least);
                    EXPECT_LE(volumes[is_first_above ? 0 : 1], most);

                    if (snap > 0.0) continue;
                    const MeshSnapshot once(body.mesh);
                    body.cut(stroke, {snap});
                    EXPECT_EQ(MeshSnapshot(body.mesh), once);
                }
            }
}

TEST(SplitOnTheGrid, SlightlyBesideIsAsThroughTheNodes) {
    static constexpr std::array places{0.25, 0.5, 0.75};
    for (int c = 0; c < 3; ++c)
        for (const double x : test::some_of(places))
            for (const double beyond : {0.0, 1.0})
                for (const double snap : {0.0, 0.05}) {
                    const double beside = std::nextafter(x, beyond);
                    for (const auto& [name, stroke] :
                         strokes_along(beside * Vec3::Unit(c), Vec3::Unit(c))) {
                        SCOPED_TRACE(testing::Message()
                                     << c << ", next to " << x << " towards " << beyond << ", snap "
                                     << snap << ", " << name);
                        SplitBody body = kuhn_cube();
                        const std::size_t num_nodes = body.mesh.num_nodes();
                        const auto report = sum(body.cut(stroke, {snap}));
                        EXPECT_EQ(report.edges_divided, 0u);
                        EXPECT_EQ(body.mesh.num_nodes(),
                                  num_nodes + (cells_a_side + 1) * (cells_a_side + 1));
                        const auto volumes = piece_volumes(body.mesh);
                        ASSERT_EQ(volumes.size(), 2u);
                        EXPECT_NEAR(volumes[1], std::min(x, 1.0 - x), 1e-14);
                        const MeshSnapshot once(body.mesh);
                        body.cut(stroke, {snap});
                        EXPECT_EQ(MeshSnapshot(body.mesh), once);
                    }
                }
}

TEST(SplitOnTheGrid, BesideOrTangentToTheBodyChangesNothing) {
    struct Case {
        Vec3 point, normal;
    };
    constexpr double hair = std::numeric_limits<double>::epsilon();
    const Vec3 corner = Vec3::Ones();
    const std::vector<Case> cases = {
        {{0, 0, 0}, {1, 0, 0}},       {{1, 0, 0}, {1, 0, 0}},         // in a side
        {{0, 1, 0}, {0, 1, 0}},       {{0, 0, 0}, {0, 0, 1}},         //
        {{0, 0, 0}, {1, 1, 0}},       {{1, 1, 0}, {1, 1, 0}},         // along an edge
        {{1, 0, 0}, {1, -1, 0}},      {{0, 0, 1}, {0, -1, 1}},        //
        {{0, 0, 0}, {1, 1, 1}},       {corner, {1, 1, 1}},            // at a corner
        {{1, 0, 0}, {2, -1, -1}},     {{1, 0, 1}, {1, -2, 1}},        //
        {{hair, 0, 0}, {1, 0, 0}},    {{1 - hair, 0, 0}, {1, 0, 0}},  // a hair inside
        {{hair, 0, 0}, {1, 1, 1}},    {{1, 1, 1 - hair}, {1, 1, 1}},  //
        {{-hair, 0, 0}, {1, 0, 0}},   {{1 + hair, 0, 0}, {1, 0, 0}},  // a hair outside
        {{-1e-300, 0, 0}, {1, 0, 0}}, {{1e-300, 0, 0}, {1, 0, 0}},    //
        {{-1, 0, 0}, {1, 0, 0}},      {{0, 0, 5}, {0, 0, 1}},         // outside
        {{3, 3, 3}, {1, 1, 1}},       {{-1e9, 0, 0}, {1, 0, 0}}};
    for (const Case& at : cases)
        for (const double snap : {0.0, 0.05, 0.1})
            for (const auto& [name, stroke] : strokes_along(at.point, at.normal)) {
                SCOPED_TRACE(testing::Message()
                             << at.normal.transpose() << " through " << at.point.transpose()
                             << ", snap " << snap << ", " << name);
                SplitBody body = kuhn_cube();
                const MeshSnapshot before(body.mesh);
                EXPECT_EQ(sum(body.cut(stroke, {snap})).faces_opened, 0u);
                EXPECT_EQ(MeshSnapshot(body.mesh), before);
            }
}

TEST(SplitOnTheGrid, TrianglesWithoutAreaCutNothing) {
    SurfaceData nothing;
    SurfaceData points = {{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}, {{0, 0, 0}, {0, 1, 0}, {1, 1, 1}}};
    SurfaceData needles;  // all corners in a line, through nodes and not
    needles.points = {{-1, 0.5, 0.5}, {0.5, 0.5, 0.5}, {2, 0.5, 0.5},
                      {-1, 0.3, 0.1}, {0.5, 0.4, 0.6}, {2, 0.5, 1.1}};
    needles.triangles = {{0, 1, 2}, {2, 1, 0}, {0, 0, 2}, {3, 5, 3}, {3, 4, 5}, {1, 4, 4}};
    for (const auto& surface : {nothing, points, needles})
        for (const double snap : {0.0, 0.1}) {
            SplitBody body = kuhn_cube();
            EXPECT_TRUE(body.cut(TriangleSurface(surface), {snap}).changes.is_empty());
        }
    // A blade that does not move, that moves along itself, and one of no length.
    const Polyline edge = {{-1, 0.5, 0.5}, {0.4, 0.5, 0.5}, {2, 0.5, 0.5}};
    const Polyline along = {{0, 0.5, 0.5}, {1, 0.5, 0.5}, {3, 0.5, 0.5}};
    const Polyline point = {{0.4, 0.4, -1}, {0.4, 0.4, -1}}, below = {{0.3, 0.3, 2}, {0.3, 0.3, 2}};
    for (const auto& [from, to] : {std::pair(edge, edge), {edge, along}, {point, below}}) {
        SplitBody body = kuhn_cube();
        EXPECT_EQ(sum(body.cut(sweep(from, to, 3), {0.1})).elements_crossed, 0u);
    }
    // Among others they change nothing.
    const Vec3 centre(0.5, 0.45, 0.55), u(3, 1, 0), v(0, 1, 3);
    SurfaceData plain = sheet(centre, u, v, 2, flat), mended = plain;
    const auto middle = static_cast<std::int64_t>(mended.points.size());
    mended.points.push_back(centre + 0.5 * u);  // on an edge between two triangles
    mended.triangles.push_back({4, middle, 5});
    mended.triangles.push_back({0, 0, 1});
    SplitBody one = kuhn_cube(), other = kuhn_cube();
    one.cut(TriangleSurface(plain));
    other.cut(TriangleSurface(mended));
    EXPECT_EQ(MeshSnapshot(one.mesh), MeshSnapshot(other.mesh));
    EXPECT_EQ(topology::components(one.mesh).count, 2);
}

// A blade in the plane x = 1/2 that stops on its way: rows of nodes that it has left behind by
// more than one element are copied, the row at the front is not.
TEST(SplitOnTheGrid, AHalfCutCopiesNodesBehindTheFront) {
    struct Case {
        double depth;
        std::size_t num_rows;  // copied
    };
    // At a row exactly, the blade has reached it along the edges that it met on its way there.
    for (const Case& at : {Case{0.1, 0},
                           {0.25, 1},
                           {0.3, 1},
                           {0.5, 2},
                           {0.55, 2},
                           {0.75, 3},
                           {0.9, 3},
                           {1.0, 5},
                           {1.1, 5}})
        for (const int num_steps : {1, 3, 40})
            for (const double snap : {0.0, 0.1}) {
                SCOPED_TRACE(testing::Message() << "depth " << at.depth << " in " << num_steps
                                                << " steps, snap " << snap);
                SplitBody body = kuhn_cube();
                const std::size_t num_nodes = body.mesh.num_nodes();
                const auto report =
                    sum(body.cut(sweep({{0.5, -1, -1}, {0.5, 2, -1}},
                                       {{0.5, -1, at.depth}, {0.5, 2, at.depth}}, num_steps),
                                 {snap}));
                EXPECT_EQ(report.edges_divided, 0u);
                EXPECT_EQ(body.mesh.num_nodes(), num_nodes + at.num_rows * (cells_a_side + 1));
                EXPECT_EQ(topology::components(body.mesh).count,
                          at.num_rows > cells_a_side ? 2 : 1);
                for (const auto front : nodes_of_cut(body.mesh).front)
                    EXPECT_EQ(body.mesh.rest_position(front).z(),
                              0.25 * static_cast<double>(at.num_rows));
            }
}

}  // namespace
}  // namespace incise::cutting
