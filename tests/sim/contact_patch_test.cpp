// Contact at rest: a closed cut is no cut, and pressed blocks bear the same pressure everywhere.
// Sources: the patch test; code_aster SSNV104 for the blocks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/num_cases.h"
#include "tests/sim/contact_answers.h"

namespace incise::sim {
namespace {

void constrain(World& world, std::string name, std::array<bool, 3> components, const Part& part,
               double down = 0.0, double duration = 0.5) {
    physics::Constraint constraint{.name = std::move(name)};
    constraint.nodes = physics::VertexSet(nodes_where(world, part));
    constraint.components = components;
    constraint.displacement =
        physics::TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {duration, -down * Vec3::UnitZ()}});
    world.add_constraint(std::move(constraint));
}

// --- A closed cut is no cut.

enum class Plates { glued, slippery };

/// A cube that plates press, at rest.
struct PressedCube {
    double force;                     ///< N
    std::vector<Vec3> displacements;  ///< by node of the whole cube, m
};
constexpr double pressed_down = 0.1 * size;  // m

/// Adds a cut. Returns the inputs of the step in which it cuts.
using CutWorld = std::function<StepInputs(World&)>;

PressedCube press_cube(Plates plates, double friction, const CutWorld& cut) {
    WorldDef def;
    const int cells = test::is_sanitized ? 5 : 9;
    def.mesh = cube(cells);
    def.materials = {Solid{.young = 1e3, .poisson = 0.3}};
    def.damping = 15.0;
    def.contact.friction = friction;
    World world(std::move(def));
    const bool is_glued = plates == Plates::glued;
    const std::array<bool, 3> held{is_glued, is_glued, true};
    constrain(world, "floor", held, [](const Vec3& x) { return x.z() < 1e-9; });
    constrain(
        world, "lid", held, [](const Vec3& x) { return x.z() > size - 1e-9; }, pressed_down);
    if (!is_glued) {
        constrain(world, "x", {true, false, false}, [](const Vec3& x) { return x.x() < 1e-9; });
        constrain(world, "y", {false, true, false}, [](const Vec3& x) { return x.y() < 1e-9; });
    }
    const std::size_t num_nodes = world.mesh().num_nodes();
    run_until(world, 2.0, cut ? cut(world) : StepInputs());
    PressedCube pressed{world.reaction(world.constraints()[0]).force.z(), {}};
    for (std::size_t n = 0; n < num_nodes; ++n)
        pressed.displacements.push_back(world.positions()[n] -
                                        world.mesh().rest_position(VertexId(n)));
    return pressed;
}

/// Adds a surface z(x, y) that ends at `x_end`. Returns the inputs of the step in which it cuts.
StepInputs cut_along_surface(World& world, double x_end,
                             const std::function<double(double, double)>& z) {
    constexpr int n = 24;
    constexpr double low = -0.01, high = size + 0.01;
    topology::SurfaceData surface;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = low + (x_end - low) * i / n, y = low + (high - low) * j / n;
            surface.points.push_back({x, y, z(x, y)});
        }
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) {
            const std::int64_t a = j * (n + 1) + i, c = a + n + 1;
            surface.triangles.push_back({a, a + 1, c + 1});
            surface.triangles.push_back({a, c + 1, c});
        }
    const ToolId tool = world.add_tool({"surface", cutting::SurfaceCut{std::move(surface)}});
    return StepInputs().move(tool, Pose()).withdraw(tool);
}

/// Returns the mean distance of displacements, over that of the lid: root of the mean square.
double distance_of(const PressedCube& a, const PressedCube& b) {
    double sum = 0.0;
    for (std::size_t n = 0; n < a.displacements.size(); ++n)
        sum += (a.displacements[n] - b.displacements[n]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.displacements.size())) / pressed_down;
}

TEST(ContactPatch, OfAClosedCutIsThatOfNoCut) {
    constexpr double tolerance = test::is_sanitized ? 3e-3 : 1e-3;
    const auto expect_whole = [&](const std::string& what, const PressedCube& whole,
                                  const PressedCube& cut) {
        expect_answer("C1 " + what + ": force, N", cut.force, whole.force, tolerance);
        record_result("C1 " + what + ": displacements, part of the lid's", distance_of(cut, whole),
                      0.0);
        EXPECT_LT(distance_of(cut, whole), tolerance) << what;
    };
    const auto flat = [](World& world) {
        return cut_along(world, {0.05, 0.05, 0.049}, Vec3::UnitZ());
    };
    expect_whole("flat, no friction", press_cube(Plates::slippery, 0.0, {}),
                 press_cube(Plates::slippery, 0.0, flat));

    struct Case {
        std::string name;
        CutWorld cut;
    };
    const std::array<Case, 3> cases{
        {{"tilted 0.3, friction 0.5",
          [](World& world) {
              return cut_along(world, {0.05, 0.05, 0.049}, {-0.3, 0.0, 1.0});
          }},
         {"curved, friction 0.5",
          [](World& world) {
              return cut_along_surface(world, size + 0.01, [](double x, double y) {
                  return 0.06 - 3.0 * ((x - 0.05) * (x - 0.05) + (y - 0.05) * (y - 0.05));
              });
          }},
         {"half cut, friction 0.5", [](World& world) {
              return cut_along_surface(world, 0.047,
                                       [](double x, double) { return 0.049 + 0.3 * (x - 0.05); });
          }}}};
    const PressedCube whole = press_cube(Plates::glued, 0.0, {});
    for (const Case& c : test::some_of(cases)) {
        expect_whole(c.name, whole, press_cube(Plates::glued, 0.5, c.cut));
        const PressedCube slipped = press_cube(Plates::glued, 0.0, c.cut);
        EXPECT_LT(slipped.force, 0.99 * whole.force) << c.name;
        EXPECT_GT(distance_of(slipped, whole), 0.01) << c.name;
    }
}

// --- Two blocks, one on the other, without Poisson's effect.

constexpr double block = 0.1;  // edge of a block, m
constexpr Solid patch_solid{.young = 1e4};

/// The nominal stress at a stretch; without Lame's lambda, neo-Hookean.
double stress_at(double stretch) { return patch_solid.shear_modulus() * (stretch - 1.0 / stretch); }

/// Presses a column of two blocks by a part of its height, and waits until it rests.
World press_column(topology::MeshData mesh, double strain, bool is_cut) {
    WorldDef def;
    def.mesh = std::move(mesh);
    def.materials = {patch_solid};
    def.damping = 40.0;
    World world(std::move(def));
    constexpr std::array<bool, 3> all{true, true, true};
    constrain(world, "floor", all, [](const Vec3& x) { return x.z() < 1e-9; });
    constrain(
        world, "lid", all, [](const Vec3& x) { return x.z() > 2.0 * block - 1e-9; },
        strain * 2.0 * block, 0.3);
    run_until(world, 1.5,
              is_cut ? cut_along(world, {0.05, 0.05, block}, Vec3::UnitZ()) : StepInputs());
    return world;
}

TEST(ContactPatch, OfTwoCubesBearsHalfOfThePressEach) {
    constexpr double down = 2e-4, strain = down / (2.0 * block);
    World world =
        press_column(box(Vec3::Zero(), {block, block, 2.0 * block}, {4, 4, 8}), strain, true);
    const double stress = stress_at(1.0 - strain);
    double top = 0.0, most = 0.0;
    std::vector<double> areas(world.mesh().node_capacity());  // of cut faces at nodes, thirds
    const auto& surface = world.surface();
    for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
        if (!surface.is_cut()[t]) continue;
        const auto& [a, b, c] = surface.triangles()[t];
        const auto X = [&](VertexId n) { return world.mesh().rest_position(n); };
        for (const VertexId n : surface.triangles()[t])
            areas[n.index()] += (X(b) - X(a)).cross(X(c) - X(a)).norm() / 6.0;
    }
    const std::vector<Vec3> forces = world.model().mesh_elastic_forces();
    std::size_t num_nodes = 0;
    for (const VertexId n : world.mesh().nodes()) {
        if (areas[n.index()] == 0.0) continue;
        ++num_nodes;
        const double moved = world.positions()[n.index()].z() - world.mesh().rest_position(n).z();
        EXPECT_NEAR(moved, -0.5 * down, 1e-6 * down);
        // The elements of a cube push it off the other one by the pressure on the thirds of faces.
        const double force = std::abs(forces[n.index()].z());
        most = std::max(most, std::abs(force / (-stress * areas[n.index()]) - 1.0));
        top += 0.5 * force;
    }
    EXPECT_EQ(num_nodes, 50u);
    EXPECT_LT(most, 1e-6);
    record_result("C4 two cubes: worst nodal force, part", most, 0.0);
    expect_answer("C4 two cubes: sum of nodal forces, N", top, -stress * block * block, 1e-6);
}

/// The deviations of the stress of elements from the uniform one: root of the mean square, and
/// largest, as parts of it.
struct PatchError {
    double rms = 0.0, most = 0.0;
};
PatchError patch_error(int below, int above) {
    constexpr double strain = 0.05;
    topology::MeshData mesh = box(Vec3::Zero(), Vec3::Constant(block), {below, below, below});
    append(mesh, box({0, 0, block}, Vec3::Constant(block), {above, above, above}));
    const World world = press_column(std::move(mesh), strain, false);
    EXPECT_GT(world.report().contact.num_points, 20u);
    PatchError error;
    for (const CellId e : world.mesh().elements()) {
        const auto c = world.mesh().corners(e);
        Eigen::Matrix3d rest, now;
        for (int k = 0; k < 3; ++k) {
            const VertexId n = c[static_cast<std::size_t>(k) + 1];
            rest.col(k) = world.mesh().rest_position(n) - world.mesh().rest_position(c[0]);
            now.col(k) = world.positions()[n.index()] - world.positions()[c[0].index()];
        }
        const Eigen::Matrix3d F = now * rest.inverse();
        const double stress = patch_solid.shear_modulus() * (F(2, 2) - F.inverse()(2, 2));
        const double off = stress / stress_at(1.0 - strain) - 1.0;
        error.rms += off * off / static_cast<double>(world.mesh().num_elements());
        error.most = std::max(error.most, std::abs(off));
    }
    error.rms = std::sqrt(error.rms);
    return error;
}

TEST(ContactPatch, OfBlocksBearsOnePressureThoughMeshesDoNotMatch) {
    constexpr std::array<std::array<int, 2>, 3> meshes{{{4, 5}, {4, 4}, {6, 9}}};
    for (const auto& [below, above] : test::some_of(meshes)) {
        const PatchError error = patch_error(below, above);
        const std::string what =
            "C3 patch " + std::to_string(below) + " on " + std::to_string(above) + " bricks: ";
        record_result(what + "stress, rms, part", error.rms, 0.0);
        record_result(what + "stress, largest, part", error.most, 0.0);
        EXPECT_LT(error.most, 1e-5) << what;
    }
}

// --- Contact that does not flicker, and none where nothing touches.

// The edges of a box that rests in tissue lie on nodes: which side of the box they leave by may not
// change from step to step.
TEST(ContactPatch, OfABoxThatRestsExertsASteadyForce) {
    WorldDef def;
    def.mesh = cube(8);
    def.materials = {Solid{.young = 5e3, .poisson = 0.3}};
    def.damping = 60.0;
    World world = held(World(std::move(def)));
    constexpr double edge = 0.05;
    const ToolId box_tool =
        world.add_tool({"box", cutting::Probe{cutting::Cuboid{Vec3::Constant(edge)}}});
    world.place_tool(box_tool, at({0.05, 0.05, size + 0.5 * edge}));
    constexpr double time = 0.2;
    while (world.time() < time) {
        const double dt = 0.8 * world.stable_step();
        const double part = std::min(1.0, (world.time() + dt) / time);
        const Pose pose = at({0.05, 0.05, size + 0.5 * edge - part * 0.002});
        world.step(dt, StepInputs().move(box_tool, pose));
    }
    run_until(world, 3.0 * time);
    double sum = 0.0, least = std::numeric_limits<double>::infinity(), most = 0.0;
    constexpr int num_steps = 200;
    for (int i = 0; i < num_steps; ++i) {
        world.step(0.8 * world.stable_step());
        const double force = world.report().tools[0].force.z();
        sum += force / num_steps;
        least = std::min(least, force);
        most = std::max(most, force);
    }
    EXPECT_GT(sum, 0.1);
    EXPECT_LT(most - least, 0.2 * sum);
}

// Round a sharp corner of a body, where elements are much smaller than elsewhere, faces that meet
// at an acute angle are no contact.
TEST(ContactPatch, OfAWedgeFineAtItsEdgeIsNone) {
    const auto radii = shells(1e-4, 4, 1.6, 0.05);
    topology::MeshData mesh = graded_quarter(radii);
    for (Vec3& x : mesh.points) x.z() -= 0.2 * (x.x() + x.y());
    WorldDef def;
    def.mesh = std::move(mesh);
    set_graded_materials(def, Solid{.young = 5e3, .poisson = 0.3}, radii);
    World world(std::move(def));
    for (int i = 0; i < 200; ++i) {
        world.step(0.8 * world.stable_step());
        ASSERT_EQ(world.report().contact.num_points, 0u);
    }
    EXPECT_EQ(world.report().contact.max_penetration, 0.0);
    EXPECT_LT(world.model().energetics().totals().kinetic_energy, 1e-20);  // of rounding
}

}  // namespace
}  // namespace incise::sim
