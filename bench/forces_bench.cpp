// Benchmarks of a force evaluation and of a whole step, by law and size.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <string>

#include "bodies.h"
#include "incise/physics/solve/explicit_step.h"

namespace incise::bench {
namespace {

const physics::Law laws[] = {physics::SaintVenantKirchhoff{6000, 4000},
                             physics::NeoHookean{2000, 6000},
                             physics::MooneyRivlin{1200, 800, 2800}};
const char* const law_names[] = {"Saint Venant-Kirchhoff", "Neo-Hookean", "Mooney-Rivlin"};

void report(benchmark::State& state, std::size_t num_elements) {
    state.counters["ns/element"] = benchmark::Counter(
        static_cast<double>(num_elements) * 1e-9,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void measure_steps(benchmark::State& state, const topology::Mesh& mesh,
                   const physics::MaterialTable& materials) {
    physics::Model model(
        mesh, materials,
        {.gravity = {0, 0, -9.81}, .damping = 1.0, .constraints = {}, .loads = {}});
    const double dt = 0.5 * model.stable_step();
    physics::ExplicitStep one_step;
    for (auto _ : state) {
        one_step.move(model, 0.0, dt);
        model.compute_forces(0.0);
    }
    report(state, mesh.num_elements());
}

void forces(benchmark::State& state) {
    const topology::Mesh mesh = make_cube(state.range(1));
    physics::Model model(mesh, make_material(laws[state.range(0)]));
    for (auto _ : state) {
        model.compute_forces(0.0);
        benchmark::DoNotOptimize(model.elastic_forces().data());
    }
    report(state, mesh.num_elements());
    state.SetLabel(law_names[state.range(0)]);
}
BENCHMARK(forces)->ArgsProduct({{0, 1, 2}, {20'000, 100'000, 500'000}});

void step(benchmark::State& state) {
    const topology::Mesh mesh = make_cube(state.range(1));
    measure_steps(state, mesh, make_material(laws[state.range(0)]));
    state.SetLabel(law_names[state.range(0)]);
}
BENCHMARK(step)->ArgsProduct({{0, 1, 2}, {20'000, 100'000, 500'000, 1'000'000}});

/// Times a step of a viscous body with a given number of Prony terms. 0 terms are the elastic body
/// for comparison.
void viscous_step(benchmark::State& state) {
    const topology::Mesh mesh = make_cube(state.range(1));
    auto table = make_material(laws[1]);
    if (state.range(2) != 0) table.precision = physics::Precision::single_precision;
    auto& links = std::get<physics::HyperElasticLinks>(table.materials[0].method);
    for (std::int64_t i = 0; i < state.range(0); ++i)
        links.prony.push_back({0.3 / static_cast<double>(i + 1), 0.1 * static_cast<double>(i + 1)});
    measure_steps(state, mesh, table);
    state.SetLabel(std::to_string(state.range(0)) + " terms, " +
                   (state.range(2) != 0 ? "single" : "double") + " precision");
}
BENCHMARK(viscous_step)->ArgsProduct({{0, 1, 2}, {20'000, 100'000}, {0, 1}});

}  // namespace
}  // namespace incise::bench
