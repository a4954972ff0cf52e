// What a VTU file means, and what is refused in one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/vtu_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using topology::CellKind;

/// Two tetrahedra in ascii; the arrays are on lines of their own.
const std::string two_tetrahedra = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<UnstructuredGrid>
<Piece NumberOfPoints="5" NumberOfCells="2">
<Points>
<DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1 0 0 0 1 1 1 1
</DataArray>
</Points>
<CellData>
<DataArray type="Int32" Name="region" format="ascii">5 -6</DataArray>
<DataArray type="Float32" Name="tissue" format="ascii">2.0 3e0</DataArray>
<DataArray type="Float32" Name="stiffness" format="ascii">2.0 0.25</DataArray>
<DataArray type="Float32" Name="fibre" NumberOfComponents="3" format="ascii">1 0 0 1 0 0</DataArray>
</CellData>
<PointData></PointData>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 1 2 3 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray>
</Cells>
</Piece>
</UnstructuredGrid>
</VTKFile>
)";

std::string with(std::string_view from, std::string_view to) {
    return replaced(two_tetrahedra, from, to);
}

TEST(VtuReader, TakesTheNamedArrayAsRegions) {
    EXPECT_THAT(read_bytes("a.vtu", two_tetrahedra).mesh.regions, ElementsAre(5, -6));
    EXPECT_THAT(read_bytes("a.vtu", two_tetrahedra, {.region_array = "tissue"}).mesh.regions,
                ElementsAre(2, 3));
    const auto absent = read_bytes("a.vtu", with("\"region\"", "\"part\""));
    EXPECT_THAT(absent.mesh.regions, ElementsAre(0, 0));
    EXPECT_THAT(absent.warnings, ElementsAre());
}

TEST(VtuReader, RefusesAFileWithoutTheRegionsAskedFor) {
    const ReadOptions options{.region_array = "organ"};
    EXPECT_EQ(refusal("a.vtu", two_tetrahedra, options),
              "a.vtu: has no cell array 'organ' to take the regions from; its cell arrays of whole "
              "numbers: 'region'");
    EXPECT_EQ(
        refusal("a.vtu",
                with("</CellData>",
                     "<DataArray type=\"UInt8\" Name=\"part\" format=\"ascii\">1 "
                     "2</DataArray>\n<DataArray type=\"Int8\" Name=\"pair\" "
                     "NumberOfComponents=\"2\" format=\"ascii\">1 2 3 4</DataArray>\n</CellData>"),
                options),
        "a.vtu: has no cell array 'organ' to take the regions from; its cell arrays of whole "
        "numbers: 'region', 'part'");
    const auto bare = with("Int32\" Name=\"region\"", "Float32\" Name=\"density\"");
    EXPECT_EQ(refusal("a.vtu", bare, options),
              "a.vtu: has no cell array 'organ' to take the regions from, nor another of whole "
              "numbers; without a name all regions are 0");
    // An array of the points is none of the cells; a piece without cells needs none.
    EXPECT_THAT(refusal("a.vtu",
                        with("<PointData>",
                             "<PointData><DataArray type=\"Int32\" Name=\"organ\" "
                             "format=\"ascii\">1 2 3 4 5</DataArray>"),
                        options),
                HasSubstr("has no cell array 'organ'"));
    const auto with_empty_piece =
        with("<Piece", "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\n<Piece");
    EXPECT_THAT(read_bytes("a.vtu", with_empty_piece, {.region_array = "tissue"}).mesh.regions,
                ElementsAre(2, 3));
}

TEST(VtuReader, RefusesRegionsThatAreNoWholeNumbers) {
    EXPECT_THAT(refusal("a.vtu", two_tetrahedra, {.region_array = "stiffness"}),
                StartsWith("a.vtu: cell 1: region 0.25 is not a whole number"));
    EXPECT_THAT(refusal("a.vtu", two_tetrahedra, {.region_array = "fibre"}),
                StartsWith("a.vtu:14: array 'fibre': regions need 1 component, this array has 3"));
}

TEST(VtuReader, KeepsTheVectorsAskedFor) {
    const ReadOptions options{.vector_arrays = {"fibre"}};
    EXPECT_TRUE(read_bytes("a.vtu", two_tetrahedra).cell_vectors.empty());
    // A triangle before the tetrahedra has a vector too, and is left out with it.
    auto mixed = with(">1 0 0 1 0 0<", ">9 9 9 1 0 0 0 -2 0.5<");
    mixed = replaced(mixed, "NumberOfCells=\"2\"", "NumberOfCells=\"3\"");
    mixed = replaced(mixed, ">5 -6<", ">0 5 -6<");
    mixed = replaced(mixed, ">0 1 2 3 1 2 3 4<", ">0 1 2 0 1 2 3 1 2 3 4<");
    mixed = replaced(mixed, ">4 8<", ">3 7 11<");
    mixed = replaced(mixed, ">10 10<", ">5 10 10<");
    EXPECT_THAT(read_bytes("a.vtu", mixed, options).cell_vectors.at("fibre"),
                ElementsAre(Vec3(1, 0, 0), Vec3(0, -2, 0.5)));
    EXPECT_EQ(refusal("a.vtu", two_tetrahedra, {.vector_arrays = {"fibers"}}),
              "a.vtu: has no cell array 'fibers' of three components; its cell arrays of three "
              "components: 'fibre'");
    EXPECT_THAT(
        refusal("a.vtu", two_tetrahedra, {.vector_arrays = {"tissue"}}),
        StartsWith("a.vtu:12: array 'tissue': vectors need 3 components, this array has 1"));
    EXPECT_THAT(refusal("a.vtu", with(">1 0 0 1 0 0<", ">1 0 0 1 0<"), options),
                StartsWith("a.vtu:14: array 'fibre'"));
}

TEST(VtuReader, StartsFromTheRestPositionsOfAFrame) {
    const auto file = read_bytes("frame.vtu", with("<PointData>", R"(<PointData>
<DataArray type="Float64" Name="rest_position" NumberOfComponents="3" format="ascii">
0 0 0 2 0 0 0 2 0 0 0 2 2 2 2</DataArray>)"));
    EXPECT_EQ(file.mesh.points[4], Vec3(2, 2, 2));
    const auto scalar = read_bytes("frame.vtu", with("<PointData>", R"(<PointData>
<DataArray type="Float64" Name="rest_position" format="ascii">0 0 0 0 0</DataArray>)"));
    EXPECT_EQ(scalar.mesh.points[4], Vec3(1, 1, 1));
}

/// The same, of which the first cell is a part of a carrier.
std::string cut_tetrahedra() {
    return replaced(
        with("<CellData>\n",
             "<CellData>\n<DataArray type=\"Int64\" Name=\"carrier\" format=\"ascii\">0 "
             "-1</DataArray>\n"),
        "<UnstructuredGrid>\n",
        "<UnstructuredGrid>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"carrier_corners\" "
        "NumberOfComponents=\"12\" NumberOfTuples=\"1\" format=\"ascii\">0 0 -1 1 0 0 0 1 0 0 0 1"
        "</DataArray>\n</FieldData>\n");
}

TEST(VtuReader, TakesTheCarriersOfACutBody) {
    const auto mesh = read_bytes("a.vtu", cut_tetrahedra()).mesh;
    EXPECT_THAT(mesh.carriers.of_cell, ElementsAre(0, -1));
    EXPECT_TRUE(mesh.points_may_coincide);
    EXPECT_THAT(mesh.carriers.corners,
                ElementsAre(topology::CarrierCorners(
                    topology::CellKind::tetrahedron,
                    std::array{Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})));
    // Cells that are left out have no carrier.
    const auto with_triangle =
        read_bytes("a.vtu", replaced(replaced(cut_tetrahedra(), ">10 10<", ">5 10<"),
                                     ">0 1 2 3 1 2 3 4</DataArray>\n<DataArray type=\"Int64\" "
                                     "Name=\"offsets\" format=\"ascii\">4 8<",
                                     ">0 1 2 1 2 3 4</DataArray>\n<DataArray type=\"Int64\" "
                                     "Name=\"offsets\" format=\"ascii\">3 7<"))
            .mesh;
    EXPECT_THAT(with_triangle.carriers.of_cell, ElementsAre(-1));
}

TEST(VtuReader, TakesTheFacesOnCuts) {
    const auto text = [](const char* faces, const char* types = "10 10") {
        return replaced(with("<CellData>\n", std::string("<CellData>\n<DataArray type=\"Int32\" "
                                                         "Name=\"cut_faces\" format=\"ascii\">") +
                                                 faces + "</DataArray>\n"),
                        ">10 10<", std::string(">") + types + "<");
    };
    EXPECT_THAT(read_bytes("a.vtu", text("0 9")).mesh.cut_faces, ElementsAre(0, 9));
    EXPECT_THAT(read_bytes("a.vtu", text("9 0")).mesh.cut_faces, ElementsAre(9, 0));
    EXPECT_TRUE(read_bytes("a.vtu", text("0 0")).mesh.cut_faces.empty());
    EXPECT_THAT(refusal("a.vtu", text("0 5000000000")), HasSubstr("a.vtu: cell 1: the cut_faces"));
    EXPECT_THAT(refusal("a.vtu", text("0 0.5")), HasSubstr("not a whole number"));
}

const std::vector<Fault> carrier_faults = {
    {"\"carrier_corners\"", "\"corners\"",
     "a.vtu:...array 'carrier': the field data has no...leave out both..."},
    {"\"carrier\"", "\"part\"",
     "a.vtu:...array 'carrier_corners': the cell data...leave out both..."},
    {"NumberOfComponents=\"12\"", "NumberOfComponents=\"3\"", "...carriers need 12 components..."},
    {"NumberOfTuples=\"1\"", "NumberOfTuples=\"2\"",
     "...array 'carrier_corners': holds 12 values, expected 24..."},
    {"NumberOfTuples=\"1\"", "", "...NumberOfTuples should be..."},
    {">0 -1<", ">0<", "...array 'carrier': holds 1 values, expected 2..."},
    {">0 -1<", ">0 -1.5<", "...not a whole number..."},
    {"Name=\"carrier\"", "Name=\"carrier\" NumberOfComponents=\"2\"",
     "...carriers need 1 component..."},
    {">0 0 -1 1 0 0", ">0 0 one 1 0 0", "...not a number..."},
};

TEST(VtuReader, PutsPiecesOneBehindTheOther) {
    const auto begin = two_tetrahedra.find("<Piece");
    const auto end = two_tetrahedra.find("</UnstructuredGrid>");
    auto text = two_tetrahedra;
    text.insert(begin, two_tetrahedra.substr(begin, end - begin));
    text.insert(begin, R"(<Piece NumberOfPoints="0" NumberOfCells="0"/>)");
    const auto file = read_bytes("pieces.vtu", text);
    EXPECT_EQ(file.mesh.points.size(), 10u);
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 6, 7, 8, 9));
    EXPECT_THAT(file.mesh.regions, ElementsAre(5, -6, 5, -6));
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("3 pieces")));
    EXPECT_THAT(refusal("pieces.vtu", replaced(text, "1 2 3 4<", "1 2 3 5<")),
                StartsWith("pieces.vtu: piece 1: cell 1: node index 5 is out of range (5 points)"));
}

TEST(VtuReader, ReadsNumbersWithCommentsSignsAndExtremes) {
    const auto file = read_bytes(
        "a.vtu", with("0 0 0 1 0 0", "+0 -0 1e-400 <!-- here --> 1 4.9e-324 <![CDATA[1e308]]>"));
    const auto& points = file.mesh.points;
    EXPECT_EQ(points[0], Vec3(0, 0, 0));
    EXPECT_EQ(points[1], Vec3(1, std::numeric_limits<double>::denorm_min(), 1e308));
}

const std::vector<Fault> vtu_faults = {
    // Index out of range.
    {"1 2 3 4<", "1 2 3 927<", "a.vtu: cell 1: node index 927 is out of range (5 points)"},
    {"1 2 3 4<", "1 2 3 -1<", "a.vtu: cell 1: node index -1 is out of range (5 points)"},
    // Coordinates of cells that are not finite.
    {"0 0 0 1", "0 nan 0 1", "a.vtu: cell 0: its node 0 has a coordinate that is not finite"},
    {"0 0 1 1 1 1\n", "0 0 1 1 -inf 1\n", "...cell 1: its node 4 has..."},
    // Offsets that descend or do not fit.
    {">4 8<", ">8 4<", "a.vtu: cell 1: ends at offset 4, before it begins at 8..."},
    {">4 8<", ">-4 8<", "...cell 0: ends at offset -4..."},
    {">4 8<", ">4 9<", "a.vtu:18: array 'connectivity': holds 8 values, expected 9..."},
    {">4 8<", ">4 7<", "...holds more values, expected 7..."},
    {">4 8<", ">3 8<", "a.vtu: cell 0: a tetrahedron has 4 nodes, this one has 3..."},
    {">4 8<", ">4 9223372036854775807<",
     "...9223372036854775807...more than a file of this size..."},
    // Counts that the arrays do not hold.
    {"NumberOfPoints=\"5\"", "NumberOfPoints=\"2000000000\"",
     "a.vtu:6: array 'Points': holds 15 values, expected 6000000000..."},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"3\"",
     "...array 'types': holds 2 values, expected 3..."},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"-2\"",
     "a.vtu:4: Piece: NumberOfCells should be a whole number from 0 to 2147483647, it is '-2'..."},
    {"NumberOfCells=\"2\"", "", "...NumberOfCells should be a whole number...it is ''..."},
    // Cells of unsupported kinds.
    {">10 10<", ">10 24<",
     "a.vtu: cell 1: a quadratic tetrahedron (VTK cell type 24)...export linear elements..."},
    {">10 10<", ">41 10<", "...cell 0: a convex point set..."},
    {">10 10<", ">42 10<", "...has no 'faceoffsets' array in Cells..."},
    {">10 10<", ">10 99<", "...cell 1: cell type 99..."},
    // Surfaces without volume.
    {">10 10<", ">9 9<", "a.vtu: holds 2 quadrilaterals but no tetrahedra..."},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"0\"", "a.vtu: holds no cells at all..."},
    // Text that is no number.
    {"0 0 0 1", "0 0 zero 1", "a.vtu:6: array 'Points': value 2 is 'zero', not a number..."},
    {"0 0 0 1", "0 0 0x1 1", "...'0x1'..."},
    {"0 0 0 1", "0 0 1,5 1", "...'1,5'..."},
    {"0 0 0 1", "0 0 1e999 1", "...'1e999'..."},
    {"0 1 2 3 1", "0 1 2 3.5 1", "...'3.5', not a whole number..."},
    {">5 -6<", ">5 4294967296<",
     "...cell 1: region 4294967296 is not a whole number of 32 bits..."},
    // Other files of VTK and unknown encodings.
    {"\"UnstructuredGrid\"", "\"PolyData\"",
     "a.vtu: holds a VTK dataset of type 'PolyData', a surface; save it..."},
    {"\"UnstructuredGrid\"", "\"ImageData\"", "...'ImageData', an image; save a segmentation..."},
    {"", "<html></html>", "...no VTKFile element..."},
    {"LittleEndian", "MiddleEndian", "...byte_order of VTKFile is 'MiddleEndian'..."},
    {"header_type=\"UInt64\"", "header_type=\"UInt16\"",
     "...'UInt16'; it must be UInt32 or UInt64..."},
    {"header_type=\"UInt64\"", "compressor=\"vtkZip\"", "...compressor of VTKFile is 'vtkZip'..."},
    {"\"ascii\">\n0 0 0", "\"hex\">\n0 0 0", "...format 'hex'..."},
    {"\"Float64\"", "\"Float128\"", "...type 'Float128'..."},
    {"type=\"Int64\"", "type=\"Float32\"",
     "...array 'connectivity': holds Float32, but must hold whole numbers..."},
    {"Name=\"types\"", "Name=\"kinds\"", "...no 'types' array..."},
    {"NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"",
     "...points need 3 components, this array has 2..."},
    {"</Cells>", "", "a.vtu:2...XML..."},
};

/// A file in which the arrays of the cells stay ascii and the points are `data` in base64.
std::string with_binary_points(const std::string& root_attributes, const std::string& data) {
    auto text = with("header_type=\"UInt64\"", root_attributes);
    text = replaced(text, "format=\"ascii\">\n0 0 0 1 0 0 0 1 0 0 0 1 1 1 1",
                    "format=\"binary\">" + data);
    return text;
}

TEST(VtuReader, TakesRegionsOfEveryTypeOfWholeNumbers) {
    // Base64 of the size, in 64 bits, and the numbers, by Python's struct.
    struct Case {
        const char *type, *data;
        int first, second;
    };
    for (const auto& [type, data, first, second] : std::initializer_list<Case>{
             {"Int8", "AgAAAAAAAAD+ZA==", -2, 100},
             {"UInt8", "AgAAAAAAAADIBw==", 200, 7},
             {"Int16", "BAAAAAAAAADU/gUA", -300, 5},
             {"UInt16", "BAAAAAAAAABg6gEA", 60000, 1},
             {"Int32", "CAAAAAAAAACQ7v7/cBEBAA==", -70000, 70000},
             {"UInt32", "CAAAAAAAAACghgEAAgAAAA==", 100000, 2},
             {"Int64", "EAAAAAAAAAD7/////////wYAAAAAAAAA", -5, 6},
             {"UInt64", "EAAAAAAAAAAHAAAAAAAAAAgAAAAAAAAA", 7, 8},
         }) {
        SCOPED_TRACE(type);
        const std::string array = std::string("type=\"") + type + "\" Name=\"region\" format=";
        EXPECT_THAT(read_bytes("a.vtu", with("type=\"Int32\" Name=\"region\" format=\"ascii\">5 -6",
                                             array + "\"binary\">" + data))
                        .mesh.regions,
                    ElementsAre(first, second));
    }
}

/// In place of the base64 of 15 doubles, which are 120 bytes. The first four bytes claim other
/// sizes.
const std::vector<Fault> binary_faults = {
    {"DATA", "gAAAAA==", "...array 'Points': holds 128 bytes, expected 120..."},
    {"DATA", "eAAAAAAAAA==", "...array 'Points': ends before 120 bytes..."},
    {"DATA", "eA!AAA==", "...array 'Points': is not sound base64..."},
    {"DATA", "", "...ends before 4 bytes..."},
};

/// The same of packed data. Three words: blocks, size of each, size of the last.
const std::vector<Fault> block_faults = {
    // 0xFFFFFFFF blocks of 1 byte.
    {"DATA", "/////wEAAAABAAAA",
     "...has 4294967295 blocks of 1 bytes, the last of 1; they should make 120..."},
    // One block of 120 bytes, packed in 0xFFFFFFFF bytes.
    {"DATA", "AQAAAHgAAAAAAAAA/////w==", "...block 0 has 4294967295 bytes, more than the file..."},
    // One block of 120 bytes, packed in 3 bytes of nonsense.
    {"DATA", "AQAAAHgAAAAAAAAAAwAAAA==AAAA", "...block 0 does not unpack to its 120 bytes..."},
};

TEST(VtuReader, RefusesFaultyFiles) {
    expect_refusals("a.vtu", two_tetrahedra, vtu_faults);
    expect_refusals("a.vtu", cut_tetrahedra(), carrier_faults);
    expect_refusals("a.vtu", with_binary_points("", "DATA"), binary_faults);
    const std::string zlib = "compressor=\"vtkZLibDataCompressor\"";
    expect_refusals("a.vtu", with_binary_points(zlib, "DATA"), block_faults);
    // 2000000000 points in one block of 3 packed bytes: refused before memory is asked for.
    expect_refusals(
        "a.vtu", with_binary_points(zlib, "AQAAAACwjvAAAAAAAwAAAA==AAAA"),
        {{"NumberOfPoints=\"5\"", "NumberOfPoints=\"168180394\"", "...array 'Points': ..."}});
}

TEST(VtuReader, StepsOverCommentsThatSpeakOfAppendedData) {
    for (const auto& sample : vtu_samples()) {
        SCOPED_TRACE(sample.name);
        const auto commented = replaced(sample.bytes, "<UnstructuredGrid",
                                        "<!-- no <AppendedData here> --><UnstructuredGrid");
        expect_same_mesh(read_bytes("a.vtu", commented).mesh, sample_mesh());
    }
}

TEST(VtuReader, RefusesAppendedDataOutsideTheFile) {
    for (const auto& sample : vtu_samples()) {
        if (!sample.name.starts_with("raw-")) continue;
        SCOPED_TRACE(sample.name);
        auto far = sample.bytes;
        const std::string attribute = "offset=\"";
        for (auto at = far.find(attribute); at != far.npos; at = far.find(attribute, at + 1))
            far.replace(at, attribute.size(), attribute + "18446744073709550000");
        const auto message = refusal("a.vtu", far);
        EXPECT_THAT(message, HasSubstr("is outside the appended data"));
    }
}

}  // namespace
}  // namespace incise::io
