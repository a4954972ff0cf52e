// Benchmarks of edits and of the updates of physics that follow, per element or face. The edited
// elements have consecutive ids, so they are close to each other, as with a tool.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include "bodies.h"
#include "incise/cutting/cutter.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/mesh_edit.h"

namespace incise::bench {
namespace {

constexpr std::size_t batch = 100;

void set_rate(benchmark::State& state) {
    state.counters["us/item"] = benchmark::Counter(
        static_cast<double>(batch) * 1e-6,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Times `edit` on a batch of elements with consecutive ids, and undoes it untimed.
template <class Edit>
void measure(benchmark::State& state, Edit edit) {
    topology::Mesh mesh = make_cube(state.range(0));
    physics::Model model(mesh, make_material(physics::NeoHookean{2000, 6000}));
    std::size_t first = mesh.element_capacity() / 2;
    for (auto _ : state) {
        topology::ChangeSet changes;
        {
            topology::MeshEdit transaction(mesh);
            for (std::size_t i = 0; i < batch; ++i) edit(mesh, transaction, CellId(first + i));
            changes = transaction.commit();
        }
        const auto done = model.apply(mesh, changes);
        state.PauseTiming();
        topology::replay(mesh, topology::inverse(changes));
        model.apply(mesh, inverse(done));
        first = (first + batch) % (mesh.element_capacity() - batch);
        state.ResumeTiming();
    }
    set_rate(state);
}

Eigen::AlignedBox3d mesh_box(const topology::Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : mesh.rest_positions()) box.extend(x);
    return box;
}

void remove(benchmark::State& state) {
    measure(state,
            [](const topology::Mesh&, topology::MeshEdit& edit, CellId e) { edit.remove(e); });
}
BENCHMARK(remove)->Arg(20'000)->Arg(100'000)->Arg(500'000);

/// Opens the first face of the element that is not on the boundary.
void open_a_face(const topology::Mesh& mesh, topology::MeshEdit& edit, CellId e) {
    for (int f = 0; f < mesh.num_faces(e); ++f)
        if (mesh.neighbor({e, f}).is_valid()) return edit.open({e, f});
}

void open(benchmark::State& state) { measure(state, open_a_face); }
BENCHMARK(open)->Arg(20'000)->Arg(100'000)->Arg(500'000);

/// Times a step in which a face is opened, with the body totals that the ledger and history.csv
/// need before and after the edit. The time is per element of the body.
void recorded_step(benchmark::State& state, topology::Mesh mesh,
                   const physics::Material& material) {
    physics::Model model(mesh, {{material}, {{0, 0}}});
    const double dt = 0.5 * model.stable_step();
    std::size_t next = mesh.element_capacity() / 2;
    physics::ExplicitStep one_step;
    for (auto _ : state) {
        one_step.move(model, 0.0, dt);
        topology::MeshEdit edit(mesh);
        open_a_face(mesh, edit, CellId(next++ % mesh.element_capacity()));
        const auto changes = edit.commit();
        model.compute_totals_and_forces();
        benchmark::DoNotOptimize(model.totals());
        model.apply(model.mesh(), changes);
        benchmark::DoNotOptimize(model.totals());
        benchmark::DoNotOptimize(model.min_volume_ratio());
        model.compute_forces(0.0);
    }
    state.counters["ns/element"] = benchmark::Counter(
        static_cast<double>(mesh.num_elements()) * 1e-9,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void recorded_step_of_tetrahedra(benchmark::State& state) {
    recorded_step(state, make_cube(state.range(0)),
                  {1000.0, physics::HyperElasticLinks{physics::NeoHookean{2000, 6000}}});
}
BENCHMARK(recorded_step_of_tetrahedra)->Arg(20'000)->Arg(100'000)->Arg(500'000);

void recorded_step_of_hexahedra(benchmark::State& state) {
    const int n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(state.range(0)))));
    const auto grid =
        topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(), Vec3::Ones(), {n, n, n});
    recorded_step(state, topology::Mesh::build(grid).mesh,
                  {1000.0, physics::HybridSprings{2000, 6000, 1.0}});
}
BENCHMARK(recorded_step_of_hexahedra)->Arg(27'000)->Arg(125'000);

/// Times a blade that moves halfway through the body in 20 steps, and not along planes of the mesh.
/// The time is per crossed element, with the search and the updates of body and boxes.
void split(benchmark::State& state) {
    constexpr int num_steps = 20;
    topology::Mesh mesh = make_cube(state.range(0));
    physics::Model model(mesh, make_material(physics::NeoHookean{2000, 6000}));
    const Vec3 low = mesh_box(mesh).min(), size = mesh_box(mesh).sizes();
    const auto edge = [&](int step) {
        const double x = -0.01 + 0.51 * step / num_steps;
        const auto at = [&](double y, double z) -> Vec3 {
            return low + size.cwiseProduct(Vec3(x, y, z + 0.21 * x));
        };
        return std::vector<Vec3>{at(-0.1, 0.41), at(1.1, 0.52)};
    };
    double crossed = 0.0;
    for (auto _ : state) {
        state.PauseTiming();
        cutting::Cutter cutter(mesh, model.mesh_positions());
        const cutting::CutId cut = cutter.begin_cut(cutting::default_snap);
        state.ResumeTiming();
        std::vector<physics::BodyEdit> history;
        for (int step = 0; step < num_steps; ++step) {
            auto done = cutter.split(cut, mesh, edge(step), edge(step + 1));
            history.push_back(model.apply(mesh, done.changes));
            cutter.apply(mesh, done.changes);
            crossed += static_cast<double>(done.report.elements_crossed);
        }
        state.PauseTiming();
        for (; !history.empty(); history.pop_back()) {
            const physics::BodyEdit back = inverse(history.back());
            if (back.is_empty()) continue;
            topology::replay(mesh, back.material);
            model.apply(mesh, back);
        }
        state.ResumeTiming();
    }
    state.counters["crossed"] = crossed / static_cast<double>(state.iterations());
    state.counters["us/crossed"] = benchmark::Counter(
        crossed * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(split)->Arg(20'000)->Arg(100'000)->Arg(500'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace incise::bench
