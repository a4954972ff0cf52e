// Runs by statics and by implicit steps, with tools that cut on the way.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <sstream>

#include "incise/base/error.h"
#include "run_folder.h"

namespace incise::runner {
namespace {

/// The cube is pulled at its top and cut half through.
const std::string pulled_and_cut = soft_cube + R"(
[[constraint]]
name = "lid"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.1, by = [0.005, 0, 0.02] }]
[[tool]]
kind = "blade"
name = "knife"
edge = [[0, -0.1, 0.06], [0, 0.2, 0.06]]
path = [{ time = 0.1, at = [-0.05, 0, 0.003] }, { time = 0.18, at = [0.05, 0, 0.003] }]
[output]
interval = 0.04
)";

std::vector<Vec3> end_of(const std::string& text) {
    Simulation simulation(scenario_of(text));
    run(simulation);
    const auto positions = simulation.world().positions();
    return {positions.begin(), positions.end()};
}

TEST(StaticRun, EndsEachLoadStepInEquilibrium) {
    const std::string text =
        pulled_and_cut + dynamics(0.2, "mode = \"static\"\nsteps = 10\ngravity = [0, 0, -2]");
    Simulation simulation(scenario_of(text));
    simulation.start();
    while (!simulation.is_finished()) {
        simulation.step();
        const physics::Model& model = simulation.model();
        double largest = 0.0, net = 0.0;
        for (const NodeId node : model.fragments().nodes()) {
            const std::size_t n = node.index();
            const Vec3 &inner = model.elastic_forces()[n],
                       &outer = model.boundary().outer_forces()[n];
            largest = std::max(largest, inner.norm());
            if (!model.boundary().constraints().of_node(n))
                net = std::max(net, (inner + outer).norm());
        }
        EXPECT_LE(net, 1e-9 * largest) << "at load time " << simulation.time();
        EXPECT_EQ(model.energetics().totals().kinetic_energy, 0.0);
    }
    // Two load steps for each frame make ten.
    EXPECT_EQ(simulation.num_steps(), 10u);
    EXPECT_GE(simulation.edits().size(), 2u);
    EXPECT_GT(simulation.model().energetics().dissipated_energy(), 0.0);  // the cut lets go
    EXPECT_LT(simulation.ledger().energy_error(), 0.01);
    EXPECT_EQ(end_of(text), end_of(text));  // to the bit
}

// A strip is stretched and then cut across, in few load steps. Each equilibrium draws the sides of
// the wound apart and moves tissue ahead across the blade, which rests then.
TEST(StaticRun, CutsWhatAnEquilibriumTakesAcrossTheBlade) {
    for (const int num_steps : {7, 11, 20}) {
        SCOPED_TRACE(num_steps);
        std::ostringstream text;
        text << R"([mesh]
box = { size = [0.08, 0.04, 0.01], cells = [8, 4, 1] }
[[material]]
density = 1000
young = 20000
poisson = 0.4
[[constraint]]
where = { half_space = { point = [0, 0, 0], normal = [-1, 0, 0] } }
fix = "xyz"
[[constraint]]
where = { half_space = { point = [0.08, 0, 0], normal = [1, 0, 0] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.3, by = [0.016, 0, 0] }]
[[tool]]
kind = "blade"
edge = [[0, 0, -0.05], [0, 0, 0.05]]
path = [{ time = 0.4, at = [0.0413, -0.01, 0] }, { time = 0.9, at = [0.0473, 0.05, 0] }]
[output]
interval = 0
[dynamics]
mode = "static"
end_time = 1
steps = )" << num_steps
             << "\n";
        Simulation simulation(scenario_of(text.str()));
        run(simulation);
        EXPECT_EQ(topology::components(simulation.mesh()).count, 2);
        EXPECT_LE(simulation.ledger().mass_error(), 1e-12);
        EXPECT_LT(simulation.ledger().energy_error(), 0.01);
    }
}

TEST(StaticRun, ReportsElementsThatEndInverted) {
    const auto pressed = [](const std::string& depth) {
        return R"(
[mesh]
box = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }
[[material]]
law = "stable-neo-hookean"
density = 1000
young = 5000
poisson = 0.4
[dynamics]
end_time = 0.1
mode = "static"
steps = 2
gravity = [0, 0, -9.81]
[[constraint]]
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[constraint]]
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.1, by = [0, 0, -)" +
               depth + "] }]\n";
    };
    Simulation gently(scenario_of(pressed("0.03")));
    run(gently);
    EXPECT_GT(gently.model().energetics().min_volume_ratio(), 0.0);
    EXPECT_TRUE(gently.warnings().empty());

    Simulation through(scenario_of(pressed("0.12")));
    run(through);
    ASSERT_LE(through.model().energetics().min_volume_ratio(), 0.0);
    ASSERT_FALSE(through.warnings().empty());
    EXPECT_NE(through.warnings().back().find("flat or inverted"), std::string::npos);
}

// All corners of a cube are led to where their angles about its diagonal are twice what they were.
TEST(Simulation, ReportsABodyThatEndsWoundUp) {
    std::ostringstream text;
    text << R"(
[mesh]
box = { size = [1, 1, 1], cells = [1, 1, 1] }
[[material]]
density = 1000
young = 1000
poisson = 0.3
[dynamics]
end_time = 1
)";
    const Vec3 axis = Vec3::Ones().normalized(), across = Vec3(1, -1, 0).normalized();
    for (int i = 0; i < 8; ++i) {
        const Vec3 x(i & 1, (i >> 1) & 1, i >> 2), beside = x - axis.dot(x) * axis;
        const double angle = std::atan2(axis.cross(across).dot(beside), across.dot(beside));
        const bool is_on_axis = beside.norm() < 1e-9;
        const Vec3 way =
            is_on_axis ? Vec3::Zero().eval() : (Eigen::AngleAxisd(angle, axis) * x - x).eval();
        const auto list = [](const Vec3& v) {
            std::ostringstream numbers;
            numbers << "[" << v[0] << ", " << v[1] << ", " << v[2] << "]";
            return numbers.str();
        };
        text << "[[constraint]]\nname = \"corner_" << i
             << "\"\nwhere = { box = { min = " << list(x - Vec3::Constant(0.1))
             << ", max = " << list(x + Vec3::Constant(0.1))
             << " } }\nmove = [{ time = 0, by = [0, 0, 0] }, { time = 1, by = " << list(way)
             << " }]\n";
    }
    Simulation simulation(scenario_of(text.str()));
    run(simulation);
    EXPECT_GT(simulation.model().energetics().min_volume_ratio(), 0.3);
    ASSERT_FALSE(simulation.warnings().empty());
    EXPECT_NE(simulation.warnings().back().find("the body is wound up: round "), std::string::npos)
        << simulation.warnings().back();
}

TEST(StaticRun, TakesOneLoadStepPerFrameByDefault) {
    Simulation simulation(scenario_of(pulled_and_cut + dynamics(0.2, "mode = \"static\"")));
    run(simulation);
    EXPECT_EQ(simulation.num_steps(), 5u);
}

TEST(StaticRun, RefusesAComponentThatFalls) {
    const std::string text = soft_cube + R"(
[[tool]]
kind = "blade"
name = "knife"
edge = [[0, -0.1, 0.06], [0, 0.2, 0.06]]
path = [{ time = 0.1, at = [-0.05, 0, 0.003] }, { time = 0.18, at = [0.15, 0, 0.003] }]
)";
    Simulation simulation(
        scenario_of(text + dynamics(0.2, "mode = \"static\"\nsteps = 10\ngravity = [0, 0, -1]")));
    try {
        run(simulation);
        FAIL() << "the upper half has nothing to stand on";
    } catch (const PhysicsError& error) {
        EXPECT_NE(std::string(error.what()).find("is not held, and loads push it"),
                  std::string::npos)
            << error.what();
    }
}

TEST(ImplicitRun, CutsInStepsThatAreLong) {
    const std::string text =
        pulled_and_cut +
        dynamics(0.3, "integrator = \"implicit-euler\"\ntime_step = 0.02\ngravity = [0, 0, -2]");
    Simulation simulation(scenario_of(text));
    EXPECT_LT(2.0 * simulation.model().stable_step(), 0.02);
    run(simulation);
    EXPECT_EQ(simulation.num_steps(), 15u);
    EXPECT_GE(simulation.edits().size(), 2u);
    EXPECT_LT(simulation.ledger().mass_error(), 1e-12);
    EXPECT_LT(simulation.ledger().energy_error(), 1e-8);
    EXPECT_GT(simulation.model().energetics().min_volume_ratio(), 0.3);
    EXPECT_EQ(end_of(text), end_of(text));  // to the bit
}

TEST(ImplicitRun, AndStaticsGoOnWhenNothingIsLeft) {
    for (const std::string solver :
         {"mode = \"static\"", "integrator = \"implicit-euler\"\ntime_step = 0.02"}) {
        Simulation simulation(scenario_of(soft_cube + R"(
[[tool]]
kind = "carver"
shape = { sphere = { radius = 1.0 } }
path = [{ time = 0.02, at = [0, 0, 0] }, { time = 0.03, at = [0, 0, 0] }]
)" + dynamics(0.06, solver)));
        run(simulation);
        EXPECT_EQ(simulation.mesh().num_elements(), 0u);
        EXPECT_EQ(simulation.time(), 0.06);
    }
}

TEST(SolverKeys, ThatDoNotGoTogetherAreReported) {
    const auto report = [](const std::string& more) {
        return RunFolder().report(soft_cube + dynamics(0.2, more));
    };
    const auto has = [](const std::vector<std::string>& lines, const std::string& text) {
        return lines.size() == 1 && lines[0].find(text) != std::string::npos;
    };
    EXPECT_TRUE(has(report("steps = 4").errors, "'dynamics.steps': is for mode = \"static\""));
    EXPECT_TRUE(
        has(report("integrator = \"implicit-euler\"").errors, "needs a 'time_step' in seconds"));
    EXPECT_TRUE(has(report("integrator = \"implicit-euler\"\ntime_step = \"auto\"").errors,
                    "'dynamics.time_step': must be a number of seconds"));
    EXPECT_TRUE(has(report("mode = \"static\"\nsteps = 0").errors, "'dynamics.steps'"));
    EXPECT_TRUE(has(report("mode = \"statics\"").errors, "'dynamics.mode'"));
    for (const std::string line :
         {"integrator = \"implicit-euler\"", "time_step = 1", "safety = 0.5", "damping = 1"}) {
        const auto with_mode = report("mode = \"static\"\n" + line);
        EXPECT_EQ(with_mode.errors, std::vector<std::string>{});
        EXPECT_TRUE(has(with_mode.warnings, "has no effect with mode = \"static\"")) << line;
    }
    const std::string single = "\nprecision = \"single\"";
    EXPECT_EQ(report(single).errors, std::vector<std::string>{});
    EXPECT_TRUE(has(report("precision = \"float\"").errors, "'dynamics.precision'"));
    EXPECT_TRUE(has(report("mode = \"static\"" + single).errors,
                    "'dynamics.precision': \"single\" is not for mode = \"static\""));
    EXPECT_TRUE(has(report("integrator = \"implicit-euler\"\ntime_step = 0.1" + single).errors,
                    "'dynamics.precision': \"single\" is not for integrator = \"implicit-euler\""));
    std::string springs = soft_cube + dynamics(0.2, single);
    springs.replace(springs.find("[[material]]"), 12, "[[material]]\nmethod = \"mass-spring\"");
    bool refuses_springs = false;
    for (const std::string& line : RunFolder().report(springs).errors)
        refuses_springs |= line.find(
                               "\"single\" is not for method = \"mass-spring\" of "
                               "material[0]") != std::string::npos;
    EXPECT_TRUE(refuses_springs);
    const auto implicit = report("integrator = \"implicit-euler\"\ntime_step = 0.1\nsafety = 0.5");
    EXPECT_EQ(implicit.errors, std::vector<std::string>{});
    EXPECT_TRUE(has(implicit.warnings, "'dynamics.safety' has no effect"));
}

}  // namespace
}  // namespace incise::runner
