// Benchmarks of whole steps of a body with constraints and loads, by size and number of threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include "bodies.h"
#include "incise/physics/solve/integrator.h"

namespace incise::bench {
namespace {

using topology::Mesh;

std::vector<VertexId> nodes_at_height(const Mesh& mesh, double z) {
    std::vector<VertexId> nodes;
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
        if (mesh.rest_position(VertexId(n)).z() == z) nodes.emplace_back(n);
    return nodes;
}

std::vector<FaceId> top_of(const Mesh& mesh) {
    std::vector<FaceId> top;
    for (const FaceId f : topology::boundary_faces(mesh)) {
        bool is_top = true;
        for (int p = 0; p < 3; ++p)
            is_top = is_top && mesh.rest_position(mesh.face_corner(f, p)).z() == 1.0;
        if (is_top) top.push_back(f);
    }
    return top;
}

std::vector<CellId> elements_of(const Mesh& mesh) {
    std::vector<CellId> elements;
    for (std::size_t e = 0; e < mesh.element_capacity(); ++e) elements.emplace_back(e);
    return elements;
}

physics::BoundaryConditions held(const Mesh& mesh) {
    // So little gravity that the tissue does not fold, however long the measurement is.
    physics::BoundaryConditions s{
        .gravity = {0, 0, -0.1}, .damping = 1.0, .constraints = {}, .loads = {}};
    s.constraints.push_back({.name = "floor",
                             .nodes = physics::VertexSet(nodes_at_height(mesh, 0.0)),
                             .displacement = {},
                             .angle = {}});
    return s;
}

/// The bottom fixed and the top rotated; a traction and a pressure on the surface, a body force.
physics::BoundaryConditions turned_and_loaded(const Mesh& mesh) {
    physics::BoundaryConditions s = held(mesh);
    s.constraints.push_back({.name = "lid",
                             .nodes = physics::VertexSet(nodes_at_height(mesh, 1.0)),
                             .displacement = {},
                             .angle = physics::TimeCurve<double>({{0.0, 0.0}, {1.0, 1e-3}}),
                             .point = {0.5, 0.5, 1.0}});
    const auto surface = topology::boundary_faces(mesh);
    s.loads.push_back({"wind", physics::TractionLoad{surface, {1.0, 0.0, 0.0}}, {}});
    s.loads.push_back({"gas", physics::PressureLoad{surface, 1.0}, {}});
    s.loads.push_back({"field", physics::BodyLoad{elements_of(mesh), {0.0, 1.0, 0.0}}, {}});
    return s;
}

constexpr physics::NeoHookean tissue{2000, 6000};

void report(benchmark::State& state, const Mesh& mesh) {
    state.counters["ns/element"] = benchmark::Counter(
        static_cast<double>(mesh.num_elements()) * 1e-9,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void explicit_step(benchmark::State& state, const physics::BoundaryConditions& boundary_conditions,
                   const Mesh& mesh) {
    physics::Model model(mesh, make_material(tissue), boundary_conditions);
    model.set_num_threads(static_cast<int>(state.range(1)));
    const double dt = 0.5 * model.stable_step();
    physics::ExplicitStep one_step;
    for (auto _ : state) {
        one_step.move(model, 0.0, dt);
        model.compute_forces(0.0);
    }
    report(state, mesh);
}

void step_held(benchmark::State& state) {
    const Mesh mesh = make_cube(state.range(0));
    explicit_step(state, held(mesh), mesh);
}
BENCHMARK(step_held)->ArgsProduct({{20'000, 500'000}, {1, 2}})->UseRealTime();

void step_turned_and_loaded(benchmark::State& state) {
    const Mesh mesh = make_cube(state.range(0));
    explicit_step(state, turned_and_loaded(mesh), mesh);
}
BENCHMARK(step_turned_and_loaded)->ArgsProduct({{20'000, 500'000}, {1, 2}})->UseRealTime();

template <class Rule>
void solved_step(benchmark::State& state) {
    const Mesh mesh = make_cube(state.range(0));
    physics::BoundaryConditions boundary_conditions = held(mesh);
    boundary_conditions.loads.push_back(
        {"gas", physics::PressureLoad{top_of(mesh), 1.0},
         physics::TimeCurve<double>({{0.0, 0.0}, {1000.0, 1000.0}})});
    physics::Model model(mesh, make_material(tissue), boundary_conditions);
    Rule rule;
    constexpr double dt = 0.01;
    double time = 0.0;
    for (auto _ : state) {
        rule.step(model, time, dt);
        time += dt;
        model.compute_forces(time);
    }
    report(state, mesh);
}
BENCHMARK_TEMPLATE(solved_step, physics::ImplicitEuler)->Arg(5'000)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(solved_step, physics::Statics)->Arg(5'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace incise::bench
