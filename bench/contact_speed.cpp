// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/bench/contact_speed.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "incise/bench/best_time.h"
#include "incise/contact/contact.h"
#include "incise/cutting/cutter.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/physics/body/model.h"
#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"

namespace incise::bench {

namespace {

constexpr double side = 0.1;         // of the block, m
constexpr double pressed_by = 0.05;  // of it
constexpr double pressed_in = 0.1;   // s

/// Returns what glues the bottom and the top of the block to plates, of which one presses.
std::vector<physics::Constraint> plates(const topology::Mesh& mesh) {
    const auto nodes_at = [&](double z) {
        std::vector<VertexId> nodes;
        for (const VertexId n : mesh.nodes())
            if (mesh.rest_position(n).z() == z) nodes.push_back(n);
        return physics::VertexSet(nodes);
    };
    physics::Constraint bottom{.name = "bottom"}, top{.name = "top"};
    bottom.nodes = nodes_at(0.0);
    top.nodes = nodes_at(side);
    top.displacement = physics::TimeCurve<Vec3>(
        {{0.0, Vec3::Zero()}, {pressed_in, -pressed_by * side * Vec3::UnitZ()}});
    return {std::move(bottom), std::move(top)};
}

}  // namespace

ContactRate measure_contact(std::size_t num_elements, double friction, double seconds) {
    const int n = std::max(
        2, static_cast<int>(std::lround(std::cbrt(static_cast<double>(num_elements) / 6.0))));
    topology::Mesh mesh =
        topology::Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                 Vec3::Constant(side), {n, n, n}))
            .mesh;
    ContactRate rate{.elements = mesh.num_elements(), .friction = friction};
    const physics::Material gel{1000.0,
                                physics::HyperElasticLinks{physics::NeoHookean{1724.0, 15517.0}}};
    physics::Model model(
        mesh, {{gel}, {{0, 0}}},
        {.gravity = Vec3::Zero(), .damping = 20.0, .constraints = plates(mesh), .loads = {}});
    cutting::Cutter cutter(mesh, model.mesh_positions());
    const cutting::Plane plane(side * Vec3(0.5, 0.5, 0.49), Vec3(0.1, 0.05, 1.0));
    const auto cut = cutter.split(mesh, plane, cutting::default_snap);
    model.apply(mesh, cut.changes);

    const topology::BoundarySurface surface(mesh);
    contact::ContactSettings settings;
    settings.friction = friction;
    contact::Contact contact(settings, side / n);
    contact.follow(model, surface);
    rate.search = 1e3 * best_time(seconds, [&] {
                      contact::Contact(settings, side / n).follow(model, surface);
                  });
    std::set<VertexId> nodes;
    for (const auto& triangle : surface.triangles()) nodes.insert(triangle.begin(), triangle.end());
    rate.surface_nodes = nodes.size();

    physics::SemiImplicitEuler with, without;
    with.add_projection(contact);
    const double dt = 0.8 * model.structure().rest_stable_step();
    double time = 0.0;
    const auto step = [&](physics::Integrator& integrator) {
        integrator.step(model, time, dt);
        contact.book_work(model);
        time += dt;
        model.compute_forces(time);
    };
    model.compute_forces(time);
    while (time < 2.0 * pressed_in) step(with);
    rate.step = 1e6 * best_time(seconds, [&] { step(with); });
    rate.points = contact.num_points();
    // The faces begin to pass through each other, which takes no more and no less time.
    rate.step_without = 1e6 * best_time(seconds, [&] { step(without); });
    return rate;
}

}  // namespace incise::bench
