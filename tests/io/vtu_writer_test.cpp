// What is written as .vtu is what VTK reads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/vtu_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/box_mesh.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

using support::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;
using topology::CellKind;

constexpr std::array all_compressions = {Compression::none, Compression::lz4, Compression::zlib,
                                         Compression::lzma};

/// A box, and a wedge and a pyramid beside it, with one field of each type.
Frame make_frame() {
    Frame frame;
    frame.mesh = topology::box_mesh(CellKind::tetrahedron, {0, 0, 0}, {1, 2, 3}, {2, 3, 2});
    const auto hexahedra =
        topology::box_mesh(CellKind::hexahedron, {5, 0, 0}, {1, 1, std::numbers::pi}, {1, 1, 2});
    auto& mesh = frame.mesh;
    const auto first = static_cast<std::int64_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), hexahedra.points.begin(), hexahedra.points.end());
    for (std::size_t c = 0; c < hexahedra.num_cells(); ++c) {
        std::vector<std::int64_t> corners;
        for (const auto corner : hexahedra.cell(c)) corners.push_back(first + corner);
        mesh.add_cell(CellKind::hexahedron, corners, 7);
    }
    mesh.add_cell(CellKind::wedge, std::vector<std::int64_t>{0, 3, 1, 12, 15, 13}, -2);
    mesh.add_cell(CellKind::pyramid, std::vector<std::int64_t>{0, 1, 4, 3, 13}, 3);

    std::vector<double> displacement;
    std::vector<std::int64_t> node_ids;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const auto x = static_cast<double>(i);
        displacement.insert(displacement.end(), {std::sin(x), x / 3, -x});
        node_ids.push_back((std::int64_t{1} << 40) + static_cast<std::int64_t>(i));
    }
    std::vector<float> stress;
    std::vector<std::int32_t> element_ids;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        for (int i = 0; i < 9; ++i) stress.push_back(1.0F / static_cast<float>(9 * c + 1 + i));
        element_ids.push_back(static_cast<std::int32_t>(3 * c));
    }
    frame.point_fields = {{"displacement", 3, displacement}, {"node_id", 1, node_ids}};
    frame.cell_fields = {{"stress", 9, stress}, {"element_id", 1, element_ids}};
    frame.time = 0.1;
    frame.active_vectors = "displacement";
    return frame;
}

vtkSmartPointer<vtkUnstructuredGrid> read_with_vtk(const std::filesystem::path& path) {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    EXPECT_EQ(reader->GetErrorCode(), vtkErrorCode::NoError);
    return reader->GetOutput();
}

void expect_same_field(vtkDataSetAttributes* data, const Field& field) {
    SCOPED_TRACE(field.name);
    auto* array = data->GetArray(field.name.c_str());
    ASSERT_NE(array, nullptr);
    ASSERT_EQ(array->GetNumberOfComponents(), field.components);
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
            EXPECT_EQ(static_cast<std::size_t>(array->GetDataTypeSize()), sizeof(T));
            ASSERT_EQ(static_cast<std::size_t>(array->GetNumberOfValues()), values.size());
            for (std::size_t i = 0; i < values.size(); ++i) {
                const auto value = array->GetVariantValue(static_cast<vtkIdType>(i));
                if constexpr (std::is_integral_v<T>)
                    ASSERT_EQ(value.ToLongLong(), values[i]);
                else
                    ASSERT_EQ(value.ToDouble(), static_cast<double>(values[i]));
            }
        },
        field.values);
}

TEST(VtuWriter, VtkReadsBackTheSameValues) {
    const TemporaryFolder folder;
    const auto frame = make_frame();
    for (const auto compression : all_compressions) {
        SCOPED_TRACE(static_cast<int>(compression));
        write_vtu(folder / "frame.vtu", frame, compression);
        const auto grid = read_with_vtk(folder / "frame.vtu");

        ASSERT_EQ(static_cast<std::size_t>(grid->GetNumberOfPoints()), frame.mesh.points.size());
        for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
            const Vec3 point(grid->GetPoint(i));
            ASSERT_EQ(point, frame.mesh.points[static_cast<std::size_t>(i)]);
        }
        ASSERT_EQ(static_cast<std::size_t>(grid->GetNumberOfCells()), frame.mesh.num_cells());
        constexpr int vtk_types[] = {VTK_TETRA, VTK_HEXAHEDRON, VTK_WEDGE, VTK_PYRAMID};
        vtkNew<vtkIdList> corners;
        for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c) {
            const auto id = static_cast<vtkIdType>(c);
            EXPECT_EQ(grid->GetCellType(id), vtk_types[static_cast<int>(frame.mesh.kinds[c])]);
            grid->GetCellPoints(id, corners);
            const auto expected = frame.mesh.cell(c);
            ASSERT_TRUE(
                std::equal(corners->begin(), corners->end(), expected.begin(), expected.end()));
        }
        for (const auto& field : frame.point_fields) expect_same_field(grid->GetPointData(), field);
        for (const auto& field : frame.cell_fields) expect_same_field(grid->GetCellData(), field);
        expect_same_field(grid->GetCellData(), {"region", 1, frame.mesh.regions});
        EXPECT_EQ(grid->GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0), 0.1);
        ASSERT_NE(grid->GetPointData()->GetVectors(), nullptr);
        EXPECT_STREQ(grid->GetPointData()->GetVectors()->GetName(), "displacement");
    }
}

TEST(VtuWriter, KeepsCarriersAndCutFaces) {
    const TemporaryFolder folder;
    Frame frame = make_frame();
    auto& carriers = frame.mesh.carriers;
    for (int row = 0; row < 400; ++row) {
        auto& corners = carriers.corners.emplace_back();
        for (std::size_t k = 0; k < 4; ++k)
            corners[k] = Vec3(row + 0.1, std::sqrt(2.0 + row), 1e-300 * static_cast<double>(k));
    }
    for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c)
        carriers.of_cell.push_back(c % 3 == 0 ? topology::Carriers::whole
                                              : static_cast<std::int64_t>(c % 400));
    auto& cut_faces = frame.mesh.cut_faces;
    for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c)
        cut_faces.push_back(static_cast<std::int32_t>(c % 16));
    for (const auto compression : all_compressions) {
        write_vtu(folder / "cut.vtu", frame, compression);
        EXPECT_EQ(read_mesh(folder / "cut.vtu").mesh.carriers, carriers);
        EXPECT_EQ(read_mesh(folder / "cut.vtu").mesh.cut_faces, cut_faces);
        const auto grid = read_with_vtk(folder / "cut.vtu");
        auto* field = grid->GetFieldData()->GetArray("carrier_corners");
        ASSERT_NE(field, nullptr);
        EXPECT_EQ(field->GetNumberOfComponents(), 12);
        EXPECT_EQ(field->GetNumberOfTuples(), 400);
    }
    frame.mesh.carriers = {};
    EXPECT_THAT(vtu_text(frame), Not(HasSubstr("carrier")));
    frame.mesh.carriers.of_cell = {0};
    EXPECT_THROW(vtu_text(frame), std::invalid_argument);
    frame.mesh.carriers = {};
    cut_faces = {0};
    EXPECT_THROW(vtu_text(frame), std::invalid_argument);
    frame = make_frame();
    frame.cell_fields.push_back(
        {"region", 1, std::vector<std::int32_t>(frame.mesh.num_cells(), 1)});
    EXPECT_THROW(vtu_text(frame), std::invalid_argument);
}

TEST(VtuWriter, GivesTheSameBytesForTheSameFrame) {
    const auto frame = make_frame();
    for (const auto compression : all_compressions)
        EXPECT_EQ(vtu_text(frame, compression), vtu_text(make_frame(), compression));
}

TEST(VtuWriter, GivesTheSameBytesAfterAnyFile) {
    for (const auto compression : all_compressions) {
        PackedBlocks known;
        auto frame = make_frame();
        for (int i = 0; i < 4; ++i) {
            EXPECT_EQ(vtu_text(frame, compression, &known), vtu_text(frame, compression));
            if (i == 0) frame.mesh.points[1].x() += 0.1;
            if (i == 1) frame.mesh.regions[3] = 12;
        }
    }
}

TEST(PackedBlocks, AreTakenFromThisFileAndTheLast) {
    PackedBlocks blocks;
    int num_packings = 0;
    const auto look_up = [&](std::string_view block) {
        return blocks.packed(block, [&] {
            ++num_packings;
            return "packed " + std::string(block);
        });
    };
    const auto expect = [&](std::string_view block, int packings) {
        EXPECT_EQ(look_up(block), "packed " + std::string(block));
        EXPECT_EQ(num_packings, packings) << block;
    };
    expect("a", 1);
    expect("b", 2);
    expect("a", 2);
    blocks.begin_file();
    expect("a", 2);
    expect("a", 2);
    expect("c", 3);
    blocks.begin_file();
    expect("a", 3);
    expect("b", 4);  // which the last file did not have
}

TEST(VtuWriter, WritesInlineWith32BitIndices) {
    const auto text = vtu_text(make_frame());
    EXPECT_THAT(text, Not(HasSubstr("<AppendedData")));
    EXPECT_THAT(text, HasSubstr("type=\"Int32\" Name=\"connectivity\" format=\"binary\""));
    EXPECT_THAT(text, HasSubstr("compressor=\"vtkZLibDataCompressor\""));
}

TEST(VtuWriter, WritesABodyOfWhichNothingIsLeft) {
    const TemporaryFolder folder;
    Frame frame;
    frame.point_fields = {{"displacement", 3, std::vector<double>{}}};
    frame.cell_fields = {{"J", 1, std::vector<float>{}}};
    frame.time = 1.0;
    frame.active_vectors = "displacement";
    write_vtu(folder / "empty.vtu", frame);
    const auto grid = read_with_vtk(folder / "empty.vtu");
    EXPECT_EQ(grid->GetNumberOfPoints(), 0);
    EXPECT_EQ(grid->GetNumberOfCells(), 0);
}

TEST(VtuWriter, KeepsNumbersThatAreNotFinite) {
    const TemporaryFolder folder;
    auto frame = make_frame();
    std::vector<double> values(frame.mesh.num_cells(), 1.0);
    values[0] = std::numeric_limits<double>::quiet_NaN();
    values[1] = std::numeric_limits<double>::infinity();
    frame.cell_fields = {{"J", 1, values}};
    write_vtu(folder / "frame.vtu", frame);
    const auto grid = read_with_vtk(folder / "frame.vtu");
    auto* array = grid->GetCellData()->GetArray("J");
    EXPECT_TRUE(std::isnan(array->GetComponent(0, 0)));
    EXPECT_TRUE(std::isinf(array->GetComponent(1, 0)));
    EXPECT_EQ(array->GetComponent(2, 0), 1.0);
}

TEST(VtuWriter, RefusesFieldsThatDoNotFitTheMesh) {
    const auto refusal = [](auto spoil) -> std::string {
        auto frame = make_frame();
        spoil(frame);
        try {
            vtu_text(frame);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "none";
    };
    const auto add_cell_field = [&](Field field) {
        return refusal([&](Frame& frame) { frame.cell_fields.push_back(std::move(field)); });
    };
    const auto num_cells = make_frame().mesh.num_cells();
    EXPECT_EQ(refusal([](Frame&) {}), "none");
    EXPECT_THAT(add_cell_field({"J", 1, std::vector<double>(3)}), HasSubstr("has 3 values"));
    EXPECT_THAT(add_cell_field({"stress", 1, std::vector<double>(num_cells)}), HasSubstr("twice"));
    EXPECT_THAT(add_cell_field({"region", 1, std::vector<double>(num_cells)}), HasSubstr("twice"));
    EXPECT_THAT(add_cell_field({"", 1, std::vector<double>(num_cells)}), HasSubstr("no name"));
    EXPECT_THAT(refusal([](Frame& frame) { frame.active_vectors = "node_id"; }),
                HasSubstr("three components"));
    EXPECT_THAT(refusal([](Frame& frame) { frame.mesh.regions.pop_back(); }), HasSubstr("region"));
}

TEST(VtuWriter, SaysThatADiskIsFull) {
    EXPECT_THROW(write_vtu("/dev/full", make_frame()), OutputError);
}

}  // namespace
}  // namespace incise::io
