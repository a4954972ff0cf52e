// Polyhedra in VTU and legacy VTK files: what is written is read, and what is wrong is refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/topology/mesh_check.h"
#include "reader_samples.h"
#include "tests/support/cut_bricks.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

using support::TemporaryFolder;
using testing::HasSubstr;
using topology::CellKind;
using topology::MeshData;

void expect_same(const MeshData& a, const MeshData& b) {
    expect_same_mesh(a, b);
    EXPECT_EQ(a.faces, b.faces);
}

TEST(Polyhedra, OfVtuFilesComeBackWithTheirCarriers) {
    const TemporaryFolder folder;
    const MeshData mesh = test::cut_bricks();
    write_mesh(folder / "cut.vtu", mesh);
    const MeshFile read = read_mesh(folder / "cut.vtu");
    EXPECT_TRUE(read.warnings.empty());
    expect_same(read.mesh, mesh);
    EXPECT_EQ(read.mesh.cut_faces, mesh.cut_faces);
    EXPECT_TRUE(read.mesh.carriers == mesh.carriers);
    EXPECT_TRUE(read.mesh.points_may_coincide);
    EXPECT_TRUE(topology::check(read.mesh).errors.empty());
}

TEST(Polyhedra, OfVtkFilesComeBackWithoutCarriers) {
    const TemporaryFolder folder;
    const MeshData mesh = test::cut_bricks();
    EXPECT_THAT(loss_in_format("cut.vtk", mesh).value_or(""),
                HasSubstr("polyhedra have no forces"));
    EXPECT_EQ(loss_in_format("cut.vtu", mesh), std::nullopt);
    write_mesh(folder / "cut.vtk", mesh);
    const MeshFile read = read_mesh(folder / "cut.vtk");
    expect_same(read.mesh, mesh);
    EXPECT_TRUE(read.mesh.carriers.is_empty());
    EXPECT_THAT(topology::check(read.mesh).errors.front(), HasSubstr("without a carrier"));
}

TEST(Polyhedra, MayStandBetweenOtherCells) {
    const TemporaryFolder folder;
    MeshData mesh = test::cut_bricks();
    const auto first = std::ssize(mesh.points);
    for (int k = 0; k < 4; ++k) mesh.points.emplace_back(5.0 + (k == 1), k == 2, k == 3);
    MeshData mixed;
    mixed.points = mesh.points;
    mixed.add_cell(CellKind::tetrahedron,
                   std::array<std::int64_t, 4>{first, first + 1, first + 2, first + 3});
    mixed.add_polyhedron(std::span(mesh.faces).first(31));
    mixed.add_cell(CellKind::hexahedron, std::array<std::int64_t, 8>{1, 2, 5, 4, 7, 8, 11, 10});
    mixed.add_polyhedron(std::span(mesh.faces).subspan(31, 31));
    for (const char* name : {"mixed.vtu", "mixed.vtk"}) {
        SCOPED_TRACE(name);
        write_mesh(folder / name, mixed);
        expect_same(read_mesh(folder / name).mesh, mixed);
    }
}

TEST(Polyhedra, AreRefusedByFormatsWithoutThem) {
    const TemporaryFolder folder;
    for (const char* name : {"cut.msh", "cut.inp", "cut.mesh", "cut.usda"}) try {
            write_mesh(folder / name, test::cut_bricks());
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("write .vtu")) << name;
        }
}

TEST(Polyhedra, WithManyFacesOnCutsHaveFurtherArrays) {
    const TemporaryFolder folder;
    MeshData mesh = test::cut_bricks();
    mesh.further_cut_faces = {{0, 5, 0}, {1 << 30, 0, 0}};  // no mesh: only written and read
    write_mesh(folder / "cut.vtu", mesh);
    const MeshFile read = read_mesh(folder / "cut.vtu");
    EXPECT_EQ(read.mesh.cut_faces, mesh.cut_faces);
    EXPECT_EQ(read.mesh.further_cut_faces, mesh.further_cut_faces);
    EXPECT_THAT(support::read_text(folder / "cut.vtu"), HasSubstr("cut_faces_62"));
}

/// A tetrahedron that is written as a polyhedron, and the brick that it is a part of.
std::string vtu_of_polyhedron() {
    return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
           "<FieldData>\n<DataArray type=\"Float64\" Name=\"carrier_corners\" "
           "NumberOfComponents=\"24\" NumberOfTuples=\"1\" format=\"ascii\">"
           "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1</DataArray>\n"
           "<DataArray type=\"Int32\" Name=\"carrier_types\" NumberOfTuples=\"1\" "
           "format=\"ascii\">12</DataArray>\n</FieldData>\n"
           "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<CellData>\n"
           "<DataArray type=\"Int64\" Name=\"carrier\" format=\"ascii\">0</DataArray>\n"
           "</CellData>\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
           "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>\n</Points>\n<Cells>\n"
           "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>\n"
           "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">42</DataArray>\n"
           "<DataArray type=\"Int64\" Name=\"faces\" format=\"ascii\">"
           "4 3 0 2 1 3 0 1 3 3 1 2 3 3 0 3 2</DataArray>\n"
           "<DataArray type=\"Int64\" Name=\"faceoffsets\" format=\"ascii\">17</DataArray>\n"
           "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

const char* vtk_of_polyhedron =
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 18\n"
    "17 4 3 0 2 1 3 0 1 3 3 1 2 3 3 0 3 2\nCELL_TYPES 1\n42\n";

TEST(Polyhedra, OfVtuFilesThatAreDamagedAreRefused) {
    const std::string text = vtu_of_polyhedron();
    const MeshData mesh = read_bytes("a.vtu", text).mesh;
    EXPECT_TRUE(topology::check(mesh).errors.empty());
    EXPECT_EQ(mesh.carriers.corners[0].kind(), CellKind::hexahedron);
    const std::vector<std::array<std::string, 3>> damages = {
        {"\"faceoffsets\"", "\"other\"", "has no 'faceoffsets' array in Cells"},
        {"\"faces\"", "\"other\"", "has no 'faces' array in Cells"},
        {">17<", ">-1<", "the faces of cell 0 end at -1, before they begin at 0"},
        {">17<", ">18<", "array 'faces': holds 17 values, expected 18"},
        {">17<", ">9000000000000<", "more than a file of this size can hold"},
        {">4 3 0", ">5 3 0", "cell 0: face 4 of 5 ends behind the faces of the polyhedron"},
        {">4 3 0", ">3 3 0", "cell 0: a polyhedron has 17 numbers for its faces, which fill 13"},
        {">4 3 0", ">-4 3 0", "cell 0: a polyhedron has -4 faces"},
        {">4 3 0", ">4 2 0", "cell 0: face 0 of 4 has 2 points"},
        {"0 3 2<", "0 3 7<", "cell 0: face 3 names point 7 of 4"},
        {">0 1 2 3<", ">0 1 2 4<", "cell 0: node index 4 is out of range"},
        {">12<", ">42<", "carrier 0 has the type 42, which must be 10"},
        {">12<", ">11<", "carrier 0 has the type 11, which must be 10"},
        {"\"carrier_types\"", "\"types\"", "carriers need 12 components, four positions"},
        {"NumberOfComponents=\"24\"", "NumberOfComponents=\"12\"",
         "carriers need 24 components, eight positions"},
    };
    for (const auto& [from, to, message] : damages) {
        SCOPED_TRACE(from + " to " + to);
        EXPECT_THAT(refusal("a.vtu", replaced(text, from, to)), HasSubstr(message));
    }
}

TEST(Polyhedra, OfVtkFilesThatAreDamagedAreRefused) {
    const MeshData mesh = read_bytes("a.vtk", vtk_of_polyhedron).mesh;
    EXPECT_EQ(mesh.faces,
              (std::vector<std::int64_t>{4, 3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2}));
    EXPECT_EQ(mesh.corners, (std::vector<std::int64_t>{0, 2, 1, 3}));
    const std::vector<std::array<std::string, 3>> damages = {
        {"17 4 3 0", "17 5 3 0", "cell 0: face 4 of 5 ends behind the faces of the polyhedron"},
        {"17 4 3 0", "17 3 3 0", "which fill 13"},
        {"17 4 3 0", "17 4 9999999 0", "cell 0: face 0 of 4 ends behind"},
        {"17 4 3 0", "17 0 3 0", "cell 0: a polyhedron has 0 faces"},
        {"0 3 2\n", "0 3 9\n", "cell 0: node index 9 is out of range"},
    };
    for (const auto& [from, to, message] : damages) {
        SCOPED_TRACE(from + " to " + to);
        EXPECT_THAT(refusal("a.vtk", replaced(vtk_of_polyhedron, from, to)), HasSubstr(message));
    }
}

}  // namespace
}  // namespace incise::io
