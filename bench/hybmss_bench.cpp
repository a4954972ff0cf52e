// Figures 11 and 12 of HybMSS 2020: time of a step against mesh size, for the eight meshes and
// three variants of the paper. Also the numbers of springs of its table 6.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <array>

#include "incise/physics/body/model.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::bench {
namespace {

/// Four cubes that are compressed, four beams that bend.
constexpr std::array<std::array<int, 3>, 8> meshes = {{{10, 10, 10},
                                                       {15, 15, 15},
                                                       {20, 20, 20},
                                                       {30, 30, 30},
                                                       {4, 4, 24},
                                                       {8, 8, 48},
                                                       {10, 10, 60},
                                                       {16, 16, 96}}};

struct Variant {
    const char* name;
    double stiffness_ratio;
    double volume_modulus;  // Pa
};
constexpr double shear_modulus = 3571.0;  // Pa; with the volume term the Poisson ratio is 0.4
constexpr Variant variants[] = {{"HybMSS-FD", 0.0, 3.0 * shear_modulus},
                                {"HybMSS-CF", 1.0, 0.0},
                                {"HybMSS", 1.0, 3.0 * shear_modulus}};

/// Numbers of springs of a grid, with edges and inner diagonals counted once.
struct SpringCounts {
    double edges, inner, faces_shared, faces_by_cell;

    explicit SpringCounts(const std::array<int, 3>& n) {
        const double x = n[0], y = n[1], z = n[2];
        edges = x * (y + 1) * (z + 1) + (x + 1) * y * (z + 1) + (x + 1) * (y + 1) * z;
        inner = 4.0 * x * y * z;
        faces_shared = 2.0 * (x * y * (z + 1) + x * (y + 1) * z + (x + 1) * y * z);
        faces_by_cell = 12.0 * x * y * z;
    }
};

void hybmss_step(benchmark::State& state) {
    const Variant& variant = variants[state.range(0)];
    const auto& cells = meshes[static_cast<std::size_t>(state.range(1))];
    const Vec3 size = 0.1 * Vec3(cells[0], cells[1], cells[2]);
    const auto mesh = topology::Mesh::build(topology::box_mesh(topology::CellKind::hexahedron,
                                                               Vec3::Zero(), size, cells))
                          .mesh;
    physics::MaterialTable table;
    table.materials.push_back({1000.0, physics::HybridSprings{shear_modulus, variant.volume_modulus,
                                                              variant.stiffness_ratio}});
    table.of_region[0] = 0;
    physics::Model model(mesh, table,
                         {.gravity = {0, 0, -1.0}, .damping = 1.0, .constraints = {}, .loads = {}});
    const double dt = 0.5 * model.stable_step();
    physics::ExplicitStep one_step;
    for (auto _ : state) {
        one_step.move(model, 0.0, dt);
        model.compute_forces(0.0);
    }
    state.SetLabel(std::string(variant.name) + " " + std::to_string(cells[0]) + "x" +
                   std::to_string(cells[1]) + "x" + std::to_string(cells[2]));
    const SpringCounts counts(cells);
    state.counters["cells"] = static_cast<double>(mesh.num_elements());
    state.counters["springs_noFD"] = counts.edges + counts.inner;
    state.counters["springs_shared"] = counts.edges + counts.inner + counts.faces_shared;
    state.counters["springs_paper"] = counts.edges + counts.inner + counts.faces_by_cell;
}
BENCHMARK(hybmss_step)
    ->ArgsProduct({{0, 1, 2}, {0, 1, 2, 3, 4, 5, 6, 7}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace incise::bench
