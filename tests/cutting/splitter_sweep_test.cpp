// Splitting by a blade: what it leaves, in tissue that is still or moves.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "blade_path.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_metrics.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::MeshSnapshot;
using test::Random;

TEST(SplitByBlade, RightThroughLeavesTheTwoHalves) {
    for (const auto* family : test::tetrahedral_families()) {
        if (family->name != "cube" && family->name != "ball") continue;
        for (const double snap : {0.0, 0.05, 0.1})
            for (const int num_steps : {1, 5, 30})
                for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
                    SCOPED_TRACE(testing::Message()
                                 << family->name << ", snap " << snap << ", seed " << seed << ", "
                                 << num_steps << " steps");
                    Random random(seed);
                    SplitBody body(family->data);
                    const BladePath path(body.box(), random);
                    const double off = snap * longest_edge(body.mesh, body.positions);
                    const auto volume = [&](double height, int side) {
                        return volume_above(body.mesh, body.positions,
                                            path.point + height * path.normal, side * path.normal);
                    };
                    const double rest = rest_volume(body.mesh);
                    const double least = std::max(volume(off, 1), volume(-off, -1)) - 1e-9 * rest;
                    const double most = std::max(volume(-off, 1), volume(off, -1)) + 1e-9 * rest;
                    body.cut(sweep(path.from, path.to, num_steps), {snap});
                    const auto volumes = piece_volumes(body.mesh);
                    ASSERT_EQ(volumes.size(), 2u);
                    EXPECT_GE(volumes[0], least);
                    EXPECT_LE(volumes[0], most);
                    EXPECT_NEAR(volumes[0] + volumes[1], rest, 1e-12 * rest);
                }
    }
}

TEST(SplitByBlade, RetracingOrRepeatingAStrokeChangesNothing) {
    static constexpr std::array shares{0.5, 1.0};
    static constexpr std::array numbers_of_steps{6, 1};
    for (const auto* family : test::tetrahedral_families())
        for (const double share : test::some_of(shares))
            for (const int num_steps : test::some_of(numbers_of_steps))
                for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
                    SCOPED_TRACE(testing::Message()
                                 << family->name << ", seed " << seed << ", " << share
                                 << " of the way in " << num_steps << " steps");
                    Random random(seed);
                    SplitBody body(family->data);
                    const BladePath path(body.box(), random, share);
                    std::optional<CutId> front;
                    for (const auto& part : sweep(path.from, path.to, num_steps))
                        body.cut(part, front, {0.0});
                    const MeshSnapshot once(body.mesh);
                    for (const auto& part : sweep(path.to, path.from, num_steps))
                        body.cut(part, front, {0.0});
                    EXPECT_EQ(MeshSnapshot(body.mesh), once);
                    body.cut(sweep(path.from, path.to, num_steps));
                    EXPECT_EQ(MeshSnapshot(body.mesh), once);
                }
}

// At any time, what is open is what the blade has left behind, but for one element at the front.
TEST(SplitByBlade, TheFrontFollowsWithinOneElement) {
    for (const double snap : {0.0, 0.1})
        for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE(testing::Message() << "snap " << snap << ", seed " << seed);
            SplitBody body(test::jittered_cube(8, 0.2, seed));
            const double edge = longest_edge(body.mesh, body.positions);
            std::optional<CutId> front;
            constexpr int num_steps = 50;
            double area = 0.0;
            for (int i = 0; i < num_steps; ++i) {
                const double from = -0.1 + 1.2 * i / num_steps, to = from + 1.2 / num_steps;
                const StrokePart step({{0.53, -1, from}, {0.53, 2, from}},
                                      {{0.53, -1, to}, {0.53, 2, to}});
                area += body.cut(step, front, {snap}).report.cut_area;
                const double passed = std::clamp(to, 0.0, 1.0);
                // Nodes that are snapped make the sheet uneven.
                EXPECT_LE(area, (snap > 0.0 ? 1.2 : 1.0 + 1e-12) * (passed + snap * edge));
                EXPECT_GE(area, passed - (1.0 + snap) * edge);
                for (const VertexId n : nodes_of_cut(body.mesh).front) {
                    const double z = body.positions[n.index()].z();
                    EXPECT_GE(z, to - (1.0 + snap) * edge);
                    EXPECT_LE(z, to + snap * edge + 1e-12);
                }
            }
            EXPECT_EQ(topology::components(body.mesh).count, 2);
        }
}

/// Tissue that turns and waves; the blade's edge waves besides. t from 0 to 1.
struct MovingCut {
    Box box;
    double size, strength;
    Vec3 normal, u, v;

    MovingCut(const Box& b, Random& random, double by)
        : box(b), size(b.diagonal().norm()), strength(by) {
        normal = random.vector(1.0).normalized();
        u = normal.unitOrthogonal();
        v = normal.cross(u);
    }
    Vec3 position(const Vec3& X, double t) const {
        const Vec3 r = (X - box.center()) / size;
        const double s = strength * std::sin(9.0 * t);
        return X + 0.1 * size * s * Vec3(r.y() + 0.3 * std::sin(4.0 * r.z()), -r.x(), 0.3 * r.z());
    }
    Polyline edge(double t) const {
        Polyline points;
        for (int i = 0; i <= 3; ++i)
            points.push_back(box.center() +
                             size * ((i - 1.5) * u + (2.0 * t - 1.0) * v +
                                     0.05 * strength * std::sin(6.0 * t + 2.0 * i) * normal));
        return points;
    }
    std::vector<double> volumes(const topology::MeshData& data, int num_steps,
                                const SplitOptions& options) const {
        SplitBody body(data);
        std::optional<CutId> front;
        for (Vec3& x : body.positions) x = position(x, 0.0);
        for (int i = 0; i < num_steps; ++i) {
            const double t0 = static_cast<double>(i) / num_steps;
            const double t1 = static_cast<double>(i + 1) / num_steps;
            std::vector<Vec3> moved;
            for (std::size_t n = 0; n < body.mesh.node_capacity(); ++n)
                moved.push_back(position(body.mesh.rest_position(VertexId(n)), t1));
            body.cut({edge(t0), edge(t1)}, front, options, moved);
        }
        return piece_volumes(body.mesh);
    }
};

TEST(SplitByBlade, ConvergesWithTheStepsInMovingTissue) {
    static constexpr std::array strengths{1.0, 0.3};
    for (const double strength : test::some_of(strengths))
        for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
            Random random(seed);
            const auto data = test::jittered_cube(test::is_sanitized ? 3 : 6, 0.2, seed);
            const MovingCut cut(SplitBody(data).box(), random, strength);
            const auto converged = cut.volumes(data, 240, {0.0});
            ASSERT_EQ(converged.size(), 2u);
            double coarse = 0.0, fine = 0.0;
            for (const int num_steps : {2, 7, 15, 30, 60, 120}) {
                SCOPED_TRACE(testing::Message() << "strength " << strength << ", seed " << seed
                                                << ", " << num_steps << " steps");
                for (const double snap : {0.0, 0.1}) {
                    const auto volumes = cut.volumes(data, num_steps, {snap});
                    ASSERT_EQ(volumes.size(), 2u) << "snap " << snap;
                    EXPECT_NEAR(volumes[0] + volumes[1], 1.0, 1e-12);
                    if (snap > 0.0) continue;
                    const double error = std::abs(volumes[0] - converged[0]);
                    if (num_steps == 7) coarse = error;
                    if (num_steps == 120) fine = error;
                }
            }
            EXPECT_LT(fine, 2e-3);
            EXPECT_LT(fine, 0.2 * coarse + 1e-4);
        }
}

/// The edge of a blade right across a body of width one in y, from one corner of the way to the
/// next in equal parts of about `part`.
Stroke way_of_edge(const std::vector<std::array<double, 2>>& corners, double part) {
    const auto edge = [](double x, double z) { return Polyline{{x, -0.1, z}, {x, 1.1, z}}; };
    Stroke stroke;
    Polyline from = edge(corners[0][0], corners[0][1]);
    for (std::size_t c = 1; c < corners.size(); ++c) {
        const auto [x0, z0] = corners[c - 1];
        const auto [x1, z1] = corners[c];
        const int n = std::max(1, static_cast<int>(std::hypot(x1 - x0, z1 - z0) / part));
        for (int i = 1; i <= n; ++i) {
            Polyline to = edge(x0 + (x1 - x0) * i / n, z0 + (z1 - z0) * i / n);
            stroke.emplace_back(from, to);
            from = std::move(to);
        }
    }
    return stroke;
}

// At round places the edge comes to rest just where it crosses edges of the mesh, and rounding
// takes the new nodes to one or the other side of it.
TEST(SplitByBlade, ThatStopsAtMeshEdgesPartsTheBody) {
    static constexpr std::array numbers_of_bricks{4, 8};
    static constexpr std::array places{0.41, 0.35, 0.5};
    for (const int n : test::some_of(numbers_of_bricks))
        for (const double at : test::some_of(places))
            for (const double part : {0.05, 0.1})
                for (const double snap : {0.0, 0.05, 0.1})
                    for (const bool along_x : {true, false}) {
                        SCOPED_TRACE(testing::Message()
                                     << n << " bricks, at " << at << ", parts of " << part
                                     << ", snap " << snap);
                        SplitBody body(topology::box_mesh(topology::CellKind::tetrahedron,
                                                          Vec3::Zero(), Vec3::Ones(), {n, n, n}));
                        body.cut(along_x ? way_of_edge({{-0.1, at}, {1.1, at}}, part)
                                         : way_of_edge({{at, 1.1}, {at, -0.1}}, part),
                                 SplitOptions{snap});
                        ASSERT_EQ(topology::components(body.mesh).count, 2);
                    }
}

// Where an edge lies all but in the cut both of its ends are near: if both counted as on it, whole
// layers of flat or long elements would, and come off in flakes, or hold the halves together.
TEST(SplitByBlade, PartsLongAndFlatElementsInTwo) {
    static constexpr std::array<std::array<int, 3>, 4> numbers_of_bricks{
        {{10, 2, 10}, {20, 4, 20}, {6, 6, 24}, {8, 24, 8}}};
    for (const auto& bricks : test::some_of(numbers_of_bricks))
        for (const double part : {0.02, 0.05, 9.0})
            for (const double snap : {0.3, default_snap})
                for (std::uint64_t seed = 0; seed < 2; ++seed) {
                    SCOPED_TRACE(testing::Message() << bricks[0] << " x " << bricks[1] << " x "
                                                    << bricks[2] << ", parts of " << part
                                                    << ", snap " << snap << ", seed " << seed);
                    Random random(seed);
                    const double from = random.uniform(0.3, 0.5), to = random.uniform(0.4, 0.6);
                    SplitBody body(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                      Vec3::Ones(), bricks));
                    body.cut(way_of_edge({{-0.1, from}, {1.2, to}}, part), SplitOptions{snap});
                    ASSERT_EQ(topology::components(body.mesh).count, 2);
                }
}

// On its way through a long element the blade is far away, measured by the edges that it has
// divided, before it comes to the next: until then the element's nodes are at the front.
TEST(SplitByBlade, RemembersElementsThatAreLongInItsDirection) {
    for (const double snap : {0.0, 0.01, default_snap})
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(testing::Message() << "snap " << snap << ", seed " << seed);
            Random random(seed);
            const double from = random.uniform(0.3, 0.7), to = from + random.uniform(-0.1, 0.1);
            SplitBody body(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                              Vec3::Ones(), {3, 1, 20}));
            body.cut(way_of_edge({{-0.1, from}, {1.1, to}}, 0.02), SplitOptions{snap});
            ASSERT_EQ(topology::components(body.mesh).count, 2);
        }
}

// Each ends beside others, and cuts again what they have cut; what they had to leave joined at
// their borders is not taken for finished.
TEST(SplitByBlade, StrokesOverlappingByAnElementPartTheBody) {
    for (const double snap : {0.0, default_snap, 0.1})
        for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
            SCOPED_TRACE(testing::Message() << "snap " << snap << ", seed " << seed);
            Random random(seed);
            SplitBody body(test::jittered_cube(5, 0.2, seed));
            const SplitOptions options = SplitOptions{snap};
            const double overlap = longest_edge(body.mesh, body.positions);
            const Vec3 centre = Vec3::Constant(0.5) + random.vector(0.1);
            const Vec3 across = random.vector(1.0).normalized();
            const Vec3 u = across.unitOrthogonal(), v = across.cross(u);
            std::vector<std::array<double, 2>> tiles;
            constexpr double width = 0.75;
            for (const double x : {-1.125, -0.375, 0.375})
                for (const double y : {-1.125, -0.375, 0.375}) tiles.push_back({x, y});
            for (std::size_t i = tiles.size(); i-- > 1;)
                std::swap(tiles[i], tiles[random.below(i + 1)]);
            for (const auto& [x, y] : tiles) {
                const auto edge_at = [&](double at) -> Polyline {
                    return {centre + (x - overlap) * u + at * v,
                            centre + (x + width + overlap) * u + at * v};
                };
                const int num_steps = 1 + static_cast<int>(random.below(8));
                body.cut(sweep(edge_at(y - overlap), edge_at(y + width + overlap), num_steps),
                         options);
            }
            EXPECT_GE(topology::components(body.mesh).count, 2);
            expect_parted(body.mesh, body.positions, {centre, across},
                          (3.0 * snap + 1e-9) * overlap);
        }
}

// It ends in the body and slides out along itself, so that it crosses nothing: the boundary where
// it was is there no more.
TEST(SplitByBlade, DrawnOutAlongItselfLeavesItsCut) {
    for (const double snap : {0.0, default_snap}) {
        SplitBody body(test::jittered_cube(4, 0.2, 1));
        std::optional<CutId> front;
        const auto go = [&](const Polyline& from, const Polyline& to) {
            for (const auto& part : sweep(from, to, 8)) body.cut(part, front, SplitOptions{snap});
        };
        const Polyline above{{0.53, 0.4, -0.1}, {0.53, 1.5, -0.1}};
        const Polyline inside{{0.53, 0.4, 0.55}, {0.53, 1.5, 0.55}};
        go(above, inside);
        EXPECT_TRUE(body.cutter().is_in_tissue(*front));
        go(inside, {{0.53, 4.4, 0.55}, {0.53, 5.5, 0.55}});
        EXPECT_FALSE(body.cutter().is_in_tissue(*front));
    }
}

TEST(SplitByBlade, CrossingItsPathWithSnapLeavesFourComponents) {
    static constexpr std::array<std::array<int, 3>, 3> numbers_of_bricks{
        {{10, 2, 10}, {6, 6, 6}, {20, 4, 20}}};
    for (const auto& bricks : test::some_of(numbers_of_bricks))
        for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
            SCOPED_TRACE(testing::Message() << bricks[0] << " bricks along x, seed " << seed);
            Random random(seed);
            const double z = random.uniform(0.3, 0.5), x = random.uniform(0.4, 0.6);
            SplitBody body(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                              Vec3::Ones(), bricks));
            body.cut(way_of_edge({{-0.1, z}, {1.2, z}, {1.2, 1.2}, {x, 1.2}, {x, -0.1}},
                                 seed % 2 == 0 ? 0.05 : 9.0),
                     SplitOptions{default_snap});
            ASSERT_EQ(topology::components(body.mesh).count, 4);
        }
}

/// Whether some piece has nodes of both sides x = 0 and x = 1.
bool are_sides_joined(const topology::Mesh& mesh) {
    const topology::Components components = topology::components(mesh);
    std::set<int> left, right;
    for (const CellId e : mesh.elements()) {
        for (const VertexId n : mesh.corners(e)) {
            const double x = mesh.rest_position(n).x();
            if (x == 0.0) left.insert(components.of_element[e.index()]);
            if (x == 1.0) right.insert(components.of_element[e.index()]);
        }
    }
    return std::any_of(left.begin(), left.end(), [&](int piece) { return right.contains(piece); });
}

// It meets again what it has cut a little earlier, some of which it has left behind by then.
TEST(SplitByBlade, ReturningBesideItsPathPartsTheBody) {
    for (const double snap : {0.0, 0.05})
        for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::num_cases(60));
             ++seed) {
            SCOPED_TRACE(testing::Message() << "snap " << snap << ", seed " << seed);
            Random random(seed);
            const int n = 3 + static_cast<int>(seed % 4);
            SplitBody body(seed % 2 == 0
                               ? test::jittered_cube(n, 0.2, seed)
                               : topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                    Vec3::Ones(), {n, n, n}));
            const bool is_wavering = seed % 3 == 0;
            std::vector<std::array<double, 2>> way{{random.uniform(0.4, 0.6), 1.3}};
            if (is_wavering) {
                for (auto [x, z] = way[0]; z > -0.3;) {
                    z += random.uniform(-0.3, 0.15);
                    x = std::clamp(x + random.uniform(-0.02, 0.02), 0.35, 0.65);
                    way.push_back({x, z});
                }
            } else {
                const double beside = random.uniform(-0.06, 0.06), low = random.uniform(0.2, 0.7);
                way.push_back({way[0][0], low});
                way.push_back({way[0][0] + beside, low + random.uniform(0.05, 0.6)});
                way.push_back({way[0][0] + 2.0 * beside, -0.3});
            }
            body.cut(way_of_edge(way, seed % 5 == 0 ? 9.0 : 0.07), SplitOptions{snap});
            ASSERT_FALSE(are_sides_joined(body.mesh));
        }
}

// Where it has been before is another cut.
TEST(SplitByBlade, CrossingItsPathLeavesFourComponents) {
    for (std::uint64_t seed = 0; seed < test::num_cases(24); ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Random random(seed);
        const double z = random.uniform(0.3, 0.5), x = random.uniform(0.4, 0.6);
        SplitBody body(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                          Vec3::Ones(), {10, 2, 10}));
        body.cut(way_of_edge({{-0.1, z}, {1.2, z}, {1.2, 1.2}, {x, 1.2}, {x, -0.1}},
                             seed % 2 == 0 ? 0.05 : 9.0));
        const auto volumes = piece_volumes(body.mesh);
        ASSERT_EQ(volumes.size(), 4u);
        EXPECT_NEAR(volumes[3], std::min({x * z, (1 - x) * z, x * (1 - z), (1 - x) * (1 - z)}),
                    1e-12);
    }
}

// From element to element it is far away from where it has crossed its earlier way, a hundredth of
// an element beside a plane of nodes.
TEST(SplitByBlade, CrossingItsPathBesideNodesLeavesFourComponents) {
    static constexpr std::array<std::array<double, 3>, 3> ways{
        {{0.403704, 0.499921, 0.05},
         {0.416506985, 0.583315689, 0.056774151},
         {0.499910597, 0.499972579, 0.048991445}}};
    for (const auto& [z, x, part] : test::some_of(ways))
        for (const double snap : {0.0, 0.01}) {
            SCOPED_TRACE(testing::Message() << "z " << z << ", x " << x << ", snap " << snap);
            SplitBody body(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                              Vec3::Ones(), {12, 1, 12}));
            body.cut(way_of_edge({{-0.1, z}, {1.2, z}, {1.2, 1.2}, {x, 1.2}, {x, -0.1}}, part),
                     SplitOptions{snap});
            ASSERT_EQ(topology::components(body.mesh).count, 4);
        }
}

}  // namespace
}  // namespace incise::cutting
