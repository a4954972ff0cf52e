// Time of edits with physics following, per element or face; elements next to each other, as a
// tool takes them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include "bodies.h"
#include "topology/mesh_edit.h"

namespace incise::bench {
namespace {

using topology::ElementId;

constexpr std::size_t batch = 100;

void set_rate(benchmark::State& state) {
    state.counters["us/item"] = benchmark::Counter(
        static_cast<double>(batch) * 1e-6,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Runs `edit` on a batch of elements from the middle of the body and takes it back untimed.
template <class Edit>
void measure(benchmark::State& state, Edit edit) {
    topology::Mesh mesh = make_cube(state.range(0));
    physics::Model model(mesh, make_material(physics::NeoHookean{2000, 6000}));
    std::size_t first = mesh.element_capacity() / 2;
    for (auto _ : state) {
        topology::ChangeSet changes;
        {
            topology::MeshEdit transaction(mesh);
            for (std::size_t i = 0; i < batch; ++i) edit(mesh, transaction, ElementId(first + i));
            changes = transaction.commit();
        }
        model.apply(changes);
        state.PauseTiming();
        const auto back = topology::inverse(changes);
        topology::replay(mesh, back);
        model.apply(back);
        first = (first + batch) % (mesh.element_capacity() - batch);
        state.ResumeTiming();
    }
    set_rate(state);
}

void remove(benchmark::State& state) {
    measure(state,
            [](const topology::Mesh&, topology::MeshEdit& edit, ElementId e) { edit.remove(e); });
}
BENCHMARK(remove)->Arg(20'000)->Arg(100'000)->Arg(500'000);

void open(benchmark::State& state) {
    measure(state, [](const topology::Mesh& mesh, topology::MeshEdit& edit, ElementId e) {
        for (int f = 0; f < mesh.num_faces(e); ++f)
            if (mesh.neighbor({e, f}).is_valid()) {
                edit.open({e, f});
                break;
            }
    });
}
BENCHMARK(open)->Arg(20'000)->Arg(100'000)->Arg(500'000);

}  // namespace
}  // namespace incise::bench
