// The force on a probe, as a haptic device reads it a thousand times a second.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "incise/io/mesh/mesh_reader.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

constexpr double tick = 1e-3, speed = 0.02;  // s, m/s

/// The liver, held at its lower side.
World held_liver() {
    WorldDef def;
    def.mesh = io::read_mesh(INCISE_DATA_DIR "/liver.vtu", {"region"}).mesh;
    def.damping = 8.0;
    def.materials = {{1060.0, physics::HyperElasticLinks{physics::NeoHookean{2740.0, 31507.0}}}};
    World world(std::move(def));
    const auto nodes = nodes_where(world, [](const Vec3&) { return true; });
    const auto lowest_near = [&](const Vec3& x) {
        double z = x.z();
        for (const VertexId n : nodes) {
            const Vec3& other = world.mesh().rest_position(n);
            if ((other - x).head<2>().norm() < 0.008) z = std::min(z, other.z());
        }
        return z;
    };
    world.add_constraint(
        {.name = "bed", .nodes = physics::VertexSet(nodes_where(world, [&](const Vec3& x) {
                            return x.z() < lowest_near(x) + 0.01;
                        }))});
    return world;
}

/// The height of the upper side along y = 0, smoothed over 16 mm.
class Ridge {
  public:
    explicit Ridge(const World& world) {
        std::vector<double> tops;
        for (int i = 0; i <= 100; ++i) {
            double top = -1.0;
            for (const VertexId n : world.mesh().nodes()) {
                const Vec3& x = world.mesh().rest_position(n);
                if (std::hypot(x.x() - place(i), x.y()) < 0.007) top = std::max(top, x.z());
            }
            tops.push_back(top);
        }
        for (int i = 8; i <= 92; ++i) {
            double sum = 0.0;
            for (int k = i - 8; k <= i + 8; ++k) sum += tops[static_cast<std::size_t>(k)] / 17.0;
            heights_.push_back(sum);
        }
    }
    double operator()(double x) const {
        const double at = (x - place(8)) / 0.001;
        const auto i = static_cast<std::size_t>(at);
        return std::lerp(heights_[i], heights_[i + 1], at - static_cast<double>(i));
    }

  private:
    static double place(int i) { return -0.06 + 0.001 * i; }
    std::vector<double> heights_;
};

struct Slide {
    double radius, depth, friction;
};

class HapticForce : public testing::TestWithParam<Slide> {};

// The probe presses in, waits, and slides for 4 cm.
TEST_P(HapticForce, OfAProbeThatSlidesOverTheLiverIsSmooth) {
    const auto [radius, depth, friction] = GetParam();
    World world = held_liver();
    const Ridge ridge(world);
    const ToolId probe =
        world.add_tool({"probe", cutting::Probe{cutting::Sphere{radius}, friction}});
    constexpr double pressed = 0.4, waited = 0.7, end = 2.7;  // s
    const auto pose = [&](double time) {
        const double part = std::min(time / pressed, 1.0);
        const double x = -0.03 + speed * std::max(0.0, time - waited);
        return at({x, 0.0, ridge(x) + radius - std::lerp(-0.005, depth, part)});
    };
    world.place_tool(probe, pose(0.0));
    double before = 0.0, most = 0.0, mean = 0.0;
    int count = 0;
    for (int i = 1; i * tick <= end; ++i) {
        Vec3 impulse = Vec3::Zero();
        const double from = world.time(), to = i * tick;
        const int num_steps =
            static_cast<int>(std::ceil((to - from) / (0.8 * world.stable_step())));
        for (int k = 1; k <= num_steps; ++k) {
            const double time = k == num_steps ? to : from + (to - from) * k / num_steps;
            const StepReport& report = world.step_to(time, StepInputs().move(probe, pose(time)));
            impulse += (report.to - report.from) * report.tools.at(0).force;
        }
        const double force = impulse.norm() / (to - from);
        if (to > waited + 0.05) {
            most = std::max(most, std::abs(force - before) / before);
            mean += force;
            ++count;
        }
        before = force;
    }
    EXPECT_GT(mean / count, 0.3);
    EXPECT_LT(most, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Contact, HapticForce,
                         testing::Values(Slide{0.010, 0.006, 0.0}, Slide{0.006, 0.004, 0.2}));

}  // namespace
}  // namespace incise::sim
