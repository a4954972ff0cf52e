// Benchmarks of HEML and of the methods that its papers compare with, on the same meshes: one
// evaluation of the forces, and a step of implicit finite elements. Results: docs/comparison.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>

#include "bench/comparators/element_loop.h"
#include "bench/comparators/heml.h"
#include "bench/comparators/implicit_step.h"
#include "bench/comparators/mass_springs.h"
#include "bench/comparators/mass_tensor.h"
#include "bench/comparators/mjed.h"
#include "bench/comparators/tled.h"
#include "bodies.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/physics/elements/heml_kernel.h"
#include "incise/physics/solve/explicit_step.h"

namespace incise::bench {
namespace {

constexpr physics::SaintVenantKirchhoff stvk{6000.0, 4000.0};
constexpr physics::NeoHookean nh{2000.0, 6000.0};
constexpr physics::MooneyRivlin mr{1200.0, 800.0, 2800.0};
constexpr double density = 1000.0;  // kg/m3

/// A mesh, and a stretched and sheared state of it without inverted elements.
struct Body {
    topology::Mesh mesh;
    std::vector<Nodes> tetrahedra;
    std::vector<Vec3> positions;

    explicit Body(topology::Mesh m) : mesh(std::move(m)), tetrahedra(tetrahedra_of(mesh)) {
        Matrix<double> F;
        F << 1.1, 0.05, 0.0, 0.02, 0.95, 0.03, 0.0, -0.04, 1.02;
        for (const Vec3& X : mesh.rest_positions()) positions.emplace_back(F * X);
    }
    std::span<const Vec3> rest_positions() const { return mesh.rest_positions(); }
};

enum Shape : std::int64_t { liver, small_cube, large_cube };

topology::Mesh liver_of_one_region() {
    topology::MeshData data =
        io::read_mesh(std::filesystem::path(INCISE_DATA_DIR) / "liver.vtu").mesh;
    std::fill(data.regions.begin(), data.regions.end(), 0);
    return topology::Mesh::build(data).mesh;
}

const Body& body_of(std::int64_t shape) {
    static const Body bodies[] = {Body(liver_of_one_region()), Body(make_cube(6'000)),
                                  Body(make_cube(100'000))};
    return bodies[shape];
}

void report(benchmark::State& state, const Body& body) {
    state.counters["elements"] = static_cast<double>(body.tetrahedra.size());
    state.counters["ns/element"] = benchmark::Counter(
        static_cast<double>(body.tetrahedra.size()) * 1e-9,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Times add(positions, forces), and setting the forces to zero before it.
template <class Add>
void time_forces(benchmark::State& state, const Body& body, Add add) {
    std::vector<Vec3> forces(body.positions.size());
    for (auto _ : state) {
        std::fill(forces.begin(), forces.end(), Vec3::Zero());
        add(std::span<const Vec3>(body.positions), std::span<Vec3>(forces));
        benchmark::DoNotOptimize(forces.data());
        benchmark::ClobberMemory();
    }
    report(state, body);
}

template <class Kernel>
void elements(benchmark::State& state, const Kernel& kernel) {
    const Body& body = body_of(state.range(0));
    const ElementLoop<Kernel> loop(kernel, body.tetrahedra, body.rest_positions());
    time_forces(state, body, [&](auto x, auto f) { loop.add_forces(x, f); });
}

void mass_tensor(benchmark::State& state) {
    const Body& body = body_of(state.range(0));
    const MassTensor tensor(stvk, body.tetrahedra, body.rest_positions());
    std::vector<Vec3> displacements;
    time_forces(state, body,
                [&](auto x, auto f) { tensor.add_forces<double>(x, f, displacements); });
    state.counters["numbers/element"] = static_cast<double>(tensor.num_coefficients()) /
                                        static_cast<double>(body.tetrahedra.size());
}

void mass_springs(benchmark::State& state) {
    const Body& body = body_of(state.range(0));
    const MassSprings springs(1e4, body.tetrahedra, body.rest_positions());
    time_forces(state, body, [&](auto x, auto f) { springs.add_forces<double>(x, f); });
}

/// The forces as a run computes them: by blocks of elements, with the fast kernels.
void program(benchmark::State& state, const physics::Law& law) {
    const Body& body = body_of(state.range(0));
    physics::Model model(body.mesh, make_material(law));
    model.set_state(body.positions, std::vector<Vec3>(body.positions.size(), Vec3::Zero()), 0.0);
    for (auto _ : state) {
        model.compute_forces(0.0);
        benchmark::DoNotOptimize(model.elastic_forces().data());
    }
    report(state, body);
}

/// An explicit step of Incise. Also reports its stable step.
void explicit_step(benchmark::State& state) {
    const Body& body = body_of(state.range(0));
    physics::Model model(body.mesh, make_material(stvk),
                         {.gravity = {0, 0, -9.81}, .constraints = {}, .loads = {}});
    const double dt = 0.5 * model.stable_step();
    physics::ExplicitStep one_step;
    for (auto _ : state) {
        one_step.move(model, 0.0, dt);
        model.compute_forces(0.0);
    }
    report(state, body);
    state.counters["stable_step_us"] = 1e6 * model.stable_step();
}

enum Phase : std::int64_t { assembly, factorization, solution, whole_step };

void implicit_step(benchmark::State& state) {
    const Body& body = body_of(state.range(0));
    const std::int64_t phase = state.range(1);
    ImplicitStep implicit(stvk, density, body.tetrahedra, body.rest_positions());
    const std::vector<Vec3> velocities(body.positions.size(), Vec3::Zero());
    constexpr double dt = 0.01;  // s
    implicit.assemble(dt, body.positions, velocities);
    if (!implicit.factorize()) state.SkipWithError("the matrix is not positive");
    for (auto _ : state) {
        if (phase == assembly || phase == whole_step)
            implicit.assemble(dt, body.positions, velocities);
        if (phase == factorization || phase == whole_step)
            benchmark::DoNotOptimize(implicit.factorize());
        if (phase == solution || phase == whole_step)
            benchmark::DoNotOptimize(implicit.solve().data());
    }
    static constexpr const char* names[] = {"assembly", "factorization", "solution", "whole step"};
    state.SetLabel(names[phase]);
    report(state, body);
    state.counters["factor_entries"] = static_cast<double>(implicit.num_factor_entries());
}

#define COMPARISON(name) BENCHMARK(name)->Name("comparison/" #name)
#define COMPARE(function, name, ...) \
    BENCHMARK_CAPTURE(function, name, __VA_ARGS__)->Name("comparison/" #name)

void on_all(benchmark::internal::Benchmark* b) { b->Arg(liver)->Arg(small_cube)->Arg(large_cube); }
void on_small(benchmark::internal::Benchmark* b) { b->Arg(liver)->Arg(small_cube); }

using Stvk = physics::SaintVenantKirchhoff;
using Nh = physics::NeoHookean;
using Mr = physics::MooneyRivlin;
COMPARE(elements, heml_stvk, physics::HemlKernel{stvk, 0.4})->Apply(on_all);
COMPARE(elements, heml_nh, physics::HemlKernel{nh, 0.4})->Apply(on_all);
COMPARE(elements, heml_mr, physics::HemlKernel{mr, 0.4})->Apply(on_all);
COMPARE(elements, heml_lean_stvk, LinkHeml<double, Stvk>{stvk})->Apply(on_all);
COMPARE(elements, heml_lean_nh, LinkHeml<double, Nh>{nh})->Apply(on_all);
COMPARE(elements, heml_lean_mr, LinkHeml<double, Mr>{mr})->Apply(on_all);
COMPARE(elements, heml_printed_stvk, PrintedHeml<double>{stvk.lambda, stvk.mu})->Apply(on_all);
COMPARE(elements, tled_stvk, Tled<double, Stvk>{stvk})->Apply(on_all);
COMPARE(elements, tled_nh, Tled<double, Nh>{nh})->Apply(on_all);
COMPARE(elements, tled_mr, Tled<double, Mr>{mr})->Apply(on_all);
COMPARE(elements, mjed_stvk, Mjed<double, Stvk>{stvk})->Apply(on_all);
COMPARE(elements, mjed_nh, Mjed<double, Nh>{nh})->Apply(on_all);
COMPARE(elements, mjed_mr, Mjed<double, Mr>{mr})->Apply(on_all);
COMPARE(elements, springs_by_element, physics::MassSpringKernel{1e4})->Apply(on_all);
COMPARISON(mass_springs)->Apply(on_all);
COMPARISON(mass_tensor)->Apply(on_small);
COMPARE(program, program_stvk, stvk)->Apply(on_all);
COMPARE(program, program_nh, nh)->Apply(on_all);
COMPARE(program, program_mr, mr)->Apply(on_all);
COMPARISON(explicit_step)->Apply(on_small)->Unit(benchmark::kMillisecond);
COMPARISON(implicit_step)
    ->ArgsProduct({{liver, small_cube}, {assembly, factorization, solution, whole_step}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace incise::bench
