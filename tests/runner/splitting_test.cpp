// Blades and cuts that split elements during a run: what they part, and what the ledger books.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>

#include "incise/topology/validate.h"
#include "run_folder.h"
#include "support/num_cases.h"

namespace incise::runner {
namespace {

const std::vector<std::string> no_violations;

/// Through the whole cube at a slant, where the mesh has no faces.
const std::string slanting_blade = R"(
[[tool]]
kind = "blade"
name = "knife"
edge = [[0, -0.1, 0.05], [0, 0.03, 0.053], [0, 0.2, 0.058]]
path = [{ time = 0.02, at = [-0.05, 0, 0] }, { time = 0.12, at = [0.15, 0, 0.01] }]
)";

const std::string gravity = "gravity = [0, 0, -9.81]\ndamping = 5\n";

TEST(SplittingBlade, PartsTheBodyWhileItMoves) {
    Simulation simulation(scenario_of(soft_cube + slanting_blade + dynamics(0.15, gravity)));
    run(simulation);
    EXPECT_EQ(topology::validate(simulation.mesh()), no_violations);
    const auto& edits = simulation.edits();
    ASSERT_GT(edits.size(), 2u);
    EXPECT_EQ(edits.back().after.components, 2);
    EXPECT_LE(simulation.ledger().mass_error(), 1e-13);

    double area = 0.0, volume_joined = 0.0;
    const BodyTotals* last = &simulation.ledger().initial();
    for (const EditRecord& edit : edits) {
        SCOPED_TRACE(testing::Message() << "at " << edit.time);
        const physics::Totals &before = edit.before.totals, &after = edit.after.totals;
        EXPECT_EQ(edit.before.nodes, last->nodes);
        EXPECT_EQ(edit.before.stable_step, last->stable_step);
        last = &edit.after;
        EXPECT_EQ(edit.after.elements, edit.before.elements + edit.elements_added);
        EXPECT_EQ(edit.after.nodes, edit.before.nodes + edit.nodes_added);
        EXPECT_LE(edit.nodes_duplicated, edit.nodes_added);
        EXPECT_LE(edit.elements_split, edit.elements_crossed);
        EXPECT_EQ(edit.elements_split > 0, std::isfinite(edit.min_altitude_ratio));
        EXPECT_EQ(edit.mass_removed, 0.0);
        EXPECT_NEAR(after.mass, before.mass, 1e-13 * before.mass);
        EXPECT_NEAR(after.rest_volume, before.rest_volume, 1e-12 * before.rest_volume);
        volume_joined += edit.volume_joined - edit.volume_released;
        // Light fragments that join others change these a little in a mesh of few bricks.
        EXPECT_NEAR(after.elastic_energy, before.elastic_energy, 5e-3 * before.elastic_energy);
        EXPECT_NEAR(after.kinetic_energy, before.kinetic_energy, 5e-3 * before.kinetic_energy);
        EXPECT_LE((after.momentum - before.momentum).norm(), 1e-13 * before.mass);
        EXPECT_LE((after.centre_of_mass - before.centre_of_mass).norm(), 1e-4);
        EXPECT_GE(edit.after.stable_step, 0.75 * simulation.ledger().initial().stable_step);
        area += edit.cut_area;
    }
    // The section of the cube, which hangs through: a slanting cut of 0.01 m2, and some per cent.
    EXPECT_NEAR(area, 0.0104, 0.0002);
    // Of the fragments that are left.
    const fragments::FragmentMesh& fragments = simulation.model().fragments();
    double volume_away = 0.0;
    for (const CellId cell : simulation.mesh().elements())
        if (!fragments.is_at_home(cell))
            volume_away += topology::rest_volume(simulation.mesh(), cell);
    EXPECT_GT(volume_away, 0.0);
    EXPECT_NEAR(volume_joined, volume_away, 1e-12 * volume_away);
}

// A plane along faces of the mesh makes copies of nodes, and no light fragments.
TEST(Ledger, TellsCopiesFromJoins) {
    const auto edit_at = [](const std::string& height) {
        Simulation simulation(scenario_of(soft_cube + dynamics(0.03, "gravity = [0.5, 0, 0]\n") +
                                          R"(
[[tool]]
kind = "cut"
time = 0.02
plane = { point = [0, 0, )" + height +
                                          R"(], normal = [0, 0, 1] }
)"));
        run(simulation);
        return simulation.edits().at(0);
    };
    const EditRecord copies = edit_at("0.033333333333333333"), joins = edit_at("0.047");
    for (const EditRecord& edit : {copies, joins}) {
        EXPECT_EQ(edit.after.components, 2);
        EXPECT_GE(edit.fragment_nodes_copied, 16u);
        EXPECT_EQ(edit.volume_released, 0.0);
    }
    EXPECT_EQ(copies.fragments_copied, 0u);
    EXPECT_EQ(copies.volume_joined, 0.0);
    EXPECT_GT(joins.fragments_copied, 0u);
    EXPECT_GT(joins.volume_joined, 0.0);
    const auto change = [](const EditRecord& edit) {
        const physics::Totals &before = edit.before.totals, &after = edit.after.totals;
        return std::max(std::abs(after.elastic_energy / before.elastic_energy - 1.0),
                        std::abs(after.kinetic_energy / before.kinetic_energy - 1.0));
    };
    EXPECT_LT(change(copies), 1e-12);
    EXPECT_GT(change(joins), 1e-9);
    EXPECT_LT(change(joins), 3e-2);
}

TEST(SplittingBlade, RepeatedEndsInTheSameBits) {
    const Scenario scenario = scenario_of(soft_cube + slanting_blade + dynamics(0.15, gravity));
    Simulation one(scenario), other(scenario);
    run(one);
    run(other);
    ASSERT_EQ(one.mesh().node_capacity(), other.mesh().node_capacity());
    for (std::size_t n = 0; n < one.mesh().node_capacity(); ++n)
        ASSERT_EQ(one.world().positions()[n], other.world().positions()[n]);
}

/// Enough elements for many blocks and ranges of nodes.
void expect_the_same_bits_for_any_number_of_threads(const std::string& more_of_material,
                                                    const std::string& precision = "double") {
    const std::string box = test::is_sanitized ? "cells = [9, 9, 9]" : "cells = [16, 16, 16]";
    const std::string body = "[mesh]\nbox = { size = [0.1, 0.1, 0.1], " + box + R"( }
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[material]]
density = 1000
law = "neo-hookean"
young = 1000
poisson = 0.4
)";
    const Scenario scenario =
        scenario_of(body + more_of_material + slanting_blade +
                    dynamics(0.06, gravity + "precision = \"" + precision + "\"\n"));
    const auto run_on = [&](int num_threads) {
        auto simulation = std::make_unique<Simulation>(scenario);
        simulation->set_num_threads(num_threads);
        run(*simulation);
        return simulation;
    };
    const auto expected = run_on(1);
    EXPECT_GT(expected->edits().size(), 2u);
    constexpr std::array numbers_of_threads{5, 2, 16};
    for (const int num_threads : test::some_of(numbers_of_threads)) {
        SCOPED_TRACE(num_threads);
        const auto simulation = run_on(num_threads);
        const auto bits_of = [](const auto& values) {
            return std::string_view(reinterpret_cast<const char*>(values.data()),
                                    values.size() * sizeof(values[0]));
        };
        const physics::Model &one = expected->model(), &other = simulation->model();
        EXPECT_EQ(bits_of(one.positions()), bits_of(other.positions()));
        EXPECT_EQ(bits_of(one.velocities()), bits_of(other.velocities()));
        EXPECT_EQ(bits_of(one.elastic_forces()), bits_of(other.elastic_forces()));
        EXPECT_EQ(bits_of(one.state().history().values()),
                  bits_of(other.state().history().values()));
        const physics::Totals a = one.energetics().totals(), b = other.energetics().totals();
        EXPECT_EQ(a.mass, b.mass);
        EXPECT_EQ(a.rest_volume, b.rest_volume);
        EXPECT_EQ(a.kinetic_energy, b.kinetic_energy);
        EXPECT_EQ(a.elastic_energy, b.elastic_energy);
        EXPECT_EQ(a.gravity_energy, b.gravity_energy);
        EXPECT_EQ(a.momentum, b.momentum);
        EXPECT_EQ(a.angular_momentum, b.angular_momentum);
        EXPECT_EQ(a.centre_of_mass, b.centre_of_mass);
        EXPECT_EQ(one.energetics().min_volume_ratio(), other.energetics().min_volume_ratio());
        EXPECT_EQ(one.energetics().external_work(), other.energetics().external_work());
        EXPECT_EQ(one.energetics().dissipated_energy(), other.energetics().dissipated_energy());
    }
}

TEST(SplittingBlade, EndsAlikeForAnyNumberOfThreads) {
    expect_the_same_bits_for_any_number_of_threads("");
}

TEST(SplittingBlade, EndsAlikeForAnyThreadsInViscousTissue) {
    expect_the_same_bits_for_any_number_of_threads("prony = [{ alpha = 0.3, tau = 0.05 }]\n");
}

TEST(SplittingBlade, EndsAlikeForAnyThreadsInSinglePrecision) {
    expect_the_same_bits_for_any_number_of_threads("", "single");
}

// Both are in the body at once, and divide elements that the other is in.
TEST(SplittingBlade, MayCrossAnother) {
    const std::string upright_blade = R"(
[[tool]]
kind = "blade"
name = "other"
edge = [[0.052, 0, -0.1], [0.049, 0, 0.2]]
path = [{ time = 0.02, at = [0, -0.04, 0] }, { time = 0.13, at = [0, 0.14, 0] }]
)";
    Simulation simulation(scenario_of(soft_cube + slanting_blade + upright_blade + dynamics(0.15)));
    run(simulation);
    EXPECT_EQ(topology::validate(simulation.mesh()), no_violations);
    EXPECT_EQ(simulation.edits().back().after.components, 4);
}

TEST(SplittingBlade, MayCrossAnotherInTheBodyMeanwhile) {
    // The second one meets the front of the first one all the way, before and after its turn.
    for (const char* order : {"knife", "other"})
        for (const char* snap : {"0", "0.1"}) {
            SCOPED_TRACE(testing::Message() << order << " first, snap " << snap);
            const auto blade = [&](const std::string& name, const char* edge) {
                return "[[tool]]\nkind = \"blade\"\nname = \"" + name + "\"\nsnap = " + snap +
                       "\nedge = " + edge +
                       "\npath = [{ time = 0, at = [0, 0, 0.113] }, { time = 0.1, at = [0, 0, "
                       "-0.02] }]\n";
            };
            const std::string along = blade("knife", "[[0.053, -0.1, 0], [0.053, 0.2, 0]]"),
                              across = blade("other", "[[-0.1, 0.047, 0], [0.2, 0.047, 0.004]]");
            Simulation simulation(scenario_of(
                soft_cube + (order == std::string("knife") ? along + across : across + along) +
                dynamics(0.12)));
            run(simulation);
            EXPECT_EQ(topology::validate(simulation.mesh()), no_violations);
            EXPECT_EQ(simulation.edits().back().after.components, 4);
        }
}

TEST(SplittingBlade, GoesOnAfterAPlaneCutsItsTissue) {
    for (const char* snap : {"0", "0.1"}) {
        SCOPED_TRACE(testing::Message() << "snap " << snap);
        Simulation simulation(scenario_of(soft_cube + dynamics(0.12) + R"(
[[tool]]
kind = "blade"
name = "knife"
edge = [[0.053, -0.1, 0], [0.053, 0.2, 0]]
path = [
    { time = 0, at = [0, 0, 0.11] }, { time = 0.04, at = [0, 0, 0.053] },
    { time = 0.06, at = [0, 0, 0.053] }, { time = 0.1, at = [0, 0, -0.02] },
]
snap = )" + snap + R"(
[[tool]]
kind = "cut"
name = "across"
time = 0.05
plane = { point = [0, 0.047, 0], normal = [0.1, 1, 0.05] }
snap = )" + snap + "\n"));
        run(simulation);
        EXPECT_EQ(topology::validate(simulation.mesh()), no_violations);
        EXPECT_EQ(simulation.edits().back().after.components, 4);
    }
}

TEST(SplittingBlade, GoesOnWhereItLeftOffAfterRetreat) {
    // Half way in, out again, and then right through.
    Simulation simulation(scenario_of(soft_cube + dynamics(0.3) + R"(
[[tool]]
kind = "blade"
edge = [[0, -0.1, 0.051], [0, 0.2, 0.054]]
path = [
    { time = 0.00, at = [-0.02, 0, 0] }, { time = 0.06, at = [0.05, 0, 0] },
    { time = 0.12, at = [-0.02, 0, 0] }, { time = 0.26, at = [0.12, 0, 0] },
]
)"));
    run(simulation);
    EXPECT_EQ(topology::validate(simulation.mesh()), no_violations);
    EXPECT_EQ(simulation.edits().back().after.components, 2);
}

/// What an exact blade opens of a cube that nothing moves but what `more` says, m2.
double opened_area(const std::string& edge, const std::string& path, const std::string& more = "") {
    Simulation simulation(scenario_of(soft_cube + more +
                                      "[[tool]]\nkind = \"blade\"\nsnap = 0\nedge = " + edge +
                                      "\npath = [" + path + "]\n" + dynamics(0.08)));
    run(simulation);
    EXPECT_EQ(topology::validate(simulation.mesh()), no_violations);
    EXPECT_EQ(simulation.edits().back().after.components, 1);
    double area = 0.0;
    for (const EditRecord& edit : simulation.edits()) area += edit.cut_area;
    return area;
}

const std::string along_y = "[[0, -0.1, 0.0473], [0, 0.2, 0.0473]]";

// The blade stops in the second of three bricks. It has cut more than half of each element there,
// so that they open whole, to the end of the brick.
constexpr double to_the_end_of_the_brick = 0.1 * 0.1 * 2.0 / 3.0;

// The last key may only repeat the one before: the way into the body tells where ahead is.
TEST(SplittingBlade, CutsUpToWhereItsPathEnds) {
    const std::string way =
        "{ time = 0.02, at = [-0.05, 0, 0] }, { time = 0.06, at = [0.0631, 0, 0] }";
    EXPECT_NEAR(opened_area(along_y, way), to_the_end_of_the_brick, 1e-8);
    EXPECT_NEAR(opened_area(along_y, way + ", { time = 0.07, at = [0.0631, 0, 0] }"),
                to_the_end_of_the_brick, 1e-8);
}

// Rounding turns what is interpolated between two equal poses.
TEST(SplittingBlade, CutsUpToWhereItRestsIfTurned) {
    const std::string edge = "[[0, -0.1, -0.2], [0, 0.1, 0.2]]";
    const std::string turn = ", rotate = { axis = [1, 1, 0], angle = 1.70 } }";
    const std::string way = "{ time = 0.02, at = [-0.15, 0.05, 0.0473]" + turn +
                            ", { time = 0.06, at = [0.0631, 0.05, 0.0473]" + turn;
    const std::string rest = ", { time = 0.07, at = [0.0631, 0.05, 0.0473]" + turn;
    EXPECT_NEAR(opened_area(edge, way + rest), opened_area(edge, way), 1e-9);
}

// A blade that stands, into which the tissue moves, and one that the tissue overtakes: the cut
// tells where ahead is.
TEST(SplittingBlade, CutsUpToWhereTissueMeetsIt) {
    const auto moved_by = [](const std::string& way) {
        return R"([[constraint]]
name = "all"
where = { half_space = { point = [0, 0, 1e-9], normal = [0, 0, 1] } }
move = [{ time = 0.02, by = [0, 0, 0] }, { time = 0.06, by = [)" +
               way + "] }]\n";
    };
    EXPECT_NEAR(
        opened_area(along_y,
                    "{ time = 0.02, at = [-0.05, 0, 0] }, { time = 0.06, at = [-0.05, 0, 0] }",
                    moved_by("-0.1131, 0, 0")),
        to_the_end_of_the_brick, 1e-8);
    // From the other side it has cut less than half of each: the cut ends at its edge.
    EXPECT_NEAR(
        opened_area(along_y,
                    "{ time = 0.02, at = [0.15, 0, 0] }, { time = 0.06, at = [0.1762, 0, 0] }",
                    moved_by("0.1131, 0, 0")),
        0.00369, 1e-8);
}

TEST(Cut, AlongAPlaneComesAtItsTime) {
    Simulation simulation(scenario_of(soft_cube + dynamics(0.05) + R"(
[[tool]]
kind = "cut"
time = 0.0234
snap = 0
plane = { point = [0.05, 0.05, 0.052], normal = [0.1, -0.2, 1] }
)"));
    run(simulation);
    ASSERT_EQ(simulation.edits().size(), 1u);
    const EditRecord& edit = simulation.edits()[0];
    EXPECT_GE(edit.time, 0.0234);
    EXPECT_LE(edit.time, 0.0334);
    EXPECT_EQ(edit.after.components, 2);
    const double slant = 1.0 / Vec3(0.1, -0.2, 1).normalized().z();
    EXPECT_NEAR(edit.cut_area, 0.01 * slant, 1e-8);
}

TEST(Cut, AlongAClosedSurfaceFreesItsInside) {
    const RunFolder folder;
    std::ofstream(folder / "octahedron.obj")
        << "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
           "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    // A cube about the origin, so that the surface lies in its middle.
    const std::string cube = R"(
[mesh]
box = { size = [0.1, 0.1, 0.1], cells = [4, 4, 4], origin = [-0.05, -0.05, -0.05] }
[[material]]
density = 1000
young = 1000
poisson = 0.4
)";
    Simulation simulation(folder.scenario(cube + dynamics(0.02) + R"(
[[tool]]
kind = "cut"
time = 0
surface = "octahedron.obj"
scale = 0.0371
snap = 0
)"));
    EXPECT_TRUE(simulation.warnings().empty());
    run(simulation);
    ASSERT_EQ(simulation.edits().size(), 1u);
    EXPECT_EQ(simulation.edits()[0].after.components, 2);
    const double face = std::sqrt(3.0) / 2.0 * 0.0371 * 0.0371;
    EXPECT_NEAR(simulation.edits()[0].cut_area, 8.0 * face, 0.03 * 8.0 * face);
}

}  // namespace
}  // namespace incise::runner
