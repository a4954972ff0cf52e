// Cut bodies of all kinds of cells in tetrahedra: they hang together as the bodies do.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/tetrahedral_division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "incise/cutting/rest/cut_at_rest.h"
#include "incise/topology/equal_faces.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/source_faces.h"
#include "random_tools.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Bricks;
using topology::Mesh;
using topology::MeshData;
using topology::TetrahedralDivision;

/// Returns the area of the faces on cuts.
double area_on_cuts(const MeshData& data) {
    const topology::SourceFaces faces(data);
    double area = 0.0;
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        for (int f = 0; f < faces.num_faces(c); ++f)
            if (data.is_on_cut(c, f))
                area += topology::area_vector(faces.size({c, f}), [&](int p) {
                            return faces.position({c, f}, p);
                        }).norm();
    return area;
}

/// Sets of cells that are joined.
class CellSets {
  public:
    explicit CellSets(std::size_t size) : next_(size) {
        std::iota(next_.begin(), next_.end(), std::size_t{0});
    }
    std::size_t find(std::size_t c) {
        while (next_[c] != c) c = next_[c] = next_[next_[c]];
        return c;
    }
    void join(std::size_t a, std::size_t b) { next_[find(a)] = find(b); }

  private:
    std::vector<std::size_t> next_;  // by cell, itself or another of its set
};

/// Expects that tetrahedra hang together as the cells of a body do, also if some are turned inside
/// out, with which no mesh can be made.
void expect_to_hang_together(const TetrahedralDivision& division, const MeshData& body) {
    const MeshData& mesh = division.mesh;
    const topology::SourceFaces faces(mesh);
    auto keys = topology::sorted_faces(mesh, faces, {});
    CellSets sets(mesh.num_cells());
    double area = 0.0;  // of the faces that are not joined
    const auto add = [&](std::span<const topology::FaceKey> open) {
        for (const topology::FaceKey& key : open)
            area +=
                topology::area_vector(3, [&](int p) { return faces.position(key.face, p); }).norm();
    };
    topology::for_each_equal_faces(mesh, keys, [&](const topology::EqualFaces& same) {
        EXPECT_LE(same.num_meeting(), 2u);
        if (same.num_meeting() != 2) {
            add(same.inner);
            add(same.on_cut);
        } else {
            const auto [a, b] = same.joined();
            sets.join(a.cell, b.cell);
            if (same.inner.size() == 2) add(same.on_cut);
        }
    });
    std::set<std::size_t> roots;
    for (std::size_t t = 0; t < mesh.num_cells(); ++t) roots.insert(sets.find(t));
    EXPECT_EQ(roots.size(),
              static_cast<std::size_t>(topology::components(Mesh::build(body).mesh).count));
    EXPECT_NEAR(area, topology::measure(body).surface_area, 1e-11);
}

/// Expects that a mesh that was read from the tetrahedra is the body.
void expect_the_body(const TetrahedralDivision& division, const MeshData& body) {
    constexpr double rounding = 1e-12;  // m2 and m3 of a cube of 1 m
    const auto built = Mesh::build(division.mesh), built_body = Mesh::build(body);
    // Nothing is pinched: there is a node for each point.
    EXPECT_EQ(built.warnings, std::vector<std::string>());
    EXPECT_EQ(built.mesh.num_nodes(), division.mesh.points.size());
    EXPECT_EQ(topology::components(built.mesh).count, topology::components(built_body.mesh).count);
    const auto metrics = topology::measure(division.mesh), of_body = topology::measure(body);
    EXPECT_NEAR(metrics.volume, of_body.volume, rounding);
    EXPECT_NEAR(metrics.surface_area, of_body.surface_area, 10.0 * rounding);
    EXPECT_NEAR(area_on_cuts(division.mesh), area_on_cuts(body), 10.0 * rounding);
    EXPECT_EQ(metrics.cells_of_region.size(), of_body.cells_of_region.size());
}

struct Cube {
    std::string name;
    std::function<MeshData(std::uint64_t seed)> make;
};

std::vector<Cube> cubes(std::initializer_list<double> jitters) {
    std::vector<Cube> all;
    for (const double jitter : jitters)
        for (const auto& [name, bricks] :
             {std::pair("hexahedra", Bricks::hexahedra), std::pair("wedges", Bricks::wedges),
              std::pair("pyramids", Bricks::pyramids), std::pair("mixed", Bricks::mixed),
              std::pair("joined", Bricks::joined)})
            all.push_back(
                {name + std::string(", jitter ") + std::to_string(jitter),
                 [=](std::uint64_t seed) { return test::brick_cube(bricks, 3, jitter, seed); }});
    return all;
}

TEST(TetrahedralDivision, OfABodyCutOnceIsTheBody) {
    for (const Cube& cube : cubes({0.0, 0.1}))
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(cube.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            const RestTool tool = seed % 3 == 0   ? random_plane(random)
                                  : seed % 3 == 1 ? random_blade(random, 2.0)
                                                  : random_blade(random, random.uniform(-0.2, 0.2));
            Mesh mesh = Mesh::build(cube.make(seed)).mesh;
            const MeshData body = cut_at_rest(mesh, {&tool, 1}, CutMode::split).mesh;
            ASSERT_GT(std::ranges::count(body.kinds, topology::CellKind::polyhedron), 5);
            const TetrahedralDivision division = topology::divide_into_tetrahedra(body);
            ASSERT_EQ(topology::check(division.mesh).errors, std::vector<std::string>());
            expect_the_body(division, body);
            if (testing::Test::HasFailure()) return;
        }
}

// Where cuts meet, cut faces of a cell can lie on each other, and a cut can come nearer to a warped
// face than that is warped. Such a surface encloses no tetrahedra that all have
// their right side out.
TEST(TetrahedralDivision, OfABodyCutSeveralTimesIsTheBody) {
    int num_whole = 0, num_bodies = 0;
    for (const Cube& cube : cubes({0.0, 0.1, 0.2}))
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(cube.name + ", seed " + std::to_string(seed));
            test::Random random(100 + seed);
            std::vector<RestTool> tools;
            for (std::uint64_t i = 0; i < 2 + seed % 2; ++i)
                tools.push_back(random.below(2) == 0 ? random_plane(random) : random_blade(random));
            Mesh mesh = Mesh::build(cube.make(seed)).mesh;
            const MeshData body = cut_at_rest(mesh, tools, CutMode::split).mesh;
            const TetrahedralDivision division = topology::divide_into_tetrahedra(body);
            ++num_bodies;
            expect_to_hang_together(division, body);
            if (topology::check(division.mesh).errors.empty()) {
                ++num_whole;
                expect_the_body(division, body);
            }
            const topology::SourceFaces tetrahedra(division.mesh), cells(body);
            std::vector<double> volumes(body.num_cells(), 0.0);
            double inverted = 0.0;
            for (std::size_t t = 0; t < division.mesh.num_cells(); ++t) {
                volumes[division.cells[t]] += tetrahedra.volume(t);
                inverted = std::max(inverted, -tetrahedra.volume(t));
            }
            EXPECT_LT(inverted, 1e-3 / 27.0);  // of a brick
            // Quadrilaterals that meet triangles are not warped in tetrahedra.
            const bool is_joined = cube.name.starts_with("joined");
            for (std::size_t c = 0; c < body.num_cells() && !is_joined; ++c)
                EXPECT_NEAR(volumes[c], cells.volume(c), 1e-14);
            if (testing::Test::HasFailure()) return;
        }
    EXPECT_GT(num_whole, num_bodies / 2);
}

TEST(TetrahedralDivision, IsThatOfThePhysicsInWholeCells) {
    for (const Cube& cube : cubes({0.0, 0.2})) {
        SCOPED_TRACE(cube.name);
        const MeshData body = cube.make(7);
        const TetrahedralDivision division = topology::divide_into_tetrahedra(body);
        if (topology::check(body).joined_quads.empty()) {
            std::size_t expected = 0;
            for (const topology::CellKind kind : body.kinds)
                expected += kind == topology::CellKind::hexahedron ? 24
                            : kind == topology::CellKind::wedge    ? 14
                            : kind == topology::CellKind::pyramid  ? 8
                                                                   : 1;
            EXPECT_EQ(division.mesh.num_cells(), expected);
        }
        ASSERT_EQ(division.added.size(), division.mesh.points.size() - body.points.size());
        for (std::size_t p = 0; p < division.added.size(); ++p) {
            Vec3 mean = Vec3::Zero();
            double sum = 0.0;
            for (const auto& [point, weight] : division.added[p]) {
                mean += weight * body.points[static_cast<std::size_t>(point)];
                sum += weight;
            }
            EXPECT_NEAR(sum, 1.0, 1e-14);
            EXPECT_LT((division.mesh.points[body.points.size() + p] - mean).norm(), 1e-14);
        }
        expect_the_body(division, body);
    }
}

}  // namespace
}  // namespace incise::cutting
