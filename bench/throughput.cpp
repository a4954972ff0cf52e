// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/bench/throughput.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>
#include <random>
#include <span>

#include "incise/bench/best_time.h"
#include "incise/bench/machine_speed.h"
#include "incise/cutting/cutter.h"
#include "incise/physics/body/model.h"
#include "incise/physics/elements/simd_heml_elements.h"
#include "incise/physics/elements/simd_hybmss_elements.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/scenario/elastic_constants.h"
#include "incise/scenario/tissue_catalog.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"

namespace incise::bench {

namespace {

constexpr double cube_size = 0.1;  // of the cubes, m
constexpr std::string_view tissue_name = "liver";

/// Returns a cube of about `num_elements` elements; for tetrahedra an irregular one.
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
    double operations;  ///< of the forces of one element in physics/simd/link_forces.h or
                        ///< hybmss_forces.cpp; a fused operation counts as two
    double bytes;       ///< of one element in a group of lanes
};

topology::CellKind kind_of(const Measured& measured) {
    return measured.method == "hybmss" ? topology::CellKind::hexahedron
                                       : topology::CellKind::tetrahedron;
}

/// Returns the three laws that the papers time, and HybMSS, with the stiffness of the tissue.
std::vector<Measured> measured_materials() {
    const scenario::Tissue& tissue = *scenario::find_tissue(tissue_name);
    const auto [lambda, mu] =
        scenario::resolve(scenario::Method::heml, tissue.law, tissue.parameters);
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
        heml("saint-venant-kirchhoff", physics::SaintVenantKirchhoff{lambda, mu}, 220.0),
        heml("neo-hookean", physics::NeoHookean{0.5 * mu, lambda}, 180.0),
        heml("mooney-rivlin", physics::MooneyRivlin{0.35 * mu, 0.15 * mu, lambda - 0.6 * mu},
             320.0),
        Measured{"hybmss",
                 {},
                 {tissue.density, springs},
                 662.0,
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
                // Damped, since a body in free fall would become too fast for its steps.
                {.gravity = Vec3(0, 0, -9.81), .damping = 10.0, .constraints = {}, .loads = {}}),
          dt(0.9 * model.stable_step()) {
        model.set_num_threads(num_threads);
    }
};

/// Best times, s.
struct StepTimes {
    double forces, step;
};

StepTimes time_steps(MovingBody& body, double seconds) {
    // Forces are timed within whole steps, so that the caches are in the state of a run.
    double forces = std::numeric_limits<double>::infinity();
    physics::ExplicitStep one_step;
    const double step = best_time(seconds, [&] {
        one_step.move(body.model, 0.0, body.dt);
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
                  .reference_ratio = std::nullopt,
                  .arithmetic = std::nullopt,
                  .steps_per_second = 1.0 / step,
                  .real_time_factor = body.dt / step,
                  .gigaflops = measured.operations * elements / forces * 1e-9,
                  .gigabytes_per_second = measured.bytes * elements / forces * 1e-9};
    if (num_threads == 1) {
        std::vector<Vec3> sums(mesh.node_capacity(), Vec3::Zero());
        const physics::Model& model = body.model;
        const physics::EndOfStep state{model.positions(), model.state().history(), body.dt};
        rate.reference = per_element * best_time(seconds, [&] {
                             model.structure().elements().add_forces(state, sums);
                         });
        if (const auto* links = std::get_if<physics::HyperElasticLinks>(&measured.material.method))
            rate.arithmetic = 1e9 * measure_arithmetic(links->law);
        rate.reference_ratio = (*rate.reference + rate.step - rate.forces) / rate.step;
    }
    return rate;
}

/// Returns the processor time, s.
double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A cube that tools cut.
struct CutCube {
    std::string_view method;
    topology::Mesh mesh;
    physics::Model model;
    cutting::Cutter cutter;

    CutCube(std::size_t num_elements, const Measured& measured)
        : method(measured.method),
          mesh(make_cube(kind_of(measured), num_elements)),
          model(mesh, table_of(measured.material)),
          cutter(mesh, model.mesh_positions()) {}

    void follow(const topology::ChangeSet& changes) {
        model.apply(model.mesh(), changes);
        cutter.apply(mesh, changes);
    }
};

constexpr int num_cut_steps = 20;

/// Returns the edge of a blade that moves halfway through the cube, and not along planes of the
/// mesh.
std::vector<Vec3> edge_of_blade(int step) {
    const double x = -0.01 + 0.51 * step / num_cut_steps;
    return {cube_size * Vec3(x, -0.1, 0.41 + 0.21 * x), cube_size * Vec3(x, 1.1, 0.52 + 0.21 * x)};
}

/// Times a tool that calls cut(cube, step) in every step, which returns the number of items. Forces
/// are evaluated between the steps, so that the caches hold other data, as in a run.
template <class Cut>
EditRate time_tool(std::string_view kind, std::string_view item, CutCube& cube, Cut cut) {
    EditRate rate{cube.method, kind, item, cube.mesh.num_elements()};
    double seconds = 0.0;
    for (int step = 0; step < num_cut_steps; ++step) {
        cube.model.compute_forces(0.0);
        const double start = processor_time();
        rate.items += cut(cube, step);
        seconds += processor_time() - start;
    }
    rate.microseconds = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(rate.items, 1));
    return rate;
}

EditRate measure_split(CutCube& cube) {
    const cutting::CutId cut = cube.cutter.begin_cut(cutting::default_snap);
    return time_tool("split", "element crossed", cube, [&](CutCube& c, int step) {
        const auto done = c.cutter.split(cut, c.mesh, edge_of_blade(step), edge_of_blade(step + 1));
        c.follow(done.changes);
        return done.report.elements_crossed;
    });
}

EditRate measure_separation(CutCube& cube) {
    return time_tool("separate", "face opened", cube, [](CutCube& c, int step) {
        const auto changes =
            c.cutter.separate(c.mesh, edge_of_blade(step), edge_of_blade(step + 1)).changes;
        c.follow(changes);
        return changes.faces_opened.size();
    });
}

/// Times a ball that moves halfway through the cube.
EditRate measure_carving(CutCube& cube) {
    const auto at = [](int step) {
        Pose pose;
        pose.position = cube_size * Vec3(-0.1 + 0.6 * step / num_cut_steps, 0.48, 0.53);
        return pose;
    };
    return time_tool("carve", "element removed", cube, [&](CutCube& c, int step) {
        const cutting::Sphere ball{0.12 * cube_size};
        const auto changes = c.cutter.carve(c.mesh, ball, at(step), at(step + 1)).changes;
        c.follow(changes);
        return changes.elements_removed.size();
    });
}

/// Times the removal of elements with consecutive ids, which are close to each other.
EditRate measure_removal(CutCube& cube) {
    const std::size_t stride = cube.mesh.element_capacity() / (num_cut_steps + 1);
    const std::size_t batch = std::min<std::size_t>(50, stride);
    return time_tool("remove", "element removed", cube, [&](CutCube& c, int step) {
        topology::MeshEdit edit(c.mesh);
        for (std::size_t i = 0; i < batch; ++i)
            edit.remove(CellId(static_cast<std::size_t>(step + 1) * stride - i - 1));
        c.follow(edit.commit());
        return batch;
    });
}

void measure_edits(std::size_t num_elements, const Measured& measured, double seconds,
                   Throughput& result) {
    const bool is_split = kind_of(measured) == topology::CellKind::tetrahedron;
    const auto time_forces = [&](physics::Model& model) {
        const double best = best_time(seconds, [&] { model.compute_forces(0.0); });
        return 1e9 * best / static_cast<double>(model.mesh().num_elements());
    };
    const auto measure_edited = [&](std::string_view edits, CutCube& cube, auto edit) {
        EditedRate rate{.method = measured.method,
                        .edits = edits,
                        .elements_before = cube.mesh.num_elements(),
                        .nodes_before = cube.mesh.num_nodes(),
                        .forces_before = time_forces(cube.model)};
        edit();
        rate.elements = cube.mesh.num_elements();
        rate.nodes = cube.mesh.num_nodes();
        rate.forces = time_forces(cube.model);
        const auto anew =
            topology::Mesh::build(topology::to_mesh_data(cube.mesh, cube.mesh.rest_positions()));
        physics::Model built_anew(anew.mesh, table_of(measured.material));
        rate.forces_built_anew = time_forces(built_anew);
        result.edited.push_back(rate);
    };

    constexpr int num_passes = 3;
    for (const auto measure :
         {measure_split, measure_separation, measure_carving, measure_removal}) {
        if (measure == measure_split && !is_split) continue;
        EditRate best;
        for (int pass = 0; pass < num_passes; ++pass) {
            CutCube cube(num_elements, measured);
            const EditRate rate = measure(cube);
            if (pass == 0 || rate.microseconds < best.microseconds) best = rate;
        }
        result.edits.push_back(best);
    }
    if (is_split) {
        CutCube split(num_elements, measured);
        measure_edited("split", split, [&] { measure_split(split); });
    }
    CutCube halved(num_elements, measured);
    measure_edited("half removed", halved, [&] {
        std::mt19937_64 random(1);
        topology::MeshEdit edit(halved.mesh);
        for (std::size_t i = 0; i < halved.mesh.element_capacity(); ++i)
            if (random() % 2 == 0) edit.remove(CellId(i));
        halved.follow(edit.commit());
    });
}

std::string processor_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name"))
            if (const auto colon = line.find(": "); colon != std::string::npos)
                return line.substr(colon + 2);
    return "unknown";
}

MachineSpeed measure_machine(int num_cores, std::span<const int> threads) {
    MachineSpeed machine{processor_name(), name_of(physics::processor()), num_cores, {}};
    for (const int n : threads) {
        const MachinePeak peak = measure_peak(n);
        machine.limits[n] = {peak.gigaflops, peak.gigabytes_per_second};
    }
    return machine;
}

}  // namespace

Throughput measure_throughput(const ThroughputPlan& plan,
                              const std::function<void(double, const std::string&)>& report) {
    const int num_cores = physics::Workers::num_cores();
    std::vector<int> threads{1};
    if (const int most = plan.num_threads > 0 ? plan.num_threads : num_cores; most > 1)
        threads.push_back(most);
    const auto materials = measured_materials();
    // The measurements of a mesh take about the same time for any size; building it does not.
    double work = 1.0, finished = 0.0;
    const auto work_of = [](std::size_t n, double num_meshes) {
        return num_meshes * (1.0 + static_cast<double>(n) * 1e-5);
    };
    constexpr double num_edited = 10.0;
    for (const auto* sizes : {&plan.tetrahedra, &plan.hexahedra})
        for (const std::size_t n : *sizes) work += work_of(n, 1.0);
    for (const auto* sizes : {&plan.edited_tetrahedra, &plan.edited_hexahedra})
        for (const std::size_t n : *sizes) work += work_of(n, num_edited);
    for (const std::size_t n : plan.touching_tetrahedra) work += work_of(n, 1.0);
    const auto next = [&](double share, const std::string& name) {
        report(finished / work, name);
        finished += share;
    };
    const auto part = [&](std::size_t n, const char* what, double num_meshes = 1.0) {
        next(work_of(n, num_meshes), std::to_string(n) + what);
    };

    Throughput result;
    result.tissue = tissue_name;
    next(1.0, "the machine's limits");
    result.machine = measure_machine(num_cores, threads);
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
    for (const std::size_t n : plan.edited_tetrahedra) {
        part(n, " tetrahedra, edited", num_edited);
        measure_edits(n, materials[1], plan.seconds, result);
    }
    for (const std::size_t n : plan.edited_hexahedra) {
        part(n, " hexahedra, edited", num_edited);
        measure_edits(n, materials.back(), plan.seconds, result);
    }
    for (const std::size_t n : plan.touching_tetrahedra) {
        part(n, " tetrahedra, touching");
        for (const double friction : {0.0, 0.3})
            result.contact.push_back(measure_contact(n, friction, plan.seconds));
    }
    for (StepRate& rate : result.steps) {
        const MachineSpeed::Limit& limit = result.machine.limits.at(rate.num_threads);
        rate.share_of_peak = rate.gigaflops / limit.gigaflops;
        rate.share_of_bandwidth = rate.gigabytes_per_second / limit.gigabytes_per_second;
    }
    return result;
}

}  // namespace incise::bench
