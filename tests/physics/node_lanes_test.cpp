// The step of several nodes side by side against that of one after the other, on each kind of
// processor at hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/node_lanes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "support/mesh_families.h"
#include "tests/physics/processors_at_hand.h"

namespace incise::physics {
namespace {

constexpr double time_step = 1e-3, slowing = 0.97;

struct Body {
    std::vector<double> masses;
    std::vector<Vec3> elastic_forces, outer_forces, positions, velocities;

    explicit Body(std::size_t num_nodes) {
        test::Random random(1);
        for (std::size_t n = 0; n < num_nodes; ++n) {
            masses.push_back(random.uniform(1e-6, 1e-3));
            elastic_forces.push_back(random.vector(1e-2));
            outer_forces.push_back(random.vector(1e-3));
            positions.push_back(random.vector(0.1));
            velocities.push_back(random.vector(2.0));
        }
    }
    StepSums move(Processor processor) {
        return free_node_moves_for(processor)(
            {masses.data(), elastic_forces.data(), outer_forces.data(), positions.data(),
             velocities.data()},
            masses.size(), time_step, slowing);
    }
};

TEST(NodeLanes, MoveAsNodesByThemselvesToTheBit) {
    for (const std::size_t num_nodes : {std::size_t{8}, std::size_t{16}, std::size_t{504}}) {
        Body expected(num_nodes);
        double work = 0.0, sum_of_magnitudes = 0.0, mass_times_square = 0.0, largest_square = 0.0;
        for (std::size_t n = 0; n < num_nodes; ++n) {
            const Vec3 force = expected.elastic_forces[n] + expected.outer_forces[n],
                       x = expected.positions[n];
            Vec3& v = expected.velocities[n];
            v = slowing * (v + time_step / expected.masses[n] * force);
            expected.positions[n] = x + time_step * v;
            work += expected.outer_forces[n].dot(expected.positions[n] - x);
            mass_times_square += expected.masses[n] * v.squaredNorm();
            sum_of_magnitudes +=
                expected.outer_forces[n].norm() * (expected.positions[n] - x).norm();
            largest_square = std::max(largest_square, (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
        }
        for (const Processor processor : processors_at_hand()) {
            Body moved(num_nodes);
            const StepSums sums = moved.move(processor);
            EXPECT_EQ(moved.positions, expected.positions);
            EXPECT_EQ(moved.velocities, expected.velocities);
            EXPECT_EQ(sums.largest_square, largest_square);
            EXPECT_NEAR(sums.work, work, 1e-14 * sum_of_magnitudes);
            EXPECT_NEAR(sums.mass_times_square, mass_times_square, 1e-14 * mass_times_square);
        }
    }
}

TEST(NodeLanes, SumToTheSameBitsOnEachProcessor) {
    const StepSums expected = Body(504).move(Processor::plain);
    for (const Processor processor : processors_at_hand()) {
        const StepSums sums = Body(504).move(processor);
        EXPECT_EQ(std::memcmp(&sums, &expected, sizeof sums), 0);
    }
}

TEST(NodeLanes, ReportAnyNodeAtANonFinitePosition) {
    for (const Processor processor : processors_at_hand())
        for (const double force :
             {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
            for (std::size_t n = 0; n < 16; ++n)
                for (int c = 0; c < 3; ++c) {
                    Body body(16);
                    body.elastic_forces[n][c] = force;
                    EXPECT_FALSE(body.move(processor).is_finite()) << n << " " << c;
                }
}

}  // namespace
}  // namespace incise::physics
