// What a carver covers: shapes against dense sampling, moving tools and tissue against a crawl in
// tiny steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/carver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Random;
using topology::Mesh;

/// Distance of a point outside the shape from it, 0 inside: written anew, from the definitions.
double distance(const CarverShape& shape, const Vec3& x) {
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return std::max(0.0, x.norm() - sphere->radius);
    if (const auto* cuboid = std::get_if<Cuboid>(&shape))
        return (x.cwiseAbs() - 0.5 * cuboid->size).cwiseMax(0.0).norm();
    const auto& capsule = std::get<Capsule>(shape);
    const Vec3 axis = capsule.to - capsule.from;
    const double length = axis.squaredNorm();
    const double s =
        length == 0.0 ? 0.0 : std::clamp((x - capsule.from).dot(axis) / length, 0.0, 1.0);
    return std::max(0.0, (x - capsule.from - s * axis).norm() - capsule.radius);
}

std::vector<CarverShape> random_shapes(Random& random) {
    const Vec3 size = (random.vector(0.8) + Vec3::Constant(0.9)).eval();
    const Vec3 from = random.vector(0.7), to = random.vector(0.7);
    return {Sphere{random.uniform(0.1, 0.8)}, Capsule{from, to, random.uniform(0.05, 0.5)},
            Capsule{from, from, random.uniform(0.05, 0.5)}, Cuboid{size}};
}

TEST(Carver, MeetsSegmentsThatHaveAPointInside) {
    constexpr int num_samples = 400;
    int num_met = 0, num_missed = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        Random random(seed);
        for (const CarverShape& shape : random_shapes(random)) {
            const Vec3 a = random.vector(1.5), b = seed % 9 == 0 ? a : random.vector(1.5);
            double nearest = distance(shape, a);
            for (int i = 1; i <= num_samples; ++i)
                nearest = std::min(nearest, distance(shape, a + i * (b - a) / num_samples));
            SCOPED_TRACE("seed " + std::to_string(seed) + ", shape " +
                         std::to_string(shape.index()));
            // A sample is at most half a sampling step from any point of the segment.
            const double spacing = 0.5 * (b - a).norm() / num_samples;
            if (nearest == 0.0) {
                EXPECT_TRUE(meets(shape, a, b));
                ++num_met;
            } else if (nearest > spacing) {
                EXPECT_FALSE(meets(shape, a, b));
                ++num_missed;
            }
            EXPECT_EQ(meets(shape, a, b), meets(shape, b, a));
        }
    }
    EXPECT_GT(num_met, 400);
    EXPECT_GT(num_missed, 400);
}

TEST(Carver, ShapesAreClosed) {
    const CarverShape sphere = Sphere{0.5}, cuboid = Cuboid{{1, 2, 4}},
                      capsule = Capsule{{0, 0, -1}, {0, 0, 1}, 0.5};
    const auto meets_point = [](const CarverShape& shape, const Vec3& x) {
        return meets(shape, x, x);
    };
    EXPECT_TRUE(meets_point(sphere, {0, 0.5, 0}));
    EXPECT_FALSE(meets_point(sphere, {0, std::nextafter(0.5, 1), 0}));
    EXPECT_TRUE(meets_point(cuboid, {0.5, -1, 2}));
    EXPECT_FALSE(meets_point(cuboid, {0.5, -1, std::nextafter(2, 3)}));
    EXPECT_TRUE(meets_point(capsule, {0, 0.5, 1}));
    EXPECT_TRUE(meets_point(capsule, {0, 0, 1.5}));
    EXPECT_FALSE(meets_point(capsule, {0, 0.4, 1.4}));
    // Along a side, and in the direction of the axis.
    EXPECT_TRUE(meets(cuboid, {0.5, -3, 0}, {0.5, 3, 0}));
    EXPECT_TRUE(meets(capsule, {0.5, 0, -9}, {0.5, 0, 9}));
    EXPECT_FALSE(meets(capsule, {0.5, 0, 1.1}, {0.5, 0, 9}));
}

Pose between(const Pose& a, const Pose& b, double s) {
    return {a.rotation.slerp(s, b.rotation), a.position + s * (b.position - a.position)};
}

std::vector<Vec3> between(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double s) {
    std::vector<Vec3> x;
    for (std::size_t i = 0; i < a.size(); ++i) x.push_back(a[i] + s * (b[i] - a[i]));
    return x;
}

std::set<CellId> as_set(const std::vector<CellId>& elements) {
    EXPECT_TRUE(std::is_sorted(elements.begin(), elements.end()));
    return {elements.begin(), elements.end()};
}

constexpr int num_moments = test::num_cases(200);

/// Covered at one of many moments of the step, with the tool grown by `growth`.
std::set<CellId> covered_at_moments(const Mesh& mesh, const std::vector<Vec3>& x0,
                                    const std::vector<Vec3>& x1, const CarverShape& shape,
                                    const Pose& before, const Pose& after, double growth) {
    std::set<CellId> covered;
    for (int i = 0; i <= num_moments; ++i) {
        const double s = static_cast<double>(i) / num_moments;
        const Pose pose = between(before, after, s);
        const std::vector<Vec3> x = between(x0, x1, s);
        for (std::size_t e = 0; e < mesh.element_capacity(); ++e)
            if (mesh.is_alive(CellId(e)) &&
                distance(shape, pose.to_tool(TissueMotion::centre(mesh, CellId(e), x))) <= growth)
                covered.insert(CellId(e));
    }
    return covered;
}

TEST(Carver, CoversWhatACrawlInTinyStepsCovers) {
    std::size_t num_covered = 0;
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        const Mesh mesh = Mesh::build(family.data).mesh;
        const std::vector<Vec3> rest(mesh.rest_positions().begin(), mesh.rest_positions().end());
        const Eigen::AlignedBox3d box = [&] {
            Eigen::AlignedBox3d b;
            for (const Vec3& x : rest) b.extend(x);
            return b;
        }();
        const double size = box.diagonal().norm();
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(seed);
            Random random(seed);
            // Tissue that drifts and wobbles; a tool that flies past, turning a little or not.
            std::vector<Vec3> x0 = rest, x1 = rest;
            const Vec3 drift = random.vector(0.3 * size);
            for (std::size_t n = 0; n < rest.size(); ++n) {
                x0[n] += random.vector(0.02 * size);
                x1[n] += drift + random.vector(0.02 * size);
            }
            const auto turned = [&](double angle) {
                return Eigen::Quaterniond(
                    Eigen::AngleAxisd(angle, random.vector(1).normalized().eval()));
            };
            Pose before{turned(1.0), box.center() + random.vector(0.5 * size)}, after = before;
            after.position = box.center() + random.vector(0.5 * size);
            const double turn = seed % 2 == 0 ? 0.0 : 0.2;
            after.rotation = turned(turn) * before.rotation;
            for (CarverShape shape : random_shapes(random)) {
                const double scale = 0.3 * size;
                if (auto* s = std::get_if<Sphere>(&shape)) s->radius *= scale;
                if (auto* c = std::get_if<Capsule>(&shape))
                    *c = {scale * c->from, scale * c->to, scale * c->radius};
                if (auto* c = std::get_if<Cuboid>(&shape)) c->size *= scale;
                // A turning tool sees bent paths, which are taken as straight: the sagitta of an
                // arc. It also sees a tissue point move by at most this much between two moments.
                const double bend = 1.5 * size * turn * turn / 8.0 + 1.5 * size * turn / 8.0;
                const double hop = 3.0 * size / num_moments;
                const auto found = as_set(covered_elements({mesh, x0, x1}, shape, before, after));
                num_covered += found.size();
                if (turn == 0.0) {
                    const auto certain =
                        covered_at_moments(mesh, x0, x1, shape, before, after, 0.0);
                    EXPECT_TRUE(
                        std::includes(found.begin(), found.end(), certain.begin(), certain.end()));
                }
                const auto possible = covered_at_moments(mesh, x0, x1, shape, before, after,
                                                         hop + (turn == 0.0 ? 0.0 : bend));
                EXPECT_TRUE(
                    std::includes(possible.begin(), possible.end(), found.begin(), found.end()));
            }
        }
    }
    EXPECT_GT(num_covered, std::size_t{test::num_cases(500)});
}

TEST(Carver, TurningInSmallStepsCoversAsACrawl) {
    const Mesh mesh = Mesh::build(test::jittered_cube(5, 0.1, 3)).mesh;
    const std::vector<Vec3> x(mesh.rest_positions().begin(), mesh.rest_positions().end());
    // A bar beside the body that turns through it by a quarter.
    const CarverShape bar = Capsule{{0.2, 0, 0}, {0.9, 0, 0}, 0.06};
    const auto pose = [](double s) {
        return Pose{
            Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi * s, Vec3::UnitZ())),
            {0, 0, 0.5}};
    };
    constexpr int num_steps = 40;
    std::set<CellId> found, certain, possible;
    for (int i = 0; i < num_steps; ++i) {
        const Pose a = pose(static_cast<double>(i) / num_steps),
                   b = pose(static_cast<double>(i + 1) / num_steps);
        found.merge(as_set(covered_elements({mesh, x, x}, bar, a, b)));
        // A chord leaves its arc by r angle^2 / 8, some 2e-4 here.
        CarverShape inner = bar;
        std::get<Capsule>(inner).radius -= 3e-4;
        certain.merge(covered_at_moments(mesh, x, x, inner, a, b, 0.0));
        possible.merge(covered_at_moments(mesh, x, x, bar, a, b, 1e-3));
    }
    EXPECT_TRUE(std::includes(found.begin(), found.end(), certain.begin(), certain.end()));
    EXPECT_TRUE(std::includes(possible.begin(), possible.end(), found.begin(), found.end()));
    EXPECT_GT(certain.size(), 20u);
    EXPECT_LT(possible.size(), mesh.num_elements() / 2);
}

TEST(Carver, AFastToolMissesNothing) {
    // Through the whole body in one step, and in a thousand: the same elements.
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron}) {
        const Mesh mesh =
            Mesh::build(topology::box_mesh(kind, {0, 0, 0}, {1, 1, 1}, {6, 6, 6})).mesh;
        const std::vector<Vec3> x(mesh.rest_positions().begin(), mesh.rest_positions().end());
        const CarverShape ball = Sphere{0.11};
        Pose from, to;
        from.position = {0.4, 0.45, -1e3};
        to.position = {0.4, 0.45, 1e3};
        const auto at_once = as_set(covered_elements({mesh, x, x}, ball, from, to));
        std::set<CellId> step_by_step;
        for (int i = 0; i < 1000; ++i) {
            from.position.z() = -0.5 + 2e-3 * i;
            to.position.z() = -0.5 + 2e-3 * (i + 1);
            step_by_step.merge(as_set(covered_elements({mesh, x, x}, ball, from, to)));
        }
        EXPECT_EQ(at_once, step_by_step);
        std::set<CellId> expected;
        for (std::size_t e = 0; e < mesh.element_capacity(); ++e) {
            const Vec3 c = TissueMotion::centre(mesh, CellId(e), x);
            if (std::hypot(c.x() - 0.4, c.y() - 0.45) <= 0.11) expected.insert(CellId(e));
        }
        EXPECT_EQ(at_once, expected);
        EXPECT_GT(expected.size(), 5u);
        // The tissue that flies through the resting tool is carved alike.
        std::vector<Vec3> x0 = x, x1 = x;
        for (Vec3& p : x0) p.z() += 1e3;
        for (Vec3& p : x1) p.z() -= 1e3;
        from.position = to.position = {0.4, 0.45, 0};
        EXPECT_EQ(as_set(covered_elements({mesh, x0, x1}, ball, from, to)), expected);
    }
}

TEST(Carver, RidingAlongCoversNoMoreThanAtFirst) {
    const Mesh mesh = Mesh::build(test::jittered_cube(4, 0.1, 1)).mesh;
    const std::vector<Vec3> x0(mesh.rest_positions().begin(), mesh.rest_positions().end());
    const Vec3 wind(3, -2, 7);
    auto x1 = x0;
    for (Vec3& p : x1) p += wind;
    const CarverShape box = Cuboid{{0.4, 0.5, 0.3}};
    Pose a, b;
    a.position = {0.5, 0.45, 0.55};
    b.position = a.position + wind;
    EXPECT_EQ(covered_elements({mesh, x0, x1}, box, a, b),
              covered_elements({mesh, x0, x0}, box, a, a));
    EXPECT_GT(covered_elements({mesh, x0, x1}, box, a, b).size(), 10u);
}

}  // namespace
}  // namespace incise::cutting
