// Splitting along triangulated surfaces: closed ones free their inside, open ones end in the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/triangle_surface.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Random;
using topology::Mesh;
using topology::SurfaceData;

/// Largest distance of an opened face's node from the surface, where the body is now.
double distance_of_cut(const SplitBody& body, const TriangleSurface& surface) {
    double largest = 0.0;
    for (const auto& pair : cut_faces(body.mesh))
        for (int p = 0; p < 3; ++p)
            largest = std::max(
                largest,
                surface.distance(body.positions[body.mesh.face_corner(pair.a, p).index()]));
    return largest;
}

double cut_area(const SplitBody& body) {
    double area = 0.0;
    for (const auto& pair : cut_faces(body.mesh)) area += topology::rest_area(body.mesh, pair.a);
    return area;
}

struct NamedSurface {
    std::string name;
    SurfaceData surface;
};

/// Convex, and well inside the unit cube.
std::vector<NamedSurface> closed_surfaces(Random& random) {
    const Vec3 centre = Vec3::Constant(0.5) + random.vector(0.1);
    Box box(centre);
    box.extend(centre - Vec3(0.31, 0.27, 0.24)).extend(centre + Vec3(0.22, 0.33, 0.26));
    SurfaceData turned = box_surface(box);
    const auto turn = Eigen::AngleAxisd(random.uniform(0.1, 1.0), random.vector(1).normalized());
    for (Vec3& x : turned.points) x = centre + 0.8 * (turn * (x - centre));
    return {{"sphere", icosphere(centre, 0.34, 2)},
            {"icosahedron", icosphere(centre, 0.37, 0)},
            {"box", box_surface(box)},
            {"turned box", turned}};
}

TEST(SplitAlongSurface, AClosedOneFreesItsInside) {
    for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
        Random random(seed);
        for (const auto& [name, data] : closed_surfaces(random)) {
            SCOPED_TRACE(name + ", seed " + std::to_string(seed));
            SplitBody body(test::jittered_cube(6, 0.2, seed));
            const double edge = longest_edge(body.mesh, body.positions);
            const TriangleSurface surface(data);
            const Split done = body.cut(surface);

            // All corners of the opened faces are on the surface, which is convex: so they
            // enclose less, and what they miss is what chords of elements cut off.
            EXPECT_LE(distance_of_cut(body, surface), 1e-14);
            const auto volumes = piece_volumes(body.mesh);
            ASSERT_EQ(volumes.size(), 2u);
            EXPECT_NEAR(volumes[0] + volumes[1], 1.0, 1e-12);
            const double inside = enclosed_volume(data);
            EXPECT_LE(volumes[1], inside * (1.0 + 1e-12));
            EXPECT_GE(volumes[1], inside - 0.25 * edge * cut_area(body));
            EXPECT_EQ(cut_faces(body.mesh).size(), done.report.faces_opened);
            EXPECT_TRUE(nodes_of_cut(body.mesh).front.empty());
        }
    }
}

TEST(SplitAlongSurface, AClosedOneFreesItsInsideWithSnapping) {
    for (const double snap : {0.01, default_snap})
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            Random random(seed);
            for (const auto& [name, data] : closed_surfaces(random)) {
                SCOPED_TRACE(name + ", seed " + std::to_string(seed) + ", snap " +
                             std::to_string(snap));
                SplitBody body(test::jittered_cube(6, 0.2, seed));
                const double edge = longest_edge(body.mesh, body.positions);
                const auto options = SplitOptions{snap};
                const TriangleSurface surface(data);
                body.cut(surface, options);
                const double off = snap * edge;
                EXPECT_LE(distance_of_cut(body, surface), off);
                const auto volumes = piece_volumes(body.mesh);
                ASSERT_EQ(volumes.size(), 2u);
                EXPECT_NEAR(volumes[0] + volumes[1], 1.0, 1e-12);
                EXPECT_NEAR(volumes[1], enclosed_volume(data),
                            (off + 0.25 * edge) * cut_area(body));
            }
        }
}

// At its creases there are elements all of whose corners are on the surface, and edges that could
// be divided for ever: both are as the first cut has left them.
TEST(SplitAlongSurface, AClosedOneAgainChangesNothing) {
    for (const double snap : {0.0, default_snap, 0.05, 0.1})
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            Random random(seed);
            for (const auto& [name, data] : closed_surfaces(random))
                for (const int n : {3, 6})
                    for (const double jitter : {0.0, 0.2}) {
                        SCOPED_TRACE(testing::Message()
                                     << name << " in " << n << " bricks, jitter " << jitter
                                     << ", seed " << seed << ", snap " << snap);
                        SplitBody body(test::jittered_cube(n, jitter, seed));
                        const auto options = SplitOptions{snap};
                        body.cut(TriangleSurface(data), options);
                        const Split again = body.cut(TriangleSurface(data), options);
                        EXPECT_TRUE(again.changes.is_empty());
                    }
        }
}

/// A box about the middle of the unit cube, of this half width, moved by `offset`.
SurfaceData middle_box(double half_width, const Vec3& offset = Vec3::Zero()) {
    const Vec3 middle = Vec3::Constant(0.5) + offset;
    Box box(middle);
    box.extend(middle - Vec3::Constant(half_width)).extend(middle + Vec3::Constant(half_width));
    return box_surface(box);
}

// Nodes at edges of the box are near one of its sides while another passes through their edges, and
// elements in its corners have all of their nodes on it.
TEST(SplitAlongSurface, ABoxOnMeshFacesFreesAllInside) {
    for (const double snap : {0.0, default_snap, 0.1})
        for (int n = 3; n <= 8; ++n)
            for (int width = 1; width < n; ++width) {
                SCOPED_TRACE(testing::Message()
                             << width << " of " << n << " bricks, snap " << snap);
                const int low = (n - width) / 2;
                SplitBody body(test::jittered_cube(n, 0.0, 0));
                Box box(Vec3::Constant(static_cast<double>(low) / n));
                box.extend(Vec3::Constant(static_cast<double>(low + width) / n));
                const SurfaceData data = box_surface(box);
                const Split done = body.cut(TriangleSurface(data), SplitOptions{snap});
                EXPECT_TRUE(done.changes.elements_added.empty());
                const auto volumes = piece_volumes(body.mesh);
                ASSERT_EQ(volumes.size(), 2u);
                const double inside = enclosed_volume(data);
                EXPECT_NEAR(volumes[0], std::max(inside, 1.0 - inside), 1e-12);
                // A side that lies on the body's own has nothing to open.
                const auto num_sides = low == 0 ? 3u : 6u;
                EXPECT_EQ(done.report.faces_opened,
                          num_sides * 2u * static_cast<std::size_t>(width * width));
                EXPECT_TRUE(body.cut(TriangleSurface(data)).changes.is_empty());
            }
}

// Rounding then puts nodes of the box's sides on either side of them, each by itself.
TEST(SplitAlongSurface, ABoxOnDeformedFacesFreesAllInside) {
    for (const bool is_strained : {false, true})
        for (const double snap : {0.0, default_snap, 0.1})
            for (int n = 3; n <= 7; ++n)
                for (int low = 1; low < n - 1; ++low) {
                    SCOPED_TRACE(testing::Message()
                                 << (is_strained ? "strained" : "turned") << ", snap " << snap
                                 << ", from " << low << " on, " << n << " bricks");
                    Random random(static_cast<std::uint64_t>(100 * n + low));
                    const Eigen::Matrix3d turn =
                        Eigen::AngleAxisd(random.uniform(0.1, 1.0), random.vector(1.0).normalized())
                            .toRotationMatrix();
                    Eigen::Matrix3d F = turn;
                    if (is_strained)
                        for (int c = 0; c < 3; ++c) F.col(c) += random.vector(0.3);
                    topology::MeshData mesh = test::jittered_cube(n, 0.0, 0);
                    if (!is_strained)
                        for (Vec3& x : mesh.points) x = F * x;
                    SplitBody body(mesh);
                    if (is_strained)
                        for (Vec3& x : body.positions) x = F * x;
                    Box box(Vec3::Constant(static_cast<double>(low) / n));
                    box.extend(Vec3::Constant(static_cast<double>(n - 1) / n));
                    SurfaceData data = box_surface(box);
                    for (Vec3& x : data.points) x = F * x;

                    const Split done = body.cut(TriangleSurface(data), SplitOptions{snap});
                    EXPECT_TRUE(done.changes.elements_added.empty());
                    const auto width = static_cast<std::size_t>(n - 1 - low);
                    EXPECT_EQ(done.report.faces_opened, 12u * width * width);
                    const auto volumes = piece_volumes(body.mesh);
                    ASSERT_EQ(volumes.size(), 2u);
                    EXPECT_NEAR(std::min(volumes[0], volumes[1]),
                                std::min(box.volume(), 1.0 - box.volume()), 1e-12);
                    EXPECT_TRUE(body.cut(TriangleSurface(data)).changes.is_empty());
                }
}

/// The faces of a tetrahedron of the mesh, or so many of them.
SurfaceData faces_of(const Mesh& mesh, CellId e, std::size_t num_faces) {
    SurfaceData data;
    for (std::size_t f = 0; f < num_faces; ++f) {
        for (int p = 0; p < 3; ++p)
            data.points.push_back(
                mesh.rest_position(mesh.face_corner({e, static_cast<std::int32_t>(f)}, p)));
        const auto first = static_cast<std::int64_t>(3 * f);
        data.triangles.push_back({first, first + 1, first + 2});
    }
    return data;
}

// No edge need be crossed then, and all nodes of what is inside are on the surface.
TEST(SplitAlongSurface, AllFacesOfATetrahedronFreeIt) {
    for (const double jitter : {0.0, 0.2}) {
        const auto data = test::jittered_cube(3, jitter, 1);
        const Mesh mesh = SplitBody(data).mesh;
        for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
            for (const std::size_t num_faces : {3u, 4u}) {
                SCOPED_TRACE(testing::Message() << num_faces << " faces of element " << i);
                const CellId e(i);
                SplitBody body(data);
                const Split done = body.cut(TriangleSurface(faces_of(mesh, e, num_faces)), {0.0});
                EXPECT_TRUE(done.changes.elements_added.empty());
                EXPECT_LE(done.report.faces_opened, num_faces);
                const auto volumes = piece_volumes(body.mesh);
                bool is_inside = true;
                for (int f = 0; f < 4; ++f) is_inside &= mesh.neighbor({e, f}).is_valid();
                if (num_faces == 4 || is_inside) {
                    EXPECT_EQ(volumes.size(), num_faces == 4 ? 2u : 1u);
                }
            }
    }
}

// All of its sides but one are in faces of the mesh, and that one is nearer than an edge to the
// opposite side: intersections of either in edges at nodes of the other are not to be forgotten.
TEST(SplitAlongSurface, AThinBoxOnMeshFacesComesFree) {
    for (const double thickness : {0.4, 0.5, 0.6, 0.7, 0.8})
        for (const int across : {0, 1, 2})
            for (int n = 4; n <= 6; ++n)
                for (int width = 1; width <= n - 2; ++width) {
                    SCOPED_TRACE(testing::Message() << thickness << " along axis " << across << ", "
                                                    << width << " of " << n << " bricks");
                    Vec3 far = Vec3::Constant(1.0 + width);
                    far[across] = 1.0 + thickness;
                    Box box(Vec3::Constant(1.0 / n));
                    box.extend(far / n);
                    SplitBody body(test::jittered_cube(n, 0.0, 0));
                    body.cut(TriangleSurface(box_surface(box)), {0.0});
                    const auto volumes = piece_volumes(body.mesh);
                    ASSERT_EQ(volumes.size(), 2u);
                    EXPECT_LE(volumes[1], box.volume() * (1.0 + 1e-12));
                }
}

// What snapping takes away at creases is little beside what chords of elements do: 0.90 of the
// boxes would come free if a node near one side forgot where the others pass through its edges.
TEST(SplitAlongSurface, WithSnappingTurnedBoxesFreeMostInside) {
    double freed = 0.0, inside = 0.0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        Random random(seed);
        SurfaceData data = middle_box(0.27, random.vector(0.05));
        const auto turn =
            Eigen::AngleAxisd(random.uniform(0.1, 1.0), random.vector(1.0).normalized());
        for (Vec3& x : data.points) x = Vec3::Constant(0.5) + turn * (x - Vec3::Constant(0.5));
        SplitBody body(test::jittered_cube(8, 0.2, seed));
        body.cut(TriangleSurface(data), SplitOptions{default_snap});
        freed += 1.0 - piece_volumes(body.mesh)[0];
        inside += enclosed_volume(data);
    }
    EXPECT_GT(freed, 0.93 * inside);
    EXPECT_LT(freed, inside);
}

// Its creases lie in planes that hold faces of the mesh or halve its bricks: edges run through
// them.
TEST(SplitAlongSurface, ABoxAlongTheMeshAgainChangesNothing) {
    for (const double snap : {0.0, default_snap, 0.05, 0.1})
        for (const double offset : {0.0, 0.013})
            for (const int n : {4, 7})
                for (int i = 0; i < static_cast<int>(test::num_cases(4)); ++i) {
                    const SurfaceData data = middle_box(0.2 + 0.031 * i, Vec3(offset, 0.0, 0.0));
                    SCOPED_TRACE(testing::Message() << "box " << i << " moved by " << offset
                                                    << " in " << n << " bricks, snap " << snap);
                    SplitBody body(test::jittered_cube(n, 0.0, 0));
                    const auto options = SplitOptions{snap};
                    body.cut(TriangleSurface(data), options);
                    EXPECT_EQ(topology::components(body.mesh).count, 2);
                    const Split again = body.cut(TriangleSurface(data), options);
                    EXPECT_TRUE(again.changes.is_empty());
                }
}

// Beside the creases of the box there are nodes that both cuts pass in the same direction, and
// faces that only the plane passes.
TEST(SplitAlongSurface, APlaneContinuesOneSideOfABox) {
    for (const double snap : {0.0, default_snap, 0.05, 0.1})
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", snap " << snap);
            Random random(seed);
            SplitBody body(test::jittered_cube(6, seed % 2 == 0 ? 0.0 : 0.2, seed));
            const auto options = SplitOptions{snap};
            const Vec3 centre = Vec3::Constant(0.5) + random.vector(0.1);
            const Eigen::AngleAxisd turn(random.uniform(0.0, 1.0), random.vector(1.0).normalized());
            Box box(Vec3(0.0, -0.3, -0.3));
            box.extend(Vec3(0.3, 0.3, 0.3));
            SurfaceData surface = box_surface(box);
            for (Vec3& x : surface.points) x = centre + turn * x;
            body.cut(TriangleSurface(surface), options);
            const Vec3 normal = turn * Vec3::UnitX();
            body.cut(Plane(centre, normal), options);
            EXPECT_GE(topology::components(body.mesh).count, 3);
            const double edge = longest_edge(body.mesh, body.positions);
            expect_parted(body.mesh, body.positions, {centre, normal},
                          (snap > 0.0 ? 0.6 : 1e-9) * edge);
        }
}

TEST(SplitAlongSurface, WhatASphereFreesConvergesToItsVolume) {
    const SurfaceData sphere = icosphere({0.51, 0.48, 0.53}, 0.35, 3);
    std::map<int, double> missing;
    for (const int n : {4, 8, 12}) {
        SplitBody body(test::jittered_cube(n, 0.2, 3));
        body.cut(TriangleSurface(sphere));
        const auto volumes = piece_volumes(body.mesh);
        ASSERT_EQ(volumes.size(), 2u);
        missing[n] = 1.0 - volumes[1] / enclosed_volume(sphere);
        EXPECT_GT(missing[n], 0.0);
    }
    // With the square of the size of elements.
    EXPECT_LT(missing[8], missing[4] / 3.0);
    EXPECT_LT(missing[12], missing[4] / 6.5);
    EXPECT_LT(missing[12], 0.02);
}

TEST(SplitAlongSurface, AClosedOneReachingOutFreesItsInside) {
    for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SplitBody body(test::jittered_cube(6, 0.2, seed));
        const Vec3 corner(seed % 2 ? 1.0 : 0.0, seed % 3 ? 1.0 : 0.0, seed > 2 ? 1.0 : 0.0);
        const double radius = random.uniform(0.45, 0.7);
        const SurfaceData sphere = icosphere(corner + random.vector(0.02), radius, 2);
        body.cut(TriangleSurface(sphere));
        const auto volumes = piece_volumes(body.mesh);
        ASSERT_EQ(volumes.size(), 2u);
        EXPECT_NEAR(volumes[1], enclosed_volume(sphere) / 8.0, 0.12 * volumes[1]);
        // Right round the body, or far from it, it cuts nothing.
        EXPECT_TRUE(body.cut(TriangleSurface(icosphere(corner, 3.0, 1))).changes.is_empty());
        EXPECT_TRUE(body.cut(TriangleSurface(icosphere({9, 0, 0}, 3.0, 1))).changes.is_empty());
    }
}

TEST(SplitAlongSurface, AWavySheetPartsBodiesWhereverTheyAre) {
    for (const auto* family : test::tetrahedral_families()) {
        if (family->name != "cube" && family->name != "ball" && family->name != "organ") continue;
        for (const double snap : {0.0, 0.1})
            for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
                SCOPED_TRACE(family->name + ", snap " + std::to_string(snap) + ", seed " +
                             std::to_string(seed));
                Random random(seed);
                SplitBody body(family->data);
                if (seed % 2 == 1) {
                    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
                    for (int c = 0; c < 3; ++c) F.col(c) += random.vector(0.3);
                    for (Vec3& x : body.positions) x = F * x;
                }
                const double size = body.box().diagonal().norm();
                const Vec3 normal = random.vector(1.0).normalized();
                const Vec3 u = size * normal.unitOrthogonal(), v = normal.cross(u);
                const double phase = random.uniform(0.0, 6.0);
                const SurfaceData data =
                    sheet(body.box().center(), u, v, 24, [&](double s, double t) -> Vec3 {
                        return 0.05 * size * std::sin(5.0 * s + 3.0 * t + phase) * normal;
                    });
                const TriangleSurface surface(data);
                const double off = snap * longest_edge(body.mesh, body.positions);
                body.cut(surface, {snap});
                EXPECT_LE(distance_of_cut(body, surface), off + 1e-14 * size);
                EXPECT_EQ(topology::components(body.mesh).count, 2);
            }
    }
}

/// The ends of edges that only one opened face has, but for those on the outside of the unit cube:
/// where a cut ends inside. By rest positions.
std::set<std::array<double, 3>> rim_of_cut(const Mesh& mesh) {
    using Point = std::array<double, 3>;
    const auto is_outside = [](const Vec3& x) {
        return (x.array() == 0.0).any() || (x.array() == 1.0).any();
    };
    std::map<std::pair<Point, Point>, std::pair<int, bool>> edges;
    for (const auto& pair : cut_faces(mesh))
        for (int p = 0; p < 3; ++p) {
            const Vec3& x = mesh.rest_position(mesh.face_corner(pair.a, p));
            const Vec3& y = mesh.rest_position(mesh.face_corner(pair.a, (p + 1) % 3));
            const Point a = {x.x(), x.y(), x.z()}, b = {y.x(), y.y(), y.z()};
            auto& [count, may_be_outside] = edges[std::minmax(a, b)];
            ++count;
            may_be_outside = is_outside(x) && is_outside(y);
        }
    std::set<Point> boundary;
    for (const auto& [ends, edge] : edges) {
        if (edge.first != 1 || edge.second) continue;
        boundary.insert(ends.first);
        boundary.insert(ends.second);
    }
    return boundary;
}

TEST(SplitAlongSurface, AnOpenOneStaysJoinedAtItsBoundary) {
    for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SplitBody body(test::jittered_cube(8, 0.2, seed));
        const double edge = longest_edge(body.mesh, body.positions);
        // A patch in the middle of the body, or half a cut.
        const Vec3 normal = (Vec3(0, 0, 1) + random.vector(0.2)).normalized();
        const Vec3 u = normal.cross(Vec3(0, 1, 0)), v = normal.cross(u);
        const bool is_patch = seed % 2 == 0;
        const Vec3 centre(is_patch ? 0.5 : 0.0, 0.5, 0.5);
        const double reach = is_patch ? 0.35 : 2.0;
        const SurfaceData data =
            sheet(centre, (is_patch ? 0.35 : 0.6) * u, reach * v, 8,
                  [&](double s, double t) { return Vec3(0.03 * std::sin(4.0 * s + t) * normal); });
        const TriangleSurface surface(data);
        const Split done = body.cut(surface);

        EXPECT_EQ(topology::components(body.mesh).count, 1);
        EXPECT_GT(done.report.faces_opened, 20u);
        EXPECT_EQ(cut_faces(body.mesh).size(), done.report.faces_opened);
        EXPECT_LE(distance_of_cut(body, surface), 1e-14);
        // It ends within one element of the surface's boundary: what is opened is less than the
        // surface in the body, by less than that.
        if (is_patch) {
            const double whole = 0.7 * 0.7, least = std::pow(0.7 - 2.0 * edge, 2);
            EXPECT_LE(done.report.cut_area, whole * 1.05);  // for its waves
            EXPECT_GE(done.report.cut_area, least);
        } else {
            EXPECT_LE(done.report.cut_area, 0.6 * 1.1);
            EXPECT_GE(done.report.cut_area, (0.6 - edge) * 0.9);
        }
        // Nodes at the boundary are one for both sides; all others were copied.
        const auto nodes = nodes_of_cut(body.mesh);
        std::set<std::array<double, 3>> front;
        for (const VertexId node : nodes.front) {
            const Vec3& x = body.mesh.rest_position(node);
            front.insert({x.x(), x.y(), x.z()});
        }
        EXPECT_EQ(front, rim_of_cut(body.mesh));
        EXPECT_GT(nodes.parted.size(), 0u);
        std::size_t num_copies = 0;
        for (const auto& record : done.changes.nodes_added) num_copies += record.num_sources == 1;
        EXPECT_EQ(nodes.parted.size(), 2 * num_copies);
    }
}

}  // namespace
}  // namespace incise::cutting
