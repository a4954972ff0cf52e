// One small mesh in every format and encoding that the readers know: data, hence a long file.
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

#include "incise/base/error.h"
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

constexpr std::array<std::array<vtkIdType, 3>, 2> sample_triangles = {{{0, 1, 2}, {1, 3, 2}}};

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

namespace {

/// Emits the numbers of a Gmsh file.
class GmshText {
  public:
    enum class Mode { ascii, binary, swapped };
    explicit GmshText(Mode mode) : mode_(mode) {}

    void text(std::string_view line) { bytes_ += line; }
    void integer(int value) { put(static_cast<std::int32_t>(value)); }
    void size(std::size_t value) { put(static_cast<std::uint64_t>(value)); }
    void real(double value) { put(value); }
    void end_line() {
        if (mode_ == Mode::ascii) bytes_ += "\n";
    }
    void format(const std::string& version) {
        text("$MeshFormat\n" + version + (mode_ == Mode::ascii ? " 0 8\n" : " 1 8\n"));
        if (mode_ != Mode::ascii) {
            integer(1);
            text("\n");
        }
        text("$EndMeshFormat\n");
    }
    /// The start or end of a section.
    void mark(const std::string& name) {
        text((name.starts_with("End") && mode_ != Mode::ascii ? "\n$" : "$") + name + "\n");
    }
    bool is_ascii() const { return mode_ == Mode::ascii; }
    const std::string& bytes() const { return bytes_; }

  private:
    template <class T>
    void put(T value) {
        if (mode_ == Mode::ascii) {
            bytes_ += std::to_string(value) + " ";
            return;
        }
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), &value, sizeof(T));
        if (mode_ == Mode::swapped) std::reverse(raw.begin(), raw.end());
        bytes_.append(raw.data(), raw.size());
    }

    Mode mode_;
    std::string bytes_;
};

/// Descending, with gaps.
int tag_of(std::int64_t node) { return 1000 - 7 * static_cast<int>(node); }

int gmsh_type(CellKind kind) {
    switch (kind) {
        case CellKind::tetrahedron:
            return 4;
        case CellKind::hexahedron:
            return 5;
        case CellKind::wedge:
            return 6;
        case CellKind::pyramid:
            return 7;
    }
    return 0;
}

std::vector<std::int64_t> gmsh_nodes(const MeshData& mesh, std::size_t c) {
    const auto corners = mesh.cell(c);
    std::vector<std::int64_t> nodes(corners.begin(), corners.end());
    if (mesh.kinds[c] == CellKind::wedge) {  // the other triangle's side up
        std::swap(nodes[1], nodes[2]);
        std::swap(nodes[4], nodes[5]);
    }
    return nodes;
}

std::string gmsh_1() {
    const auto mesh = sample_mesh();
    GmshText out(GmshText::Mode::ascii);
    out.text("$NOD\n" + std::to_string(mesh.points.size()) + "\n");
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        out.integer(tag_of(static_cast<std::int64_t>(i)));
        for (const double x : mesh.points[i]) out.real(x);
        out.end_line();
    }
    out.text("$ENDNOD\n$ELM\n" + std::to_string(mesh.num_cells() + 3) + "\n");
    int tag = 1;
    const auto element = [&](int type, int region, const auto& nodes) {
        for (const int value : {tag++, type, region, 77, static_cast<int>(std::size(nodes))})
            out.integer(value);
        for (const auto node : nodes) out.integer(tag_of(node));
        out.end_line();
    };
    element(1, 9, std::array<std::int64_t, 2>{0, 1});
    for (const auto& triangle : sample_triangles) element(2, 9, triangle);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        element(gmsh_type(mesh.kinds[c]), mesh.regions[c], gmsh_nodes(mesh, c));
    out.text("$ENDELM\n");
    return out.bytes();
}

/// Nodes are on points, curves, surfaces and in volumes by turns, with parameters if asked for.
std::string gmsh_2(GmshText::Mode mode, bool is_parametric) {
    const auto mesh = sample_mesh();
    GmshText out(mode);
    out.text("$Comments\nmade by hand; $Nodes are below\n$EndComments\n");
    out.format("2.2");
    out.text("$PhysicalNames\n1\n3 4 \"liver\"\n$EndPhysicalNames\n");
    const std::string section = is_parametric ? "ParametricNodes" : "Nodes";
    out.text("$" + section + "\n" + std::to_string(mesh.points.size()) + "\n");
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        out.integer(tag_of(static_cast<std::int64_t>(i)));
        for (const double x : mesh.points[i]) out.real(x);
        if (is_parametric) {
            const int dimension = static_cast<int>(i) % 4;
            out.integer(dimension);
            out.integer(10);
            for (int k = 0; dimension < 3 && k < dimension; ++k) out.real(0.125);
        }
        out.end_line();
    }
    out.mark("End" + section);
    int tag = 1;
    // In ascii the type precedes the tags of each element; in binary it heads a block.
    const auto block = [&](int type, std::size_t count) {
        if (out.is_ascii()) return;
        out.integer(type);
        out.integer(static_cast<int>(count));
        out.integer(2);
    };
    const auto element = [&](int type, int region, const auto& nodes) {
        out.integer(tag++);
        if (out.is_ascii()) {
            out.integer(type);
            out.integer(2);
        }
        out.integer(region);
        out.integer(77);
        for (const auto node : nodes) out.integer(tag_of(node));
        out.end_line();
    };
    out.text("$Elements\n" + std::to_string(mesh.num_cells() + 3) + "\n");
    block(1, 1);
    element(1, 9, std::array<std::int64_t, 2>{0, 1});
    block(2, 2);
    for (const auto& triangle : sample_triangles) element(2, 9, triangle);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        block(gmsh_type(mesh.kinds[c]), 1);
        element(gmsh_type(mesh.kinds[c]), mesh.regions[c], gmsh_nodes(mesh, c));
    }
    out.mark("EndElements");
    out.text("$NodeData\n1\n\"T\"\n0\n0\n$EndNodeData\n");
    return out.bytes();
}

/// One volume a region, tagged 10 times as high; of a partitioned mesh if asked for.
std::string gmsh_4(GmshText::Mode mode, bool is_partitioned) {
    const auto mesh = sample_mesh();
    GmshText out(mode);
    out.format("4.1");
    out.mark(is_partitioned ? "PartitionedEntities" : "Entities");
    if (is_partitioned) {
        out.size(2);  // partitions
        out.size(1);  // ghost entities
        out.integer(500);
        out.integer(2);
        out.end_line();
    }
    for (const std::size_t count : {1, 1, 1, 3}) out.size(count);
    out.end_line();
    const auto entity = [&](int dimension, int tag, const std::vector<int>& groups) {
        out.integer(tag);
        if (is_partitioned) {
            out.integer(dimension);
            out.integer(1);
            out.size(1);
            out.integer(2);
        }
        for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) out.real(0.5 * i);
        out.size(groups.size());
        for (const int group : groups) out.integer(group);
        if (dimension > 0) {
            out.size(2);
            out.integer(1);
            out.integer(-1);
        }
        out.end_line();
    };
    entity(0, 1, {});
    entity(1, 1, {7});
    entity(2, 10, {8, 9});
    entity(3, 10, {1});
    entity(3, 20, {-2});
    entity(3, 40, {4});
    out.mark(is_partitioned ? "EndPartitionedEntities" : "EndEntities");

    // Nodes in two blocks, the first with parameters.
    const std::size_t num_first = 5;
    out.mark("Nodes");
    for (const std::size_t n :
         {std::size_t{2}, mesh.points.size(), std::size_t{1}, std::size_t{1000}})
        out.size(n);
    out.end_line();
    const auto nodes = [&](int dimension, bool is_parametric, std::size_t begin, std::size_t end) {
        out.integer(dimension);
        out.integer(10);
        out.integer(is_parametric ? 1 : 0);
        out.size(end - begin);
        out.end_line();
        for (std::size_t i = begin; i < end; ++i)
            out.size(static_cast<std::size_t>(tag_of(static_cast<std::int64_t>(i))));
        out.end_line();
        for (std::size_t i = begin; i < end; ++i) {
            for (const double x : mesh.points[i]) out.real(x);
            for (int k = 0; is_parametric && k < dimension; ++k) out.real(0.125);
            out.end_line();
        }
    };
    nodes(2, true, 0, num_first);
    nodes(3, false, num_first, mesh.points.size());
    out.mark("EndNodes");

    out.mark("Elements");
    for (const std::size_t n :
         {mesh.num_cells() + 2, mesh.num_cells() + 3, std::size_t{1}, mesh.num_cells() + 3})
        out.size(n);
    out.end_line();
    std::size_t tag = 1;
    const auto block = [&](int dimension, int entity_tag, int type, std::size_t count) {
        out.integer(dimension);
        out.integer(entity_tag);
        out.integer(type);
        out.size(count);
        out.end_line();
    };
    const auto element = [&](const auto& element_nodes) {
        out.size(tag++);
        for (const auto node : element_nodes) out.size(static_cast<std::size_t>(tag_of(node)));
        out.end_line();
    };
    block(1, 1, 1, 1);
    element(std::array<std::int64_t, 2>{0, 1});
    block(2, 10, 2, 2);
    for (const auto& triangle : sample_triangles) element(triangle);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        block(3, 10 * mesh.regions[c], gmsh_type(mesh.kinds[c]), 1);
        element(gmsh_nodes(mesh, c));
    }
    out.mark("EndElements");
    return out.bytes();
}

}  // namespace

std::vector<Sample> gmsh_samples() {
    using enum GmshText::Mode;
    std::vector<Sample> samples{{"ascii-1.msh", gmsh_1()}};
    for (const auto& [mode, name] :
         {std::pair{ascii, "ascii"}, std::pair{binary, "binary"}, std::pair{swapped, "swapped"}}) {
        samples.push_back({std::string(name) + "-2.msh", gmsh_2(mode, false)});
        samples.push_back({std::string(name) + "-2-parametric.msh", gmsh_2(mode, true)});
        samples.push_back({std::string(name) + "-4.msh", gmsh_4(mode, false)});
        samples.push_back({std::string(name) + "-4-partitioned.msh", gmsh_4(mode, true)});
    }
    return samples;
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
        for (const auto node : gmsh_nodes(mesh, c)) text += std::to_string(node + 1) + " ";
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
        add_row(5 * c + 1, tags(gmsh_nodes(mesh, c)));
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
            element(gmsh_nodes(mesh, c));
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
    const support::TemporaryFolder folder;
    std::ofstream(folder / name, std::ios::binary) << bytes;
    try {
        read_mesh(folder / name, options);
    } catch (const InputError& error) {
        const std::string message = error.what();
        const auto prefix = folder.path().string() + "/";
        EXPECT_TRUE(message.starts_with(prefix + name + ":")) << message;
        return message.substr(std::min(prefix.size(), message.size()));
    }
    ADD_FAILURE() << name << " was not refused";
    return {};
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
