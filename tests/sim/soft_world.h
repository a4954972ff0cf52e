// A soft cube, held at its bottom, that tests step, cut, hold and load from outside.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "incise/sim/undo_point.h"
#include "incise/sim/world.h"
#include "incise/topology/box_mesh.h"

namespace incise::sim {

using cutting::Blade;
using cutting::CutMode;

inline constexpr double size = 0.1;  // of the cube, m

inline topology::MeshData cube(int cells = 4) {
    return topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Constant(size),
                              {cells, cells, cells});
}

inline WorldDef soft_body(Solver solver = Solver::semi_implicit_euler) {
    WorldDef def;
    def.mesh = cube();
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{200.0, 600.0}}}};
    def.gravity = {0, 0, -9.81};
    def.damping = 2.0;
    def.solver = solver;
    return def;
}

/// Definitions of all that the state of a world can consist of.
inline std::vector<std::pair<const char*, std::function<WorldDef()>>> resumable_bodies() {
    const auto viscous = [](physics::PronyRule rule) {
        WorldDef def = soft_body();
        auto& links = std::get<physics::HyperElasticLinks>(def.materials[0].method);
        links.prony = {{0.4, 0.05}, {0.2, 0.5}};
        links.prony_rule = rule;
        return def;
    };
    return {{"explicit", [] { return soft_body(); }},
            {"implicit", [] { return soft_body(Solver::implicit_euler); }},
            {"single precision",
             [] {
                 WorldDef def = soft_body();
                 def.precision = physics::Precision::single_precision;
                 return def;
             }},
            {"viscous", [=] { return viscous(physics::PronyRule::stress); }},
            {"viscous by nodes", [=] { return viscous(physics::PronyRule::nodal); }},
            {"hexahedra", [] {
                 WorldDef def = soft_body();
                 def.mesh = topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(),
                                               Vec3::Constant(size), {4, 4, 4});
                 def.materials = {{1000.0, physics::HybridSprings{400.0, 400.0}}};
                 return def;
             }}};
}

struct ResumableCut {
    const char* name;
    std::function<WorldDef()> body;
    CutMode mode;
};

/// The bodies that are split, and one that is separated.
inline std::vector<ResumableCut> resumable_cuts() {
    std::vector<ResumableCut> cuts;
    for (const auto& [name, body] : resumable_bodies())
        cuts.push_back({name, body, CutMode::split});
    cuts.push_back({"separated hexahedra", cuts.back().body, CutMode::separate});
    return cuts;
}

inline std::vector<VertexId> nodes_where(const World& world,
                                         const std::function<bool(const Vec3&)>& is_in) {
    std::vector<VertexId> nodes;
    for (const VertexId n : world.mesh().nodes())
        if (is_in(world.mesh().rest_position(n))) nodes.push_back(n);
    return nodes;
}

/// Holds a cube at its bottom.
inline World held(World world) {
    world.add_constraint({.name = "floor",
                          .nodes = physics::VertexSet(
                              nodes_where(world, [](const Vec3& x) { return x.z() == 0.0; }))});
    return world;
}
inline World held_world(Solver solver = Solver::semi_implicit_euler) {
    return held(World(soft_body(solver)));
}

inline ToolDef scalpel(CutMode mode = CutMode::split) {
    return {"scalpel", Blade{{{0, -0.02, 0.051}, {0, 0.12, 0.053}}, mode}};
}

inline Pose at(const Vec3& position) { return {Eigen::Quaterniond::Identity(), position}; }

/// Adds a plane. Returns the inputs of the step in which it cuts.
[[nodiscard]] inline StepInputs cut_along(World& world, const Vec3& point, const Vec3& normal) {
    const ToolId plane = world.add_tool({"plane", cutting::PlaneCut{point, normal}});
    return StepInputs().move(plane, Pose()).withdraw(plane);
}

/// @param inputs  of the first step
inline void run_until(World& world, double time, StepInputs inputs = {}) {
    for (; world.time() < time; inputs.clear()) world.step(0.8 * world.stable_step(), inputs);
}

/// Where the scalpel is after so much of its way through the cube.
inline Pose scalpel_pose(double part) { return at({-0.01 + 0.12 * part, 0, 0}); }

inline std::string input_error_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Steps with a cut across the body, a grasp and a load that come and go.
class Session {
  public:
    explicit Session(World world, ToolDef knife = scalpel()) : world_(std::move(world)) {
        knife_ = world_.add_tool(std::move(knife));
    }

    void run(int from, int to) {
        for (int i = from; i < to; ++i) step(i);
    }
    World& world() { return world_; }
    /// Goes on from the state of any session of the same kind.
    void restore(const std::string& bytes) {
        world_.restore(bytes);
        find_ids();
    }
    void undo(const UndoPoint& point) {
        world_.undo(point);
        find_ids();
    }

    static constexpr int num_steps = 60;

  private:
    void find_ids() {
        // Beside the floor there is the grasp, if anything.
        grasp_ = world_.constraints().size() > 1 ? world_.constraints().back() : ConstraintId();
        load_ = world_.loads().empty() ? LoadId() : world_.loads().back();
    }
    void step(int i) {
        StepInputs inputs;
        if (i == 5) world_.place_tool(knife_, scalpel_pose(0.0));
        if (i >= 5 && i < 35) inputs.move(knife_, scalpel_pose((i - 4) / 30.0));
        if (i == 34) inputs.withdraw(knife_);
        if (i == 10)
            grasp_ = world_.grasp("hand",
                                  nodes_where(world_,
                                              [](const Vec3& x) {
                                                  return x.z() > 0.99 * size && x.x() < 0.3 * size;
                                              }),
                                  at({0, 0, size}));
        if (i >= 10 && i < 45) inputs.move(grasp_, at({0, 0, size + 2e-4 * (i - 9)}));
        if (i == 45) world_.release(grasp_);
        if (i == 20)
            load_ = world_.add_load({.name = "push",
                                     .kind = physics::NodalLoad{
                                         physics::VertexSet(nodes_where(
                                             world_, [](const Vec3& x) { return x.x() > 0.09; })),
                                         {1e-3, 0, 0}}});
        if (i == 30) world_.set_load_factor(load_, 0.5);
        if (i == 50) world_.remove_load(load_);
        world_.step(0.5 * world_.stable_step(), inputs);
    }

    World world_;
    ToolId knife_{};
    ConstraintId grasp_{};
    LoadId load_{};
};

}  // namespace incise::sim
