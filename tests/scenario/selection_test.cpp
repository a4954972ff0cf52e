// What a `where` selects.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>

#include "incise/base/error.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/scenario/body.h"
#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"

namespace incise::scenario {
namespace {

using namespace sim;

using topology::Mesh;

/// A cube of side 4 in 4 x 4 x 4 bricks, region 1 where x < 2, else 2.
const Mesh& cube(topology::CellKind kind) {
    const auto build = [](topology::CellKind k) {
        auto data = topology::box_mesh(k, {0, 0, 0}, {4, 4, 4}, {4, 4, 4});
        for (std::size_t c = 0; c < data.num_cells(); ++c) {
            double x = 0.0;
            for (const auto p : data.cell(c)) x += data.points[static_cast<std::size_t>(p)].x();
            data.regions[c] = x < 2.0 * static_cast<double>(data.cell(c).size()) ? 1 : 2;
        }
        return Mesh::build(data).mesh;
    };
    static const Mesh tets = build(topology::CellKind::tetrahedron),
                      hexes = build(topology::CellKind::hexahedron);
    return kind == topology::CellKind::tetrahedron ? tets : hexes;
}

using Rule = std::function<bool(const Vec3&)>;

bool is_in_regions(const Mesh& mesh, const Selection& where, CellId e) {
    return !where.regions ||
           std::count(where.regions->begin(), where.regions->end(), mesh.region(e)) > 0;
}

/// That nodes are exactly those that the rule on positions gives; faces and elements those with
/// all nodes among them and of the regions.
void expect_selects(const Selection& where, const Rule& rule) {
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron}) {
        const Mesh& mesh = cube(kind);
        const auto holds = [&](VertexId n) { return rule(mesh.rest_position(n)); };
        std::vector<VertexId> nodes;
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
            if (holds(VertexId(n))) nodes.emplace_back(n);
        EXPECT_EQ(select_nodes(mesh, where), nodes);
        std::vector<FaceId> faces;
        for (const FaceId f : topology::boundary_faces(mesh)) {
            int count = 0;
            for (int p = 0; p < mesh.face_size(f); ++p) count += holds(mesh.face_corner(f, p));
            if (count == mesh.face_size(f) && is_in_regions(mesh, where, f.cell))
                faces.push_back(f);
        }
        EXPECT_EQ(select_faces(mesh, where), faces);
        std::vector<CellId> elements;
        for (std::size_t e = 0; e < mesh.element_capacity(); ++e) {
            const auto corners = mesh.corners(CellId(e));
            if (std::all_of(corners.begin(), corners.end(), holds) &&
                is_in_regions(mesh, where, CellId(e)))
                elements.emplace_back(e);
        }
        EXPECT_EQ(select_elements(mesh, where), elements);
    }
}

bool is_on_surface(const Vec3& x) { return x.minCoeff() == 0.0 || x.maxCoeff() == 4.0; }

TEST(Selection, OfNothingInParticularIsAll) {
    const Selection where;
    EXPECT_TRUE(where.selects_all());
    expect_selects(where, [](const Vec3&) { return true; });
}

TEST(Selection, BoxesSpheresAndHalfSpacesAreClosed) {
    Selection box, sphere, half_space;
    box.box = {{1, 0, -5}, {3, 2, 0}};
    expect_selects(
        box, [](const Vec3& x) { return x.x() >= 1 && x.x() <= 3 && x.y() <= 2 && x.z() == 0; });
    EXPECT_EQ(select_nodes(cube(topology::CellKind::hexahedron), box).size(), 9u);
    sphere.sphere = {{2, 2, 2}, 1.0};
    EXPECT_EQ(select_nodes(cube(topology::CellKind::hexahedron), sphere).size(), 7u);
    expect_selects(sphere, [](const Vec3& x) { return (x - Vec3(2, 2, 2)).norm() <= 1.0; });
    half_space.half_space = {{0, 0, 3}, {0, 0, 1}};
    EXPECT_EQ(select_nodes(cube(topology::CellKind::hexahedron), half_space).size(), 50u);
    expect_selects(half_space, [](const Vec3& x) { return x.z() >= 3.0; });
}

TEST(Selection, RegionsShareTheNodesBetweenThem) {
    Selection where;
    where.regions = {1};
    expect_selects(where, [](const Vec3& x) { return x.x() <= 2.0; });
    where.regions = {2, 7};
    expect_selects(where, [](const Vec3& x) { return x.x() >= 2.0; });
}

/// Three tetrahedra around an edge: the corners of the second, of region 2, are all corners of the
/// first and the third, of region 1.
Mesh enclosed() {
    topology::MeshData data;
    data.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    const auto add = [&](std::int64_t a, std::int64_t b, int region) {
        data.add_cell(topology::CellKind::tetrahedron, std::vector<std::int64_t>{0, a, b, 1},
                      region);
    };
    add(2, 3, 1);
    add(3, 4, 2);
    add(4, 5, 1);
    return Mesh::build(data).mesh;
}

TEST(Selection, ElementsAndFacesAreOfOneRegionOnly) {
    const Mesh mesh = enclosed();
    ASSERT_EQ(mesh.num_elements(), 3u);
    Selection where;
    where.regions = {1};
    EXPECT_EQ(select_nodes(mesh, where).size(), 6u);
    EXPECT_EQ(select_elements(mesh, where), (std::vector{CellId(0), CellId(2)}));
    EXPECT_EQ(select_faces(mesh, where).size(), 6u);
    where.regions = {2};
    EXPECT_EQ(select_nodes(mesh, where).size(), 4u);
    EXPECT_EQ(select_elements(mesh, where), std::vector{CellId(1)});
    const auto faces = select_faces(mesh, where);
    EXPECT_EQ(faces.size(), 2u);
    for (const FaceId f : faces) EXPECT_EQ(f.cell, CellId(1));
}

TEST(Selection, RegionalBodyForceIsForceTimesVolume) {
    // Every third tetrahedron, so that those of the other region have all corners in this one too.
    auto data =
        topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {4, 4, 4}, {4, 4, 4});
    for (std::size_t c = 0; c < data.num_cells(); ++c) data.regions[c] = c % 3 == 0 ? 2 : 1;
    const double volume = 64.0 / 3.0;
    const Mesh mesh = Mesh::build(data).mesh;

    Scenario scenario;
    const Vec3 density(1.0, -2.0, 30.0);
    scenario.loads.push_back({"field", {}, BodyForce{density}, {}});
    scenario.loads[0].where.regions = {2};
    physics::MaterialTable table;
    table.materials = {{.density = 1.0, .method = physics::MassSprings{1.0}}};
    table.of_region = {{1, 0}, {2, 0}};
    physics::Model model(mesh, table, build_boundary_conditions(scenario, mesh));
    model.compute_forces(0.0);
    const double dt = 0.25 * model.stable_step();
    physics::ExplicitStep().move(model, 0.0, dt);
    EXPECT_LE((model.energetics().totals().momentum / dt - volume * density).norm(), 1e-10);
}

TEST(Selection, NamesConstraintOrLoadOfMissingNodesOnce) {
    const Mesh& mesh = cube(topology::CellKind::tetrahedron);
    const auto error_of = [&](const Scenario& scenario) -> std::string {
        try {
            build_boundary_conditions(scenario, mesh);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    Selection absent, empty;
    absent.nodes = {{125}};
    empty.regions = {{3}};
    const std::string no_node =
        "the selection names node 125, which no element has; the nodes of the mesh are numbered "
        "from "
        "0 to 124";
    const std::string between = "; the mesh lies between [0, 0, 0] and [4, 4, 4]";
    Scenario scenario;
    scenario.constraints.emplace_back();
    scenario.constraints[0].name = "clamp";
    scenario.constraints[0].where = absent;
    EXPECT_EQ(error_of(scenario), "constraint 'clamp': " + no_node);
    scenario.constraints[0].where = empty;
    EXPECT_EQ(error_of(scenario), "constraint 'clamp' selects no node" + between);

    const std::pair<decltype(LoadSpec::load), std::string> loads[] = {
        {NodalForce{Vec3::UnitX()}, "node"},
        {Traction{Vec3::UnitX()}, "face of the surface"},
        {Pressure{1.0}, "face of the surface"},
        {BodyForce{Vec3::UnitX()}, "element"}};
    for (const auto& [load, things] : loads) {
        Scenario loaded;
        loaded.loads.push_back({"pull", absent, load, {}});
        EXPECT_EQ(error_of(loaded), "load 'pull': " + no_node);
        loaded.loads[0].where = empty;
        EXPECT_EQ(error_of(loaded), "load 'pull' selects no " + things + between);
    }
}

TEST(Selection, SurfaceLeavesOutWhatIsInside) {
    Selection where;
    where.surface = true;
    expect_selects(where, is_on_surface);
}

TEST(Selection, EverythingGivenMustHold) {
    Selection where;
    where.box = {{0, 0, 0}, {4, 4, 2}};
    where.sphere = {{2, 2, 2}, 3.0};
    where.half_space = {{0, 1, 0}, {0, 1, 0}};
    where.regions = {2};
    where.surface = true;
    expect_selects(where, [](const Vec3& x) {
        return x.z() <= 2 && (x - Vec3(2, 2, 2)).norm() <= 3 && x.y() >= 1 && x.x() >= 2 &&
               is_on_surface(x);
    });
    where.nodes = {0, 1, 2, 3, 9, 14};  // along x, then y: (4, 1, 0) and (4, 2, 0) are the last
    expect_selects(where, [](const Vec3& x) { return x == Vec3(4, 1, 0) || x == Vec3(4, 2, 0); });
}

TEST(Selection, NodesAreNumbersOfTheSource) {
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron}) {
        const Mesh& mesh = cube(kind);
        Selection where;
        where.nodes = {1, 30, 124};
        std::set<std::vector<double>> positions;
        for (const VertexId n : select_nodes(mesh, where)) {
            const Vec3& x = mesh.rest_position(n);
            positions.insert({x.x(), x.y(), x.z()});
        }
        EXPECT_EQ(positions, (std::set<std::vector<double>>{{1, 0, 0}, {0, 1, 1}, {4, 4, 4}}));
        for (const std::int64_t absent : {-1, 125, 1000000}) {
            where.nodes = {1, absent};
            EXPECT_THROW(select_nodes(mesh, where), InputError);
        }
    }
}

/// Two tetrahedra that touch in point 1 only, of regions 1 and 2; point 7 is used by none.
Mesh pinched() {
    topology::MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                   {2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {9, 9, 9}};
    data.add_cell(topology::CellKind::tetrahedron, std::vector<std::int64_t>{0, 1, 2, 3}, 1);
    data.add_cell(topology::CellKind::tetrahedron, std::vector<std::int64_t>{4, 5, 1, 6}, 2);
    return Mesh::build(data).mesh;
}

TEST(Selection, APinchedPointIsAllOfItsNodes) {
    const Mesh mesh = pinched();
    ASSERT_EQ(mesh.num_nodes(), 8u);
    Selection where;
    where.nodes = {1};
    EXPECT_EQ(select_nodes(mesh, where).size(), 2u);
    // Of which each is in one region only.
    for (const int region : {1, 2}) {
        where.regions = {region};
        const auto nodes = select_nodes(mesh, where);
        ASSERT_EQ(nodes.size(), 1u) << region;
        EXPECT_EQ(mesh.region(mesh.incident_element(nodes[0])), region);
    }
    where.regions = {3};
    EXPECT_TRUE(select_nodes(mesh, where).empty());
    where.regions.reset();
    where.nodes = {7};
    EXPECT_THROW(select_nodes(mesh, where), InputError);
}

TEST(Selection, AnEmptyOneTellsWhereTheMeshIs) {
    const Mesh mesh = pinched();
    EXPECT_NO_THROW(require_selected(1, mesh, "load 'pull'", "node"));
    try {
        require_selected(0, mesh, "load 'pull'", "face of the surface");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "load 'pull' selects no face of the surface; the mesh lies between "
                     "[0, 0, 0] and [2, 1, 1]");
    }
}

TEST(Selection, RefusesRegionsThatAreNotFinite) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.0, 0)).mesh;
    const double nan = std::nan("");
    for (const Selection& where :
         {Selection{.box = BoxRegion{{0, 0, 0}, {1, nan, 1}}},
          Selection{.sphere = SphereRegion{{0, 0, 0}, nan}},
          Selection{.half_space = HalfSpaceRegion{{0, 0, nan}, {0, 0, 1}}}}) {
        EXPECT_THROW(select_nodes(mesh, where), InputError);
        EXPECT_THROW(select_faces(mesh, where), InputError);
        EXPECT_THROW(select_elements(mesh, where), InputError);
    }
}

TEST(Selection, RefusesANodeThatIsNotThere) {
    const auto built = topology::Mesh::build(test::jittered_cube(2, 0.0, 0));
    Selection where;
    where.nodes = {{0, 27}};
    try {
        select_nodes(built.mesh, where);
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "the selection names node 27, which no element has; the nodes of the mesh "
                     "are numbered from 0 to 26");
    }
}

}  // namespace
}  // namespace incise::scenario
