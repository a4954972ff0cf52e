// Every format that is written keeps the mesh: points, cells, orientation, regions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/mesh_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>

#include <Eigen/Geometry>
#include <array>
#include <numbers>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/mesh/mesh_text.h"
#include "incise/topology/box_mesh.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

using support::read_text;
using support::TemporaryFolder;
using testing::HasSubstr;
using topology::CellKind;
using topology::MeshData;

/// One cell of each kind, each of positive volume in VTK's numbering.
MeshData make_mesh() {
    MeshData mesh;
    const double third = 1.0 / 3, pi = std::numbers::pi;
    mesh.points = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0},        {1, 1, 0},      {0, 0, 1},
                   {1, 0, 1},  {0, 1, 1},  {1, 1, 1},        {third, .5, 2}, {third, 0.5, -pi},
                   {2, .5, 0}, {2, .5, 1}, {1e-300, -2, 1e9}};
    const auto add = [&](CellKind kind, std::vector<std::int64_t> corners, int region) {
        mesh.add_cell(kind, corners, region);
    };
    add(CellKind::wedge, {1, 3, 10, 5, 7, 11}, 4);
    add(CellKind::hexahedron, {0, 1, 3, 2, 4, 5, 7, 6}, 1);
    add(CellKind::pyramid, {4, 5, 7, 6, 8}, 2);
    add(CellKind::tetrahedron, {0, 2, 1, 9}, 1);
    return mesh;
}

/// Six times the volume of a tetrahedron; positive in every format.
double determinant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a);
}

TEST(MeshWriter, VtkReadsBackTheLegacyFile) {
    const TemporaryFolder folder;
    const auto mesh = make_mesh();
    write_mesh(folder / "mesh.vtk", mesh);
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->SetFileName((folder / "mesh.vtk").c_str());
    reader->Update();
    auto* grid = reader->GetOutput();
    ASSERT_EQ(static_cast<std::size_t>(grid->GetNumberOfPoints()), mesh.points.size());
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
        EXPECT_EQ(Vec3(grid->GetPoint(i)), mesh.points[static_cast<std::size_t>(i)]);
    ASSERT_EQ(static_cast<std::size_t>(grid->GetNumberOfCells()), mesh.num_cells());
    constexpr int types[] = {VTK_WEDGE, VTK_HEXAHEDRON, VTK_PYRAMID, VTK_TETRA};
    vtkNew<vtkIdList> corners;
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
        EXPECT_EQ(grid->GetCellType(c), types[c]);
        grid->GetCellPoints(c, corners);
        const auto expected = mesh.cell(static_cast<std::size_t>(c));
        EXPECT_TRUE(std::equal(corners->begin(), corners->end(), expected.begin(), expected.end()));
        EXPECT_EQ(static_cast<int>(grid->GetCellData()->GetArray("region")->GetComponent(c, 0)),
                  mesh.regions[static_cast<std::size_t>(c)]);
    }
}

TEST(MeshWriter, WedgesFaceInwardsWhereTheFormatSaysSo) {
    const auto mesh = make_mesh();
    const auto wedge = with_wedges_facing_inwards(mesh, 0);
    const auto point = [&](std::int64_t i) { return mesh.points[static_cast<std::size_t>(i)]; };
    const auto vtk = mesh.cell(0);
    EXPECT_LT(determinant(point(vtk[0]), point(vtk[1]), point(vtk[2]), point(vtk[3])), 0);
    const auto& corners = wedge.corners;
    EXPECT_GT(
        determinant(point(corners[0]), point(corners[1]), point(corners[2]), point(corners[3])), 0);
    for (std::size_t i = 0; i < 3; ++i)  // above one another as before
        EXPECT_EQ(point(corners[i + 3]) - point(corners[i]), Vec3(0, 0, 1));
    for (std::size_t c = 1; c < mesh.num_cells(); ++c) {
        const auto same = with_wedges_facing_inwards(mesh, c);
        const auto expected = mesh.cell(c);
        EXPECT_TRUE(std::equal(same.begin(), same.end(), expected.begin(), expected.end()));
    }
}

TEST(MeshWriter, GmshFileIsAsItsManualSays) {
    EXPECT_EQ(gmsh_text(make_mesh()),
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
              "$Nodes\n13\n"
              "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n5 0 0 1\n6 1 0 1\n7 0 1 1\n8 1 1 1\n"
              "9 0.3333333333333333 0.5 2\n10 0.3333333333333333 0.5 -3.141592653589793\n"
              "11 2 0.5 0\n12 2 0.5 1\n13 1e-300 -2 1e+09\n"
              "$EndNodes\n$Elements\n4\n"
              "1 6 2 4 4 2 11 4 6 12 8\n"
              "2 5 2 1 1 1 2 4 3 5 6 8 7\n"
              "3 7 2 2 2 5 6 8 7 9\n"
              "4 4 2 1 1 1 3 2 10\n"
              "$EndElements\n");
}

TEST(MeshWriter, MeditFileGroupsCellsByKind) {
    EXPECT_THAT(medit_text(make_mesh()),
                HasSubstr("Tetrahedra\n1\n1 3 2 10 1\nHexahedra\n1\n1 2 4 3 5 6 8 7 1\n"
                          "Prisms\n1\n2 11 4 6 12 8 4\nPyramids\n1\n5 6 8 7 9 2\nEnd\n"));
}

TEST(MeshWriter, AbaqusFileGroupsByRegionAndKeepsNumbers) {
    EXPECT_THAT(abaqus_text(make_mesh()),
                HasSubstr("*ELEMENT, TYPE=C3D4, ELSET=REGION_1\n4,1,3,2,10\n"
                          "*ELEMENT, TYPE=C3D8, ELSET=REGION_1\n2,1,2,4,3,5,6,8,7\n"
                          "*ELEMENT, TYPE=C3D5, ELSET=REGION_2\n3,5,6,8,7,9\n"
                          "*ELEMENT, TYPE=C3D6, ELSET=REGION_4\n1,2,11,4,6,12,8\n"));
}

/// The same cells in the order of MEDIT's sections.
MeshData grouped_by_kind(const MeshData& mesh) {
    MeshData grouped;
    grouped.points = mesh.points;
    for (const auto& kind :
         {CellKind::tetrahedron, CellKind::hexahedron, CellKind::wedge, CellKind::pyramid})
        for (std::size_t c = 0; c < mesh.num_cells(); ++c)
            if (mesh.kinds[c] == kind) grouped.add_cell(kind, mesh.cell(c), mesh.regions[c]);
    return grouped;
}

TEST(MeshWriter, OurReaderGivesBackTheSameMesh) {
    const TemporaryFolder folder;
    for (const std::string suffix : {".vtu", ".vtk", ".msh", ".mesh", ".inp"}) {
        SCOPED_TRACE(suffix);
        const auto mesh = suffix == ".mesh" ? grouped_by_kind(make_mesh()) : make_mesh();
        const auto path = folder / ("mesh" + suffix);
        write_mesh(path, mesh);
        const auto [again, warnings, vectors] = read_mesh(path);
        EXPECT_EQ(again.points, mesh.points);
        EXPECT_EQ(again.kinds, mesh.kinds);
        EXPECT_EQ(again.offsets, mesh.offsets);
        EXPECT_EQ(again.corners, mesh.corners);
        EXPECT_EQ(again.regions, mesh.regions);
        EXPECT_TRUE(warnings.empty());
    }
}

TEST(MeshWriter, WarnsOfCarriersThatAFormatCannotHold) {
    topology::MeshData mesh =
        topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {1, 1, 1});
    for (const std::string& suffix : writable_suffixes())
        EXPECT_EQ(loss_in_format("a" + suffix, mesh), std::nullopt);
    mesh.carriers.of_cell.assign(mesh.num_cells(), 0);
    mesh.carriers.corners.emplace_back();
    for (const std::string& suffix : writable_suffixes())
        EXPECT_EQ(loss_in_format("a" + suffix, mesh).has_value(), suffix != ".vtu") << suffix;
}

TEST(MeshWriter, RefusesUnknownSuffixesAndNamesTheKnownOnes) {
    const TemporaryFolder folder;
    for (const auto* name : {"mesh.stl", "mesh", "mesh.vtu.bak"}) {
        try {
            write_mesh(folder / name, make_mesh());
            FAIL() << "no error";
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(name));
            for (const auto& suffix : writable_suffixes())
                EXPECT_THAT(error.what(), HasSubstr(suffix));
        }
    }
    EXPECT_EQ(support::count_entries(folder.path()), 0U);
    EXPECT_NO_THROW(check_writable("MESH.VTU"));
    EXPECT_THROW(check_writable("mesh.xyz"), InputError);
}

TEST(MeshWriter, ReportsAFullDiskInEveryFormat) {
    const TemporaryFolder folder;
    for (const auto& suffix : writable_suffixes()) {
        if (suffix == ".usda") continue;  // has no place for all kinds of cells
        const auto path = folder / ("mesh" + suffix);
        std::filesystem::create_symlink("/dev/full", path);
        EXPECT_THROW(write_mesh(path, make_mesh()), OutputError) << suffix;
    }
}

}  // namespace
}  // namespace incise::io
