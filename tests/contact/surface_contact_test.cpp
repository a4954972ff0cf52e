// Halves of a cut block that collide in flight: what contact keeps, and what it takes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "incise/contact/contact.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_metrics.h"
#include "support/exact_plane.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "support/present_energy.h"

namespace incise::contact {
namespace {

using physics::Model;
using topology::Mesh;

/// A jittered cube in two halves, which fly at each other and spin.
struct Halves {
    Mesh mesh;
    physics::MaterialTable table;
    Model model;
    topology::BoundarySurface surface;
    double size = 0.25;  // of an element, m

    explicit Halves(std::uint64_t seed)
        : mesh(Mesh::build(test::jittered_cube(4, 0.1, seed)).mesh),
          table{{{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1500.0, 6000.0}}}},
                {{0, 0}},
                {}},
          model(mesh, table),
          surface(mesh) {
        test::Random random(seed);
        const Vec3 point = Vec3::Constant(0.5),
                   normal = (Vec3::UnitZ() + random.vector(0.5)).normalized();
        const auto changes = test::cut_along_plane(mesh, point, normal);
        model.apply(mesh, changes);
        surface.apply(mesh, changes);
        const Vec3 spin = random.vector(0.1), slide = random.vector(0.03);
        std::vector<Vec3> x(model.positions().begin(), model.positions().end()), v(x.size());
        for (const ElementId e : model.fragments().elements()) {
            const CellId cell = model.fragments().cells_of(e)[0];
            Vec3 centre = Vec3::Zero();
            for (const VertexId n : mesh.corners(cell)) centre += 0.25 * mesh.rest_position(n);
            const double side = (centre - point).dot(normal) > 0.0 ? 1.0 : -1.0;
            for (const NodeId n : model.fragments().corners(e)) {
                const Vec3& X = model.fragments().rest_position(n);
                x[n.index()] = X + side * 0.05 * normal;
                v[n.index()] = side * (slide - 0.1 * normal) + spin.cross(X - point);
            }
        }
        model.set_state(x, v, 0.0);
        model.compute_totals_and_forces();
    }
};

void expect_sound_collision(std::uint64_t seed, double friction) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", friction " << friction);
    Halves halves(seed);
    Model& model = halves.model;
    Contact contact({.friction = friction}, halves.size);
    contact.follow(model, halves.surface);
    physics::SemiImplicitEuler integrator;
    integrator.add_projection(contact);
    const physics::Totals before = model.energetics().totals();
    double scale = 0.0, most = 0.0, rest = 0.0, deepest = 0.0, time = 0.0;
    for (std::size_t n = 0; n < model.masses().size(); ++n)
        scale += model.masses()[n] * model.velocities()[n].norm();
    std::size_t num_points = 0;
    for (int i = 0; i < 600; ++i) {
        const double dt = 0.4 * model.structure().rest_stable_step();
        integrator.step(model, time, dt);
        contact.book_work(model);
        time += dt;
        model.compute_forces(time);
        rest = test::present_energy(model, dt);
        most = std::max(most, rest);
        deepest = std::max(deepest, contact.max_penetration());
        num_points = std::max(num_points, contact.num_points());
    }
    const physics::Totals after = model.energetics().totals();
    EXPECT_GT(num_points, 10u);
    EXPECT_LE((after.momentum - before.momentum).norm(), 1e-13 * scale);
    EXPECT_LE((after.angular_momentum - before.angular_momentum).norm(),
              (friction == 0.0 ? 1e-12 : 1e-4) * scale);
    const double energy = before.elastic_energy + before.kinetic_energy;
    EXPECT_LT(most, 1.002 * energy);
    EXPECT_GT(contact.dissipation(), 0.0);
    EXPECT_NEAR(rest + contact.dissipation(), energy, 2e-3 * energy);
    EXPECT_LT(deepest, 0.02 * halves.size);
}

TEST(SurfaceContact, KeepsMomentumAndAccountsForEnergy) {
    for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed)
        for (const double friction : {0.0, 0.4}) expect_sound_collision(seed, friction);
}

// Without contact the halves of the test above pass through each other.
TEST(SurfaceContact, IsWhatStopsTheHalves) {
    Halves halves(1);
    double time = 0.0;
    const double dt = 0.4 * halves.model.structure().rest_stable_step();
    for (int i = 0; i < 600; ++i) {
        physics::ExplicitStep().move(halves.model, time, dt);
        time += dt;
        halves.model.compute_forces(time);
    }
    double lowest = 0.0;  // of the top, against where it was
    for (const VertexId n : halves.mesh.nodes())
        if (halves.mesh.rest_position(n).z() == 1.0)
            lowest = std::min(lowest, halves.model.mesh_positions()[n.index()].z() - 1.0);
    EXPECT_LT(lowest, -0.1);
}

/// A jittered cube that flies, with a corner cut off. The corner slides along the cut, and slowly
/// away from it.
struct SlidingCorner {
    static constexpr int num_bricks = 6;
    static constexpr double size = 1.0 / num_bricks;  // of an element, m

    Mesh mesh;
    physics::MaterialTable table{
        {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1500.0, 6000.0}}}}, {{0, 0}}, {}};
    Model model;
    topology::BoundarySurface surface;
    double dt;  // s

    explicit SlidingCorner(std::uint64_t seed)
        : mesh(Mesh::build(test::jittered_cube(num_bricks, 0.1, seed)).mesh),
          model(mesh, table),
          surface(mesh),
          dt(0.4 * model.structure().rest_stable_step()) {
        test::Random random(seed);
        const Vec3 point = Vec3::Constant(0.85),
                   normal = (Vec3::Ones() + random.vector(0.3)).normalized();
        const auto changes = test::cut_along_plane(mesh, point, normal);
        model.apply(mesh, changes);
        surface.apply(mesh, changes);
        const Vec3 flight = 0.03 * size / dt * random.vector(1.0);
        const Vec3 slide = 0.05 * size / dt * normal.cross(random.vector(1.0)).normalized() +
                           0.001 * size / dt * normal;
        const auto now = model.positions();
        std::vector<Vec3> x(now.begin(), now.end()), v(x.size(), flight);
        for (const ElementId e : model.fragments().elements()) {
            Vec3 centre = Vec3::Zero();
            for (const VertexId n : mesh.corners(model.fragments().cells_of(e)[0]))
                centre += 0.25 * mesh.rest_position(n);
            if ((centre - point).dot(normal) < 0.0) continue;
            for (const NodeId n : model.fragments().corners(e)) v[n.index()] = flight + slide;
        }
        model.set_state(x, v, 0.0);
        model.compute_totals_and_forces();
    }
};

// The search follows the corner alone. What it finds is what a new search of all finds.
TEST(SurfaceContact, SearchesOnlyNearWhatMoves) {
    constexpr int num_steps = 150;
    for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
        SCOPED_TRACE(seed);
        SlidingCorner body(seed);
        SurfaceContact contact({}, body.size);
        ContactSolver solver(body.size), new_solver(body.size);
        contact.follow(body.model, body.surface);
        const std::size_t at_first = contact.num_tested();
        std::size_t num_points = 0, num_new_points = 0;
        for (int i = 0; i < num_steps; ++i) {
            // One step earlier: edges are points of contact by how fast they move.
            SurfaceContact anew({}, body.size);
            if (i % 5 == 0) {
                anew.follow(body.model, body.surface);
                anew.add_points(body.model, new_solver);
            }
            physics::ExplicitStep().move(body.model, i * body.dt, body.dt);
            body.model.compute_forces((i + 1) * body.dt);
            solver.clear();
            contact.add_points(body.model, solver);
            if (i % 5 != 0) continue;
            new_solver.clear();
            anew.add_points(body.model, new_solver);
            EXPECT_GE(solver.size(), new_solver.size()) << i;
            num_points += solver.size();
            num_new_points += new_solver.size();
        }
        EXPECT_GT(num_new_points, 100u);
        EXPECT_LT(num_points, 1.1 * static_cast<double>(num_new_points));
        EXPECT_LT(contact.num_tested(), 12 * at_first);  // 30 searches
    }
}

// Two thin plates, one just above the other, in the grid of one another or beside it. The upper one
// falls upwards. What is behind a plate is not in it.
TEST(SurfaceContact, OfThinPlatesIsNoneBehindThem) {
    constexpr double edge = 0.01, thick = 0.0005, apart = 1e-5;  // m
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0.0013, 0.0013, 0), Vec3(0.0013, 0.0027, 0)}) {
        SCOPED_TRACE(shift.transpose());
        const auto plate = [&](const Vec3& origin) {
            return topology::box_mesh(topology::CellKind::tetrahedron, origin,
                                      Vec3(edge, edge, thick), {4, 4, 1});
        };
        topology::MeshData data = plate(Vec3::Zero());
        const topology::MeshData upper = plate(shift + Vec3(0, 0, thick + apart));
        const auto first = static_cast<std::int64_t>(data.points.size());
        data.points.insert(data.points.end(), upper.points.begin(), upper.points.end());
        for (std::size_t c = 0; c < upper.num_cells(); ++c) {
            std::vector<std::int64_t> corners(upper.cell(c).begin(), upper.cell(c).end());
            for (std::int64_t& corner : corners) corner += first;
            data.add_cell(upper.kinds[c], corners, upper.regions[c]);
        }
        const Mesh mesh = Mesh::build(data).mesh;
        const physics::MaterialTable table{
            {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1500.0, 6000.0}}}},
            {{0, 0}},
            {}};
        std::vector<VertexId> lower_nodes, upper_nodes;
        for (const VertexId n : mesh.nodes())
            (mesh.rest_position(n).z() < thick + 0.5 * apart ? lower_nodes : upper_nodes)
                .push_back(n);
        physics::BoundaryConditions boundary;
        boundary.gravity = Vec3(0, 0, 1);
        boundary.constraints.push_back({.name = "lower", .nodes = physics::VertexSet(lower_nodes)});
        Model model(mesh, table, std::move(boundary));
        const topology::BoundarySurface surface(mesh);
        Contact contact({}, topology::mean_element_length(mesh));
        contact.follow(model, surface);
        physics::SemiImplicitEuler integrator;
        integrator.add_projection(contact);
        double time = 0.0, deepest = 0.0;
        model.compute_forces(time);
        while (time < 0.05) {
            const double dt = 0.5 * model.structure().rest_stable_step();
            integrator.step(model, time, dt);
            contact.book_work(model);
            time += dt;
            model.compute_forces(time);
            deepest = std::max(deepest, contact.max_penetration());
        }
        EXPECT_LT(deepest, 0.02 * thick);
        for (const VertexId n : upper_nodes)
            EXPECT_NEAR(model.mesh_positions()[n.index()].z() - mesh.rest_position(n).z(),
                        0.5 * time * time, 0.03 * 0.5 * time * time);
    }
}

}  // namespace
}  // namespace incise::contact
