// A blade that turns, and tissue that moves, with the blade or against it: the body is parted.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "swept_body.h"

namespace incise::cutting {
namespace {

using test::Random;

/// Tissue in random smooth motion, with a little jitter of each node for itself, so that opened
/// sides part. All motions are of the given speed (body sizes a step).
class Motion {
  public:
    Motion(const Body& body, double speed, std::uint64_t seed)
        : random_(seed), size_(body.box().diagonal().norm()), speed_(speed) {
        for (auto& wave : waves_)
            wave = {random_.vector(1), random_.vector(4 / size_), random_.uniform(0, 7)};
    }
    /// Positions after one more step; `calm` is 0 where nodes must stay, up to 1 where they may
    /// move as they like.
    std::vector<Vec3> next(const Body& body, const std::function<double(const Vec3&)>& calm) {
        ++step_;
        std::vector<Vec3> moved = body.positions;
        for (std::size_t n = 0; n < moved.size(); ++n) {
            const Vec3& X = body.mesh.rest_position(VertexId(n));
            Vec3 velocity = random_.vector(0.1);
            for (const auto& wave : waves_)
                velocity += wave.direction * std::sin(wave.number.dot(X) + wave.phase * step_);
            moved[n] += calm(X) * speed_ * size_ * velocity;
        }
        return moved;
    }

  private:
    struct Wave {
        Vec3 direction, number;
        double phase;
    };
    Random random_;
    double size_, speed_;
    std::array<Wave, 3> waves_;
    int step_ = 0;
};

/// An element below and one above the middle of the body, all of whose nodes are `held`; invalid
/// where there are none.
std::pair<CellId, CellId> held_elements(const Body& body,
                                        const std::function<bool(const Vec3&)>& held) {
    std::pair<CellId, CellId> found;
    for (std::size_t e = 0; e < body.mesh.element_capacity(); ++e) {
        const auto corners = body.mesh.corners(CellId(e));
        const bool is_held = std::all_of(corners.begin(), corners.end(), [&](VertexId n) {
            return held(body.mesh.rest_position(n));
        });
        const bool is_low = body.centre(CellId(e)).z() < body.box().center().z();
        if (is_held) (is_low ? found.first : found.second) = CellId(e);
    }
    return found;
}

bool are_separated(const Body& body, CellId a, CellId b) {
    const auto pieces = topology::components(body.mesh);
    return pieces.of_element[a.index()] != pieces.of_element[b.index()];
}

TEST(Separator, PartsTissueThatMovesHoweverItMoves) {
    for (const auto& family : test::mesh_families()) {
        if (!is_convex(family.name)) continue;
        SCOPED_TRACE(family.name);
        // A step of the blade is a 20th of the way: the fastest tissue outruns it by far.
        for (const double speed : {1e-3, 1e-2, 1e-1})
            for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
                SCOPED_TRACE(testing::Message() << "speed " << speed << ", seed " << seed);
                Body body(family.data);
                const auto box = body.box();
                const double size = box.diagonal().norm(), low = box.min().z(),
                             height = box.sizes().z();
                Motion motion(body, speed, seed);
                // Held at both ends, far enough from the blade that it never gets there.
                const auto calm = [&](const Vec3& X) {
                    const double s = (X.z() - low) / height;
                    return s < 0.3 || s > 0.7 ? 0.0 : 1.0;
                };
                const auto [bottom, top] =
                    held_elements(body, [&](const Vec3& X) { return calm(X) == 0.0; });
                ASSERT_TRUE(bottom.is_valid() && top.is_valid());
                const BladePlane plane({box.center().x(), box.center().y(), low + 0.5 * height},
                                       {0.03, -0.02, 1});
                constexpr int num_steps = 20;
                const double reach = 50 * size;  // however far the tissue is thrown
                const auto edge = [&](int i) {
                    return plane.edge(reach, reach * (2.0 * i / num_steps - 1.0));
                };
                const auto slow_edge = [&](int i) {
                    return plane.edge(reach, size * (2.0 * i / num_steps - 1.0));
                };
                // From far away to the body, through it slowly, and away.
                body.step(edge(0), slow_edge(0), motion.next(body, calm));
                for (int i = 0; i < num_steps; ++i)
                    body.step(slow_edge(i), slow_edge(i + 1), motion.next(body, calm));
                body.step(slow_edge(num_steps), edge(num_steps), motion.next(body, calm));
                EXPECT_TRUE(are_separated(body, bottom, top));
            }
    }
}

TEST(Separator, PartsTissueThatRunsIntoTheBlade) {
    for (const auto& family : test::mesh_families()) {
        if (!is_convex(family.name)) continue;
        SCOPED_TRACE(family.name);
        // Positive: the blade flees from the tissue, which overtakes it.
        for (const double blade_speed : {0.0, 0.02, -0.05})
            for (const int num_steps : {1, 30}) {
                Body body(family.data);
                const auto box = body.box();
                const double size = box.diagonal().norm();
                const BladePlane plane(box.center(), {0.1, 0.3, 1});
                const auto edge = [&](double t) {
                    return plane.edge(3 * size, size * (1.0 + blade_speed * t));
                };
                for (int i = 0; i < num_steps; ++i) {
                    auto moved = body.positions;
                    for (Vec3& x : moved) x += 3 * size / num_steps * plane.v;
                    const double t = static_cast<double>(i) / num_steps;
                    body.step(edge(t), edge(t + 1.0 / num_steps), moved);
                }
                EXPECT_EQ(topology::components(body.mesh).count, 2);
                const auto pieces = topology::components(body.mesh);
                std::map<int, std::set<bool>> sides;
                for (std::size_t e = 0; e < pieces.of_element.size(); ++e)
                    if (!is_leaf(body.mesh, CellId(e)))
                        sides[pieces.of_element[e]].insert(plane.height(body.centre(CellId(e))) >
                                                           0.0);
                for (const auto& [piece, of_piece] : sides) EXPECT_EQ(of_piece.size(), 1u);
            }
    }
}

TEST(Separator, BladeThatRidesAlongOpensNothing) {
    // On the grid of the mesh, all numbers small fractions of two: nothing is rounded, and the
    // blade touches nodes and faces all the time.
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron}) {
        Body body(topology::box_mesh(kind, {0, 0, 0}, {4, 4, 4}, {4, 4, 4}));
        const Polyline edge = {{-1, 2, 2}, {1, 2, 2}, {2, 3, 2.25}, {9, 3, 2}};
        body.step(edge, edge);
        for (const Vec3& wind : {Vec3(0, 0, 1), Vec3(-3, 0.5, 0.25), Vec3(1, 0, 0)}) {
            Polyline moved_edge = edge;
            for (Vec3& x : moved_edge) x += wind;
            auto moved = body.positions;
            for (Vec3& x : moved) x += wind;
            Body rider(topology::box_mesh(kind, {0, 0, 0}, {4, 4, 4}, {4, 4, 4}));
            rider.step(edge, moved_edge, moved);
            EXPECT_TRUE(rider.opened.empty());
        }
        // The same blade cuts when it stays behind.
        auto moved = body.positions;
        for (Vec3& x : moved) x.z() += 1;
        body.step(edge, edge, moved);
        EXPECT_FALSE(body.opened.empty());
    }
}

TEST(Separator, ATurningBladePartsTheBody) {
    // The edge lies along x, above the body, and is turned about an axis along x below it: it goes
    // round through the body in an arc.
    for (const auto& family : test::mesh_families()) {
        if (!is_convex(family.name)) continue;
        SCOPED_TRACE(family.name);
        for (const int num_steps : {5, 40}) {
            Body body(family.data);
            const auto box = body.box();
            const double size = box.diagonal().norm();
            const Vec3 pivot = box.center() - Vec3(0, 0, 1.5 * size);
            const double radius = 1.5 * size + 0.05 * size;
            const auto edge = [&](double s) -> Polyline {
                const double angle = std::numbers::pi * (s - 0.5);
                const Vec3 arm(0, radius * std::sin(angle), radius * std::cos(angle));
                return {pivot + arm - Vec3(2 * size, 0.1 * size, 0),
                        pivot + arm + Vec3(2 * size, 0.1 * size, 0)};
            };
            const auto [bottom, top] = held_elements(body, [&](const Vec3& X) {
                return std::abs(X.z() - box.center().z()) > 0.2 * box.sizes().z();
            });
            for (int i = 0; i < num_steps; ++i)
                body.step(edge(static_cast<double>(i) / num_steps),
                          edge(static_cast<double>(i + 1) / num_steps));
            EXPECT_TRUE(are_separated(body, bottom, top));
            for (std::size_t e = 0; e < body.mesh.element_capacity(); ++e) {
                // Well outside of the arc, or well within: the side is plain.
                const Vec3 x = body.centre(CellId(e)) - pivot;
                const double r = std::hypot(x.y(), x.z()) - radius;
                // Chords leave their arc by this, the slant of the edge by some more.
                if (std::abs(r) <
                    radius * (1 - std::cos(std::numbers::pi / num_steps / 2)) + 0.1 * size)
                    continue;
                EXPECT_FALSE(are_separated(body, CellId(e), r > 0 ? top : bottom));
            }
        }
    }
}

}  // namespace
}  // namespace incise::cutting
