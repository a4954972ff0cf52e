// The quality of cuts at their default: how smooth they are, and what they cost of the stable step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "incise/base/disjoint_set.h"
#include "incise/cutting/rest/cut_at_rest.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/geometry.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "support/plane_section.h"

namespace incise::cutting {
namespace {

using topology::Mesh;
using topology::MeshData;

constexpr int num_trials = 20;
constexpr double farthest = 0.03;  // nodes of a cut from its surface, mean edges
constexpr double largest_angle = 0.5 * std::numbers::pi / 180.0;  // mean, of faces to a plane

/// A body, with the least ratios of the stable step after cuts to that before.
struct Body {
    std::string name;
    MeshData data;
    double step_after_one, step_after_eight;
};

MeshData organ(const std::string& file) {
    return io::read_mesh(std::string(INCISE_DATA_DIR) + "/" + file).mesh;
}

const std::vector<Body>& bodies() {
    static const std::vector<Body> all = {
        {"Kuhn cube",
         topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(),
                            {15, 15, 15}),
         0.75, 0.75},
        {"jittered cube", test::jittered_cube(15, 0.2, 1), 0.53, 0.5},
        {"liver", organ("liver.vtu"), 0.75, 0.75},
        {"kidney", organ("kidney.vtu"), 0.75, 0.75},
        {"long bricks",
         topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), {1.0, 1.0, 3.0},
                            {12, 12, 12}),
         0.55, 0.5}};
    return all;
}

/// Bodies of the other kinds of cells.
const std::vector<Body>& bodies_of_any_cells() {
    static const std::vector<Body> all = [] {
        std::vector<Body> bodies;
        for (const auto& [name, bricks] :
             {std::pair("hexahedra", test::Bricks::hexahedra),
              std::pair("wedges", test::Bricks::wedges),
              std::pair("pyramids", test::Bricks::pyramids),
              std::pair("mixed", test::Bricks::mixed), std::pair("joined", test::Bricks::joined)}) {
            bodies.push_back({name, test::brick_cube(bricks, 8, 0.0, 1), 0.75, 0.5});
            bodies.push_back({std::string("jittered ") + name, test::brick_cube(bricks, 8, 0.2, 1),
                              bricks == test::Bricks::joined ? 0.4 : 0.55, 0.4});
        }
        return bodies;
    }();
    return all;
}

Eigen::AlignedBox3d box_of(const Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : mesh.rest_positions()) box.extend(x);
    return box;
}

PlaneCut random_plane(const Eigen::AlignedBox3d& box, test::Random& random) {
    return {box.center() + random.vector(0.2).cwiseProduct(box.sizes()),
            random.vector(1.0).normalized()};
}

/// Of the part of a plane that is inside a body of tetrahedra, m2.
double area_in(const Mesh& mesh, const PlaneCut& plane) {
    double sum = 0.0;
    for (const CellId e : mesh.elements()) {
        std::array<Vec3, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) corners[k] = mesh.rest_position(mesh.corners(e)[k]);
        sum += test::polygon_area(test::plane_section(corners, plane.point, plane.normal));
    }
    return sum;
}

/// Returns into how many pieces a plane parts a body: two, if the body does not bend back to it.
std::size_t pieces_beside(const Mesh& mesh, const PlaneCut& plane) {
    DisjointSet pieces(mesh.node_capacity());
    const auto is_above = [&](VertexId n) {
        return plane.normal.dot(mesh.rest_position(n) - plane.point) > 0.0;
    };
    for (const CellId e : mesh.elements())
        for (const VertexId a : mesh.corners(e))
            for (const VertexId b : mesh.corners(e))
                if (is_above(a) == is_above(b)) pieces.join(a.value, b.value);
    std::set<std::int32_t> heads;
    for (const VertexId n : mesh.nodes()) heads.insert(pieces.find(n.value));
    return heads.size();
}

/// Cuts a body by random planes, one at a time.
/// @param area_in  of the part of a plane that is inside the uncut body, m2
template <class AreaIn>
void expect_smooth_planes(const Body& body, int num_planes, AreaIn area_in) {
    const Mesh whole = Mesh::build(body.data).mesh;
    test::Random random(1);
    for (int trial = 0; trial < test::num_cases(num_planes); ++trial) {
        SCOPED_TRACE(body.name + ", trial " + std::to_string(trial));
        const PlaneCut plane = random_plane(box_of(whole), random);
        Mesh mesh = Mesh::build(body.data).mesh;
        const RestTool tool{"plane", plane};
        const RestCutReport report = cut_at_rest(mesh, {&tool, 1}, CutMode::split);
        EXPECT_EQ(report.pieces.size(), pieces_beside(whole, plane));
        ASSERT_TRUE(report.total.surface_distance && report.total.mean_angle);
        EXPECT_LE(report.total.surface_distance->nodes, farthest * report.before.mean_edge_length);
        EXPECT_LE(*report.total.mean_angle, largest_angle);
        const double area = area_in(whole, plane);
        EXPECT_NEAR(report.total.cut_area, area, 0.002 * area);
        EXPECT_GE(*report.stable_step_ratio(), body.step_after_one);
    }
}

TEST(SmoothCut, AlongAPlanePartsEveryBodyAndKeepsTheStep) {
    for (const Body& body : bodies()) expect_smooth_planes(body, num_trials, area_in);
}

/// Of the part of a plane that is inside the unit cube, m2.
double area_in_cube(const Mesh&, const PlaneCut& plane) {
    return area_in(Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                  Vec3::Ones(), {1, 1, 1}))
                       .mesh,
                   plane);
}

TEST(SmoothCut, AlongAPlanePartsCellsOfAnyKindAndKeepsTheStep) {
    for (const Body& body : bodies_of_any_cells()) expect_smooth_planes(body, 5, area_in_cube);
}

void expect_steps_after_eight_planes(const Body& body, int num_programs) {
    test::Random random(2);
    for (int trial = 0; trial < test::num_cases(num_programs); ++trial) {
        SCOPED_TRACE(body.name + ", trial " + std::to_string(trial));
        Mesh mesh = Mesh::build(body.data).mesh;
        std::vector<RestTool> tools;
        for (int i = 0; i < 8; ++i) tools.push_back({"plane", random_plane(box_of(mesh), random)});
        const RestCutReport report = cut_at_rest(mesh, tools, CutMode::split);
        EXPECT_GE(report.pieces.size(), 8u);
        EXPECT_LE(report.volume_error(), 1e-12);
        EXPECT_GE(*report.stable_step_ratio(), body.step_after_eight);
    }
}

TEST(SmoothCut, AlongEightPlanesKeepsTheStep) {
    for (const Body& body : bodies()) expect_steps_after_eight_planes(body, 5);
    for (const Body& body : bodies_of_any_cells()) expect_steps_after_eight_planes(body, 1);
}

/// A sheet through the middle of a box, with waves of a twentieth of its size.
SurfaceCut waved_sheet(const Eigen::AlignedBox3d& box, test::Random& random) {
    const double size = box.sizes().norm(), phase = random.uniform(0.0, 6.0);
    constexpr std::int64_t n = 60;
    SurfaceCut cut;
    for (std::int64_t i = 0; i <= n; ++i)
        for (std::int64_t j = 0; j <= n; ++j) {
            const double s = double(i) / n - 0.5, t = double(j) / n - 0.5;
            const double height = 0.05 * std::sin(8.0 * s + phase) * std::cos(6.0 * t);
            cut.surface.points.push_back(box.center() + 1.2 * size * Vec3(s, height, t));
        }
    for (std::int64_t i = 0; i < n; ++i)
        for (std::int64_t j = 0; j < n; ++j) {
            const std::int64_t a = i * (n + 1) + j, b = a + n + 1;
            cut.surface.triangles.push_back({a, b, b + 1});
            cut.surface.triangles.push_back({a, b + 1, a + 1});
        }
    return cut;
}

/// A sphere of triangles between circles of latitude.
SurfaceCut sphere(const Vec3& centre, double radius) {
    constexpr std::int64_t rows = 24, columns = 48;
    SurfaceCut cut;
    cut.surface.points = {centre + radius * Vec3::UnitZ(), centre - radius * Vec3::UnitZ()};
    const auto at = [](std::int64_t i, std::int64_t j) { return 2 + i * columns + j % columns; };
    for (std::int64_t i = 1; i < rows; ++i)
        for (std::int64_t j = 0; j < columns; ++j) {
            const double polar = double(i) / rows * std::numbers::pi,
                         azimuth = 2.0 * double(j) / columns * std::numbers::pi;
            cut.surface.points.push_back(centre + radius * Vec3(std::sin(polar) * std::cos(azimuth),
                                                                std::sin(polar) * std::sin(azimuth),
                                                                std::cos(polar)));
        }
    auto& triangles = cut.surface.triangles;
    for (std::int64_t j = 0; j < columns; ++j) {
        triangles.push_back({0, at(0, j), at(0, j + 1)});
        triangles.push_back({1, at(rows - 2, j + 1), at(rows - 2, j)});
        for (std::int64_t i = 0; i + 2 < rows; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return cut;
}

// Faces are chords of the surface, so that only nodes are on it.
TEST(SmoothCut, AlongCurvedSurfacesKeepsTheStep) {
    for (const Body& body : bodies()) {
        test::Random random(3);
        for (std::size_t trial = 0; trial < test::num_cases(10); ++trial) {
            SCOPED_TRACE(body.name + ", trial " + std::to_string(trial));
            Mesh mesh = Mesh::build(body.data).mesh;
            const auto box = box_of(mesh);
            const bool is_sphere = trial % 2 == 0;
            const RestTool tool =
                is_sphere
                    ? RestTool{"sphere",
                               sphere(box.center() + random.vector(0.1).cwiseProduct(box.sizes()),
                                      0.3 * box.sizes().minCoeff())}
                    : RestTool{"sheet", waved_sheet(box, random)};
            const RestCutReport report = cut_at_rest(mesh, {&tool, 1}, CutMode::split);
            EXPECT_GE(report.pieces.size(), 2u);
            EXPECT_LE(report.volume_error(), 1e-12);
            ASSERT_TRUE(report.total.surface_distance);
            EXPECT_LE(report.total.surface_distance->nodes,
                      farthest * report.before.mean_edge_length);
            EXPECT_GE(*report.stable_step_ratio(), body.step_after_one);
        }
    }
}

}  // namespace
}  // namespace incise::cutting
