// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/section.h"

#include <vtkAppendPolyData.h>
#include <vtkClipPolyData.h>
#include <vtkCutter.h>
#include <vtkNew.h>
#include <vtkPlane.h>

#include <array>
#include <cmath>
#include <string>

#include "incise/app/render/tissue_look.h"
#include "incise/io/files/number_text.h"

namespace incise::render {

std::optional<Section> parse_section(std::string_view text) {
    constexpr std::string_view axes = "xyz";
    const auto parse = [](std::string_view number) {
        const auto value = io::parse_number<double>(number);
        return value && std::isfinite(*value) ? value : std::nullopt;
    };
    if (text.empty()) return std::nullopt;
    if (const auto axis = axes.find(text[0]); axis != std::string_view::npos) {
        const int number = static_cast<int>(axis);
        if (text.size() == 1) return MiddlePlane{number};
        const auto height = text[1] == '=' ? parse(text.substr(2)) : std::nullopt;
        if (!height) return std::nullopt;
        return SectionPlane{*height * Vec3::Unit(number), Vec3::Unit(number)};
    }
    std::array<double, 6> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto end = text.find(',');
        const auto value = parse(text.substr(0, end));
        if (!value || (end == std::string_view::npos) != (i + 1 == values.size()))
            return std::nullopt;
        values[i] = *value;
        if (end != std::string_view::npos) text.remove_prefix(end + 1);
    }
    const Vec3 normal(values[3], values[4], values[5]);
    if (!(normal.stableNorm() > 0.0)) return std::nullopt;
    return SectionPlane{{values[0], values[1], values[2]}, normal.stableNormalized()};
}

SectionPlane place(const Section& section, const vtkBoundingBox& bounds, const Vec3& view) {
    SectionPlane plane{};
    if (const auto* middle = std::get_if<MiddlePlane>(&section)) {
        bounds.GetCenter(plane.point.data());
        plane.normal = Vec3::Unit(middle->axis);
    } else {
        plane = std::get<SectionPlane>(section);
    }
    if (plane.normal.dot(view) < 0.0) plane.normal = -plane.normal;
    return plane;
}

void cut_open(vtkUnstructuredGrid& grid, const SectionPlane& plane, vtkPolyData& surface) {
    vtkNew<vtkPlane> function;
    function->SetOrigin(plane.point.data());
    function->SetNormal(plane.normal.data());

    vtkNew<vtkClipPolyData> behind;
    behind->SetInputData(&surface);
    behind->SetClipFunction(function);
    behind->InsideOutOn();
    vtkNew<vtkCutter> cutter;
    cutter->SetInputData(&grid);
    cutter->SetCutFunction(function);
    cutter->GenerateTrianglesOff();
    cutter->Update();
    vtkNew<vtkPolyData> section;
    section->ShallowCopy(cutter->GetOutput());
    add_section_look(grid, *section);

    vtkNew<vtkAppendPolyData> both;
    both->AddInputConnection(behind->GetOutputPort());
    both->AddInputData(section);
    both->Update();
    surface.ShallowCopy(both->GetOutput());
}

}  // namespace incise::render
