// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/tissue_look.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "incise/topology/cell_kind.h"
#include "incise/topology/mesh_data.h"

namespace incise::render {

namespace {

using Tone = std::array<unsigned char, 3>;

// Muted, as tissue is; all are well apart from the red of a cut.
constexpr std::array<Tone, 6> tissues = {{{204, 138, 122},
                                          {222, 196, 150},
                                          {150, 120, 140},
                                          {176, 160, 112},
                                          {140, 150, 160},
                                          {230, 214, 200}}};
constexpr Tone of_cut = {158, 30, 36};

std::optional<topology::CellKind> kind_of(int vtk_type) {
    switch (vtk_type) {
        case VTK_TETRA:
            return topology::CellKind::tetrahedron;
        case VTK_HEXAHEDRON:
            return topology::CellKind::hexahedron;
        case VTK_WEDGE:
            return topology::CellKind::wedge;
        case VTK_PYRAMID:
            return topology::CellKind::pyramid;
        default:
            return std::nullopt;
    }
}

/// The bits of a cell in the arrays cut_faces, cut_faces_31, ...
class CutFaces {
  public:
    explicit CutFaces(vtkUnstructuredGrid& grid) {
        vtkDataArray* array = nullptr;
        const auto name = [&] {
            const std::size_t first = arrays_.size() * topology::max_cut_faces;
            return "cut_faces" + (first == 0 ? "" : "_" + std::to_string(first));
        };
        while ((array = grid.GetCellData()->GetArray(name().c_str())) != nullptr)
            arrays_.push_back(array);
    }
    bool has(vtkIdType cell, int face) const {
        const auto list = static_cast<std::size_t>(face / topology::max_cut_faces);
        return list < arrays_.size() && (static_cast<int>(arrays_[list]->GetComponent(cell, 0)) >>
                                             face % topology::max_cut_faces &
                                         1) != 0;
    }

  private:
    std::vector<vtkDataArray*> arrays_;
};

/// As is_cut(), for a polyhedron. A polygon may be a part of a face.
bool is_cut_of_polyhedron(vtkUnstructuredGrid& grid, vtkIdType cell, const CutFaces& cut_faces,
                          const std::vector<vtkIdType>& polygon) {
    vtkNew<vtkIdList> stream;
    grid.GetFaceStream(cell, stream);
    vtkIdType at = 0;
    const vtkIdType count = stream->GetId(at++);
    std::vector<vtkIdType> face;
    for (int f = 0; f < count; ++f) {
        face.clear();
        for (vtkIdType left = stream->GetId(at++); left > 0; --left)
            face.push_back(stream->GetId(at++));
        std::sort(face.begin(), face.end());
        if (cut_faces.has(cell, f) && std::ranges::includes(face, polygon)) return true;
    }
    return false;
}

/// True if a polygon, of these points in ascending order, is a face of the cell that `cut_faces`
/// has.
bool is_cut(vtkUnstructuredGrid& grid, vtkIdType cell, const CutFaces& cut_faces,
            const std::vector<vtkIdType>& polygon) {
    if (grid.GetCellType(cell) == VTK_POLYHEDRON)
        return is_cut_of_polyhedron(grid, cell, cut_faces, polygon);
    const auto kind = kind_of(grid.GetCellType(cell));
    if (!kind) return false;
    vtkNew<vtkIdList> corners;
    grid.GetCellPoints(cell, corners);
    const topology::CellTraits& traits = topology::traits(*kind);
    std::vector<vtkIdType> face;
    for (int f = 0; f < traits.num_faces; ++f) {
        if (!cut_faces.has(cell, f)) continue;
        face.clear();
        for (const int corner : traits.face(f)) face.push_back(corners->GetId(corner));
        std::sort(face.begin(), face.end());
        if (face == polygon) return true;
    }
    return false;
}

/// The tones of the regions of a frame.
class Tones {
  public:
    explicit Tones(vtkUnstructuredGrid& grid) {
        auto* regions = grid.GetCellData()->GetArray("region");
        if (!regions) return;
        for (vtkIdType i = 0; i < regions->GetNumberOfTuples(); ++i)
            numbers_.emplace(regions->GetComponent(i, 0), 0);
        std::size_t count = 0;
        for (auto& [region, number] : numbers_) number = count++;
    }
    /// `regions` may be null: the body then has one tone.
    const Tone& of(vtkDataArray* regions, vtkIdType cell) const {
        const std::size_t number = regions ? numbers_.at(regions->GetComponent(cell, 0)) : 0;
        return tissues[number % tissues.size()];
    }

  private:
    std::map<double, std::size_t> numbers_;
};

vtkSmartPointer<vtkUnsignedCharArray> colors_for(vtkPolyData& surface) {
    auto colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
    colors->SetName(look_array);
    colors->SetNumberOfComponents(3);
    colors->SetNumberOfTuples(surface.GetNumberOfCells());
    return colors;
}

}  // namespace

void add_section_look(vtkUnstructuredGrid& grid, vtkPolyData& section) {
    const Tones tones(grid);
    auto* regions = section.GetCellData()->GetArray("region");
    const auto colors = colors_for(section);
    for (vtkIdType i = 0; i < section.GetNumberOfCells(); ++i) {
        Tone pale = tones.of(regions, i);
        for (unsigned char& part : pale) part = static_cast<unsigned char>((part + 255) / 2);
        colors->SetTypedTuple(i, pale.data());
    }
    section.GetCellData()->AddArray(colors);
}

void add_tissue_look(vtkUnstructuredGrid& grid, vtkPolyData& surface) {
    auto* cells =
        vtkIdTypeArray::SafeDownCast(surface.GetCellData()->GetArray("vtkOriginalCellIds"));
    auto* points =
        vtkIdTypeArray::SafeDownCast(surface.GetPointData()->GetArray("vtkOriginalPointIds"));
    if (!cells || !points) return;
    auto* regions = grid.GetCellData()->GetArray("region");
    const CutFaces cut_faces(grid);
    const Tones tones(grid);
    const auto colors = colors_for(surface);
    vtkNew<vtkIdList> ids;
    std::vector<vtkIdType> polygon;
    for (vtkIdType i = 0; i < surface.GetNumberOfCells(); ++i) {
        const vtkIdType cell = cells->GetValue(i);
        surface.GetCellPoints(i, ids);
        polygon.clear();
        for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
            polygon.push_back(points->GetValue(ids->GetId(k)));
        std::sort(polygon.begin(), polygon.end());
        colors->SetTypedTuple(i, is_cut(grid, cell, cut_faces, polygon)
                                     ? of_cut.data()
                                     : tones.of(regions, cell).data());
    }
    surface.GetCellData()->AddArray(colors);
}

}  // namespace incise::render
