// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/vtu_writer.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <limits>
#include <new>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

#include "incise/io/files/atomic_file.h"
#include "incise/io/vtk/throwing_vtk.h"
#include "incise/io/vtk/vtk_cells.h"

namespace incise::io {

namespace {

using topology::CellKind;
using topology::MeshData;

static_assert(vtk_cell_type(CellKind::tetrahedron) == VTK_TETRA &&
              vtk_cell_type(CellKind::hexahedron) == VTK_HEXAHEDRON &&
              vtk_cell_type(CellKind::wedge) == VTK_WEDGE &&
              vtk_cell_type(CellKind::pyramid) == VTK_PYRAMID &&
              vtk_cell_type(CellKind::polyhedron) == VTK_POLYHEDRON);

/// Returns a VTK array that shares the memory of `values` and only reads it.
/// @lifetime  the values must outlive the array
template <class T>
vtkSmartPointer<vtkAOSDataArrayTemplate<T>> view_as_array(std::span<const T> values,
                                                          int components) {
    constexpr int memory_stays_ours = 1;
    auto array = vtkSmartPointer<vtkAOSDataArrayTemplate<T>>::New();
    array->SetNumberOfComponents(components);
    array->SetArray(const_cast<T*>(values.data()), static_cast<vtkIdType>(values.size()),
                    memory_stays_ours);
    return array;
}

template <class Array>
vtkSmartPointer<Array> copy_as_array(const auto& values) {
    auto array = vtkSmartPointer<Array>::New();
    if (!array->SetNumberOfValues(static_cast<vtkIdType>(values.size()))) throw std::bad_alloc();
    std::transform(values.begin(), values.end(), array->GetPointer(0),
                   [](auto value) { return static_cast<typename Array::ValueType>(value); });
    return array;
}

template <class IndexArray>
void set_cells(vtkUnstructuredGrid& grid, const MeshData& mesh) {
    std::vector<int> types(mesh.num_cells());
    std::transform(mesh.kinds.begin(), mesh.kinds.end(), types.begin(), vtk_cell_type);
    vtkNew<vtkCellArray> cells;
    cells->SetData(copy_as_array<IndexArray>(mesh.offsets),
                   copy_as_array<IndexArray>(mesh.corners));
    const auto all_types = copy_as_array<vtkUnsignedCharArray>(types);
    if (mesh.faces.empty()) {
        grid.SetCells(all_types, cells);
        return;
    }
    std::vector<std::int64_t> places(mesh.num_cells(), -1);
    mesh.for_each_polyhedron([&](std::size_t cell, std::size_t first) {
        places[cell] = static_cast<std::int64_t>(first);
    });
    grid.SetCells(all_types, cells, copy_as_array<vtkIdTypeArray>(places),
                  copy_as_array<vtkIdTypeArray>(mesh.faces));
}

void add_fields(vtkFieldData& data, std::span<const Field> fields, std::size_t num_tuples,
                const char* location) {
    std::set<std::string> names;
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) names.insert(data.GetArrayName(i));
    for (const auto& field : fields) {
        const auto fail = [&](const std::string& why) {
            throw std::invalid_argument(std::string(location) + " field '" + field.name + "' " +
                                        why);
        };
        if (field.name.empty()) fail("has no name");
        if (!names.insert(field.name).second) fail("is there twice");
        if (field.components < 1) fail("has no components");
        const auto expected = num_tuples * static_cast<std::size_t>(field.components);
        if (field.size() != expected)
            fail("has " + std::to_string(field.size()) + " values, not " +
                 std::to_string(expected));
        std::visit(
            [&]<class T>(const std::vector<T>& values) {
                const auto array = view_as_array<T>(values, field.components);
                array->SetName(field.name.c_str());
                data.AddArray(array);
            },
            field.values);
    }
}

void set_active_vectors(vtkPointData& data, const std::string& name) {
    if (name.empty()) return;
    const auto* array = data.GetArray(name.c_str());
    if (!array || const_cast<vtkDataArray*>(array)->GetNumberOfComponents() != 3)
        throw std::invalid_argument("active vectors '" + name +
                                    "' are no point field of three components");
    data.SetActiveVectors(name.c_str());
}

void add_carriers(vtkUnstructuredGrid& grid, const MeshData& mesh) {
    const topology::Carriers& carriers = mesh.carriers;
    if (carriers.of_cell.size() != mesh.num_cells())
        throw std::invalid_argument("there are carriers for " +
                                    std::to_string(carriers.of_cell.size()) + " cells, not " +
                                    std::to_string(mesh.num_cells()));
    const auto of_cell = view_as_array<std::int64_t>(carriers.of_cell, 1);
    of_cell->SetName(carrier_array);
    grid.GetCellData()->AddArray(of_cell);
    const bool are_tetrahedra = std::ranges::all_of(carriers.corners, [](const auto& corners) {
        return corners.kind() == CellKind::tetrahedron;
    });
    const std::size_t size = are_tetrahedra ? 4 : topology::max_corners;
    std::vector<double> coordinates;
    coordinates.reserve(3 * size * carriers.corners.size());
    for (const auto& corners : carriers.corners) {
        for (const Vec3& x : corners) coordinates.insert(coordinates.end(), x.begin(), x.end());
        coordinates.resize(coordinates.size() + 3 * (size - corners.size()));
    }
    const auto corners = copy_as_array<vtkDoubleArray>(coordinates);
    corners->SetNumberOfComponents(static_cast<int>(3 * size));
    corners->SetName(carrier_corners_array);
    grid.GetFieldData()->AddArray(corners);
    if (are_tetrahedra) return;
    std::vector<int> types;
    for (const auto& of_row : carriers.corners) types.push_back(vtk_cell_type(of_row.kind()));
    const auto type_of_row = copy_as_array<vtkTypeInt32Array>(types);
    type_of_row->SetName(carrier_types_array);
    grid.GetFieldData()->AddArray(type_of_row);
    std::vector<int> diagonals;
    for (const auto& of_row : carriers.corners) diagonals.push_back(of_row.diagonals.bits());
    if (std::ranges::all_of(diagonals, [](int bits) { return bits == 0; })) return;
    const auto diagonals_of_row = copy_as_array<vtkTypeInt32Array>(diagonals);
    diagonals_of_row->SetName(carrier_diagonals_array);
    grid.GetFieldData()->AddArray(diagonals_of_row);
}

void add_cut_faces(vtkUnstructuredGrid& grid, const MeshData& mesh) {
    for (std::size_t k = 0; k <= mesh.further_cut_faces.size(); ++k) {
        const auto& faces = k == 0 ? mesh.cut_faces : mesh.further_cut_faces[k - 1];
        if (faces.empty()) continue;
        if (faces.size() != mesh.num_cells())
            throw std::invalid_argument("there are " + cut_faces_array(k) + " for " +
                                        std::to_string(faces.size()) + " cells, not " +
                                        std::to_string(mesh.num_cells()));
        const auto cut_faces = view_as_array<std::int32_t>(faces, 1);
        cut_faces->SetName(cut_faces_array(k).c_str());
        grid.GetCellData()->AddArray(cut_faces);
    }
}

vtkSmartPointer<vtkUnstructuredGrid> view_as_grid(const Frame& frame) {
    const auto& mesh = frame.mesh;
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();

    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    const auto* coordinates = mesh.points.empty() ? nullptr : mesh.points.front().data();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetData(view_as_array<double>({coordinates, 3 * mesh.points.size()}, 3));
    grid->SetPoints(points);

    // With 32 bits the file is a fifth smaller.
    const auto largest = std::max(mesh.points.size(), mesh.corners.size());
    if (largest <= std::numeric_limits<std::int32_t>::max())
        set_cells<vtkTypeInt32Array>(*grid, mesh);
    else
        set_cells<vtkTypeInt64Array>(*grid, mesh);

    if (mesh.regions.size() != mesh.num_cells())
        throw std::invalid_argument("a mesh needs one region a cell");
    const auto regions = view_as_array<std::int32_t>(mesh.regions, 1);
    regions->SetName("region");
    grid->GetCellData()->AddArray(regions);

    if (!mesh.carriers.is_empty()) add_carriers(*grid, mesh);
    add_cut_faces(*grid, mesh);
    add_fields(*grid->GetPointData(), frame.point_fields, mesh.points.size(), "point");
    add_fields(*grid->GetCellData(), frame.cell_fields, mesh.num_cells(), "cell");
    set_active_vectors(*grid->GetPointData(), frame.active_vectors);

    for (const Field& field : frame.field_data) {
        const auto components = static_cast<std::size_t>(field.components);
        add_fields(*grid->GetFieldData(), {&field, 1}, field.size() / components, "field data");
    }

    if (frame.time) {
        vtkNew<vtkDoubleArray> time;
        time->SetName("TimeValue");
        time->InsertNextValue(*frame.time);
        grid->GetFieldData()->AddArray(time);
    }
    return grid;
}

vtkSmartPointer<vtkDataCompressor> make_compressor(Compression compression, PackedBlocks* known) {
    constexpr int fastest = 1, middle = 5;
    switch (compression) {
        case Compression::none:
            break;
        case Compression::lz4:
            return ThrowingCompressor<vtkLZ4DataCompressor>::make(middle,
                                                                  known);  // fast at any level
        case Compression::zlib:
            return ThrowingCompressor<FastZlibCompressor>::make(fastest, known);
        case Compression::lzma:
            return ThrowingCompressor<vtkLZMADataCompressor>::make(fastest, known);
    }
    return nullptr;
}

/// Returns the text without the InformationKey elements (ranges of norms). They are not needed, and
/// VTK writes their numbers in the locale of the process.
std::string without_notes(std::string_view text) {
    constexpr std::string_view end_mark = "</InformationKey>";
    std::string result;
    result.reserve(text.size());
    while (true) {
        const auto begin = text.find("<InformationKey");
        result += text.substr(0, begin);
        if (begin == text.npos) return result;
        result.erase(result.find_last_not_of(" \n") + 1);
        text.remove_prefix(text.find(end_mark, begin) + end_mark.size());
    }
}

}  // namespace

std::string vtu_text(const Frame& frame, Compression compression, PackedBlocks* known) {
    const SilentVtk silence;
    const SequentialVtk on_this_thread;
    if (known) known->begin_file();
    const auto grid = view_as_grid(frame);
    const auto writer = ThrowingGridWriter::make();
    writer->SetInputData(grid);
    writer->SetDataModeToBinary();
    writer->SetHeaderTypeToUInt64();  // uncompressed arrays may exceed 4 GB
    writer->SetCompressor(make_compressor(compression, known));
    writer->WriteToOutputStringOn();
    if (writer->Write() != 1 || writer->GetErrorCode() != vtkErrorCode::NoError)
        throw std::runtime_error(std::string("VTK cannot make a .vtu file: ") +
                                 vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
    return without_notes(writer->GetOutputString());
}

void write_vtu(const std::filesystem::path& path, const Frame& frame, Compression compression) {
    write_file(path, vtu_text(frame, compression));
}

}  // namespace incise::io
