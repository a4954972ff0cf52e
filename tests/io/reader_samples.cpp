// One small mesh in every format and encoding that the readers know; of Gmsh in gmsh_samples.cpp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "tests/io/reader_samples.h"

#include <gtest/gtest.h>
#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "tests/io/refusals.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {

using topology::CellKind;
using topology::MeshData;

MeshData sample_mesh() {
    MeshData mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},    {1, 1, 0},       {0, 0, 1},  {1, 0, 1},
                   {0, 1, 1}, {1, 1, 1}, {.25, .5, 2}, {.25, .5, -3.5}, {2, .5, 0}, {2, .5, 1}};
    const auto add = [&](CellKind kind, std::vector<std::int64_t> corners, int region) {
        mesh.add_cell(kind, corners, region);
    };
    add(CellKind::wedge, {1, 3, 10, 5, 7, 11}, 4);
    add(CellKind::hexahedron, {0, 1, 3, 2, 4, 5, 7, 6}, 1);
    add(CellKind::pyramid, {4, 5, 7, 6, 8}, 2);
    add(CellKind::tetrahedron, {0, 2, 1, 9}, 1);
    return mesh;
}

namespace {

/// The mesh as VTK's grid: a line first, triangles among the cells, the hexahedron as a voxel.
vtkNew<vtkUnstructuredGrid> sample_grid() {
    const auto mesh = sample_mesh();
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const auto& p : mesh.points) points->InsertNextPoint(p.data());
    grid->SetPoints(points);

    vtkNew<vtkIntArray> regions;
    regions->SetName("region");
    const auto insert = [&](int type, std::initializer_list<vtkIdType> nodes, int region) {
        grid->InsertNextCell(type, static_cast<vtkIdType>(nodes.size()), nodes.begin());
        regions->InsertNextValue(region);
    };
    insert(VTK_LINE, {0, 1}, 9);
    insert(VTK_WEDGE, {1, 3, 10, 5, 7, 11}, 4);
    insert(VTK_TRIANGLE, {0, 1, 2}, 9);
    insert(VTK_VOXEL, {0, 1, 2, 3, 4, 5, 6, 7}, 1);
    insert(VTK_PYRAMID, {4, 5, 7, 6, 8}, 2);
    insert(VTK_TRIANGLE, {1, 3, 2}, 9);
    insert(VTK_TETRA, {0, 2, 1, 9}, 1);
    grid->GetCellData()->AddArray(regions);

    vtkNew<vtkFloatArray> displacement;
    displacement->SetName("displacement");
    displacement->SetNumberOfComponents(3);
    displacement->SetComponentName(0, "east");  // makes the writers add meta data
    displacement->SetNumberOfTuples(grid->GetNumberOfPoints());
    displacement->Fill(0.5);
    grid->GetPointData()->SetVectors(displacement);
    return grid;
}

/// Attributes of all kinds that a legacy file may have, for the reader to step over.
void add_other_attributes(vtkUnstructuredGrid* grid) {
    vtkNew<vtkFloatArray> temperature;
    temperature->SetName("a temperature");
    temperature->SetNumberOfTuples(grid->GetNumberOfPoints());
    temperature->Fill(37);
    vtkNew<vtkLookupTable> table;
    table->SetNumberOfTableValues(5);
    table->Build();
    temperature->SetLookupTable(table);
    grid->GetPointData()->SetScalars(temperature);
    vtkNew<vtkFloatArray> texture;
    texture->SetName("texture");
    texture->SetNumberOfComponents(2);
    texture->SetNumberOfTuples(grid->GetNumberOfPoints());
    texture->Fill(0.25);
    grid->GetPointData()->SetTCoords(texture);

    const auto num_cells = grid->GetNumberOfCells();
    vtkNew<vtkUnsignedCharArray> color;
    color->SetName("color");
    color->SetNumberOfComponents(3);
    color->SetNumberOfTuples(num_cells);
    color->Fill(10);  // as a byte, a line feed
    grid->GetCellData()->SetScalars(color);
    vtkNew<vtkDoubleArray> stress;
    stress->SetName("stress");
    stress->SetNumberOfComponents(9);
    stress->SetNumberOfTuples(num_cells);
    stress->Fill(1.5);
    grid->GetCellData()->SetTensors(stress);
    vtkNew<vtkBitArray> flags;
    flags->SetName("flags");
    vtkNew<vtkStringArray> labels;
    labels->SetName("labels");
    for (vtkIdType c = 0; c < num_cells; ++c) {
        flags->InsertNextValue(static_cast<int>(c % 2));
        labels->InsertNextValue(c == 0 ? std::string(100, 'x') : c == 1 ? "two words" : "");
    }
    // In front of the regions, so that a wrong step is noticed.
    auto* data = grid->GetCellData();
    vtkNew<vtkIntArray> regions;
    regions->DeepCopy(data->GetArray("region"));
    regions->SetName("region");
    data->RemoveArray("region");
    data->AddArray(flags);
    data->AddArray(labels);
    data->AddArray(regions);
}

}  // namespace

std::vector<Sample> vtu_samples() {
    const auto grid = sample_grid();
    std::vector<Sample> samples;
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    writer->WriteToOutputStringOn();
    const auto write = [&](const std::string& name) {
        writer->Write();
        samples.push_back({name + ".vtu", writer->GetOutputString()});
    };
    writer->SetDataModeToAscii();
    write("ascii");
    const std::array<const char*, 4> compressors = {"none", "zlib", "lz4", "lzma"};
    for (const bool is_wide : {false, true}) {
        is_wide ? writer->SetHeaderTypeToUInt64() : writer->SetHeaderTypeToUInt32();
        for (const bool is_big : {false, true}) {
            is_big ? writer->SetByteOrderToBigEndian() : writer->SetByteOrderToLittleEndian();
            for (int c = 0; c < 4; ++c) {
                writer->SetCompressorType(c);
                writer->SetBlockSize(64);  // several blocks an array, the last one shorter
                const std::string name = std::string(is_wide ? "64" : "32") +
                                         (is_big ? "-big-" : "-little-") +
                                         compressors[static_cast<std::size_t>(c)];
                writer->SetDataModeToBinary();
                write("inline-" + name);
                writer->SetDataModeToAppended();
                writer->EncodeAppendedDataOff();
                write("raw-" + name);
                writer->EncodeAppendedDataOn();
                write("base64-" + name);
            }
        }
    }
    return samples;
}

std::vector<Sample> legacy_vtk_samples() {
    const auto grid = sample_grid();
    add_other_attributes(grid);
    std::vector<Sample> samples;
    for (const int version : {42, 51}) {
        for (const bool is_binary : {false, true}) {
            vtkNew<vtkUnstructuredGridWriter> writer;
            writer->SetInputData(grid);
            writer->SetFileVersion(version);
            is_binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
            writer->WriteToOutputStringOn();
            writer->Write();
            samples.push_back(
                {std::string(is_binary ? "binary-" : "ascii-") + std::to_string(version) + ".vtk",
                 writer->GetOutputStdString()});
        }
    }
    return samples;
}

int tag_of(std::int64_t node) { return 1000 - 7 * static_cast<int>(node); }

std::vector<std::int64_t> nodes_in_files(const MeshData& mesh, std::size_t c) {
    const auto corners = mesh.cell(c);
    std::vector<std::int64_t> nodes(corners.begin(), corners.end());
    if (mesh.kinds[c] == CellKind::wedge) {  // the other triangle's side up
        std::swap(nodes[1], nodes[2]);
        std::swap(nodes[4], nodes[5]);
    }
    return nodes;
}

std::vector<Sample> medit_samples() {
    const auto mesh = sample_mesh();
    std::string text = "MeshVersionFormatted 2\n# by hand\nDimension\n3\nVertices # all\n" +
                       std::to_string(mesh.points.size()) + "\n";
    for (const auto& point : mesh.points) {
        for (const double x : point) text += std::to_string(x) + " ";
        text += "0\n";
    }
    text += "Corners\n2\n1\n2\nEdges\n1\n1 2 9\nTriangles\n2\n";
    for (const auto& [a, b, c] : sample_triangles)
        text += std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) +
                " 9\n";
    constexpr std::array keywords = {"Prisms", "Hexahedra", "Pyramids", "Tetrahedra"};
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        text += std::string(keywords[c]) + "\n1\n";
        for (const auto node : nodes_in_files(mesh, c)) text += std::to_string(node + 1) + " ";
        text += std::to_string(mesh.regions[c]) + "\n";
    }
    return {{"ascii.mesh", text + "End\n"}};
}

std::vector<Sample> abaqus_samples() {
    const auto mesh = sample_mesh();
    std::string text = "*HEADING\nmade by hand\n** nodes\n*NODE, NSET=all\n";
    const auto add_row = [&](std::size_t number, const auto& numbers) {
        text += std::to_string(number);
        for (const auto value : numbers) text += ", " + std::to_string(value);
        text += "\n";
    };
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        add_row(static_cast<std::size_t>(tag_of(static_cast<std::int64_t>(i))), mesh.points[i]);
    const auto tags = [](auto nodes) {
        for (auto& node : nodes) node = tag_of(node);
        return nodes;
    };
    text += "*ELEMENT, TYPE=T3D2\n";
    add_row(90, tags(std::array<std::int64_t, 2>{0, 1}));
    text += "*ELEMENT, TYPE=S3\n";
    for (const auto& triangle : sample_triangles) add_row(91, tags(triangle));
    constexpr std::array types = {"C3D6", "C3D8R", "C3D5", "C3D4"};
    for (std::size_t c = mesh.num_cells(); c-- > 0;) {
        text += std::string("*ELEMENT, TYPE=") + types[c] + ", ELSET=REGION_" +
                std::to_string(mesh.regions[c]) + "\n";
        add_row(5 * c + 1, tags(nodes_in_files(mesh, c)));
    }
    return {{"ascii.inp", text + "*STEP\n*STATIC\n0.1, 1.\n*END STEP\n"}};
}

std::vector<Sample> febio_samples() {
    const auto mesh = sample_mesh();
    std::vector<Sample> samples;
    for (const std::string version : {"2.5", "3.0", "4.0"}) {
        const std::string section = version == "2.5" ? "Geometry" : "Mesh";
        std::string text = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<!-- by <hand> -->\n" +
                           ("<febio_spec version=\"" + version) +
                           "\">\n<Module type=\"solid\"/>\n<" + section + ">\n<Nodes>\n";
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            if (i == 5) text += "</Nodes><Nodes name=\"more\">\n";
            text += "<node id=\"" + std::to_string(tag_of(static_cast<std::int64_t>(i))) + "\">";
            for (Eigen::Index k = 0; k < 3; ++k)
                text += (k > 0 ? ", " : "") + std::to_string(mesh.points[i][k]);
            text += "</node>\n";
        }
        text += "</Nodes>\n";
        int id = 1;
        const auto begin = [&](const std::string& type, int region) {
            const auto number = std::to_string(region);
            text += "<Elements type=\"" + type + "\" " +
                    (version == "2.5" ? "mat=\"" + number + "\" name=\"Part\""
                                      : "name=\"REGION_" + number + "\"") +
                    ">\n";
        };
        const auto element = [&](const auto& nodes) {
            text += "<elem id=\"" + std::to_string(id++) + "\">";
            bool is_first = true;
            for (const auto node : nodes) {
                text += (is_first ? "" : ",") + std::to_string(tag_of(node));
                is_first = false;
            }
            text += "</elem>\n";
        };
        begin("line2", 9);
        element(std::array<std::int64_t, 2>{0, 1});
        text += "</Elements>\n";
        begin("tri3", 9);
        for (const auto& triangle : sample_triangles) element(triangle);
        text += "</Elements>\n";
        constexpr std::array types = {"penta6", "hex8", "pyra5", "tet4"};
        for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
            begin(types[c], mesh.regions[c]);
            element(nodes_in_files(mesh, c));
            text += "</Elements>\n";
        }
        text += "<NodeSet name=\"held\"/>\n</" + section + ">\n</febio_spec>\n";
        samples.push_back({"ascii-" + version + ".feb", text});
    }
    return samples;
}

std::vector<Sample> all_samples() {
    auto samples = vtu_samples();
    for (auto& sample : legacy_vtk_samples()) samples.push_back(std::move(sample));
    for (auto& sample : gmsh_samples()) samples.push_back(std::move(sample));
    for (auto& sample : medit_samples()) samples.push_back(std::move(sample));
    for (auto& sample : abaqus_samples()) samples.push_back(std::move(sample));
    for (auto& sample : febio_samples()) samples.push_back(std::move(sample));
    return samples;
}

MeshFile read_bytes(const std::string& name, std::string_view bytes, const ReadOptions& options) {
    const support::TemporaryFolder folder;
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return read_mesh(folder / name, options);
}

std::string refusal(const std::string& name, std::string_view bytes, const ReadOptions& options) {
    return refusal_by([&](const auto& path) { read_mesh(path, options); }, name, bytes);
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const auto position = text.find(from);
    if (position == text.npos) {
        ADD_FAILURE() << from << " is not in the text";
        return text;
    }
    return text.replace(position, from.size(), to);
}

void expect_wedge_of_unit_height(const MeshData& mesh) {
    ASSERT_EQ(mesh.num_cells(), 1u);
    ASSERT_EQ(mesh.kinds[0], CellKind::wedge);
    const auto corner = [&](std::size_t i) {
        return mesh.points[static_cast<std::size_t>(mesh.cell(0)[i])];
    };
    const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const Vec3 up = corner(3) - corner(0);
    EXPECT_LT(normal.dot(up), 0);
    EXPECT_EQ(up.norm(), 1);
    for (std::size_t i = 1; i < 3; ++i) EXPECT_EQ(corner(i + 3), corner(i) + up);
}

void expect_same_mesh(const MeshData& actual, const MeshData& expected) {
    EXPECT_EQ(actual.points, expected.points);
    EXPECT_EQ(actual.kinds, expected.kinds);
    EXPECT_EQ(actual.offsets, expected.offsets);
    EXPECT_EQ(actual.corners, expected.corners);
    EXPECT_EQ(actual.regions, expected.regions);
}

}  // namespace incise::io
