// Splitting along planes in general position: against the volumes of plain geometry, and what an
// edit has to say of itself.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "incise/base/error.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/fragments/validate.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/validate.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::MeshSnapshot;
using test::Random;
using topology::Mesh;
using topology::MeshData;

constexpr int num_seeds = test::num_cases(12);

std::vector<const test::MeshFamily*> convex_families() {
    std::vector<const test::MeshFamily*> families;
    for (const auto* family : test::tetrahedral_families())
        if (family->name == "one tetrahedron" || family->name == "cube" || family->name == "ball")
            families.push_back(family);
    return families;
}

/// A plane that passes well through the body.
struct Halves {
    Vec3 point, normal;

    Halves(std::span<const Vec3> positions, Random& random) {
        Vec3 mean = Vec3::Zero();
        for (const Vec3& x : positions) mean += x / static_cast<double>(positions.size());
        point = 0.6 * mean + 0.4 * positions[random.below(positions.size())] + random.vector(0.01);
        do normal = random.vector(3.0);
        while (normal.norm() < 0.3);
    }
    Plane plane() const { return {point, normal}; }
    double height(const Vec3& x) const { return (x - point).dot(normal.normalized()); }
    Vec3 raised(double by) const { return point + by * normal.normalized(); }
};

/// Volumes of the pieces above and below, which there must be two of.
std::pair<double, double> volumes_of_halves(const SplitBody& body, const Halves& halves) {
    const auto pieces = topology::components(body.mesh);
    EXPECT_EQ(pieces.count, 2);
    // The piece with the highest node is the one above.
    double highest = -std::numeric_limits<double>::infinity();
    int upper = 0;
    std::array<double, 2> volumes{};
    for (std::size_t i = 0; i < body.mesh.element_capacity(); ++i) {
        for (const VertexId n : body.mesh.corners(CellId(i))) {
            const double height = halves.height(body.positions[n.index()]);
            if (height <= highest) continue;
            highest = height;
            upper = pieces.of_element[i];
        }
        volumes.at(static_cast<std::size_t>(pieces.of_element[i])) +=
            element_volume(body.mesh, CellId(i), body.positions);
    }
    return {volumes.at(static_cast<std::size_t>(upper)),
            volumes.at(static_cast<std::size_t>(1 - upper))};
}

/// Returns the largest distance of a node of the cut from the plane between the halves, m.
double distance_of_cut(const SplitBody& body, const Halves& halves) {
    double largest = 0.0;
    for (const auto& pair : cut_faces(body.mesh))
        for (int p = 0; p < 3; ++p) {
            const VertexId n = body.mesh.face_corner(pair.a, p);
            largest = std::max(largest, std::abs(halves.height(body.positions[n.index()])));
        }
    return largest;
}

// At rest, and stretched and sheared by a linear map, which leaves convex bodies convex.
TEST(Split, WithoutSnappingLeavesTheTwoHalves) {
    for (const auto* family : convex_families())
        for (std::uint64_t seed = 0; seed < 2 * num_seeds; ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            Random random(seed);
            SplitBody body(family->data);
            Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
            if (seed >= num_seeds)
                for (int c = 0; c < 3; ++c) F.col(c) += random.vector(0.3);
            for (Vec3& x : body.positions) x = F * x;
            const Halves halves(body.positions, random);
            const double above =
                volume_above(body.mesh, body.positions, halves.point, halves.normal);
            const double below =
                volume_above(body.mesh, body.positions, halves.point, -halves.normal);
            const double rest = rest_volume(body.mesh);

            const Split done = body.cut(halves.plane());
            const auto [upper, lower] = volumes_of_halves(body, halves);
            EXPECT_NEAR(upper, above, 1e-9 * above);
            EXPECT_NEAR(lower, below, 1e-9 * below);
            EXPECT_NEAR(rest_volume(body.mesh), rest, 1e-12 * rest);

            const double size = body.box().diagonal().norm();
            const auto faces = cut_faces(body.mesh);
            EXPECT_EQ(faces.size(), done.report.faces_opened);
            double area = 0.0;
            for (const auto& pair : faces) area += topology::rest_area(body.mesh, pair.a);
            EXPECT_LE(distance_of_cut(body, halves), 1e-14 * size);
            EXPECT_NEAR(done.report.cut_area, area, 1e-12 * area);
            EXPECT_EQ(done.report.nodes_snapped, 0u);
            EXPECT_TRUE(nodes_of_cut(body.mesh).front.empty());
        }
}

TEST(Split, WithSnappingLeavesTheTwoHalvesWithinSnap) {
    for (const auto* family : convex_families())
        for (const double snap : {0.01, default_snap, 0.05, 0.1})
            for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
                SCOPED_TRACE(family->name + ", snap " + std::to_string(snap) + ", seed " +
                             std::to_string(seed));
                Random random(seed);
                SplitBody body(family->data);
                const Halves halves(body.positions, random);
                const double off = (1.0 + 1e-9) * snap * longest_edge(body.mesh, body.positions);
                const auto volume = [&](double height, int side) {
                    return volume_above(body.mesh, body.positions, halves.raised(height),
                                        side * halves.normal);
                };
                const double least_above = volume(off, 1), most_above = volume(-off, 1);
                const double least_below = volume(-off, -1), most_below = volume(off, -1);
                const double rest = rest_volume(body.mesh);

                const auto options = SplitOptions{snap};
                const Split done = body.cut(halves.plane(), options);
                EXPECT_NEAR(rest_volume(body.mesh), rest, 1e-12 * rest);
                EXPECT_LE(distance_of_cut(body, halves), off);
                if (least_above == 0.0 || least_below == 0.0) continue;  // all is near
                const auto [upper, lower] = volumes_of_halves(body, halves);
                EXPECT_GE(upper, least_above - 1e-12 * rest);
                EXPECT_LE(upper, most_above + 1e-12 * rest);
                EXPECT_GE(lower, least_below - 1e-12 * rest);
                EXPECT_LE(lower, most_below + 1e-12 * rest);
                EXPECT_EQ(done.report.faces_opened, cut_faces(body.mesh).size());
            }
}

TEST(Split, AlongAPlaneAgainChangesNothing) {
    for (const auto* family : test::tetrahedral_families())
        for (const double snap : {0.0, default_snap, 0.05, 0.1})
            for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
                SCOPED_TRACE(family->name + ", snap " + std::to_string(snap) + ", seed " +
                             std::to_string(seed));
                Random random(seed);
                SplitBody body(family->data);
                const Halves halves(body.positions, random);
                body.cut(halves.plane(), {snap});
                const MeshSnapshot once(body.mesh);
                const Split again = body.cut(halves.plane(), {snap});
                EXPECT_TRUE(again.changes.is_empty());
                EXPECT_EQ(again.report.edges_divided, 0u);
                EXPECT_EQ(again.report.faces_opened, 0u);
                EXPECT_EQ(MeshSnapshot(body.mesh), once);
            }
}

TEST(Split, AgainAfterOtherCutsChangesNothing) {
    for (const auto* family : test::tetrahedral_families())
        for (const double snap : {0.0, default_snap, 0.1})
            for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
                SCOPED_TRACE(family->name + ", snap " + std::to_string(snap) + ", seed " +
                             std::to_string(seed));
                Random random(seed);
                SplitBody body(family->data);
                const SplitOptions options = SplitOptions{snap};
                const Halves first(body.positions, random), second(body.positions, random);
                body.cut(first.plane(), options);
                body.cut(second.plane(), options);
                const MeshSnapshot once(body.mesh);
                body.cut(first.plane(), options);
                body.cut(second.plane(), options);
                EXPECT_EQ(MeshSnapshot(body.mesh), once);
            }
}

// Thinner than an element, they have no node off both cuts; all the same they are pieces.
TEST(Split, SlicesAndDiceComeOffHoweverThin) {
    const auto num_pieces = [](const std::array<int, 3>& bricks, const std::vector<Plane>& planes) {
        const Vec3 size(bricks[0], bricks[1], bricks[2]);
        SplitBody body(
            topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), size, bricks));
        const SplitOptions options = SplitOptions{default_snap};
        for (const Plane& plane : planes) body.cut(plane, options);
        return topology::components(body.mesh).count;
    };
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed)
        for (const double thickness : {1.0, 1.5}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", bricks " + std::to_string(thickness));
            Random random(seed);
            const double start = random.uniform(2.0, 3.0);
            std::vector<Plane> slices, dice;
            for (int i = 0; i < 4; ++i)
                slices.emplace_back(Vec3(start + i * thickness, 0, 0), Vec3::UnitX());
            EXPECT_EQ(num_pieces({10, 1, 1}, slices), 5);
            for (int axis = 0; axis < 2; ++axis)
                for (int i = 0; i < 3; ++i)
                    dice.emplace_back(Vec3::Constant(start + i * 1.3 * thickness),
                                      Vec3::Unit(axis));
            EXPECT_EQ(num_pieces({8, 8, 1}, dice), 16);
        }
}

TEST(Split, AlongTwoCrossingPlanesLeavesFourComponents) {
    for (const double snap : {0.0, 0.05, 0.1})
        for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
            SCOPED_TRACE("snap " + std::to_string(snap) + ", seed " + std::to_string(seed));
            Random random(seed);
            SplitBody body(test::jittered_cube(5, 0.2, seed));
            const double off = snap * longest_edge(body.mesh, body.positions);
            const Vec3 centre = Vec3::Constant(0.5) + random.vector(0.1);
            const Vec3 n = random.vector(1.0).normalized();
            const std::array<Vec3, 2> normals = {n, n.unitOrthogonal()};
            for (const Vec3& normal : normals) body.cut(Plane(centre, normal), {snap});

            // One piece on each pair of sides, and on each side of a plane two of the right sum.
            const auto pieces = topology::components(body.mesh);
            ASSERT_EQ(pieces.count, 4);
            std::array<Vec3, 4> moments;
            moments.fill(Vec3::Zero());
            std::array<double, 4> volumes{};
            for (std::size_t i = 0; i < body.mesh.element_capacity(); ++i) {
                const auto piece = static_cast<std::size_t>(pieces.of_element[i]);
                const double volume = element_volume(body.mesh, CellId(i), body.positions);
                volumes[piece] += volume;
                moments[piece] +=
                    volume * TissueMotion::centre(body.mesh, CellId(i), body.positions);
            }
            std::set<std::pair<bool, bool>> sides;
            std::array<double, 2> above{};
            for (std::size_t piece = 0; piece < 4; ++piece) {
                std::array<bool, 2> is_above{};
                for (std::size_t k = 0; k < 2; ++k) {
                    is_above[k] = normals[k].dot(moments[piece] - volumes[piece] * centre) > 0.0;
                    if (is_above[k]) above[k] += volumes[piece];
                }
                sides.emplace(is_above[0], is_above[1]);
            }
            EXPECT_EQ(sides.size(), 4u);
            for (std::size_t k = 0; k < 2; ++k) {
                const auto volume = [&](double height) {
                    return volume_above(body.mesh, body.positions, centre + height * normals[k],
                                        normals[k]);
                };
                EXPECT_GE(above[k], volume(off) - 1e-9);
                EXPECT_LE(above[k], volume(-off) + 1e-9);
            }
        }
}

TEST(Split, RecordsWhereItsNodesAndElementsComeFrom) {
    for (const auto* family : test::tetrahedral_families())
        for (const double snap : {0.0, 0.1})
            for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
                SCOPED_TRACE(family->name + ", snap " + std::to_string(snap) + ", seed " +
                             std::to_string(seed));
                Random random(seed);
                MeshData data = family->data;
                for (int& region : data.regions) region = static_cast<int>(random.below(3));
                SplitBody body(data);
                for (int cut = 0; cut < 2; ++cut) {
                    const MeshSnapshot before(body.mesh);
                    const Split done = body.cut(Halves(body.positions, random).plane(), {snap});
                    const auto& changes = done.changes;
                    std::size_t num_divisions = 0;
                    for (const auto& record : changes.nodes_added) {
                        Vec3 x = Vec3::Zero();
                        double sum = 0.0;
                        ASSERT_TRUE(record.num_sources == 1 || record.num_sources == 2);
                        for (std::size_t s = 0; s < static_cast<std::size_t>(record.num_sources);
                             ++s) {
                            const auto& source = record.sources[s];
                            EXPECT_LT(source.node, record.id);
                            x += source.weight * body.mesh.rest_position(source.node);
                            sum += source.weight;
                            if (record.num_sources == 2) {
                                EXPECT_TRUE(source.weight > 0.0 && source.weight < 1.0);
                            }
                        }
                        EXPECT_NEAR(sum, 1.0, 1e-15);
                        EXPECT_EQ(record.rest_position, body.mesh.rest_position(record.id));
                        EXPECT_LE((record.rest_position - x).norm(), 1e-15 * (1.0 + x.norm()));
                        num_divisions += record.num_sources == 2;
                    }
                    EXPECT_EQ(num_divisions, done.report.edges_divided);
                    EXPECT_TRUE(changes.nodes_removed.empty());
                    EXPECT_TRUE(changes.elements_removed.empty());
                    for (const auto& record : changes.elements_added) {
                        EXPECT_LT(record.parent, record.id);
                        EXPECT_EQ(record.region, body.mesh.region(record.parent));
                        EXPECT_EQ(record.region, body.mesh.region(record.id));
                    }
                    // Undone and redone by the record alone.
                    const MeshSnapshot after(body.mesh);
                    replay(body.mesh, inverse(changes));
                    EXPECT_EQ(MeshSnapshot(body.mesh), before);
                    EXPECT_EQ(topology::validate(body.mesh), std::vector<std::string>{});
                    replay(body.mesh, changes);
                    EXPECT_EQ(MeshSnapshot(body.mesh), after);
                }
            }
}

// Where all fragments of a slice are light, elements on its two sides carry it. Validation finds
// parts that hang together in the mesh and come apart in the motion.
TEST(FragmentsOfCuts, OfThinSlicesHangTogether) {
    constexpr int num_bricks = 6;
    for (const double jitter : {0.0, 0.2})
        for (const double thickness : {0.02, 0.05, 0.1, 0.2})
            for (std::uint64_t seed = 0; seed < num_seeds / 2; ++seed) {
                SCOPED_TRACE(testing::Message() << "jitter " << jitter << ", thickness "
                                                << thickness << ", seed " << seed);
                Random random(seed);
                SplitBody body(test::jittered_cube(num_bricks, jitter, seed));
                const Vec3 point = Vec3::Constant(0.5) + random.vector(0.3);
                const Vec3 normal = random.vector(1.0).normalized();
                for (const double offset : {0.0, thickness}) {
                    body.cut(Plane(point + offset / num_bricks * normal, normal));
                    EXPECT_EQ(fragments::validate(body.fragments, body.mesh),
                              std::vector<std::string>{});
                }
            }
}

}  // namespace
}  // namespace incise::cutting
