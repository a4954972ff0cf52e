// What tests of contact with known answers share: bodies, loads, means, and a record of results.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "incise/topology/geometry.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {

/// Tells whether a material point belongs to a part of the body, by its rest position, m.
using Part = std::function<bool(const Vec3&)>;

/// Returns a number in as few digits as it needs.
inline std::string short_text(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

/// Records a result beside its answer: data/validation/contact_plots.py makes the table of
/// docs/validation.md of these records.
inline void record_result(const std::string& what, double result, double answer) {
    std::ostringstream text;
    text.precision(10);
    text << result << ' ' << answer;
    testing::Test::RecordProperty(what, text.str());
}

/// Expects a result within a part `tolerance` of the answer, and records both.
inline void expect_answer(const std::string& what, double result, double answer, double tolerance) {
    record_result(what, result, answer);
    EXPECT_NEAR(result, answer, tolerance * std::abs(answer)) << what;
}

/// Records a point of a curve, for a figure.
inline void record_point(const std::string& curve, double x, double y) {
    record_result("curve " + curve + " at " + short_text(x), x, y);
}

/// An elastic solid. With damping, half of its stiffness is viscous: vibrations of about the
/// period of the relaxation time fade. Friction without it makes soft tissue vibrate.
struct Solid {
    double young = 1e5;  ///< Pa
    double poisson = 0.0;
    double density = 1000.0;       ///< kg/m3
    double relaxation_time = 0.0;  ///< s; 0: no viscosity

    double shear_modulus() const { return young / (2.0 * (1.0 + poisson)); }
    double lambda() const { return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)); }
    double plane_modulus() const { return young / (1.0 - poisson * poisson); }
    /// `young` is the modulus at long times.
    operator physics::Material() const {
        const double factor = relaxation_time > 0.0 ? 2.0 : 1.0;
        physics::HyperElasticLinks links{
            .law = physics::NeoHookean{0.5 * factor * shear_modulus(), factor * lambda()}};
        if (relaxation_time > 0.0) links.prony = {{0.5, relaxation_time}};
        return {density, links};
    }
};

inline topology::MeshData box(const Vec3& origin, const Vec3& edges, std::array<int, 3> cells) {
    return topology::box_mesh(topology::CellKind::tetrahedron, origin, edges, cells);
}

/// The radii of the shells of a graded body: `fine` steps of `h`, m, then each radius `growth`
/// times the one before, up to `end`, m.
inline std::vector<double> shells(double h, int fine, double growth, double end) {
    std::vector<double> radii{0.0};
    for (int k = 1; k <= fine; ++k) radii.push_back(h * k);
    while (radii.back() < end) radii.push_back(growth * radii.back());
    return radii;
}

/// Returns a part of a block, fine about the origin and ever coarser away from it: bricks between
/// cubes of these radii. The region of a cell is the number of its outer cube.
/// @param low, high  where the part begins and ends, by axis: -1, 0, or 1
inline topology::MeshData graded_block(const std::vector<double>& radii,
                                       const std::array<int, 3>& low,
                                       const std::array<int, 3>& high) {
    const int n = static_cast<int>(radii.size()) - 1;
    std::array<int, 3> cells{};
    Vec3 origin, edges;
    for (std::size_t c = 0; c < 3; ++c) {
        cells[c] = n * (high[c] - low[c]);
        origin[static_cast<int>(c)] = n * low[c];
        edges[static_cast<int>(c)] = cells[c];
    }
    topology::MeshData mesh = box(origin, edges, cells);
    const auto shell = [](const Vec3& x) { return x.cwiseAbs().maxCoeff(); };
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        double outer = 0.0;
        for (const std::int64_t p : mesh.cell(c))
            outer = std::max(outer, shell(mesh.points[static_cast<std::size_t>(p)]));
        mesh.regions[c] = static_cast<int>(std::lround(outer));
    }
    for (Vec3& x : mesh.points)
        if (const double k = shell(x); k > 0.0)
            x *= radii[static_cast<std::size_t>(std::lround(k))] / k;
    return mesh;
}

/// Returns a quarter of such a block under the plane z = 0. If it is whole, it goes on above it.
inline topology::MeshData graded_quarter(const std::vector<double>& radii, bool is_whole = false) {
    return graded_block(radii, {0, 0, -1}, {1, 1, is_whole ? 1 : 0});
}

/// The materials of a graded body. Mass does not matter at rest. It is chosen such that waves take
/// as long for an outer element as for an inner one: then the body comes to rest soon.
inline void set_graded_materials(WorldDef& def, const Solid& solid,
                                 const std::vector<double>& radii) {
    for (std::size_t k = 1; k < radii.size(); ++k) {
        Solid of_shell = solid;
        const double ratio = static_cast<double>(k) * radii[1] / radii[k];
        of_shell.density *= ratio * ratio;
        def.material_of_region[static_cast<int>(k)] = def.materials.size();
        def.materials.push_back(of_shell);
    }
}

/// Appends the cells of a separate body.
inline void append(topology::MeshData& all, const topology::MeshData& more) {
    const auto first = static_cast<std::int64_t>(all.points.size());
    all.points.insert(all.points.end(), more.points.begin(), more.points.end());
    for (std::size_t c = 0; c < more.num_cells(); ++c) {
        std::vector<std::int64_t> corners(more.cell(c).begin(), more.cell(c).end());
        for (std::int64_t& corner : corners) corner += first;
        all.add_cell(more.kinds[c], corners, more.regions[c]);
    }
    all.points_may_coincide = true;
}

inline std::vector<CellId> elements_where(const World& world, const Part& is_in) {
    std::vector<CellId> elements;
    for (const CellId e : world.mesh().elements()) {
        Vec3 centre = Vec3::Zero();
        for (const VertexId n : world.mesh().corners(e)) centre += world.mesh().rest_position(n);
        if (is_in(centre / static_cast<double>(world.mesh().corners(e).size())))
            elements.push_back(e);
    }
    return elements;
}

/// Mean displacement and velocity of some elements, by mass.
struct Motion {
    double mass = 0.0;                 ///< kg
    Vec3 displacement = Vec3::Zero();  ///< m
    Vec3 velocity = Vec3::Zero();      ///< m/s
};
inline Motion mean_motion(const World& world, const std::vector<CellId>& elements, double density) {
    Motion sum;
    const topology::Mesh& mesh = world.mesh();
    for (const CellId e : elements) {
        // Tetrahedra between a corner and the triangles of the faces have its volume as their sum.
        const VertexId apex = mesh.corners(e)[0];
        for (int f = 0; f < mesh.num_faces(e); ++f)
            for (int p = 2; p < mesh.face_size({e, f}); ++p) {
                const std::array corners{apex, mesh.face_corner({e, f}, 0),
                                         mesh.face_corner({e, f}, p - 1),
                                         mesh.face_corner({e, f}, p)};
                std::array<Vec3, 4> X;
                for (std::size_t k = 0; k < 4; ++k) X[k] = mesh.rest_position(corners[k]);
                const double mass = density * topology::tetrahedron_volume(X[0], X[1], X[2], X[3]);
                sum.mass += mass;
                for (std::size_t k = 0; k < 4; ++k) {
                    const std::size_t n = corners[k].index();
                    sum.displacement += 0.25 * mass * (world.positions()[n] - X[k]);
                    sum.velocity += 0.25 * mass * world.velocities()[n];
                }
            }
    }
    sum.displacement /= sum.mass;
    sum.velocity /= sum.mass;
    return sum;
}

/// Adds a velocity to all of some elements, by a body force in one step.
inline void launch(World& world, const std::vector<CellId>& elements, double density,
                   const Vec3& velocity, double dt) {
    const LoadId push = world.add_load(
        {.name = "push",
         .kind = physics::BodyLoad{physics::CellSet(elements), density / dt * velocity}});
    world.step(dt);
    world.remove_load(push);
}

/// The faces of the surface all of whose corners are in a part.
inline std::vector<FaceId> faces_where(World& world, const Part& is_in) {
    std::vector<FaceId> faces;
    const topology::BoundarySurface& surface = world.surface();
    for (std::size_t t = 0; t < surface.triangles().size(); ++t)
        if (std::ranges::all_of(surface.triangles()[t],
                                [&](VertexId n) { return is_in(world.mesh().rest_position(n)); }))
            faces.push_back(surface.faces()[t]);
    std::ranges::sort(faces);
    return faces;
}

/// Returns the mean by time of what `value` is after each step until `end`, s.
inline double mean_until(World& world, double end, const std::function<double()>& value) {
    const double begin = world.time();
    double sum = 0.0;
    while (world.time() < end) {
        const double before = world.time();
        world.step(0.8 * world.stable_step());
        sum += (world.time() - before) * value();
    }
    return sum / (world.time() - begin);
}

}  // namespace incise::sim
