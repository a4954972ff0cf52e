// Cells of second and higher order: refused, or read by their corners if asked for.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tests/io/reader_samples.h"

namespace incise::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using topology::CellKind;

const ReadOptions linear{.linear = true};

/// A kind of cell as a format has it: a word or number for it, and how many nodes it has.
struct Form {
    std::string code;
    std::size_t num_nodes;
};
/// In the order of the cells of sample_mesh(): wedge, hexahedron, pyramid, tetrahedron.
using Forms = std::array<Form, 4>;

/// The sample mesh with further nodes in each cell. They are before all corners in the file.
struct HigherOrderMesh {
    std::vector<Vec3> points;
    std::vector<std::vector<std::int64_t>> cells;
    std::size_t num_more = 0;
};
HigherOrderMesh with_nodes(const Forms& forms, bool has_wedges_inwards) {
    const auto sample = sample_mesh();
    HigherOrderMesh mesh;
    for (std::size_t c = 0; c < forms.size(); ++c)
        mesh.num_more += forms[c].num_nodes - sample.cell(c).size();
    for (std::size_t i = 0; i < mesh.num_more; ++i)
        mesh.points.emplace_back(7, 7, static_cast<double>(i));
    std::int64_t next = 0;
    for (std::size_t c = 0; c < forms.size(); ++c) {
        std::vector<std::int64_t> nodes;
        for (const auto corner : sample.cell(c))
            nodes.push_back(corner + static_cast<std::int64_t>(mesh.num_more));
        if (has_wedges_inwards && sample.kinds[c] == CellKind::wedge) {
            std::swap(nodes[1], nodes[2]);
            std::swap(nodes[4], nodes[5]);
        }
        while (nodes.size() < forms[c].num_nodes) nodes.push_back(next++);
        mesh.cells.push_back(nodes);
    }
    mesh.points.insert(mesh.points.end(), sample.points.begin(), sample.points.end());
    return mesh;
}

std::string row(const auto& numbers, const std::string& separator, std::int64_t shift = 0) {
    std::string text;
    for (const auto number : numbers)
        text += (text.empty() ? "" : separator) +
                std::to_string(number + static_cast<std::decay_t<decltype(number)>>(shift));
    return text;
}

std::string gmsh_text_of(const Forms& forms) {
    const auto mesh = with_nodes(forms, true);
    std::string text =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(mesh.points.size());
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        text += "\n" + std::to_string(i + 1) + " " + row(mesh.points[i], " ");
    text += "\n$EndNodes\n$Elements\n4";
    for (std::size_t c = 0; c < 4; ++c)
        text += "\n" + std::to_string(c + 1) + " " + forms[c].code + " 2 " +
                std::to_string(sample_mesh().regions[c]) + " 1 " + row(mesh.cells[c], " ", 1);
    return text + "\n$EndElements\n";
}

std::string vtk_text_of(const Forms& forms) {
    const auto mesh = with_nodes(forms, false);
    std::string text =
        "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
        std::to_string(mesh.points.size()) + " double\n";
    for (const auto& point : mesh.points) text += row(point, " ") + "\n";
    std::size_t size = 0;
    std::string cells, types;
    for (std::size_t c = 0; c < 4; ++c) {
        size += 1 + mesh.cells[c].size();
        cells += std::to_string(mesh.cells[c].size()) + " " + row(mesh.cells[c], " ") + "\n";
        types += forms[c].code + "\n";
    }
    return text + "CELLS 4 " + std::to_string(size) + "\n" + cells + "CELL_TYPES 4\n" + types +
           "CELL_DATA 4\nSCALARS region int\nLOOKUP_TABLE default\n" +
           row(sample_mesh().regions, "\n") + "\n";
}

std::string vtu_text_of(const Forms& forms) {
    const auto mesh = with_nodes(forms, false);
    const auto array = [](const std::string& attributes, const std::string& values) {
        return "<DataArray " + attributes + " format=\"ascii\">" + values + "</DataArray>\n";
    };
    std::string points, connectivity, offsets, types;
    std::size_t end = 0;
    for (const auto& point : mesh.points) points += row(point, " ") + " ";
    for (std::size_t c = 0; c < 4; ++c) {
        connectivity += row(mesh.cells[c], " ") + " ";
        offsets += std::to_string(end += mesh.cells[c].size()) + " ";
        types += forms[c].code + " ";
    }
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
           std::to_string(mesh.points.size()) + "\" NumberOfCells=\"4\">\n<Points>" +
           array("type=\"Float64\" NumberOfComponents=\"3\"", points) + "</Points><Cells>" +
           array("type=\"Int64\" Name=\"connectivity\"", connectivity) +
           array("type=\"Int64\" Name=\"offsets\"", offsets) +
           array("type=\"UInt8\" Name=\"types\"", types) + "</Cells><CellData>" +
           array("type=\"Int32\" Name=\"region\"", row(sample_mesh().regions, " ")) +
           "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
}

std::string abaqus_text_of(const Forms& forms) {
    const auto mesh = with_nodes(forms, true);
    std::string text = "*NODE\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        text += std::to_string(i + 1) + ", " + row(mesh.points[i], ", ") + "\n";
    for (std::size_t c = 0; c < 4; ++c)
        text += "*ELEMENT, TYPE=" + forms[c].code + ", ELSET=REGION_" +
                std::to_string(sample_mesh().regions[c]) + "\n" + std::to_string(c + 1) + ", " +
                row(mesh.cells[c], ",\n", 1) + "\n";
    return text;
}

std::string medit_text_of(const Forms& forms) {
    const auto mesh = with_nodes(forms, true);
    std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n" +
                       std::to_string(mesh.points.size()) + "\n";
    for (const auto& point : mesh.points) text += row(point, " ") + " 0\n";
    for (std::size_t c = 0; c < 4; ++c)
        text += forms[c].code + "\n1\n" + row(mesh.cells[c], " ", 1) + " " +
                std::to_string(sample_mesh().regions[c]) + "\n";
    return text + "End\n";
}

std::string febio_text_of(const Forms& forms) {
    const auto mesh = with_nodes(forms, true);
    std::string text = "<febio_spec version=\"4.0\"><Mesh><Nodes>\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        text +=
            "<node id=\"" + std::to_string(i + 1) + "\">" + row(mesh.points[i], ",") + "</node>\n";
    text += "</Nodes>\n";
    for (std::size_t c = 0; c < 4; ++c)
        text += "<Elements type=\"" + forms[c].code + "\" name=\"REGION_" +
                std::to_string(sample_mesh().regions[c]) + "\">\n<elem id=\"" +
                std::to_string(c + 1) + "\">" + row(mesh.cells[c], ",", 1) +
                "</elem>\n</Elements>\n";
    return text + "</Mesh></febio_spec>\n";
}

struct Case {
    const char* name;
    std::function<std::string(const Forms&)> text;
    Forms forms;
};

const std::vector<Case> cases = {
    {"a.msh", gmsh_text_of, {{{"18", 15}, {"17", 20}, {"19", 13}, {"11", 10}}}},
    {"b.msh", gmsh_text_of, {{{"13", 18}, {"12", 27}, {"14", 14}, {"29", 20}}}},
    {"c.msh", gmsh_text_of, {{{"18", 15}, {"93", 125}, {"19", 13}, {"31", 56}}}},
    {"a.vtk", vtk_text_of, {{{"26", 15}, {"25", 20}, {"27", 13}, {"24", 10}}}},
    {"b.vtk", vtk_text_of, {{{"32", 18}, {"29", 27}, {"37", 19}, {"24", 10}}}},
    {"c.vtk", vtk_text_of, {{{"31", 12}, {"33", 24}, {"27", 13}, {"71", 20}}}},
    {"a.vtu", vtu_text_of, {{{"26", 15}, {"25", 20}, {"27", 13}, {"24", 10}}}},
    {"b.vtu", vtu_text_of, {{{"73", 18}, {"72", 27}, {"74", 14}, {"71", 10}}}},
    {"c.vtu", vtu_text_of, {{{"80", 40}, {"79", 64}, {"81", 30}, {"78", 20}}}},
    {"a.inp", abaqus_text_of, {{{"C3D15", 15}, {"C3D20R", 20}, {"C3D13", 13}, {"C3D10M", 10}}}},
    {"b.inp", abaqus_text_of, {{{"C3D15V", 15}, {"C3D27", 27}, {"C3D13", 13}, {"C3D10", 10}}}},
    {"a.feb", febio_text_of, {{{"penta15", 15}, {"HEX20", 20}, {"pyra13", 13}, {"tet10g8", 10}}}},
    {"b.feb", febio_text_of, {{{"penta15", 15}, {"hex27", 27}, {"pyra13", 13}, {"tet5", 5}}}},
    {"a.mesh",
     medit_text_of,
     {{{"PrismsP2", 18}, {"HexahedraQ2", 27}, {"PyramidsP2", 14}, {"TetrahedraP2", 10}}}},
};

TEST(HigherOrder, IsReadByItsCornersIfAskedFor) {
    for (const auto& [name, text, forms] : cases) {
        SCOPED_TRACE(name);
        const auto file = read_bytes(name, text(forms), linear);
        const auto num_more = with_nodes(forms, false).num_more;
        expect_same_mesh(file.mesh, sample_mesh());
        EXPECT_THAT(file.warnings,
                    ElementsAre(AllOf(HasSubstr("read 1 "), HasSubstr("by the corners alone"),
                                      HasSubstr("; " + std::to_string(num_more) +
                                                " nodes that are no corners were left out"))));
        const auto first =
            std::string(name).ends_with(".vtk") || std::string(name).ends_with(".vtu")
                ? num_more
                : num_more + 1;
        EXPECT_EQ(file.mesh.point_name(0),
                  "point 0 (number " + std::to_string(first) + " in the file)");
    }
}

TEST(HigherOrder, IsRefusedUnlessAskedFor) {
    for (const auto& [name, text, forms] : cases) {
        SCOPED_TRACE(name);
        EXPECT_THAT(refusal(name, text(forms)),
                    AllOf(HasSubstr(": a "), HasSubstr("cannot be used; export linear elements"),
                          HasSubstr(", or read them by their corners with ReadOptions::linear")));
        EXPECT_THAT(refusal(name, text(forms), {.linear_advice = "say please"}),
                    HasSubstr("pyramids), or say please"));
    }
}

TEST(HigherOrder, ChangesNothingWhereThereIsNone) {
    for (const auto& sample : all_samples()) {
        SCOPED_TRACE(sample.name);
        const auto file = read_bytes(sample.name, sample.bytes, linear);
        expect_same_mesh(file.mesh, sample_mesh());
        EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("ignored 1 line and 2 triangles")));
    }
}

TEST(HigherOrder, KeepsNodesThatAreCornersOfOtherCells) {
    // Node 5 is a mid-side node of the first element and a corner of the second. Node 12 belongs to
    // no element.
    const auto file = read_bytes("a.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
12
1 0 0 0
2 2 0 0
3 0 2 0
4 0 0 2
5 1 0 0
6 1 1 0
7 0 1 0
8 0 0 1
9 0 1 1
10 1 0 1
11 1 0 -1
12 9 9 9
$EndNodes
$Elements
3
1 11 0 1 2 3 4 5 6 7 8 9 10
2 4 0 1 5 11 3
3 11 0 1 2 3 4 5 6 7 8 9 10
$EndElements
)",
                                 linear);
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 0, 4, 5, 2, 0, 1, 2, 3));
    EXPECT_THAT(file.mesh.source_points, ElementsAre(1, 2, 3, 4, 5, 11, 12));
    EXPECT_THAT(file.warnings,
                ElementsAre("read 2 second-order tetrahedra by the corners alone, as linear; 5 "
                            "nodes that are no corners were left out"));
}

TEST(HigherOrder, StaysRefusedWhereTheCornersAreNotKnown) {
    Forms forms = {{{"26", 15}, {"25", 20}, {"27", 13}, {"41", 10}}};
    EXPECT_THAT(refusal("a.vtu", vtu_text_of(forms), linear),
                StartsWith("a.vtu: cell 3: a convex point set (VTK cell type 41) cannot be used"));
    forms[0] = {"72", 6};
    EXPECT_EQ(refusal("a.vtu", vtu_text_of(forms), linear),
              "a.vtu: cell 0: a Lagrange hexahedron has at least 8 nodes, this one has 6");
    forms[0] = {"26", 14};
    EXPECT_EQ(refusal("a.vtu", vtu_text_of(forms), linear),
              "a.vtu: cell 0: a quadratic wedge has 15 nodes, this one has 14");
}

TEST(HigherOrder, StillNeedsNodesThatExist) {
    const auto text = gmsh_text_of(cases[0].forms);
    EXPECT_THAT(refusal("a.msh", replaced(text, "4 11 2 1 1 ", "4 11 2 1 1 999 "), linear),
                HasSubstr("element 4: node tag 999 is not one of the"));
}

}  // namespace
}  // namespace incise::io
