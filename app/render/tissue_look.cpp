// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/tissue_look.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "incise/topology/cell_kind.h"

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

/// True if a polygon, of these points in ascending order, is a face of the cell that `cut_faces`
/// has.
bool is_cut(vtkUnstructuredGrid& grid, vtkIdType cell, int cut_faces,
            const std::vector<vtkIdType>& polygon) {
    const auto kind = kind_of(grid.GetCellType(cell));
    if (!kind || cut_faces == 0) return false;
    vtkNew<vtkIdList> corners;
    grid.GetCellPoints(cell, corners);
    const topology::CellTraits& traits = topology::traits(*kind);
    std::vector<vtkIdType> face;
    for (int f = 0; f < traits.num_faces; ++f) {
        if ((cut_faces >> f & 1) == 0) continue;
        face.clear();
        for (const int corner : traits.face(f)) face.push_back(corners->GetId(corner));
        std::sort(face.begin(), face.end());
        if (face == polygon) return true;
    }
    return false;
}

}  // namespace

void add_tissue_look(vtkUnstructuredGrid& grid, vtkPolyData& surface) {
    auto* cells =
        vtkIdTypeArray::SafeDownCast(surface.GetCellData()->GetArray("vtkOriginalCellIds"));
    auto* points =
        vtkIdTypeArray::SafeDownCast(surface.GetPointData()->GetArray("vtkOriginalPointIds"));
    if (!cells || !points) return;
    auto* regions = grid.GetCellData()->GetArray("region");
    auto* cut_faces = grid.GetCellData()->GetArray("cut_faces");
    std::map<double, std::size_t> number_of_region;
    if (regions)
        for (vtkIdType i = 0; i < regions->GetNumberOfTuples(); ++i)
            number_of_region.emplace(regions->GetComponent(i, 0), 0);
    std::size_t count = 0;
    for (auto& [region, number] : number_of_region) number = count++;

    vtkNew<vtkUnsignedCharArray> colors;
    colors->SetName(look_array);
    colors->SetNumberOfComponents(3);
    colors->SetNumberOfTuples(surface.GetNumberOfCells());
    vtkNew<vtkIdList> ids;
    std::vector<vtkIdType> polygon;
    for (vtkIdType i = 0; i < surface.GetNumberOfCells(); ++i) {
        const vtkIdType cell = cells->GetValue(i);
        surface.GetCellPoints(i, ids);
        polygon.clear();
        for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
            polygon.push_back(points->GetValue(ids->GetId(k)));
        std::sort(polygon.begin(), polygon.end());
        const std::size_t number =
            regions ? number_of_region.at(regions->GetComponent(cell, 0)) : 0;
        const int faces = cut_faces ? static_cast<int>(cut_faces->GetComponent(cell, 0)) : 0;
        colors->SetTypedTuple(i, is_cut(grid, cell, faces, polygon)
                                     ? of_cut.data()
                                     : tissues[number % tissues.size()].data());
    }
    surface.GetCellData()->AddArray(colors);
}

}  // namespace incise::render
