// A mesh as CGAL's linear cell complex, and back: also after edits, through a file, and complexes
// that CGAL's own operations have made.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/linear_cell_complex.h"

#include <CGAL/Combinatorial_map_save_load.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "incise/base/error.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

using Point = LinearCellComplex::Point;

void edit_at_random(Mesh& mesh, test::Random& random, int count) {
    for (int i = 0; i < count && mesh.num_elements() > 1; ++i) test::random_edit(mesh, random);
}

/// Expects that two meshes have the same cells, joined in the same way, under ids in the same
/// order.
void expect_same_body(const Mesh& a, const Mesh& b) {
    ASSERT_EQ(a.num_elements(), b.num_elements());
    ASSERT_EQ(a.num_nodes(), b.num_nodes());
    std::vector<std::int64_t> vertex_of(a.node_capacity(), -1), cell_of(a.element_capacity(), -1);
    std::int64_t next = 0;
    for (const VertexId n : a.nodes()) vertex_of[n.index()] = next++;
    next = 0;
    for (const CellId e : a.elements()) cell_of[e.index()] = next++;
    std::vector<VertexId> vertices;
    for (const VertexId n : b.nodes()) vertices.push_back(n);
    next = 0;
    for (const CellId e : a.elements()) {
        const CellId other(static_cast<std::size_t>(next++));
        ASSERT_EQ(a.kind(e), b.kind(other));
        EXPECT_EQ(a.region(e), b.region(other));
        for (std::size_t k = 0; k < a.corners(e).size(); ++k) {
            const VertexId n =
                vertices[static_cast<std::size_t>(vertex_of[a.corners(e)[k].index()])];
            EXPECT_EQ(b.corners(other)[k], n);
            EXPECT_EQ(b.rest_position(n), a.rest_position(a.corners(e)[k]));
        }
        for (int f = 0; f < a.num_faces(e); ++f) {
            const FaceId there = a.neighbor({e, f}), far = b.neighbor({other, f});
            ASSERT_EQ(there.is_valid(), far.is_valid());
            EXPECT_EQ(a.is_on_cut({e, f}), b.is_on_cut({other, f}));
            if (!there.is_valid()) continue;
            EXPECT_EQ(cell_of[there.cell.index()], far.cell.value);
            EXPECT_EQ(there.face, far.face);
        }
    }
    EXPECT_EQ(validate(b), std::vector<std::string>{});
}

TEST(LinearCellComplex, IsValidAndComesBackAsTheSameBody) {
    for (const auto& family : test::mesh_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(family.name + " " + std::to_string(seed));
            test::Random random(seed);
            MeshData data = family.data;
            for (int& region : data.regions) region = static_cast<int>(random.below(3));
            Mesh mesh = Mesh::build(data).mesh;
            edit_at_random(mesh, random, seed == 0 ? 0 : 6);
            const LinearCellComplex complex = to_linear_cell_complex(mesh);
            EXPECT_TRUE(complex.is_valid());
            EXPECT_EQ(complex.attributes<0>().size(), mesh.num_nodes());
            EXPECT_EQ(complex.attributes<3>().size(), mesh.num_elements());
            expect_same_body(mesh, from_linear_cell_complex(complex).mesh);
        }
}

TEST(LinearCellComplex, IsTheSameAfterCgalsOwnFile) {
    test::Random random(3);
    for (const char* name : {"mixed", "joined", "jittered cube"}) {
        const auto& families = test::mesh_families();
        const auto family =
            std::ranges::find_if(families, [&](const auto& f) { return f.name == name; });
        Mesh mesh =
            Mesh::build(family == families.end() ? test::jittered_cube(2, 0.1, 1) : family->data)
                .mesh;
        edit_at_random(mesh, random, 3);
        Carriers carriers;
        carriers.of_cell.assign(mesh.num_elements(), Carriers::whole);
        if (mesh.kind(*mesh.elements().begin()) == CellKind::tetrahedron) {
            carriers.of_cell[0] = 0;
            CarrierCorners& corners = carriers.corners.emplace_back();
            for (std::size_t k = 0; k < 4; ++k)
                corners[k] = mesh.rest_position(mesh.corners(*mesh.elements().begin())[k]);
        }
        const LinearCellComplex complex = to_linear_cell_complex(mesh, carriers);
        const std::string file = std::filesystem::temp_directory_path() /
                                 ("incise_complex_" + std::to_string(::getpid()) + ".xml");
        ASSERT_TRUE(CGAL::save_combinatorial_map(complex, file.c_str()));
        LinearCellComplex read;
        ASSERT_TRUE(CGAL::load_combinatorial_map(file.c_str(), read));
        std::filesystem::remove(file);
        EXPECT_TRUE(read.is_valid());
        const Mesh back = from_linear_cell_complex(read).mesh;
        expect_same_body(mesh, back);
        EXPECT_EQ(back.source_carriers().corners, carriers.corners);
    }
}

TEST(LinearCellComplex, OfSomebodyElseBecomesAMesh) {
    // Two hexahedra as CGAL makes them, and a tetrahedron by itself: no ids, no regions.
    for (const double sign : {1.0, -1.0}) {
        LinearCellComplex complex;
        const auto box = [&](double x) {
            const auto p = [&](double a, double b, double c) { return Point(x + a, b, sign * c); };
            return complex.make_hexahedron(p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0),
                                           p(0, 1, 1), p(0, 0, 1), p(1, 0, 1), p(1, 1, 1));
        };
        box(0.0);
        box(1.0);
        complex.make_tetrahedron(Point(5, 0, 0), Point(6, 0, 0), Point(5, 1, 0), Point(5, 0, sign));
        EXPECT_EQ(complex.sew3_same_facets(), 1u);
        const Mesh mesh = from_linear_cell_complex(complex).mesh;
        EXPECT_EQ(validate(mesh), std::vector<std::string>{});
        EXPECT_EQ(mesh.num_nodes(), 16u);
        EXPECT_EQ(components(mesh).count, 2);
        double volume = 0.0;
        for (const CellId e : mesh.elements()) volume += rest_volume(mesh, e);
        EXPECT_NEAR(volume, 2.0 + 1.0 / 6.0, 1e-14);
        expect_same_body(mesh, from_linear_cell_complex(to_linear_cell_complex(mesh)).mesh);
    }
}

TEST(LinearCellComplex, FollowsWhatCgalsOperationsDidToIt) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    LinearCellComplex complex = to_linear_cell_complex(mesh);
    const std::size_t sewn = 2 * mesh.num_elements();
    ASSERT_GT(sewn, 0u);
    complex.remove_cell<3>(complex.attributes<3>().begin()->dart());
    std::size_t opened = 0;
    for (auto d = complex.darts().begin(); d != complex.darts().end() && opened < 3; ++d)
        if (!complex.is_free<3>(d)) {
            complex.unsew<3>(d);
            ++opened;
        }
    const Mesh back = from_linear_cell_complex(complex).mesh;
    EXPECT_EQ(validate(back), std::vector<std::string>{});
    EXPECT_EQ(back.num_elements(), mesh.num_elements() - 1);
    EXPECT_EQ(back.num_nodes(), complex.attributes<0>().size());
    EXPECT_GE(boundary_faces(back).size(), boundary_faces(mesh).size() + 2 * opened - 4);
}

std::string refusal_of(const LinearCellComplex& complex) {
    try {
        from_linear_cell_complex(complex);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(LinearCellComplex, RefusesWhatIsNoMesh) {
    LinearCellComplex open;
    open.make_segment(Point(0, 0, 0), Point(1, 0, 0));
    EXPECT_NE(refusal_of(open).find("volume 0 is not closed: a face has an edge at (0, 0, 0) that "
                                    "no other one follows"),
              std::string::npos)
        << refusal_of(open);
    const LinearCellComplex empty;
    EXPECT_NE(refusal_of(empty).find("a volume mesh is needed"), std::string::npos);
}

}  // namespace
}  // namespace incise::topology
