// Tools that touch tissue, in runs of scenarios.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "incise/runner/frame_builder.h"
#include "incise/runner/measured_quantities.h"
#include "run_folder.h"

namespace incise::runner {
namespace {

/// A thread between two points below the top of the cube.
std::string suture(const std::string& more) {
    return R"(
[[tool]]
kind = "suture"
name = "thread"
points = [[0.02, 0.05, 0.09], [0.08, 0.05, 0.09]]
stiffness = 20
time = 0.02
)" + more;
}

void run_to(Simulation& simulation, double time) {
    if (simulation.num_steps() == 0) simulation.start();
    while (simulation.time() < time) simulation.step();
}

double value_of(const Simulation& simulation, const std::string& name) {
    const Quantities row = history_row(simulation, simulation.ledger().body_totals());
    return std::ranges::find(row, name, &Quantities::value_type::first)->second;
}

TEST(TouchingTools, ASutureIsTiedAndDrawnAtItsTimes) {
    const RunFolder folder;
    Simulation simulation(folder.scenario(soft_cube + dynamics(0.3, "damping = 20\n") +
                                          suture("tighten = { over = 0.1, length = 0.05 }\n") +
                                          "[output]\ninterval = 0.01\n"));
    const ToolId thread = simulation.world().tools()[0];
    run_to(simulation, 0.019);
    EXPECT_FALSE(simulation.world().is_suture_tied(thread));
    run_to(simulation, 0.07);
    EXPECT_TRUE(simulation.world().is_suture_tied(thread));
    EXPECT_NEAR(simulation.world().suture_length(thread), 0.055, 1e-12);
    EXPECT_GT(value_of(simulation, "force_thread_x"), -1.0);
    run_to(simulation, 0.3);
    EXPECT_NEAR(simulation.world().suture_length(thread), 0.05, 1e-15);
    // The tissue pulls the thread back at its first point, to the left.
    EXPECT_LT(value_of(simulation, "force_thread_x"), -1e-3);
    EXPECT_NEAR(value_of(simulation, "force_thread_y"), 0.0,
                0.1 * -value_of(simulation, "force_thread_x"));
    EXPECT_EQ(simulation.warnings(), std::vector<std::string>{});
}

/// Sums what each step says of a tool, and compares the means with the rows of the history.
class ImpulseCheck : public Observer {
  public:
    int num_rows = 0;
    double largest = 0.0;  // N

    void on_edit(const Simulation& simulation, const sim::EditRecord&) override {
        take_step(simulation);
        compare(simulation);
    }
    void on_frame(const Simulation& simulation) override {
        take_step(simulation);
        compare(simulation);
    }
    void on_step(const Simulation& simulation) override { take_step(simulation); }

  private:
    void take_step(const Simulation& simulation) {
        if (simulation.num_steps() == num_steps_) return;
        num_steps_ = simulation.num_steps();
        const sim::StepReport& step = simulation.world().report();
        if (row_is_over_) {
            impulse_.setZero();
            from_ = step.from;
            row_is_over_ = false;
        }
        for (const sim::ToolState& tool : step.tools)
            impulse_ += (step.to - step.from) * tool.force;
    }
    void compare(const Simulation& simulation) {
        const double duration = simulation.time() - from_;
        row_is_over_ = true;
        if (duration == 0.0) return;
        const Vec3 mean = impulse_ / duration;
        largest = std::max(largest, mean.norm());
        ++num_rows;
        EXPECT_NEAR(value_of(simulation, "force_ball_x"), mean.x(), 1e-12 * (1.0 + mean.norm()));
        EXPECT_NEAR(value_of(simulation, "force_ball_z"), mean.z(), 1e-12 * (1.0 + mean.norm()));
    }

    Vec3 impulse_ = Vec3::Zero();  // N s, since from_
    double from_ = 0.0;            // s
    std::uint64_t num_steps_ = 0;
    bool row_is_over_ = false;
};

TEST(TouchingTools, ForcesOfARowAreMeansSinceTheRowBefore) {
    const RunFolder folder;
    // The ball presses while a carver makes edits between the frames.
    const scenario::Scenario pressed = folder.scenario(soft_cube + dynamics(0.1) + R"(
[[tool]]
kind = "probe"
name = "ball"
shape = { sphere = { radius = 0.02 } }
path = [{ time = 0, at = [0.05, 0.05, 0.121] }, { time = 0.1, at = [0.055, 0.05, 0.105] }]
[[tool]]
kind = "carver"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0.033, at = [0, 0, 0] }, { time = 0.077, at = [0.1, 0.05, 0] }]
[output]
interval = 0.02
)");
    Simulation simulation(pressed);
    ImpulseCheck check;
    simulation.add_observer(check);
    simulation.start();
    while (!simulation.is_finished()) simulation.step();
    EXPECT_GT(simulation.edits().size(), 1u);
    EXPECT_GT(check.num_rows, 6);
    EXPECT_GT(check.largest, 0.01);
    // A run that is resumed between two rows has the same means.
    Simulation halted(pressed), resumed(pressed);
    halted.start();
    while (halted.time() < 0.049) halted.step();
    ArchiveWriter state;
    halted.save(state);
    ArchiveReader reader(state.bytes());
    resumed.restore(reader);
    while (!resumed.is_finished()) resumed.step();
    EXPECT_EQ(value_of(resumed, "force_ball_z"), value_of(simulation, "force_ball_z"));
}

TEST(TouchingTools, ASutureThatTearsIsReportedOnce) {
    const RunFolder folder;
    Simulation simulation(
        folder.scenario(soft_cube + dynamics(0.2) +
                        suture("max_force = 0.001\ntighten = { over = 0.1, length = 0.03 }\n")));
    run_to(simulation, 0.2);
    ASSERT_EQ(simulation.warnings().size(), 1u);
    EXPECT_NE(simulation.warnings()[0].find("suture 'thread' holds nothing from t = "),
              std::string::npos);
    // The same after a restore between.
    Simulation halted(simulation.scenario());
    run_to(halted, 0.15);
    ArchiveWriter state;
    halted.save(state);
    Simulation resumed(simulation.scenario());
    ArchiveReader reader(state.bytes());
    resumed.restore(reader);
    while (!resumed.is_finished()) resumed.step();
    EXPECT_EQ(resumed.warnings(), simulation.warnings());
}

TEST(TouchingTools, WarnOfTissueThatIsInsideThem) {
    const RunFolder folder;
    const auto warnings_with = [&](const std::string& shape) {
        return Simulation(folder.scenario(soft_cube + dynamics(0.1) +
                                          "[[obstacle]]\nname = \"stone\"\nshape = { " + shape +
                                          " }\n"))
            .warnings();
    };
    EXPECT_TRUE(warnings_with("half_space = { point = [0, 0, 0], normal = [0, 0, 1] }").empty());
    for (const std::string shape :
         {"half_space = { point = [0, 0, 0.05], normal = [0, 0, 1] }", "sphere = { radius = 0.05 }",
          "capsule = { from = [0, 0, 0], to = [0, 0, 0.1], radius = 0.01 }",
          "box = { size = [0.1, 0.1, 0.1] }"}) {
        SCOPED_TRACE(shape);
        ASSERT_EQ(warnings_with(shape).size(), 1u);
        EXPECT_NE(warnings_with(shape)[0].find("tool 'stone' has "), std::string::npos);
        EXPECT_NE(warnings_with(shape)[0].find("of the body at rest inside it"), std::string::npos);
    }
}

const std::vector<float>& floats(const io::Frame& frame, const std::string& name) {
    return std::get<std::vector<float>>(
        std::ranges::find(frame.point_fields, name, &io::Field::name)->values);
}

TEST(TouchingTools, FramesHaveTheForcesAndPressuresOfContact) {
    const RunFolder folder;
    // Without lateral contraction the pressure is the same everywhere.
    std::string cube = soft_cube;
    cube.replace(cube.find("poisson = 0.4"), 13, "poisson = 0.0");
    Simulation simulation(folder.scenario(cube + dynamics(0.4, "damping = 30\n") + R"(
[[tool]]
kind = "probe"
name = "plate"
shape = { box = { size = [0.3, 0.3, 0.02] } }
path = [{ time = 0, at = [0.05, 0.05, 0.11] }, { time = 0.2, at = [0.05, 0.05, 0.107] },
        { time = 1, at = [0.05, 0.05, 0.107] }]
)"));
    const auto frame_now = [&] {
        const auto forces = simulation.world().contact_forces();
        return build_frame(simulation.model(), simulation.time(), {}, &forces.value());
    };
    const io::Frame first = frame_now();
    EXPECT_EQ(std::ranges::count(floats(first, "contact_force"), 0.0f), 3 * 64);
    run_to(simulation, 0.4);
    const io::Frame frame = frame_now();
    const std::vector<float>& forces = floats(frame, "contact_force");
    const std::vector<float>& pressures = floats(frame, "contact_pressure");
    const double force = value_of(simulation, "force_plate_z");
    double sum = 0.0;
    for (std::size_t n = 0; n < frame.mesh.points.size(); ++n) {
        sum += forces[3 * n + 2];
        const bool is_on_top = simulation.mesh().rest_position(VertexId(n)).z() > 0.09;
        EXPECT_NEAR(pressures[n], is_on_top ? force / 0.01 : 0.0, 0.02 * force / 0.01);
    }
    EXPECT_GT(force, 0.1);
    EXPECT_NEAR(-sum, force, 1e-5 * force);
}

TEST(TouchingTools, FramesOfRunsWithoutContactHaveNoSuchFields) {
    const RunFolder folder;
    const Simulation simulation(
        folder.scenario(soft_cube + dynamics(0.1) + "[contact]\nenabled = false\n"));
    EXPECT_FALSE(simulation.world().contact_forces().has_value());
}

// Scissors close and open at their times, and the run is the same after a checkpoint or without.
TEST(TouchingTools, ScissorsCutBetweenTheirTimes) {
    const RunFolder folder;
    // They lie across the cube, at half its height.
    const std::string scissors = R"(
[[tool]]
kind = "scissors"
length = 0.4
angle = 2
closing_time = 0.05
close = 0.02
open = 0.1
path = [
  { time = 0, at = [0.052, -0.05, 0.05], rotate = { axis = [1, -1, 1], angle = 2.0943951023931953 } },
  { time = 0.2, at = [0.052, -0.05, 0.05], rotate = { axis = [1, -1, 1], angle = 2.0943951023931953 } },
]
)";
    Simulation simulation(folder.scenario(soft_cube + dynamics(0.2, "damping = 20\n") + scissors +
                                          "[output]\ninterval = 0.01\n"));
    const ToolId tool = simulation.world().tools()[0];
    run_to(simulation, 0.019);
    EXPECT_FALSE(simulation.world().is_tool_closed(tool));
    EXPECT_EQ(simulation.edits().size(), 0U);
    run_to(simulation, 0.09);
    EXPECT_TRUE(simulation.world().is_tool_closed(tool));
    EXPECT_EQ(topology::components(simulation.world().mesh()).count, 2);
    const std::size_t num_edits = simulation.edits().size();
    run_to(simulation, 0.2);
    EXPECT_FALSE(simulation.world().is_tool_present(tool));
    EXPECT_EQ(simulation.edits().size(), num_edits);
    EXPECT_EQ(simulation.warnings(), std::vector<std::string>{});
}

}  // namespace
}  // namespace incise::runner
