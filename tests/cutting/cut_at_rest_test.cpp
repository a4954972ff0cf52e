// Cuts at rest: what is reported is what happened to the mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/rest/cut_at_rest.h"

#include <gtest/gtest.h>

#include <span>

#include "incise/base/error.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "support/surfaces.h"

namespace incise::cutting {
namespace {

using topology::Mesh;

constexpr int num_rest_seeds = 6;

Eigen::AlignedBox3d box_of(const Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : mesh.rest_positions()) box.extend(x);
    return box;
}

/// Not through the very middle, where the families have nodes.
Vec3 point_inside(const Eigen::AlignedBox3d& box, test::Random& random) {
    return box.center() + random.vector(0.2).cwiseProduct(box.sizes());
}

RestTool random_plane(const Eigen::AlignedBox3d& box, test::Random& random,
                      double snap = default_snap) {
    const Vec3 point = point_inside(box, random);
    return {"plane", PlaneCut{point, random.vector(1.0), snap}};
}

/// A straight edge that passes right through the body, turning a little, in three poses.
RestTool random_sweep(const Eigen::AlignedBox3d& box, test::Random& random,
                      double snap = default_snap) {
    const double size = box.sizes().norm();
    const Vec3 centre = point_inside(box, random), normal = random.vector(1.0).normalized();
    const Vec3 along = normal.unitOrthogonal(), ahead = normal.cross(along);
    Sweep sweep{{}, snap};
    for (const double at : {-1.0, 0.1, 1.0}) {
        std::vector<Vec3> edge;
        for (const double end : {-1.0, 1.0})
            edge.push_back(centre + size * (at * ahead + end * along + random.vector(0.05)));
        sweep.poses.push_back(edge);
    }
    return {"sweep", sweep};
}

TEST(CutAtRest, OpensFacesOnTheSurfaceWithoutSnap) {
    for (const auto* family : test::tetrahedral_families())
        for (int seed = 0; seed < num_rest_seeds; ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            Mesh mesh = Mesh::build(family->data).mesh;
            test::Random random(100 + static_cast<std::uint64_t>(seed));
            const auto box = box_of(mesh);
            // The second runs across what the first one opened.
            const std::vector<RestTool> tools = {random_plane(box, random, 0.0),
                                                 random_sweep(box, random, 0.0)};
            const auto report = cut_at_rest(mesh, tools, CutMode::split);
            EXPECT_TRUE(topology::validate(mesh).empty());
            for (const ToolReport& tool : report.tools) {
                EXPECT_EQ(tool.counts.faces_opened > 0, tool.counts.surface_distance.has_value());
                // Nodes nearer to it than 1e-7 of an edge count as on it.
                const auto distance = tool.counts.surface_distance.value_or(CutCounts::Distance{});
                EXPECT_LT(distance.nodes, 1e-7 * box.sizes().norm());
                EXPECT_GE(distance.faces, distance.nodes);
                if (tool.tool == "plane") {
                    EXPECT_LT(distance.faces, 1e-7 * box.sizes().norm());
                }
            }
            EXPECT_LT(report.volume_error(), 1e-13);
        }
}

TEST(CutAtRest, OpensFacesOnTheSurfaceWithoutSnapInCellsOfAnyShape) {
    for (const test::Bricks bricks : {test::Bricks::hexahedra, test::Bricks::wedges,
                                      test::Bricks::pyramids, test::Bricks::mixed})
        for (int seed = 0; seed < num_rest_seeds; ++seed) {
            SCOPED_TRACE(static_cast<int>(bricks));
            Mesh mesh = Mesh::build(test::brick_cube(bricks, 3, 0.0, 1)).mesh;
            test::Random random(150 + static_cast<std::uint64_t>(seed));
            const auto box = box_of(mesh);
            // The second runs across what the first one opened, which is in a plane of the mesh.
            const std::vector<RestTool> tools = {
                {"plane", PlaneCut{Vec3(1.0 / 3.0, 0.5, 0.5), Vec3::UnitX(), 0.0}},
                random_plane(box, random, 0.0)};
            const auto report = cut_at_rest(mesh, tools, CutMode::split);
            EXPECT_TRUE(topology::validate(mesh).empty());
            for (const ToolReport& tool : report.tools) {
                ASSERT_TRUE(tool.counts.surface_distance);
                EXPECT_LT(tool.counts.surface_distance->nodes, 1e-5);
            }
            EXPECT_LT(report.volume_error(), 1e-13);
        }
}

TEST(CutAtRest, ReportsWhatHasChanged) {
    for (const auto& family : test::mesh_families())
        for (int seed = 0; seed < num_rest_seeds; ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            Mesh mesh = Mesh::build(family.data).mesh;
            test::Random random(200 + static_cast<std::uint64_t>(seed));
            const auto box = box_of(mesh);
            std::vector<RestTool> tools = {random_plane(box, random), random_sweep(box, random)};
            if (mesh.num_elements() > 10)
                tools.push_back(
                    {"ball", Removal{Sphere{0.2 * box.sizes().norm()}, point_inside(box, random)}});
            const std::size_t elements = mesh.num_elements(), nodes = mesh.num_nodes();
            const auto report = cut_at_rest(mesh, tools, CutMode::split);
            EXPECT_EQ(report.before.elements, elements);
            EXPECT_EQ(report.before.nodes, nodes);
            EXPECT_EQ(report.after.elements, mesh.num_elements());
            EXPECT_EQ(report.after.nodes, mesh.num_nodes());
            EXPECT_EQ(mesh.num_elements(),
                      elements + report.total.elements_added - report.total.elements_removed);
            EXPECT_GE(nodes + report.total.nodes_added, mesh.num_nodes());
            EXPECT_LT(report.volume_error(), 1e-13);
            double volume = 0.0;
            for (std::size_t p = 0; p < report.pieces.size(); ++p) {
                volume += report.pieces[p].volume;
                if (p > 0) {
                    EXPECT_LE(report.pieces[p].volume, report.pieces[p - 1].volume);
                }
            }
            EXPECT_NEAR(volume, report.after.volume, 1e-13 * report.before.volume);
            EXPECT_EQ(report.pieces.size(),
                      static_cast<std::size_t>(topology::components(mesh).count));
            ASSERT_EQ(report.tools.size(), tools.size());
            EXPECT_EQ(report.tools.back().pieces, topology::components(mesh).count);
        }
}

// Whatever the tolerance: a plane opens no face of a part that it does not cut off.
TEST(CutAtRest, PartsTheBodyByEveryPlaneThatOpensFaces) {
    std::size_t num_parted = 0;
    for (const auto* family : test::tetrahedral_families())
        for (int seed = 0; seed < num_rest_seeds; ++seed)
            for (const double snap : {0.0, default_snap, 0.5}) {
                SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
                Mesh mesh = Mesh::build(family->data).mesh;
                test::Random random(900 + static_cast<std::uint64_t>(seed));
                const RestTool tool = random_plane(box_of(mesh), random, snap);
                const int pieces = topology::components(mesh).count;
                const auto report = cut_at_rest(mesh, {&tool, 1}, CutMode::split);
                const bool has_parted = topology::components(mesh).count > pieces;
                EXPECT_EQ(report.total.faces_opened > 0, has_parted);
                EXPECT_EQ(report.warnings.empty(), has_parted);
                num_parted += has_parted;
            }
    EXPECT_GT(num_parted, 10u);
}

TEST(CutAtRest, SeparatesElementsWhoseCentresThePlaneParts) {
    for (const auto& family : test::mesh_families())
        for (int seed = 0; seed < num_rest_seeds; ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            Mesh mesh = Mesh::build(family.data).mesh;
            test::Random random(300 + static_cast<std::uint64_t>(seed));
            const RestTool tool = random_plane(box_of(mesh), random);
            const auto& [point, normal, snap] = std::get<PlaneCut>(tool.kind);
            const Plane plane(point, normal);
            const auto side = [&](CellId e) {
                return plane.side(TissueMotion::centre(mesh, e, mesh.rest_positions()));
            };
            std::size_t parted = 0;
            for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
                for (int f = 0; f < mesh.num_faces(CellId(i)); ++f) {
                    const FaceId face{CellId(i), f}, other = mesh.neighbor(face);
                    parted += face < other && side(face.cell) != side(other.cell);
                }
            const auto report = cut_at_rest(mesh, {&tool, 1}, CutMode::separate);
            EXPECT_EQ(report.total.faces_opened, parted);
            EXPECT_EQ(report.after.elements, report.before.elements);
            EXPECT_EQ(report.warnings.empty(), parted > 0);
            for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
                for (int f = 0; f < mesh.num_faces(CellId(i)); ++f)
                    if (const FaceId other = mesh.neighbor({CellId(i), f}); other.is_valid()) {
                        EXPECT_EQ(side(CellId(i)), side(other.cell));
                    }
        }
}

// Also where the blade rests at the end: the last pose is the one before once more.
TEST(CutAtRest, OfASweepEndsWhereTheBladeDoes) {
    for (int seed = 0; seed < num_rest_seeds; ++seed) {
        SCOPED_TRACE(seed);
        Mesh mesh = Mesh::build(test::jittered_cube(4, 0.2, static_cast<std::uint64_t>(seed))).mesh;
        test::Random random(400 + static_cast<std::uint64_t>(seed));
        const double height = random.uniform(0.3, 0.7), end = random.uniform(0.3, 0.7);
        Sweep sweep{{}, 0.0};
        for (const double x : {-0.5, 0.2, end, end})
            sweep.poses.push_back({{x, -1.0, height}, {x, 2.0, height}});
        const RestTool tool{"sweep", sweep};
        const auto report = cut_at_rest(mesh, {&tool, 1}, CutMode::split);
        EXPECT_TRUE(topology::validate(mesh).empty());
        EXPECT_NEAR(report.total.cut_area, end, 0.5 / 4);  // to half a brick
        EXPECT_EQ(report.pieces.size(), 1u);
        ASSERT_TRUE(report.total.surface_distance);
        EXPECT_LT(report.total.surface_distance->faces, 1e-7);
    }
}

struct Cube {
    std::string name;
    topology::MeshData data;
};

/// Unit cubes of all kinds of cells.
std::vector<Cube> cubes(int n) {
    using test::Bricks;
    std::vector<Cube> all;
    for (const double jitter : {0.0, 0.2}) {
        const std::string text = ", jitter " + std::to_string(jitter);
        all.push_back({"tetrahedra" + text, test::jittered_cube(n, jitter, 3)});
        for (const auto& [name, bricks] :
             {std::pair("hexahedra", Bricks::hexahedra), std::pair("wedges", Bricks::wedges),
              std::pair("pyramids", Bricks::pyramids), std::pair("mixed", Bricks::mixed),
              std::pair("joined", Bricks::joined)})
            all.push_back({name + text, test::brick_cube(bricks, n, jitter, 3)});
    }
    return all;
}

// Right through a body, within it, and along a surface that bends.
TEST(CutAtRest, OfTheSameToolAgainChangesNothing) {
    for (const auto& [name, data] : cubes(4))
        for (int seed = 0; seed < test::num_cases(4); ++seed) {
            test::Random random(700 + static_cast<std::uint64_t>(seed));
            const Vec3 point = Vec3::Constant(0.5) + random.vector(0.1);
            const Vec3 normal = random.vector(1.0);
            const Vec3 along = normal.unitOrthogonal(), ahead = normal.normalized().cross(along);
            const auto edge = [&](double at) {
                return std::vector<Vec3>{point + at * ahead - 2.0 * along,
                                         point + at * ahead + 2.0 * along};
            };
            const RestTool plane{"plane", PlaneCut{point, normal}};
            const RestTool sweep{"sweep", Sweep{{edge(-2), edge(-0.3), edge(0.2), edge(2)}}};
            const RestTool sphere{"sphere", SurfaceCut{test::icosphere(point, 0.31, 2)}};
            const RestTool part{"part", Sweep{{edge(-2), edge(-0.3), edge(0.02)}}};
            const RestTool back{"back", Sweep{{edge(-2), edge(0.02), edge(-2)}}};
            const std::vector<std::vector<RestTool>> programs = {
                {plane, plane, plane},    {sweep, sweep, sweep}, {plane, sweep, plane},
                {sphere, sphere, sphere}, {part, part, part},    {back, back}};
            for (const auto& tools : programs) {
                SCOPED_TRACE(name + ", seed " + std::to_string(seed) + ", " + tools[0].name + ", " +
                             tools[1].name);
                Mesh mesh = Mesh::build(data).mesh;
                const auto report = cut_at_rest(mesh, tools, CutMode::split);
                const auto& first = report.tools.front();
                EXPECT_GT(first.counts.faces_opened, 0u);
                EXPECT_EQ(first.pieces,
                          tools[0].name == "part" || tools[0].name == "back" ? 1u : 2u);
                for (const ToolReport& again : std::span(report.tools).subspan(1)) {
                    EXPECT_EQ(again.pieces, first.pieces);
                    // A path that comes back may open faces that are smaller than the tolerance.
                    if (tools[0].name == "back" && name.ends_with("0.200000")) {
                        EXPECT_LT(again.counts.cut_area, 1e-5);
                        continue;
                    }
                    EXPECT_EQ(again.counts.faces_opened, 0u);
                    EXPECT_EQ(again.counts.cut_area, 0.0);
                }
                if (tools[0].name != "back") {
                    EXPECT_EQ(report.warnings.size(), tools.size() - 1);
                }
            }
        }
}

/// Strokes of one blade, which is wider than the body.
struct Strokes {
    Vec3 point = Vec3::Zero(), along = Vec3::UnitY(), ahead = -Vec3::UnitZ();

    /// Through a place near the middle of the unit cube, in any direction.
    static Strokes random(test::Random& random) {
        const Vec3 point = Vec3::Constant(0.5) + random.vector(0.1);
        const Vec3 normal = random.vector(1.0).normalized(), along = normal.unitOrthogonal();
        return {point, along, normal.cross(along)};
    }
    /// From outside up to a distance from the point, m.
    RestTool to(double end) const {
        Sweep sweep;
        for (const double at : {-2.0, -0.3, end})
            sweep.poses.push_back(
                {point + at * ahead - 2.0 * along, point + at * ahead + 2.0 * along});
        return {"stroke", sweep};
    }
};

/// Calls test(cube, random) for bodies of all kinds of cells but tetrahedra alone.
template <class Test>
void for_cells_of_any_shape(int num_seeds, std::uint64_t first_seed, Test test) {
    for (const Cube& cube : cubes(4)) {
        if (cube.name.starts_with("tetrahedra")) continue;
        for (int seed = 0; seed < test::num_cases(num_seeds); ++seed) {
            SCOPED_TRACE(cube.name + ", seed " + std::to_string(seed));
            test::Random random(first_seed + static_cast<std::uint64_t>(seed));
            test(cube, random);
        }
    }
}

constexpr double largest_crumb = 1e-3;  // m3

// Strokes that end inside the body, and one that goes on with their cut.
TEST(CutAtRest, OfStrokesThatGoDeeperIsThatOfOneStroke) {
    for_cells_of_any_shape(8, 900, [](const Cube& cube, test::Random& random) {
        const Strokes strokes = Strokes::random(random);
        const double first = random.uniform(-0.25, 0.1);
        const double second = first + random.uniform(0.02, 0.3);
        Mesh once = Mesh::build(cube.data).mesh, deeper = once;
        const auto whole = cut_at_rest(once, std::vector{strokes.to(2.0)}, CutMode::split);
        const auto parts =
            cut_at_rest(deeper, std::vector{strokes.to(first), strokes.to(second), strokes.to(2.0)},
                        CutMode::split);
        ASSERT_EQ(whole.pieces.size(), 2u);
        ASSERT_GE(parts.pieces.size(), 2u);
        // Where cells are small, a crumb may come off.
        for (std::size_t p = 0; p < 2; ++p)
            EXPECT_NEAR(parts.pieces[p].volume, whole.pieces[p].volume, largest_crumb);
        EXPECT_NEAR(parts.total.cut_area, whole.total.cut_area, 0.01 * whole.total.cut_area);
        EXPECT_LE(parts.volume_error(), 1e-13);
    });
}

// A stroke that ends inside the body, a plane across it, and the stroke again.
TEST(CutAtRest, OfAStrokeAgainAfterAnotherCutFreesNoMoreThanCrumbs) {
    for_cells_of_any_shape(4, 950, [](const Cube& cube, test::Random& random) {
        const Strokes strokes = Strokes::random(random);
        const RestTool stroke = strokes.to(0.05);
        const RestTool across{"across",
                              PlaneCut{strokes.point, strokes.along + random.vector(0.3)}};
        Mesh mesh = Mesh::build(cube.data).mesh;
        const auto report = cut_at_rest(
            mesh, std::vector{stroke, across, stroke, stroke, stroke, stroke}, CutMode::split);
        const auto is_large = [](const Piece& piece) { return piece.volume > largest_crumb; };
        EXPECT_EQ(std::ranges::count_if(report.pieces, is_large), 2);
        EXPECT_LT(report.tools.back().counts.cut_area, 1e-3);
        EXPECT_LE(report.volume_error(), 1e-13);
    });
}

// In planes of the mesh and beside them, with ends on its nodes and between; in bodies of bricks.
TEST(CutAtRest, OfStrokesAgainInPlanesOfTheMeshChangesNothing) {
    constexpr double brick = 0.25;
    for (const Cube& cube : cubes(4)) {
        if (cube.name.starts_with("tetrahedra") || cube.name.ends_with("0.200000")) continue;
        for (const double beside : {0.0, 0.3 * brick})
            for (const double ahead : {0.0, 0.5 * brick}) {
                SCOPED_TRACE(cube.name + ", beside " + std::to_string(beside) + ", ahead " +
                             std::to_string(ahead));
                const Strokes strokes{{0.5 + beside, 0.5, 0.5}};
                const RestTool stroke = strokes.to(ahead);
                Mesh mesh = Mesh::build(cube.data).mesh, deeper = mesh;
                const auto again =
                    cut_at_rest(mesh, std::vector{stroke, stroke, stroke}, CutMode::split);
                EXPECT_GT(again.tools[0].counts.faces_opened, 0u);
                EXPECT_EQ(again.tools[1].counts.faces_opened, 0u);
                EXPECT_EQ(again.tools[2].counts.faces_opened, 0u);
                const auto parted = cut_at_rest(
                    deeper, std::vector{stroke, strokes.to(ahead + brick), strokes.to(2.0)},
                    CutMode::split);
                ASSERT_GE(parted.pieces.size(), 2u);
                EXPECT_NEAR(parted.pieces[0].volume, 0.5 + beside, 3e-3);
                EXPECT_NEAR(parted.pieces[1].volume, 0.5 - beside, 3e-3);
            }
    }
}

// They also have nodes of earlier poses, and sides that keep their nodes.
TEST(CutAtRest, OfSeveralPosesKnowsAllFacesThatItOpens) {
    for (const auto& [name, data] : cubes(4))
        for (int seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(name + ", seed " + std::to_string(seed));
            test::Random random(800 + static_cast<std::uint64_t>(seed));
            const Vec3 point = Vec3::Constant(0.5) + random.vector(0.1);
            const Vec3 normal = random.vector(1.0).normalized();
            const Vec3 along = normal.unitOrthogonal(), ahead = normal.cross(along);
            Sweep sweep{{}, 0.0};
            for (const double at : {-2.0, -0.4, -0.1, 0.15, 0.3, 2.0})
                sweep.poses.push_back(
                    {point + at * ahead - 2.0 * along, point + at * ahead + 2.0 * along});
            const std::vector<RestTool> tools = {{"sweep", sweep}};
            Mesh mesh = Mesh::build(data).mesh;
            const auto report = cut_at_rest(mesh, tools, CutMode::split);
            ASSERT_TRUE(report.total.surface_distance);
            // A pose moves nodes that an earlier one opened by default_snap of an edge, off the
            // cut.
            EXPECT_LT(report.total.surface_distance->nodes, default_snap / 4);
            EXPECT_EQ(report.pieces.size(), 2u);
        }
}

TEST(CutAtRest, NamesTheToolThatFails) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.0, 1)).mesh;
    const RestTool all{"the ball", Removal{Sphere{10.0}, Vec3::Zero()}};
    try {
        cut_at_rest(mesh, {&all, 1}, CutMode::split);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "the ball: removes the last element: nothing is left of the body");
    }
}

}  // namespace
}  // namespace incise::cutting
