// Corners and edges of pieces of tissue that fall on each other: how deep they come, and what is
// told of it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/edge_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>

#include "incise/base/archive.h"
#include "incise/contact/contact.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh_metrics.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::contact {
namespace {

using physics::Model;
using topology::Mesh;

constexpr double cube_side = 0.02;  // of the cube, and the thickness of the slab, m

/// A slab whose bottom is held, and a cube above it.
struct SlabAndCube {
    /// @param fine  elements along an edge of the cube
    /// @param turn  of the cube about its middle
    /// @param over  where the middle of the cube is above the slab, which goes to 1.5 edges, m
    SlabAndCube(int fine, const Eigen::Quaterniond& turn, const Vec3& over, double height)
        : data(box({-1.5, -1.5, -1}, {3, 3, 1}, fine)) {
        const auto first = static_cast<std::int64_t>(data.points.size());
        topology::MeshData cube = box({-0.5, -0.5, -0.5}, {1, 1, 1}, fine);
        double lowest = 0.0;
        for (Vec3& x : cube.points) {
            x = turn * x;
            lowest = std::min(lowest, x.z());
        }
        for (std::size_t c = 0; c < cube.num_cells(); ++c) {
            std::vector<std::int64_t> corners(cube.cell(c).begin(), cube.cell(c).end());
            for (std::int64_t& corner : corners) corner += first;
            data.add_cell(cube.kinds[c], corners, cube.regions[c]);
        }
        for (const Vec3& x : cube.points)
            data.points.push_back(x + over + (height - lowest) * Vec3::UnitZ());
    }
    static topology::MeshData box(const Vec3& origin, const Vec3& edges, int fine) {
        return topology::box_mesh(
            topology::CellKind::tetrahedron, cube_side * origin, cube_side * edges,
            {fine * static_cast<int>(edges.x()), fine * static_cast<int>(edges.y()),
             fine * static_cast<int>(edges.z())});
    }

    topology::MeshData data;
};

/// The nodes that are between two heights at rest, m.
physics::VertexSet nodes_between(const Mesh& mesh, double low, double high) {
    std::vector<VertexId> nodes;
    for (const VertexId n : mesh.nodes())
        if (mesh.rest_position(n).z() >= low && mesh.rest_position(n).z() <= high)
            nodes.push_back(n);
    return physics::VertexSet(nodes);
}

/// A body in contact with itself.
struct Body {
    Mesh mesh;
    Model model;
    topology::BoundarySurface surface;
    double size;
    Contact contact;
    topology::Components pieces;
    physics::SemiImplicitEuler integrator;
    double time = 0.0;

    /// @param conditions  of the mesh
    Body(const topology::MeshData& data, double friction,
         const std::function<physics::BoundaryConditions(const Mesh&)>& conditions)
        : mesh(Mesh::build(data).mesh),
          model(mesh,
                {{{1000.0, physics::HyperElasticLinks{physics::NeoHookean{960.0, 2900.0}}}},
                 {{0, 0}},
                 {}},
                conditions(mesh)),
          surface(mesh),
          size(topology::mean_element_length(mesh)),
          contact({.friction = friction}, size),
          pieces(topology::components(mesh)) {
        contact.follow(model, surface);
        integrator.add_projection(contact);
        model.compute_forces(time);
    }
    void step(double part) {
        const double dt = part * model.stable_step();
        integrator.step(model, time, dt);
        contact.book_work(model);
        time += dt;
        model.compute_forces(time);
    }
    int piece_of(VertexId n) const { return pieces.of_element[mesh.incident_element(n).index()]; }

    bool is_inside(const Vec3& x, CellId e) const {
        std::array<Vec3, 4> at;
        for (std::size_t k = 0; k < 4; ++k)
            at[k] = model.mesh_positions()[mesh.corners(e)[k].index()];
        for (std::size_t k = 0; k < 4; ++k) {
            auto other = at;
            other[k] = x;
            if (topology::tetrahedron_volume(other[0], other[1], other[2], other[3]) < 0.0)
                return false;
        }
        return true;
    }
    /// Returns how deep nodes and edges of the surface of one piece are in the other one, m.
    double deepest() const {
        const auto x = model.mesh_positions();
        std::array<Box, 2> boxes;
        for (const VertexId n : mesh.nodes())
            boxes[static_cast<std::size_t>(piece_of(n))].extend(x[n.index()]);
        double deepest = 0.0;
        const auto look_at = [&](const Vec3& point, int piece) {
            if (!boxes[static_cast<std::size_t>(1 - piece)].contains(point)) return;
            const auto elements = mesh.elements();
            if (std::none_of(elements.begin(), elements.end(), [&](CellId e) {
                    return pieces.of_element[e.index()] != piece && is_inside(point, e);
                }))
                return;
            double least = std::numeric_limits<double>::infinity();
            for (const auto& [a, b, c] : surface.triangles())
                if (piece_of(a) != piece)
                    least = std::min(
                        least, squared_distance(point, x[a.index()], x[b.index()], x[c.index()]));
            deepest = std::max(deepest, std::sqrt(least));
        };
        for (const Triangle& triangle : surface.triangles())
            for (std::size_t k = 0; k < 3; ++k) {
                const VertexId a = triangle[k], b = triangle[(k + 1) % 3];
                if (b < a) continue;
                for (const double part : {0.0, 0.33, 0.67})
                    look_at((1.0 - part) * x[a.index()] + part * x[b.index()], piece_of(a));
            }
        return deepest;
    }
};

/// Contact that goes on from an archive finds the points that it would have found.
void expect_restorable(Body& body) {
    ArchiveWriter writer;
    body.contact.save(writer);
    Contact restored({}, body.size);
    ArchiveReader reader(writer.bytes());
    restored.restore(reader, body.model, body.surface);
    const double dt = 1e-4;
    body.contact.prepare(body.model, body.time, dt);
    restored.prepare(body.model, body.time, dt);
    const ContactSolver &one = body.contact.solver(), &two = restored.solver();
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one.point(i).gap, two.point(i).gap);
        EXPECT_EQ(one.point(i).normal, two.point(i).normal);
        EXPECT_EQ(one.point(i).impulse, two.point(i).impulse);
    }
}

void expect_to_stay_outside(const SlabAndCube& bodies, double friction, double part) {
    Body body(bodies.data, friction, [](const Mesh& mesh) {
        return physics::BoundaryConditions{
            .gravity = Vec3(0, 0, -9.81),
            .damping = 5.0,
            .constraints = {{.name = "bottom",
                             .nodes = nodes_between(mesh, -cube_side, -0.99 * cube_side)}},
            .loads = {}};
    });
    ASSERT_EQ(body.pieces.count, 2);
    double deepest = 0.0, told = 0.0;
    std::size_t num_points = 0;
    for (int i = 0; body.time < 0.2; ++i) {
        body.step(part);
        told = std::max(told, body.contact.max_penetration());
        num_points = std::max(num_points, body.contact.num_points());
        if (i % static_cast<int>(20.0 / part) == 0) deepest = std::max(deepest, body.deepest());
        if (i == static_cast<int>(160.0 / part)) expect_restorable(body);
    }
    EXPECT_GT(num_points, 0u);
    EXPECT_LT(deepest, 0.1 * body.size);
    EXPECT_GT(told, deepest - 0.05 * body.size);
}

Eigen::Quaterniond turn_of(const Vec3& from, const Vec3& to, double about) {
    return Eigen::AngleAxisd(about, to.normalized()) * Eigen::Quaterniond::FromTwoVectors(from, to);
}

// At the impact the cube has 0.7 m/s, a third of the speed of waves.
TEST(EdgeContact, KeepsCornersAndEdgesOutOfTissue) {
    constexpr double height = 0.025;
    const Vec3 down = -Vec3::UnitZ(), corner(1, 1, 1), on_edge(1, 1, 0);
    for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
        test::Random random(seed);
        const int fine = seed % 2 == 0 ? 2 : 1;
        const double friction = seed % 4 < 2 ? 0.0 : 0.3, part = seed % 3 == 0 ? 0.8 : 0.4;
        const auto on = [&](double x, double y) -> Vec3 {
            return cube_side * Vec3(x, y, 0) +
                   random.vector(0.1 * cube_side).cwiseProduct(Vec3(1, 1, 0));
        };
        const double any = random.uniform(0.0, 2.0 * std::numbers::pi);
        const auto expect_outside = [&](const char* what, const Eigen::Quaterniond& turn,
                                        const Vec3& over) {
            SCOPED_TRACE(testing::Message() << what << ", seed " << seed);
            expect_to_stay_outside(SlabAndCube(fine, turn, over, height), friction, part);
        };
        expect_outside("corner on face", turn_of(corner, down, any), on(0, 0));
        expect_outside("corner on corner", turn_of(corner, down, any), on(1.4, 1.4));
        expect_outside("edge on edge",
                       turn_of(on_edge, Vec3(0, 0.5, -1), random.uniform(-0.2, 0.2)), on(0, 1.5));
        expect_outside("any on any", turn_of(random.vector(1.0), random.vector(1.0), any),
                       on(0.8, 1.2));
    }
}

// Two bars, each with an edge towards the other one. The crossing of the edges slides over nodes,
// and the upper bar turns until a face of it lies on the edge.
TEST(EdgeContact, KeepsCrossedBarsOutOfEachOther) {
    for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        topology::MeshData data;
        double lowest = 0.0;
        const auto add_bar = [&](double thick, const std::array<int, 3>& bricks,
                                 const Eigen::Quaterniond& turn, const Vec3& shift, bool is_upper) {
            topology::MeshData bar =
                topology::box_mesh(topology::CellKind::tetrahedron, -0.5 * Vec3(0.08, thick, thick),
                                   Vec3(0.08, thick, thick), bricks);
            Box box;
            for (Vec3& x : bar.points) box.extend(x = turn * x);
            const double rise = is_upper ? 0.005 - box.min().z() : -box.max().z();
            if (!is_upper) lowest = box.min().z() + rise;
            const auto first = static_cast<std::int64_t>(data.points.size());
            for (const Vec3& x : bar.points)
                data.points.push_back(x + shift + rise * Vec3::UnitZ());
            for (std::size_t c = 0; c < bar.num_cells(); ++c) {
                std::vector<std::int64_t> corners(bar.cell(c).begin(), bar.cell(c).end());
                for (std::int64_t& corner : corners) corner += first;
                data.add_cell(bar.kinds[c], corners, bar.regions[c]);
            }
        };
        const Eigen::Quaterniond edge_up(Eigen::AngleAxisd(0.25 * std::numbers::pi, Vec3::UnitX()));
        const Eigen::Quaterniond across(Eigen::AngleAxisd(random.uniform(0.7, 1.5), Vec3::UnitZ()));
        add_bar(0.014, {8, 2, 2}, edge_up, Vec3::Zero(), false);
        add_bar(0.01, {8, 1, 1}, across * edge_up, random.vector(0.003).cwiseProduct(Vec3(1, 1, 0)),
                true);
        Body body(data, 0.0, [&](const Mesh& mesh) {
            return physics::BoundaryConditions{
                .gravity = Vec3(0, 0, -9.81),
                .damping = 5.0,
                .constraints = {{.name = "bottom",
                                 .nodes = nodes_between(mesh, lowest - 1e-6, lowest + 1e-6)}},
                .loads = {}};
        });
        ASSERT_EQ(body.pieces.count, 2);
        double deepest = 0.0;
        for (int i = 0; body.time < 0.2; ++i) {
            body.step(0.8);
            if (i % 20 == 0) deepest = std::max(deepest, body.deepest());
        }
        EXPECT_LT(deepest, 0.1 * body.size);
    }
}

// Where a corner and a node of the face are on each other, the point of the node alone, with the
// normal of a side of the cube, would let the corner in.
TEST(EdgeContact, KeepsAPressedCornerOutOfANode) {
    for (const Vec3& from_node : {Vec3(-0.0029, -0.0037, 0), Vec3(0.002, 0.0012, 0)}) {
        const SlabAndCube bodies(2, turn_of({1, 1, 1}, -Vec3::UnitZ(), 0.3), from_node, 1e-4);
        Body body(bodies.data, 0.0, [](const Mesh& mesh) {
            physics::Constraint top{.name = "top",
                                    .nodes = nodes_between(mesh, 0.9 * cube_side, 1.0)};
            top.displacement = physics::TimeCurve<Vec3>(
                {{0.0, Vec3::Zero()}, {0.2, Vec3(0, 0, -0.4 * cube_side)}});
            return physics::BoundaryConditions{
                .gravity = Vec3::Zero(),
                .damping = 40.0,
                .constraints = {{.name = "bottom",
                                 .nodes = nodes_between(mesh, -cube_side, -0.99 * cube_side)},
                                std::move(top)},
                .loads = {}};
        });
        for (int i = 0; body.time < 0.3; ++i) {
            body.step(0.8);
            if (i % 20 == 0) {
                EXPECT_LT(body.deepest(), 0.02 * body.size);
            }
        }
    }
}

// All nodes are led, so that no force keeps the cube out.
TEST(EdgeContact, TellsHowDeepACornerIs) {
    constexpr double way = 0.9 * cube_side;
    const SlabAndCube bodies(3, turn_of({1, 1, 1}, -Vec3::UnitZ(), 0.3), Vec3(0.001, 0.002, 0),
                             1e-4);
    Body body(bodies.data, 0.0, [](const Mesh& mesh) {
        physics::Constraint slab{.name = "slab", .nodes = nodes_between(mesh, -cube_side, 0.0)};
        physics::Constraint cube{.name = "cube", .nodes = nodes_between(mesh, 1e-5, 1.0)};
        cube.displacement =
            physics::TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {0.2, Vec3(0, 0, -way)}});
        return physics::BoundaryConditions{.gravity = Vec3::Zero(),
                                           .damping = 0.0,
                                           .constraints = {std::move(slab), std::move(cube)},
                                           .loads = {}};
    });
    while (body.time < 0.2) {
        const double depth = way * body.time / 0.2 - 1e-4;
        body.step(0.8);
        EXPECT_NEAR(body.contact.max_penetration(), std::max(depth, 0.0), 0.02 * body.size);
    }
}

}  // namespace
}  // namespace incise::contact
