// Polyhedra in linear cell complexes of CGAL: what they become, and which are refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <CGAL/Combinatorial_map_save_load.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/topology/linear_cell_complex.h"
#include "incise/topology/mesh.h"
#include "incise/topology/validate.h"
#include "support/cut_bricks.h"
#include "support/mesh_families.h"
#include "support/temporary_folder.h"

namespace incise::topology {
namespace {

using testing::HasSubstr;
using Handle = LinearCellComplex::Dart_handle;

LinearCellComplex complex_of(const MeshData& data) {
    return to_linear_cell_complex(Mesh::build(data).mesh, data.carriers);
}

/// Expects that a mesh has the cells of the data, as they are there.
void expect_cells(const BuiltMesh& built, const MeshData& data) {
    EXPECT_EQ(validate(built.mesh), std::vector<std::string>());
    EXPECT_EQ(built.warnings, std::vector<std::string>());
    const MeshData cells = to_mesh_data(built.mesh, built.mesh.rest_positions());
    EXPECT_EQ(cells.points, data.points);
    EXPECT_EQ(cells.kinds, data.kinds);
    EXPECT_EQ(cells.faces, data.faces);
    EXPECT_EQ(cells.corners, data.corners);
    EXPECT_EQ(cells.regions, data.regions);
    EXPECT_EQ(cells.cut_faces, data.cut_faces);
    EXPECT_EQ(cells.further_cut_faces, data.further_cut_faces);
    EXPECT_EQ(built.mesh.source_carriers(), data.carriers);
}

LinearCellComplex after_a_file(const LinearCellComplex& complex) {
    const support::TemporaryFolder folder;
    const std::string file = folder / "complex.xml";
    LinearCellComplex read;
    EXPECT_TRUE(CGAL::save_combinatorial_map(complex, file.c_str()));
    EXPECT_TRUE(CGAL::load_combinatorial_map(file.c_str(), read));
    return read;
}

TEST(ComplexOfPolyhedra, ComesBackAsTheSameCells) {
    const MeshData data = test::cut_bricks();
    const LinearCellComplex complex = complex_of(data);
    EXPECT_TRUE(complex.is_valid());
    expect_cells(from_linear_cell_complex(complex), data);
    expect_cells(from_linear_cell_complex(after_a_file(complex)), data);
}

TEST(ComplexOfPolyhedra, KeepsDiagonalsOfCarriers) {
    MeshData data = test::cut_bricks();
    data.carriers.corners[0].diagonals.divide(2, 1);
    data.carriers.corners[1].diagonals.divide(5, 0);
    for (const LinearCellComplex& complex : {complex_of(data), after_a_file(complex_of(data))})
        EXPECT_EQ(from_linear_cell_complex(complex).mesh.source_carriers(), data.carriers);
}

TEST(ComplexOfPolyhedra, MayRunTheOtherWayRound) {
    const MeshData data = test::cut_bricks();
    LinearCellComplex complex = complex_of(data);
    complex.reverse_orientation();
    const Mesh mesh = from_linear_cell_complex(complex).mesh;
    EXPECT_EQ(validate(mesh), std::vector<std::string>());
    EXPECT_EQ(mesh.source_carriers(), data.carriers);
    EXPECT_EQ(components(mesh).count, 1);
    EXPECT_DOUBLE_EQ(rest_volume(mesh, CellId(0)), 0.5);
    EXPECT_DOUBLE_EQ(rest_volume(mesh, CellId(2)), 1.0);
}

// A cut can leave a crumb that is turned inside out a little. It is not turned back.
TEST(ComplexOfPolyhedra, KeepsACrumbThatIsInsideOut) {
    MeshData data = test::cut_bricks();
    const std::array<Vec3, 4> crumb = {Vec3(0.5, 0.5, 0.9), Vec3(0.6, 0.5, 0.9),
                                       Vec3(0.5, 0.6, 0.9), Vec3(0.5, 0.5, 0.8)};
    const auto first = std::ssize(data.points);
    data.points.insert(data.points.end(), crumb.begin(), crumb.end());
    std::vector<std::int64_t> faces{0};
    for (const int f : {0, 1, 2, 3}) {
        std::vector<std::int64_t> points;
        for (const int k : traits(CellKind::tetrahedron).face(f)) points.push_back(first + k);
        test::add_face(faces, points);
    }
    data.add_polyhedron(faces, 4);
    data.carriers.of_cell.push_back(0);
    // Room for it in the carrier.
    for (const std::size_t p : {14u, 15u, 16u, 17u}) data.points[p].z() = 0.6;
    const BuiltMesh built = Mesh::build(data);
    EXPECT_LT(rest_volume(built.mesh, CellId(3)), 0.0);
    const Mesh mesh = from_linear_cell_complex(complex_of(data)).mesh;
    EXPECT_EQ(rest_volume(mesh, CellId(3)), rest_volume(built.mesh, CellId(3)));
    EXPECT_EQ(to_mesh_data(mesh, mesh.rest_positions()).faces, data.faces);
}

/// Adds a closed volume: its faces, each a list of points anticlockwise as seen from outside.
Handle add_volume(LinearCellComplex& complex, const std::vector<Vec3>& points,
                  const std::vector<std::vector<std::size_t>>& faces) {
    std::vector<std::pair<std::array<std::size_t, 2>, Handle>> darts;
    for (const auto& face : faces) {
        Handle d = complex.make_combinatorial_polygon(static_cast<unsigned>(face.size()));
        for (std::size_t p = 0; p < face.size(); ++p, d = complex.beta<1>(d)) {
            const Vec3& x = points[face[p]];
            complex.set_vertex_attribute(
                d, complex.create_vertex_attribute(LinearCellComplex::Point(x[0], x[1], x[2])));
            darts.push_back({{face[p], face[(p + 1) % face.size()]}, d});
        }
    }
    for (const auto& [ends, d] : darts)
        for (const auto& [others, other] : darts)
            if (ends[0] < ends[1] && others == std::array{ends[1], ends[0]})
                complex.sew<2>(d, other);
    complex.set_attribute<3>(darts[0].second, complex.create_attribute<3>());
    return darts[0].second;
}

/// The corners of a pyramid, from which a smaller one on the same base is taken away.
const std::vector<Vec3> roof = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 1}, {1, 1, 2}};

CarrierCorners brick_round_roof() {
    std::vector<Vec3> x;
    for (const double z : {0.0, 2.0})
        for (const auto& [a, b] :
             {std::pair(0.0, 0.0), std::pair(2.0, 0.0), std::pair(2.0, 2.0), std::pair(0.0, 2.0)})
            x.emplace_back(a, b, z);
    return {CellKind::hexahedron, x};
}

TEST(ComplexOfPolyhedra, OfSomebodyElseNeedsCarriersOnly) {
    LinearCellComplex complex;
    const Handle d = add_volume(
        complex, roof,
        {{0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 0, 5}, {1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}});
    ASSERT_TRUE(complex.is_valid());
    EXPECT_THROW(from_linear_cell_complex(complex), InputError);
    complex.info<3>(d).carrier = brick_round_roof();
    complex.info<3>(d).region = 7;
    const Mesh mesh = from_linear_cell_complex(complex).mesh;
    EXPECT_EQ(validate(mesh), std::vector<std::string>());
    ASSERT_EQ(mesh.num_elements(), 1u);
    EXPECT_TRUE(mesh.is_polyhedron(CellId(0)));
    EXPECT_EQ(mesh.num_faces(CellId(0)), 8);
    EXPECT_EQ(mesh.region(CellId(0)), 7);
    EXPECT_DOUBLE_EQ(rest_volume(mesh, CellId(0)), 4.0 / 3.0);
}

/// Returns the dart of a cell between two vertices.
Handle find_dart(LinearCellComplex& complex, std::size_t cell, std::size_t from, std::size_t to) {
    for (auto d = complex.darts().begin(); d != complex.darts().end(); ++d)
        if (complex.info<3>(d).id == CellId(cell) && complex.info<0>(d).id == VertexId(from) &&
            complex.info<0>(complex.beta<1>(d)).id == VertexId(to))
            return d;
    return nullptr;
}

TEST(ComplexOfPolyhedra, TakesPartsThatCgalHasDivided) {
    const MeshData data = test::cut_bricks();
    LinearCellComplex complex = complex_of(data);
    // The upper half of the first brick, along the diagonals of its top and its bottom.
    const auto diagonal = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Handle d = find_dart(complex, 1, a, b);
        EXPECT_EQ(complex.info<0>(complex.beta<1, 1>(d)).id, VertexId(c));
        complex.insert_cell_1_in_cell_2(d, complex.beta<1, 1>(d));
    };
    diagonal(6, 7, 10);
    diagonal(17, 16, 14);
    const std::vector<Handle> path{find_dart(complex, 1, 6, 10), find_dart(complex, 1, 10, 17),
                                   find_dart(complex, 1, 17, 14), find_dart(complex, 1, 14, 6)};
    for (const Handle d : path) ASSERT_NE(d, nullptr);
    complex.insert_cell_2_in_cell_3(path.begin(), path.end());
    ASSERT_TRUE(complex.is_valid());
    const Mesh mesh = from_linear_cell_complex(complex).mesh;
    EXPECT_EQ(validate(mesh), std::vector<std::string>());
    EXPECT_EQ(mesh.num_elements(), 4u);
    EXPECT_EQ(mesh.source_carriers().of_cell, (std::vector<std::int64_t>{0, 0, 0, 1}));
    for (const std::size_t part : {1u, 2u}) {
        EXPECT_TRUE(mesh.is_polyhedron(CellId(part)));
        EXPECT_EQ(mesh.num_faces(CellId(part)), 5);
        EXPECT_DOUBLE_EQ(rest_volume(mesh, CellId(part)), 0.25);
    }
}

/// The refusal of a complex has all of these texts.
void expect_complex_fault(const LinearCellComplex& complex, const std::vector<std::string>& texts) {
    std::string fault = "none";
    try {
        from_linear_cell_complex(complex);
    } catch (const InputError& error) {
        fault = error.what();
    }
    EXPECT_THAT(fault, testing::StartsWith("linear cell complex: "));
    for (const std::string& text : texts) EXPECT_THAT(fault, HasSubstr(text));
    EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
    EXPECT_EQ(fault.find("file"), std::string::npos) << fault;
}

Handle dart_of_cell(LinearCellComplex& complex, std::size_t cell) {
    for (auto d = complex.darts().begin(); d != complex.darts().end(); ++d)
        if (complex.info<3>(d).id == CellId(cell)) return d;
    return nullptr;
}

/// Moves the vertex of an id.
void move_vertex(LinearCellComplex& complex, std::size_t id, const Vec3& to) {
    for (auto v = complex.attributes<0>().begin(); v != complex.attributes<0>().end(); ++v)
        if (complex.info_of_attribute<0>(v).id == VertexId(id))
            complex.point_of_vertex_attribute(v) = LinearCellComplex::Point(to[0], to[1], to[2]);
}

TEST(ComplexOfPolyhedra, RefusesPolyhedraWithoutCarriers) {
    const MeshData data = test::cut_bricks();
    const Mesh mesh = Mesh::build(data).mesh;
    // The halves have the shape of hexahedra; cell 2 has corners in its edges.
    expect_complex_fault(to_linear_cell_complex(mesh),
                         {"cell 2 (polyhedron, number 2 in the complex) without a carrier",
                          "set it", "to_linear_cell_complex()"});
    // Somebody else's division of a whole cell.
    LinearCellComplex divided =
        to_linear_cell_complex(Mesh::build(test::jittered_cube(1, 0.0, 1)).mesh);
    divided.insert_barycenter_in_cell<1>(dart_of_cell(divided, 3));
    expect_complex_fault(divided, {"(polyhedron, number ", "more without a carrier: forces need"});
}

TEST(ComplexOfPolyhedra, RefusesVolumesThatAreNone) {
    const MeshData data = test::cut_bricks();
    const LinearCellComplex sound = complex_of(data);
    const auto expect = [&](const std::vector<std::string>& texts, auto forge) {
        SCOPED_TRACE(texts.front());
        LinearCellComplex forged = sound;
        forge(forged);
        expect_complex_fault(forged, texts);
    };
    expect({"volume 1 (number 1 in the complex) is not closed: the edge from (", "only one face",
            "sew<2>"},
           [](LinearCellComplex& c) {
               Handle d = dart_of_cell(c, 1);
               while (!c.is_free<3>(d) || !c.is_free<3>(c.beta<2>(d))) d = c.beta<1, 2, 1>(d);
               c.unsew<2>(d);
           });
    expect({"cell 0 (polyhedron, number 0 in the complex) has the volume -0.2, which must be "
            "positive: its faces run the wrong way round; mend the volume"},
           [](LinearCellComplex& c) {
               move_vertex(c, 0, {0, 0, 0.9});
               move_vertex(c, 3, {0, 1, 0.9});
               move_vertex(c, 12, {0, 0, 0});
               move_vertex(c, 13, {0, 1, 0});
           });
    expect({"cell 0 (polyhedron, number 0 in the complex) has a face", "that is not plane",
            "mend the volume"},
           [](LinearCellComplex& c) {
               move_vertex(c, 12, {0, 0, 0.05});
               move_vertex(c, 13, {0, 1, 0.95});
               move_vertex(c, 16, {1, 0, 0.95});
               move_vertex(c, 17, {1, 1, 0.05});
           });
    expect({"cell 0 (polyhedron, number 0 in the complex) is not inside its carrier 0",
            "ComplexCell::carrier"},
           [](LinearCellComplex& c) {
               move_vertex(c, 12, {-0.1, 0, 0.5});
           });
    expect({"carrier 1 has the volume 0", "its first part is cell 2 (polyhedron, number 2 in the"},
           [](LinearCellComplex& c) {
               for (Vec3& x : *c.info<3>(dart_of_cell(c, 2)).carrier) x.z() = 0.0;
           });
    expect({"the carrier of cell 2 (polyhedron, number 2 in the complex) divides faces"},
           [](LinearCellComplex& c) {
               c.info<3>(dart_of_cell(c, 2)).carrier->diagonals = Diagonals::of_bits(0xffff);
           });
}

TEST(ComplexOfPolyhedra, RefusesATorus) {
    std::vector<Vec3> points;
    std::vector<std::vector<std::size_t>> faces;
    for (const Vec3& out : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)})
        points.insert(points.end(), {2.0 * out, 3.0 * out, 2.5 * out + Vec3(0, 0, 1)});
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t a = 3 * k, b = 3 * ((k + 1) % 4);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            faces.push_back({a + j, b + j, b + i, a + i});
        }
    }
    LinearCellComplex complex;
    complex.info<3>(add_volume(complex, points, faces)).carrier = brick_round_roof();
    ASSERT_TRUE(complex.is_valid());
    expect_complex_fault(complex, {"cell 0 (polyhedron) is no ball: it has 12 corners, 24 edges",
                                   "mend the volume, or remove it with remove_cell<3>()"});
}

TEST(ComplexOfPolyhedra, NamesATetrahedronThatIsInsideOut) {
    LinearCellComplex complex =
        to_linear_cell_complex(Mesh::build(test::jittered_cube(2, 0.0, 1)).mesh);
    move_vertex(complex, 0, {1.5, 1.5, 1.5});
    expect_complex_fault(complex, {" is turned inside out: it has the volume -", "number "});
}

}  // namespace
}  // namespace incise::topology
