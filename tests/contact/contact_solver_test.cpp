// Impulses at points of contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/contact_solver.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/mesh_families.h"

namespace incise::contact {
namespace {

constexpr double one_step = 1e-3;

/// Nodes of some masses with velocities; the impulses that act on them.
struct Nodes {
    std::vector<Vec3> velocities, inverse_masses;

    void add(double mass, const Vec3& velocity) {
        velocities.push_back(velocity);
        inverse_masses.push_back(Vec3::Constant(1.0 / mass));
    }
    void add_fixed() {
        velocities.push_back(Vec3::Zero());
        inverse_masses.push_back(Vec3::Zero());
    }
    Vec3 momentum() const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t n = 0; n < velocities.size(); ++n)
            if (inverse_masses[n].x() > 0.0) sum += velocities[n] / inverse_masses[n].x();
        return sum;
    }
    void apply(ContactSolver& solver) {
        solver.solve(velocities, inverse_masses, one_step, one_step);
        for (std::size_t i = 0; i < solver.size(); ++i)
            for (const NodeWeight& share : solver.weights(i))
                velocities[share.node.index()] +=
                    share.weight *
                    inverse_masses[share.node.index()].cwiseProduct(solver.impulse(i));
    }
};

void add_pair(ContactSolver& solver, ContactPoint point, std::size_t a, std::size_t b) {
    solver.begin(point);
    solver.add_weight(NodeId(a), 1.0);
    solver.add_weight(NodeId(b), -1.0);
}

TEST(ContactSolver, BringsTwoMassesToTheirCommonVelocity) {
    Nodes nodes;
    nodes.add(2.0, {0.0, 0.0, -1.0});
    nodes.add(1.0, {0.0, 0.0, 2.0});
    ContactSolver solver(1.0);
    add_pair(solver, {}, 0, 1);
    nodes.apply(solver);
    EXPECT_NEAR(nodes.velocities[0].z(), 0.0, 1e-12);
    EXPECT_NEAR(nodes.velocities[1].z(), 0.0, 1e-12);
}

TEST(ContactSolver, LeavesAloneWhatPartsOrIsFar) {
    ContactSolver solver(1.0);
    Nodes nodes;
    nodes.add(1.0, {0.0, 0.0, 1.0});
    nodes.add(1.0, {0.0, 0.0, 0.0});
    nodes.add(1.0, {0.0, 0.0, -1.0});
    add_pair(solver, {}, 0, 1);
    add_pair(solver, {.gap = 1.01 * one_step}, 2, 1);
    nodes.apply(solver);
    EXPECT_TRUE(solver.impulse(0).isZero(0.0));
    EXPECT_TRUE(solver.impulse(1).isZero(0.0));
}

TEST(ContactSolver, ClosesAGapExactly) {
    Nodes nodes;
    nodes.add(1.0, {0.0, 0.0, -1.0});
    nodes.add_fixed();
    ContactSolver solver(1.0);
    add_pair(solver, {.gap = 0.25 * one_step}, 0, 1);
    nodes.apply(solver);
    EXPECT_NEAR(nodes.velocities[0].z(), -0.25, 1e-12);
}

// Below the limit friction stops the slip, above it takes its share of the normal impulse.
TEST(ContactSolver, HasCoulombsFriction) {
    for (const double slip : {0.1, 0.29, 0.31, 2.0}) {
        Nodes nodes;
        nodes.add(1.0, {slip, 0.0, -1.0});
        nodes.add_fixed();
        ContactSolver solver(1.0);
        add_pair(solver, {.friction = 0.3}, 0, 1);
        nodes.apply(solver);
        EXPECT_NEAR(nodes.velocities[0].x(), std::max(0.0, slip - 0.3), 1e-12);
        EXPECT_NEAR(nodes.velocities[0].z(), 0.0, 1e-12);
    }
}

TEST(ContactSolver, FollowsARigidBody) {
    Nodes nodes;
    nodes.add(1.0, Vec3::Zero());
    ContactSolver solver(1.0);
    solver.begin({.velocity = {0.0, 0.0, 0.5}});
    solver.add_weight(NodeId(0), 1.0);
    nodes.apply(solver);
    EXPECT_NEAR(nodes.velocities[0].z(), 0.5, 1e-12);
}

// Random points between weighted combinations of nodes: momentum stays, and energy falls.
TEST(ContactSolver, KeepsMomentumAndTakesEnergy) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        Nodes nodes;
        for (int n = 0; n < 40; ++n) nodes.add(random.uniform(0.1, 2.0), random.vector(1.0));
        ContactSolver solver(1.0);
        for (int i = 0; i < 30; ++i) {
            solver.begin({.normal = random.vector(1.0).normalized(), .friction = 0.2 * (i % 3)});
            for (const double side : {1.0, -1.0}) {
                const double w = random.uniform(0.0, 1.0);
                solver.add_weight(NodeId(random.below(40)), side * w);
                solver.add_weight(NodeId(random.below(40)), side * (1.0 - w));
            }
        }
        const auto energy = [&] {
            double sum = 0.0;
            for (std::size_t n = 0; n < 40; ++n)
                sum += 0.5 * nodes.velocities[n].squaredNorm() / nodes.inverse_masses[n].x();
            return sum;
        };
        const Vec3 momentum = nodes.momentum();
        const double before = energy();
        nodes.apply(solver);
        EXPECT_LE((nodes.momentum() - momentum).norm(), 1e-12);
        EXPECT_LT(energy(), before);
    }
}

// Shares of one node count together; a point whose sides follow the same nodes cannot give way.
TEST(ContactSolver, AddsUpSharesOfANode) {
    Nodes nodes;
    nodes.add(1.0, {0.0, 0.0, -1.0});
    ContactSolver solver(1.0);
    solver.begin({});
    solver.add_weight(NodeId(0), 0.75);
    solver.add_weight(NodeId(0), 0.25);
    solver.begin({});
    solver.add_weight(NodeId(0), 1.0);
    solver.add_weight(NodeId(0), -1.0);
    ASSERT_EQ(solver.weights(0).size(), 1u);
    EXPECT_EQ(solver.weights(0)[0].weight, 1.0);
    nodes.apply(solver);
    EXPECT_NEAR(nodes.velocities[0].z(), 0.0, 1e-12);
    EXPECT_TRUE(solver.impulse(1).isZero(0.0));
}

TEST(ContactSolver, HoldsAPointUpToItsLargestForce) {
    for (const double limit : {10.0, 0.25}) {  // of the velocity of a mass of 1 kg in a step
        Nodes nodes;
        nodes.add(1.0, {0.3, 0.0, -0.4});
        ContactSolver solver(1.0);
        ContactPoint point{.is_bilateral = true};
        point.largest_force = limit / one_step;
        solver.begin(point);
        solver.add_weight(NodeId(0), 1.0);
        nodes.apply(solver);
        EXPECT_NEAR(nodes.velocities[0].norm(), std::max(0.0, 0.5 - limit), 1e-12);
    }
}

// An impulse of the step before is forgotten where nothing can give way any more.
TEST(ContactSolver, HoldsNothingThatIsPrescribed) {
    Nodes nodes;
    nodes.add_fixed();
    ContactSolver solver(1.0);
    solver.begin({.impulse = {1.0, 2.0, 3.0}, .is_bilateral = true});
    solver.add_weight(NodeId(0), 1.0);
    nodes.apply(solver);
    EXPECT_TRUE(solver.impulse(0).isZero(0.0));
}

TEST(ContactSolver, RemovesOverlapsSlowly) {
    Nodes nodes;
    nodes.add(1.0, Vec3::Zero());
    nodes.add(1.0, Vec3::Zero());
    nodes.add_fixed();
    ContactSolver solver(1.0);
    add_pair(solver, {.gap = -1e-3}, 0, 2);
    add_pair(solver, {.gap = -1.0}, 1, 2);
    nodes.apply(solver);
    EXPECT_NEAR(nodes.velocities[0].z() * one_step, 1e-4, 1e-12);
    EXPECT_NEAR(nodes.velocities[1].z() * one_step, 1e-3, 1e-12);  // at most so much
}

/// Two masses at the ends of the segment of a thread, which is to have no length.
Nodes pulled_together(const Vec3& span, double impulse, const Vec3& velocity) {
    Nodes nodes;
    nodes.add(1.0, Vec3::Zero());
    nodes.add(3.0, velocity);
    ContactSolver solver(1.0);
    solver.begin_thread({.length = 0.0, .stiffness = 1e12, .impulse = impulse});
    solver.begin_segment(span, Vec3(-impulse, 0.0, 0.0));
    solver.add_weight(NodeId(0), -1.0);
    solver.add_weight(NodeId(1), 1.0);
    const Vec3 momentum = nodes.momentum();
    nodes.apply(solver);
    EXPECT_LT((nodes.momentum() - momentum).norm(), 1e-15);
    EXPECT_NEAR(solver.thread_impulse(0), solver.impulse(0).norm(), 1e-12);
    return nodes;
}

TEST(ContactSolver, HoldsTheEndsOfAThreadTogetherInAllDirections) {
    const Vec3 span(1e-9, 0.0, 0.0), velocity(0.0, 0.5, -0.2);
    const Nodes nodes = pulled_together(span, 1e-3, velocity);
    const Vec3 after = span + one_step * (nodes.velocities[1] - nodes.velocities[0]);
    EXPECT_LT(after.norm(), 1e-6 * one_step);
}

TEST(ContactSolver, PullsALongSegmentAlongItself) {
    const Nodes nodes = pulled_together({1.0, 0.0, 0.0}, 1e-3, {0.0, 0.5, -0.2});
    const Vec3 relative = nodes.velocities[1] - nodes.velocities[0];
    EXPECT_EQ(relative.y(), 0.5);
    EXPECT_EQ(relative.z(), -0.2);
    EXPECT_NEAR(relative.x(), -1.0 / one_step, 1e-6 / one_step);
}

}  // namespace
}  // namespace incise::contact
