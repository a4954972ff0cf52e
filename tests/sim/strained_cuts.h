// Random bars that are drawn out, cut at once along a plane, and let go or held, as tests of the
// stable step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "incise/cutting/cutter.h"
#include "incise/physics/body/motion_failure.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/sim/world.h"
#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"

namespace incise::sim {

struct StrainedCut {
    std::string law;
    double stretch;
    bool is_cut, is_released;
    WorldDef def;
    cutting::PlaneCut cut;

    static constexpr double length = 0.1;                                  // of the bar, m
    static constexpr double drawn_at = 0.15, cut_at = 0.2, end_at = 0.35;  // s
};

inline StrainedCut strained_cut(std::uint64_t seed) {
    using namespace physics;
    struct Named {
        const char* name;
        Law law;
    };
    // Young's moduli of some 10 kPa.
    static const std::vector<Named> laws = {
        {"neo-Hookean, nu 0.3", NeoHookean{1923.0, 5769.0}},
        {"neo-Hookean, nu 0.46", NeoHookean{1712.0, 39384.0}},
        {"Mooney-Rivlin", MooneyRivlin{1346.0, 577.0, 13462.0}},
        {"Fung-Demiray", FungDemiray{3846.0, 0.5, 9000.0}},
        {"Ogden", Ogden{{{{2000.0, 1.3}, {900.0, 5.0}, {700.0, -3.0}}}, 3, 20000.0}},
        {"isochoric Fung-Demiray", IsochoricFungDemiray{3846.0, 0.5, 20000.0}},
        {"Yeoh", Yeoh{1923.0, 400.0, 150.0, 20000.0}},
        {"Ciarlet's neo-Hookean", CiarletNeoHookean{3846.0, 15769.0}},
        {"stable neo-Hookean", StableNeoHookean::of_rest_moduli(15769.0, 3846.0)},
        {"fibres", HolzapfelGasserOgden{3846.0, 20000.0, 1000.0, 0.3, 0.1}},
    };
    test::Random random(seed);
    const Named& law = laws[seed % laws.size()];
    StrainedCut c{
        law.name, random.uniform(1.0, 2.2), random.below(5) != 0, random.below(2) == 0, {}, {}};
    const double width = 0.4 * StrainedCut::length;
    topology::MeshData data =
        topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                           Vec3(StrainedCut::length, width, width), {8, 3, 3});
    const auto is_left = [](const Vec3& x) { return x.x() < 1e-6; };
    const auto is_right = [](const Vec3& x) { return x.x() > StrainedCut::length - 1e-6; };
    for (Vec3& x : data.points)
        if (!is_left(x) && !is_right(x)) x += random.vector(0.15 * StrainedCut::length / 8.0);
    topology::Mesh mesh = topology::Mesh::build(data).mesh;
    Constraint fixed{.name = "fixed"}, drawn{.name = "drawn"};
    std::vector<VertexId> left, right;
    for (const VertexId n : mesh.nodes()) {
        if (is_left(mesh.rest_position(n))) left.push_back(n);
        if (is_right(mesh.rest_position(n))) right.push_back(n);
    }
    fixed.nodes = VertexSet(left);
    drawn.nodes = VertexSet(right);
    drawn.displacement = TimeCurve<Vec3>(
        {{0.0, Vec3::Zero()},
         {StrainedCut::drawn_at, (c.stretch - 1.0) * StrainedCut::length * Vec3::UnitX()}});
    if (has_fibres(law.law)) c.def.fibres.assign(mesh.element_capacity(), Vec3::UnitX());
    c.def.mesh = std::move(mesh);
    c.def.materials = {{1000.0, HyperElasticLinks{law.law}}};
    c.def.damping = 5.0;
    c.def.constraints = {fixed, drawn};
    c.cut.point = Vec3(0.5 * c.stretch * StrainedCut::length, 0.5 * width, 0.5 * width) +
                  random.vector(0.1 * StrainedCut::length);
    c.cut.normal = Vec3::UnitX() + random.vector(1.0);
    return c;
}

inline std::string describe(const StrainedCut& c) {
    std::ostringstream text;
    text << c.law << ", stretch " << c.stretch << (c.is_cut ? ", cut" : "")
         << (c.is_released ? ", released" : "") << ": ";
    return text.str();
}

/// Runs the case in a world with automatic steps. Returns the message of the failure, if it fails.
inline std::optional<std::string> failure_in_a_world(StrainedCut c, double safety = 0.8) {
    World world(std::move(c.def));
    bool was_cut = false;
    try {
        while (world.time() < StrainedCut::end_at) {
            StepInputs inputs;
            if (!was_cut && world.time() >= StrainedCut::cut_at) {
                was_cut = true;
                if (c.is_released) world.release(world.constraints()[1]);
                if (c.is_cut) {
                    const ToolId knife = world.add_tool({"knife", c.cut});
                    inputs.move(knife, Pose()).withdraw(knife);
                }
            }
            world.step(safety * world.stable_step(), inputs);
        }
    } catch (const physics::MotionFailure& failure) {
        return failure.what();
    }
    return std::nullopt;
}

/// Runs the same with steps of a part of the stable step at rest.
inline std::optional<std::string> failure_at_rest_steps(StrainedCut c, double safety = 0.8) {
    topology::Mesh mesh = std::get<topology::Mesh>(std::move(c.def.mesh));
    physics::MaterialTable table;
    table.materials = c.def.materials;
    table.of_region[0] = 0;
    table.fibres = c.def.fibres;
    physics::Model model(mesh, table, {c.def.gravity, c.def.damping, c.def.constraints, {}});
    cutting::Cutter cutter(mesh, model.mesh_positions());
    bool was_cut = false;
    try {
        for (double time = 0.0; time < StrainedCut::end_at;) {
            const double dt = safety * model.structure().rest_stable_step();
            const bool is_time = !was_cut && time >= StrainedCut::cut_at;
            if (is_time && c.is_released) model.boundary().remove_constraint(1);
            physics::ExplicitStep().move(model, time, dt);
            time += dt;
            cutter.follow_motion(mesh, model.mesh_positions());
            if (is_time) {
                was_cut = true;
                if (c.is_cut) {
                    const auto done =
                        cutter.split(mesh, *cutting::cut_surface_of(c.cut), c.cut.snap);
                    model.apply(mesh, done.changes);
                    cutter.apply(mesh, done.changes);
                }
            }
            model.compute_forces(time);
        }
    } catch (const physics::MotionFailure& failure) {
        return failure.what();
    }
    return std::nullopt;
}

}  // namespace incise::sim
