// What the tests of the module of Python compare with: runs and steps without Python.
//     python_reference run SCENARIO OUT     writes positions and velocities at the end as doubles
//     python_reference time                 prints the mean time of a step of a tiny world, s
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string_view>

#include "incise/physics/laws/material.h"
#include "incise/runner/simulation.h"
#include "incise/scenario/scenario_reader.h"
#include "incise/topology/box_mesh.h"

namespace {

using namespace incise;

void write(std::ofstream& out, const Vec3& v) {
    out.write(reinterpret_cast<const char*>(v.data()), 3 * sizeof(double));
}

void run(const char* file, const char* name) {
    auto report = scenario::read_scenario(std::filesystem::path(file));
    for (const std::string& error : report.errors) std::fprintf(stderr, "%s\n", error.c_str());
    runner::Simulation simulation(report.scenario);
    simulation.start();
    while (!simulation.is_finished()) simulation.step();
    const topology::Mesh& mesh = simulation.mesh();
    std::ofstream out(name, std::ios::binary);
    for (const VertexId n : mesh.nodes()) write(out, simulation.world().positions()[n.index()]);
    for (const VertexId n : mesh.nodes()) write(out, simulation.world().velocities()[n.index()]);
    std::printf("%llu %zu\n", static_cast<unsigned long long>(simulation.num_steps()),
                simulation.edits().size());
}

void time_steps() {
    using Clock = std::chrono::steady_clock;
    sim::WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    def.materials = {{.density = 1000.0,
                      .method = physics::HyperElasticLinks{
                          physics::StableNeoHookean::of_rest_moduli(1e5, 3e4)}}};
    sim::World world(std::move(def));
    constexpr int num_steps = 20000;
    double least = 1.0;
    for (int round = 0; round < 5; ++round) {
        const auto begin = Clock::now();
        for (int i = 0; i < num_steps; ++i) world.step(0.8 * world.stable_step());
        const std::chrono::duration<double> elapsed = Clock::now() - begin;
        least = std::min(least, elapsed.count() / num_steps);
    }
    std::printf("%.9g\n", least);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc == 4 && std::string_view(argv[1]) == "run")
            run(argv[2], argv[3]);
        else
            time_steps();
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
