// SPDX-License-Identifier: LGPL-3.0-or-later
#include "app/throughput.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "cutting/element_boxes.h"
#include "cutting/splitter.h"
#include "cutting/step_length.h"
#include "cutting/swept_edge.h"
#include "physics/heml_lanes.h"
#include "physics/hybmss_lanes.h"
#include "physics/machine_speed.h"
#include "physics/model.h"
#include "sim/elastic_constants.h"
#include "sim/tissue_catalog.h"
#include "topology/box_mesh.h"
#include "topology/mesh_edit.h"

namespace incise::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double cube_size = 0.1;  // of the cubes, m
constexpr std::string_view tissue_name = "liver";

/// Best time of one call, s, of as many as take so many seconds in all.
template <class Work>
double best_time(double seconds, Work work) {
    double best = std::numeric_limits<double>::infinity();
    const auto start = Clock::now();
    do {
        const auto before = Clock::now();
        work();
        best = std::min(best, std::chrono::duration<double>(Clock::now() - before).count());
    } while (std::chrono::duration<double>(Clock::now() - start).count() < seconds);
    return best;
}

/// A cube of about so many elements, of tetrahedra an irregular one.
topology::Mesh make_cube(topology::CellKind kind, std::size_t num_elements) {
    const bool are_tetrahedra = kind == topology::CellKind::tetrahedron;
    const double num_bricks = static_cast<double>(num_elements) / (are_tetrahedra ? 6.0 : 1.0);
    const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(num_bricks))));
    auto data = topology::box_mesh(kind, Vec3::Zero(), Vec3::Constant(cube_size), {n, n, n});
    std::mt19937_64 random(1);
    for (Vec3& x : data.points)
        for (int c = 0; c < 3; ++c) {
            const double jitter = static_cast<double>(random() >> 11) * 0x1.0p-53 - 0.5;
            if (are_tetrahedra && x[c] > 0.0 && x[c] < cube_size)
                x[c] += 0.3 * jitter * cube_size / n;
        }
    return topology::Mesh::build(data).mesh;
}

struct Measured {
    std::string_view method, law;
    physics::Material material;
    double operations;  ///< of one element's forces: physics/heml_forces.cpp, hybmss_forces.cpp
    double bytes;       ///< of one element in a group of lanes
};

/// The three laws that the papers time, and the springs, with the stiffness of the tissue.
std::vector<Measured> measured_materials() {
    const sim::Tissue& tissue = *sim::find_tissue(tissue_name);
    const auto [lambda, mu] = sim::resolve(sim::Method::heml, tissue.law, tissue.parameters);
    const auto heml = [&](std::string_view name, const physics::Law& law, double operations) {
        return Measured{
            "heml",
            name,
            {tissue.density, physics::HyperElasticLinks{law}},
            operations,
            sizeof(physics::LinkGroup<double>) / double{physics::LinkGroup<double>::size}};
    };
    const physics::HybridSprings springs{mu, lambda - mu};
    return {
        heml("saint-venant-kirchhoff", physics::SaintVenantKirchhoff{lambda, mu}, 260.0),
        heml("neo-hookean", physics::NeoHookean{0.5 * mu, lambda}, 260.0),
        heml("mooney-rivlin", physics::MooneyRivlin{0.35 * mu, 0.15 * mu, lambda - 0.6 * mu},
             350.0),
        Measured{"hybmss",
                 {},
                 {tissue.density, springs},
                 690.0,
                 sizeof(physics::CellGroup<double>) / double{physics::CellGroup<double>::size}}};
}

physics::MaterialTable table_of(
    const physics::Material& material,
    physics::Precision precision = physics::Precision::double_precision) {
    return {{material}, {{0, 0}}, {}, precision};
}

/// A body of one material in motion.
struct MovingBody {
    physics::Model model;
    double dt;  ///< s

    MovingBody(const topology::Mesh& mesh, const Measured& measured, physics::Precision precision,
               int num_threads)
        : model(mesh, table_of(measured.material, precision),
                {.gravity = Vec3(0, 0, -9.81), .damping = 0.0, .supports = {}, .loads = {}}),
          dt(0.9 * model.stable_step()) {
        model.set_num_threads(num_threads);
    }
};

/// Best times, s.
struct StepTimes {
    double forces, step;
};

StepTimes time_steps(MovingBody& body, double seconds) {
    // Fused loops of a whole step, so that each finds in the caches what the other left there.
    double forces = std::numeric_limits<double>::infinity();
    const double step = best_time(seconds, [&] {
        body.model.integrate(0.0, body.dt);
        forces = std::min(forces, best_time(0.0, [&] { body.model.compute_forces(0.0); }));
    });
    return {forces, step};
}

StepRate measure_steps(const topology::Mesh& mesh, const Measured& measured, int num_threads,
                       double seconds) {
    using enum physics::Precision;
    MovingBody body(mesh, measured, double_precision, num_threads);
    const auto [forces, step] = time_steps(body, seconds);
    const auto single = [&] {
        MovingBody in_single(mesh, measured, single_precision, num_threads);
        return time_steps(in_single, seconds);
    }();
    const auto elements = static_cast<double>(mesh.num_elements());
    const double per_element = 1e9 / elements;
    StepRate rate{.method = measured.method,
                  .law = measured.law,
                  .elements = mesh.num_elements(),
                  .num_threads = num_threads,
                  .forces = forces * per_element,
                  .step = step * per_element,
                  .single_forces = single.forces * per_element,
                  .single_step = single.step * per_element,
                  .reference = std::nullopt,
                  .steps_per_second = 1.0 / step,
                  .real_time_factor = body.dt / step,
                  .gigaflops = measured.operations * elements / forces * 1e-9,
                  .gigabytes_per_second = measured.bytes * elements / forces * 1e-9};
    if (num_threads == 1) {
        std::vector<Vec3> sums(mesh.node_capacity(), Vec3::Zero());
        const physics::Model& model = body.model;
        const physics::EndOfStep state{model.positions(), model.history(), body.dt};
        rate.reference =
            per_element * best_time(seconds, [&] { model.elements().add_forces(state, sums); });
    }
    return rate;
}

/// Time of an edit that the model follows, s: with what the evaluation of forces after it takes
/// longer than one more.
template <class Edit>
double time_edit(physics::Model& model, Edit edit) {
    const auto start = Clock::now();
    edit();
    model.compute_forces(0.0);
    const auto edited = Clock::now();
    model.compute_forces(0.0);
    return std::chrono::duration<double>((edited - start) - (Clock::now() - edited)).count();
}

/// A blade that goes half way through the cube in 20 steps, with body and boxes following.
EditRate measure_split(topology::Mesh mesh, const physics::Material& material) {
    physics::Model model(mesh, table_of(material));
    cutting::ElementBoxes boxes(mesh, model.positions());
    const cutting::SplitOptions options{cutting::default_snap, cutting::uncut_body(mesh)};
    constexpr int num_steps = 20;
    const auto edge = [](int step) {
        const double x = -0.01 + 0.51 * step / num_steps;
        return std::vector<Vec3>{cube_size * Vec3(x, -0.1, 0.41 + 0.21 * x),
                                 cube_size * Vec3(x, 1.1, 0.52 + 0.21 * x)};
    };
    EditRate rate{"split", mesh.num_elements(), 0, 0.0};
    cutting::CutFront front;
    cutting::Scars scars;
    double seconds = 0.0;
    for (int step = 0; step < num_steps; ++step)
        seconds += time_edit(model, [&] {
            const cutting::TissueMotion tissue{mesh, model.positions(), model.positions(), &boxes};
            const cutting::SweptEdge way(edge(step), edge(step + 1));
            const auto done = cutting::split(mesh, tissue, way, front, options, &scars);
            model.apply(done.changes);
            boxes.follow(mesh, model.positions(), done.changes);
            rate.items += done.report.elements_crossed;
        });
    rate.microseconds = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(rate.items, 1));
    return rate;
}

/// Ten times a hundred elements that follow one another, so that they lie together.
EditRate measure_removal(topology::Mesh mesh, const physics::Material& material) {
    physics::Model model(mesh, table_of(material));
    constexpr std::size_t num_batches = 10, batch = 100;
    EditRate rate{"remove", mesh.num_elements(), 0, 0.0};
    const std::size_t stride = mesh.element_capacity() / (num_batches + 1);
    double seconds = 0.0;
    for (std::size_t b = 0; b < num_batches; ++b)
        seconds += time_edit(model, [&] {
            topology::MeshEdit edit(mesh);
            for (std::size_t i = 0; i < std::min(batch, stride); ++i)
                edit.remove(topology::ElementId((b + 1) * stride - i - 1));
            model.apply(edit.commit());
            rate.items += std::min(batch, stride);
        });
    rate.microseconds = 1e6 * seconds / static_cast<double>(rate.items);
    return rate;
}

HalvedRate measure_halved(topology::Mesh mesh, const physics::Material& material, double seconds) {
    const auto time_forces = [&](physics::Model& model) {
        model.compute_forces(0.0);  // numbers nodes
        const double best = best_time(seconds, [&] { model.compute_forces(0.0); });
        return 1e9 * best / static_cast<double>(model.mesh().num_elements());
    };
    physics::Model model(mesh, table_of(material));
    HalvedRate rate{
        .elements = mesh.num_elements(), .nodes = mesh.num_nodes(), .forces = time_forces(model)};
    std::mt19937_64 random(1);
    topology::MeshEdit edit(mesh);
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
        if (random() % 2 == 0) edit.remove(topology::ElementId(i));
    model.apply(edit.commit());
    rate.elements_left = mesh.num_elements();
    rate.nodes_left = mesh.num_nodes();
    rate.forces_left = time_forces(model);
    const auto anew = topology::Mesh::build(topology::to_mesh_data(mesh, mesh.rest_positions()));
    physics::Model built_anew(anew.mesh, table_of(material));
    rate.forces_built_anew = time_forces(built_anew);
    return rate;
}

std::string processor_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name"))
            if (const auto colon = line.find(": "); colon != std::string::npos)
                return line.substr(colon + 2);
    return "unknown";
}

MachineSpeed measure_machine(int num_cores) {
    const physics::MachinePeak peak = physics::measure_peak();
    return {processor_name(), physics::name_of(physics::processor()), num_cores, peak.gigaflops,
            peak.gigabytes_per_second};
}

}  // namespace

Throughput measure_throughput(const ThroughputPlan& plan,
                              const std::function<void(double, const std::string&)>& tell) {
    const int num_cores = physics::Workers::num_cores();
    std::vector<int> threads{1};
    if (const int most = plan.num_threads > 0 ? plan.num_threads : num_cores; most > 1)
        threads.push_back(most);
    const auto materials = measured_materials();
    // Large meshes take longest to make, all others about as long as each other.
    double work = 1.0, finished = 0.0;
    for (const auto* sizes : {&plan.tetrahedra, &plan.hexahedra, &plan.edited})
        for (const std::size_t n : *sizes) work += 1.0 + static_cast<double>(n) * 1e-5;
    const auto next = [&](double share, const std::string& name) {
        tell(finished / work, name);
        finished += share;
    };
    const auto part = [&](std::size_t n, const char* what) {
        next(1.0 + static_cast<double>(n) * 1e-5, std::to_string(n) + what);
    };

    Throughput result;
    result.tissue = tissue_name;
    next(1.0, "the machine's limits");
    result.machine = measure_machine(num_cores);
    const auto measure_bodies = [&](topology::CellKind kind, std::size_t n,
                                    std::string_view method) {
        const topology::Mesh mesh = make_cube(kind, n);
        for (const Measured& measured : materials)
            if (measured.method == method)
                for (const int num_threads : threads)
                    result.steps.push_back(
                        measure_steps(mesh, measured, num_threads, plan.seconds));
    };
    for (const std::size_t n : plan.tetrahedra) {
        part(n, " tetrahedra");
        measure_bodies(topology::CellKind::tetrahedron, n, "heml");
    }
    for (const std::size_t n : plan.hexahedra) {
        part(n, " hexahedra");
        measure_bodies(topology::CellKind::hexahedron, n, "hybmss");
    }
    for (const std::size_t n : plan.edited) {
        part(n, " tetrahedra, edited");
        for (const auto measure : {measure_split, measure_removal})
            result.edits.push_back(
                measure(make_cube(topology::CellKind::tetrahedron, n), materials[1].material));
        result.halved.push_back(measure_halved(make_cube(topology::CellKind::tetrahedron, n),
                                               materials[1].material, plan.seconds));
    }
    return result;
}

}  // namespace incise::app
