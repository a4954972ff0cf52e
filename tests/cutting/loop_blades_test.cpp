// Cuts of blades through cells of any shape, with a cutter: that stop and go on, are withdrawn,
// come again, and meet each other. SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/darts.h"
#include "loop_body.h"
#include "support/plane_section.h"

namespace incise::cutting {
namespace {

constexpr std::size_t num_unjoined_kinds = num_kinds_of_loops - 2;

TEST(LoopSplitter, CutsNothingMoreAtTheSamePlace) {
    for_bodies(
        3, 4,
        [](Body& whole, Random& random) {
            CutBody body(whole.data);
            const auto planes = random_planes(random, 1);
            std::size_t num_cells = 0;
            for (int pass = 0; pass < 6; ++pass) {
                const StraightPath path(planes[0], 0.3 * pass);
                const CutId cut = body.cutter.begin_cut(default_snap);
                body.lead(cut, path, -2.0, 2.0, 5 + 3 * pass);
                EXPECT_FALSE(body.cutter.is_in_tissue(cut));
                body.cutter.remove_cut(cut);
                if (pass == 0) num_cells = body.mesh.num_elements();
                EXPECT_EQ(body.mesh.num_elements(), num_cells) << "pass " << pass;
            }
            body.cut_along(Plane(planes[0].point, planes[0].normal));
            EXPECT_EQ(body.mesh.num_elements(), num_cells);
            expect_parts(body, planes, 3e-3);
        },
        num_kinds_of_loops);
}

/// Two blades by turns, and one along a plane through nodes of the mesh.
TEST(LoopSplitter, CutsNothingMoreAlongTheSamePaths) {
    for (const bool is_lattice_plane : {false, true})
        for_bodies(
            6, 4,
            [&](Body& whole, Random& random) {
                CutBody body(whole.data);
                const auto planes =
                    is_lattice_plane ? lattice_planes(random, 1) : random_planes(random, 2);
                std::size_t num_cells = 0;
                for (int pass = 0; pass < 4; ++pass) {
                    body.lead_by_turns(planes, 8, 0.3 * pass);
                    if (pass == 0) num_cells = body.mesh.num_elements();
                    EXPECT_EQ(body.mesh.num_elements(), num_cells) << "pass " << pass;
                }
                const auto volumes = body.rest_volumes(), expected = exact_volumes(planes);
                ASSERT_EQ(volumes.size(), expected.size());
            },
            num_kinds_of_loops);
}

/// Also in the same step, before the tissue has moved.
TEST(LoopSplitter, CutsNothingMoreAlongTheSamePlane) {
    for (const bool has_steps : {true, false})
        for_bodies(
            4, 4,
            [&](Body& whole, Random& random) {
                CutBody body(whole.data);
                const auto planes = random_planes(random, 1);
                body.cutter.follow_motion(body.mesh, body.positions);
                for (int pass = 0; pass < 4; ++pass) {
                    if (has_steps) body.cutter.follow_motion(body.mesh, body.positions);
                    body.follow(body.cutter.split(
                        body.mesh, Plane(planes[0].point, planes[0].normal), default_snap));
                }
                expect_parts(body, planes, 2e-3);
            },
            num_kinds_of_loops);
}

TEST(LoopSplitter, MayBeWithdrawnAndComeBack) {
    for_bodies(
        4, 4,
        [](Body& whole, Random& random) {
            CutBody body(whole.data);
            const auto planes = random_planes(random, 1);
            const StraightPath path(planes[0]);
            const CutId cut = body.cutter.begin_cut(default_snap);
            double at = -2.0;
            for (const double to : {0.1, -0.15, 0.3, -2.0, 0.35, 0.2, 2.0, -2.0}) {
                body.lead(cut, path, at, to, 9);
                at = to;
            }
            expect_parts(body, planes, 3e-3);
            EXPECT_FALSE(body.cutter.is_in_tissue(cut));
        },
        num_kinds_of_loops);
}

/// An upright edge goes into a cube and turns in it: a wedge comes off. Arms that are nearer to
/// each other than a tenth of an edge can be taken for one path: a few bodies stay joined.
TEST(LoopSplitter, PartsABodyAlongAPathThatTurnsInIt) {
    int num_bodies = 0, num_wrong = 0;
    for (const int num_steps : {1, 12})
        for_bodies(20, 3, [&](Body& whole, Random& random) {
            const double x = random.uniform(0.3, 0.7), depth = random.uniform(0.3, 0.8);
            const std::array corners{Vec3(x + random.uniform(-0.25, 0.25), -0.1, 0.0),
                                     Vec3(x, depth, 0.0),
                                     Vec3(x + random.uniform(-0.25, 0.25), -0.1, 0.0)};
            const double width = std::abs(corners[0].x() - corners[2].x()) * depth / (depth + 0.1);
            if (width < 0.05) return;
            const auto edge = [&](std::size_t arm, double share) {
                const Vec3 at = corners[arm] + share * (corners[arm + 1] - corners[arm]);
                return std::vector<Vec3>{at - Vec3::UnitZ(), at + 2.0 * Vec3::UnitZ()};
            };
            CutBody body(whole.data);
            const CutId cut = body.cutter.begin_cut(default_snap);
            for (const std::size_t arm : {0u, 1u})
                for (int i = 0; i < num_steps; ++i)
                    body.move(cut, edge(arm, 1.0 * i / num_steps),
                              edge(arm, (i + 1.0) / num_steps));
            const std::vector<double> volumes = body.rest_volumes();
            const double rest = *std::ranges::max_element(volumes);
            ++num_bodies;
            num_wrong += volumes.size() < 2 || std::abs(1.0 - 0.5 * width * depth - rest) > 0.02;
        });
    EXPECT_GT(num_bodies, 0);
    EXPECT_LE(num_wrong, num_bodies / 40);
}

TEST(LoopSplitter, StopsOnNodesEdgesAndFaces) {
    for_bodies(
        20, 4,
        [](Body& whole, Random& random) {
            CutBody body(whole.data);
            // A plane through a node; half of them in directions of the lattice.
            const auto node = [&] {
                return body.mesh.rest_position(VertexId(random.below(body.mesh.node_capacity())));
            };
            Divider plane;
            for (;;) {
                plane.point = node();
                plane.normal = random.below(2) == 0 ? Vec3(random.grid_point(3) - Vec3::Ones())
                                                    : random.vector(1.0);
                if (plane.normal.norm() < 0.1) continue;
                plane.normal.normalize();
                const auto parts = exact_volumes({plane});
                if (parts.size() == 2 && parts.front() > 2e-2) break;
            }
            const StraightPath path(plane, random.uniform(0.0, 6.0));
            // It stops where it meets nodes, middles of edges and of faces.
            std::vector<double> stops;
            for (int i = 0; i < 6; ++i) {
                Vec3 x = node();
                const std::size_t what = random.below(3);
                for (std::size_t k = 0; k < what; ++k) x += node();
                stops.push_back((x / static_cast<double>(what + 1) - plane.point).dot(path.v));
            }
            if (random.below(3) != 0) std::ranges::sort(stops);  // else it goes back and on
            stops.push_back(2.0);
            const CutId cut = body.cutter.begin_cut(default_snap);
            double at = -2.0;
            for (const double to : stops) {
                body.move(cut, path.edge(at), path.edge(to));
                at = to;
            }
            const auto volumes = body.rest_volumes();
            EXPECT_NEAR(Body::sum(volumes), body.volume_before, 1e-13);
            const auto expected = exact_volumes({plane});
            std::vector<double> large;
            for (const double v : volumes)
                if (v > 5e-3) large.push_back(v);
            ASSERT_EQ(large.size(), 2u);
            EXPECT_NEAR(large.front(), expected.front(), 1e-2);
        },
        num_kinds_of_loops);
}

/// Blades go by turns through a body, and each crosses what the others have not finished.
TEST(LoopSplitter, PartsABodyAlongThePathsOfSeveralBladesAtATime) {
    for (const int num_blades : {2, 3})
        for (const int num_steps : {7, 30})
            for_bodies(
                6, 4,
                [&](Body& whole, Random& random) {
                    CutBody body(whole.data);
                    const auto planes = random_planes(random, num_blades);
                    std::vector<StraightPath> paths;
                    std::vector<CutId> cuts;
                    for (const Divider& plane : planes) {
                        paths.emplace_back(plane, static_cast<double>(paths.size()));
                        cuts.push_back(body.cutter.begin_cut(default_snap));
                    }
                    for (int i = 0; i < num_steps; ++i) {
                        body.cutter.follow_motion(body.mesh, body.positions);
                        for (std::size_t k = 0; k < cuts.size(); ++k)
                            body.follow(body.cutter.split(
                                cuts[k], body.mesh, paths[k].edge(-2.0 + 4.0 * i / num_steps),
                                paths[k].edge(-2.0 + 4.0 * (i + 1) / num_steps)));
                    }
                    expect_parts(body, planes, 5e-3);
                    body.expect_replay();
                },
                num_kinds_of_loops);
}

TEST(LoopFront, IsNotOnAMeshThatLacksItsNodes) {
    const Mesh mesh =
        Mesh::build(topology::box_mesh(CellKind::hexahedron, Vec3::Zero(), Vec3::Ones(), {1, 1, 1}))
            .mesh;
    const VertexId here(0), there(8);
    const auto is_on = [&](auto change) {
        LoopFront front;
        change(front);
        return front.is_on(mesh);
    };
    EXPECT_TRUE(is_on([&](LoopFront& front) { front.toggle_passed({here, VertexId(7)}); }));
    EXPECT_FALSE(is_on([&](LoopFront& front) { front.put_on(there, 1.0); }));
    EXPECT_FALSE(is_on([&](LoopFront& front) { front.mark(here, there); }));
    EXPECT_FALSE(is_on([&](LoopFront& front) { front.toggle_passed({here, there}); }));
    EXPECT_FALSE(is_on([&](LoopFront& front) { front.toggle_passed({there, here}); }));
    EXPECT_FALSE(is_on([&](LoopFront& front) { front.set_open(CellId(0), here, there); }));
    EXPECT_FALSE(is_on([&](LoopFront& front) { front.set_open(CellId(1), here, here); }));
    EXPECT_FALSE(is_on([&](LoopFront& front) {
        front.put_on(here, 1.0);
        front.set_waiting(mesh, {CellId(0), 0}, there, true);
    }));
}

/// Their planes go through nodes of the mesh, and they stop in each other's planes. Some 10 of 120
/// seeds leave faces that contradict each other, or a body whole, with any kind of cells. Of the
/// first 12 these are none but one of the joined bodies, which are left out.
TEST(LoopSplitter, PartsABodyAlongLatticePlanesOfTwoBladesAtATime) {
    for_bodies(
        12, 4,
        [](Body& whole, Random& random) {
            CutBody body(whole.data);
            const auto planes = lattice_planes(random, 2);
            std::vector<CutId> cuts;
            for (std::size_t k = 0; k < planes.size(); ++k)
                cuts.push_back(body.cutter.begin_cut(default_snap));
            constexpr int num_steps = 8;
            for (int i = 0; i < num_steps; ++i) {
                body.cutter.follow_motion(body.mesh, body.positions);
                for (std::size_t k = 0; k < planes.size(); ++k) {
                    const StraightPath path(planes[k]);
                    body.follow(body.cutter.split(cuts[k], body.mesh,
                                                  path.edge(-2.0 + 4.0 * i / num_steps),
                                                  path.edge(-2.0 + 4.0 * (i + 1) / num_steps)));
                }
                for (const CutId cut : cuts)
                    EXPECT_TRUE(body.cutter.contradictory_faces(cut, body.mesh).empty());
            }
            const auto volumes = body.rest_volumes(), expected = exact_volumes(planes);
            EXPECT_NEAR(Body::sum(volumes), body.volume_before, 1e-13);
            std::vector<double> large;  // but for what is between a plane and the nodes beside it
            for (const double v : volumes)
                if (v > 1.5e-3) large.push_back(v);
            ASSERT_EQ(large.size(), expected.size());
            for (std::size_t i = 0; i < large.size(); ++i) EXPECT_NEAR(large[i], expected[i], 2e-3);
        },
        num_unjoined_kinds);
}

/// The section of a cell with a plane, as corners round it, m. For convex cells.
Polygon section_of(const Mesh& mesh, CellId e, const Divider& plane) {
    Polygon section;
    for (int f = 0; f < mesh.num_faces(e); ++f)
        for (int p = 0; p < mesh.face_size({e, f}); ++p) {
            const topology::Dart d{{e, f}, p};
            const Vec3 &a = mesh.rest_position(from(mesh, d)), &b = mesh.rest_position(to(mesh, d));
            const double from_height = plane.height(a), to_height = plane.height(b);
            if (from(mesh, d) < to(mesh, d) && (from_height < 0.0) != (to_height < 0.0))
                section.push_back(a + from_height / (from_height - to_height) * (b - a));
        }
    if (section.size() < 3) return {};
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : section) centre += x / static_cast<double>(section.size());
    const Vec3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
    std::ranges::sort(section, {}, [&](const Vec3& x) {
        return std::atan2((x - centre).dot(v), (x - centre).dot(u));
    });
    return section;
}

/// The share of a section that is behind a line across `ahead` through `stop`.
double share_behind(const Polygon& section, const Vec3& stop, const Vec3& ahead) {
    Polygon behind;
    for (std::size_t i = 0; i < section.size(); ++i) {
        const Vec3 &x = section[i], &y = section[(i + 1) % section.size()];
        const double a = ahead.dot(x - stop), b = ahead.dot(y - stop);
        if (a <= 0.0) behind.push_back(x);
        if (a * b < 0.0) behind.push_back(x + a / (a - b) * (y - x));
    }
    return behind.size() < 3 ? 0.0 : test::polygon_area(behind) / test::polygon_area(section);
}

/// True if is_cut(where, a, b) is for each edge of a cell through which a plane goes.
template <class IsCut>
bool is_cut_all_round(const Mesh& mesh, CellId e, const Divider& plane, IsCut is_cut) {
    for (int f = 0; f < mesh.num_faces(e); ++f)
        for (int p = 0; p < mesh.face_size({e, f}); ++p) {
            const topology::Dart d{{e, f}, p};
            const VertexId a = from(mesh, d), b = to(mesh, d);
            const double height = plane.height(mesh.rest_position(a)),
                         other = plane.height(mesh.rest_position(b));
            if ((height < 0.0) == (other < 0.0)) continue;
            const Vec3 edge = mesh.rest_position(b) - mesh.rest_position(a);
            if (!is_cut(mesh.rest_position(a) + height / (height - other) * edge, a, b))
                return false;
        }
    return true;
}

/// True if a cell reaches to one side of a plane by less than a cut's tolerance at nodes: there the
/// cut goes along faces of it.
bool is_grazed(const Mesh& mesh, CellId e, const Divider& plane) {
    double least = 0.0, most = 0.0, longest = 0.0;
    for (const VertexId a : mesh.corners(e)) {
        const double height = plane.height(mesh.rest_position(a));
        least = std::min(least, height);
        most = std::max(most, height);
        for (const VertexId b : mesh.corners(e))
            longest = std::max(longest, (mesh.rest_position(a) - mesh.rest_position(b)).norm());
    }
    return std::min(most, -least) <= 0.5 * default_snap * longest;
}

/// A carrier that is cut in part moves as if it were whole, but for one that is cut all round.
TEST(LoopSplitter, EndsWithEveryCellPartedOrWhole) {
    for (const int num_steps : {1, 6})
        for_bodies(6, 4, [&](Body& whole, Random& random) {
            CutBody body(whole.data);
            const fragments::FragmentMesh fragments_before(body.mesh);
            fragments::FragmentMesh fragments = fragments_before;
            const auto planes = random_planes(random, 1);
            const StraightPath path(planes[0], random.uniform(0.0, 6.0));
            const double stop = random.uniform(-0.2, 0.2);
            const CutId cut = body.cutter.begin_cut(default_snap);
            for (int i = 0; i < num_steps; ++i)
                fragments.apply(body.mesh,
                                body.move(cut, path.edge(-2.0 + (stop + 2.0) * i / num_steps),
                                          path.edge(-2.0 + (stop + 2.0) * (i + 1) / num_steps))
                                    .changes);
            fragments.apply(body.mesh,
                            body.follow(body.cutter.end_cut(cut, body.mesh, fragments,
                                                            {path.edge(stop), {path.v, path.v}}))
                                .changes);
            EXPECT_FALSE(body.cutter.is_in_tissue(cut));
            EXPECT_NEAR(Body::sum(body.rest_volumes()), body.volume_before, 1e-13);
            std::size_t num_parted = 0, num_at_edge = 0;
            std::vector<int> num_parts(fragments_before.element_capacity());
            for (const CellId e : body.mesh.elements())
                ++num_parts[fragments.carrier_of_cell(e).index()];
            const Mesh uncut = Mesh::build(whole.data).mesh;
            for (const CellId e : uncut.elements()) {
                const Polygon section = section_of(uncut, e, planes[0]);
                if (section.size() < 3) {
                    EXPECT_EQ(num_parts[e.index()], 1);
                    continue;
                }
                const double share = share_behind(section, path.edge(stop)[0], path.v);
                num_parted += num_parts[e.index()] > 1;
                num_at_edge += share > 0.0 && share < 1.0;
                // Near a half, the nodes beside the plane decide.
                if (std::abs(share - 0.5) < 0.05 || is_grazed(uncut, e, planes[0])) continue;
                if (share > 0.5) {
                    EXPECT_GT(num_parts[e.index()], 1) << share;
                } else if (num_parts[e.index()] > 1) {
                    EXPECT_TRUE(is_cut_all_round(
                        uncut, e, planes[0],
                        [&](const Vec3& x, VertexId a, VertexId b) {
                            if (path.v.dot(x - path.edge(stop)[0]) < 1e-9) return true;
                            return std::ranges::any_of(uncut.elements(), [&](CellId other) {
                                return num_parts[other.index()] > 1 && other != e &&
                                       uncut.corner_of(other, a) >= 0 &&
                                       uncut.corner_of(other, b) >= 0;
                            });
                        }))
                        << share;
                }
            }
            EXPECT_GT(num_parted, 0u);
            EXPECT_GT(num_at_edge, 0u);
        });
}

}  // namespace
}  // namespace incise::cutting
