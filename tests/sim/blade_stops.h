// Straight cuts through small boxes in steps that end where the caller says.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "incise/cutting/cutter.h"
#include "incise/sim/world.h"
#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"

namespace incise::sim {

/// A box of tetrahedra that a straight edge cuts, from outside to outside. Its planes lie at
/// multiples of `spacing`.
struct StoppedCut {
    static constexpr double spacing = 0.01;  // m
    static constexpr std::array<int, 3> num_cells = {4, 2, 4};

    Solver solver = Solver::semi_implicit_euler;
    double snap = cutting::default_snap;
    double jitter = 0.0;            ///< of the inner nodes, as a share of the spacing
    double gravity = 0.0;           ///< m/s2
    double height = 2.5;            ///< z of the edge on its way, in spacings
    bool has_second_blade = false;  ///< one that goes up at the same time, across x
    bool is_resumed = false;        ///< saved and restored after each step

    friend std::ostream& operator<<(std::ostream& out, const StoppedCut& c) {
        return out << "solver " << static_cast<int>(c.solver) << ", snap " << c.snap << ", jitter "
                   << c.jitter << ", gravity " << c.gravity << ", height " << c.height
                   << (c.has_second_blade ? ", two blades" : "")
                   << (c.is_resumed ? ", resumed" : "");
    }
};

/// What a cut has come to.
struct StoppedOutcome {
    int num_components = 0;
    double cut_area = 0.0;              ///< at rest, m2
    std::size_t num_contradictory = 0;  ///< triangles in all steps: see Cutter
};

inline World box_of(const StoppedCut& c, std::uint64_t seed) {
    Vec3 size;
    for (int k = 0; k < 3; ++k)
        size[k] = StoppedCut::spacing * StoppedCut::num_cells[static_cast<std::size_t>(k)];
    topology::MeshData mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                 size, StoppedCut::num_cells);
    test::Random random(seed);
    for (Vec3& x : mesh.points)
        for (int k = 0; k < 3; ++k)
            if (x[k] > 1e-9 && x[k] < size[k] - 1e-9)
                x[k] += c.jitter * StoppedCut::spacing * random.uniform(-1.0, 1.0);
    WorldDef def;
    def.mesh = mesh;
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1000.0, 3000.0}}}};
    def.gravity = {0, 0, -c.gravity};
    def.damping = 20.0;
    def.solver = c.solver;
    World world(std::move(def));
    // Both ends, so that each part is held when the cut is through.
    std::vector<VertexId> ends;
    for (const VertexId n : world.mesh().nodes())
        if (const double z = world.mesh().rest_position(n).z(); z < 1e-9 || z > size.z() - 1e-9)
            ends.push_back(n);
    world.add_constraint({.name = "ends", .nodes = physics::VertexSet(std::move(ends))});
    return world;
}

/// Leads the edge along x to each of `stops` in turn, in spacings, a step each.
inline StoppedOutcome cut_with_stops(const StoppedCut& c, std::span<const double> stops,
                                     std::uint64_t seed = 0) {
    constexpr double h = StoppedCut::spacing;
    World world = box_of(c, seed);
    const double dt = c.solver == Solver::semi_implicit_euler ? 0.5 * world.stable_step() : 1e-3;
    const auto at = [](const Vec3& x) { return Pose{Eigen::Quaterniond::Identity(), x}; };
    std::vector<ToolId> blades{world.add_tool(
        {"blade", cutting::Blade{{{0, -0.3 * h, c.height * h}, {0, 2.3 * h, c.height * h}},
                                 cutting::CutMode::split,
                                 c.snap}})};
    if (c.has_second_blade)
        blades.push_back(world.add_tool(
            {"second", cutting::Blade{{{2.25 * h, -0.4 * h, 0}, {2.25 * h, 2.2 * h, 0}},
                                      cutting::CutMode::split,
                                      c.snap}}));
    const auto pose = [&](std::size_t blade, double x) {
        return at(blade == 0 ? Vec3(x * h, 0, 0) : Vec3(0, 0, x * h));
    };
    for (std::size_t b = 0; b < blades.size(); ++b) world.place_tool(blades[b], pose(b, -1.0));
    StoppedOutcome outcome;
    const auto step = [&](const StepInputs& inputs) {
        for (const Edit& edit : world.step(dt, inputs).edits)
            outcome.cut_area += edit.record.cut_area;
        for (std::size_t b = 0; b < blades.size(); ++b)
            outcome.num_contradictory +=
                world.cutter().contradictory_faces({b}, world.mesh()).size();
        if (c.is_resumed) {
            const std::string state = world.save();
            World other = box_of(c, seed);
            other.restore(state);
            world = std::move(other);
        }
    };
    const auto lead = [&](double x) {
        StepInputs inputs;
        for (std::size_t b = 0; b < blades.size(); ++b) inputs.move(blades[b], pose(b, x));
        step(inputs);
    };
    for (const double x : stops) lead(x);
    lead(6.0);
    StepInputs withdrawal;
    for (const ToolId blade : blades) withdrawal.withdraw(blade);
    step(withdrawal);
    outcome.num_components = topology::components(world.mesh()).count;
    return outcome;
}

}  // namespace incise::sim
