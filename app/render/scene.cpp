// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/scene.h"

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkAxesActor.h>
#include <vtkCamera.h>
#include <vtkCaptionActor2D.h>
#include <vtkCellArray.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkErrorCode.h>
#include <vtkExtractEdges.h>
#include <vtkImageData.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>

#include "incise/app/render/tissue_look.h"
#include "incise/base/error.h"

namespace incise::render {

namespace {

constexpr double text_gray = 0.15;
constexpr double legend_part = 0.16;  ///< share of the width, at the right

void style_text(vtkTextProperty& text, int pixels) {
    text.SetFontFamilyToArial();
    text.SetFontSize(pixels);
    text.SetColor(text_gray, text_gray, text_gray);
    text.BoldOff();
    text.ItalicOff();
    text.ShadowOff();
}

/// Places the camera so that the whole box is visible from the direction `view`. The box is as
/// large as possible in the part of the picture beside the legend and the captions.
void aim(vtkCamera& camera, const vtkBoundingBox& box, const Vec3& view, double aspect,
         bool has_legend) {
    const Vec3 back = view.normalized();
    const bool is_from_above = std::abs(back.z()) > 0.999;
    const Vec3 up_hint = is_from_above ? Vec3::UnitY() : Vec3::UnitZ();
    const Vec3 right = up_hint.cross(back).normalized();
    const Vec3 up = back.cross(right);

    Vec3 center, low, high;
    box.GetCenter(center.data());
    box.GetMinPoint(low.data());
    box.GetMaxPoint(high.data());

    constexpr double view_angle = 25.0;  // degrees; a small angle gives little perspective
    constexpr double fill_x = 0.90, fill_y = 0.82;
    const double tangent = std::tan(view_angle / 2 * std::numbers::pi / 180);
    const double free_part = has_legend ? 1 - legend_part : 1;
    const double tangent_x = tangent * aspect * free_part * fill_x;
    const double tangent_y = tangent * fill_y;
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                          (i & 4 ? high : low).z());
        const Vec3 offset = corner - center;
        const double extent =
            std::max(std::abs(offset.dot(right)) / tangent_x, std::abs(offset.dot(up)) / tangent_y);
        distance = std::max(distance, extent + offset.dot(back));
    }

    const Vec3 eye = center + distance * back;
    camera.SetViewAngle(view_angle);
    camera.SetFocalPoint(center.data());
    camera.SetPosition(eye.data());
    camera.SetViewUp(up.data());
    camera.SetWindowCenter(1 - free_part, 0);
}

/// Returns the number of drawn pixels for each pixel of the picture, in both directions. It smooths
/// edges independently of the driver. It is 1 for very large pictures, because VTK could not draw
/// more pixels.
int oversampling(const std::array<int, 2>& size) {
    constexpr int largest_drawn = 8192;
    return 2 * std::max(size[0], size[1]) <= largest_drawn ? 2 : 1;
}

/// Returns the image with each block of factor x factor pixels averaged.
/// @pre  the image is RGB, and its size is divisible by `factor`
vtkSmartPointer<vtkImageData> reduce(vtkImageData& image, int factor) {
    const int width = image.GetDimensions()[0] / factor;
    const int height = image.GetDimensions()[1] / factor;
    auto reduced = vtkSmartPointer<vtkImageData>::New();
    reduced->SetDimensions(width, height, 1);
    reduced->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    const auto* source = static_cast<const unsigned char*>(image.GetScalarPointer());
    auto* target = static_cast<unsigned char*>(reduced->GetScalarPointer());
    const auto row = static_cast<std::ptrdiff_t>(3) * factor * width;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                int sum = factor * factor / 2;
                for (int j = 0; j < factor; ++j)
                    for (int i = 0; i < factor; ++i)
                        sum += source[(y * factor + j) * row + 3 * (x * factor + i) + channel];
                *target++ = static_cast<unsigned char>(sum / (factor * factor));
            }
    return reduced;
}

}  // namespace

struct Scene::Parts {
    int oversampling = 1;
    bool has_field = false;
    std::optional<SectionPlane> section;
    vtkNew<vtkDataSetSurfaceFilter> surface;
    vtkNew<vtkPolyData> body;  // the surface, with what the pictures add
    vtkNew<vtkPolyDataNormals> normals;
    vtkNew<vtkExtractEdges> edges;
    vtkNew<vtkPolyDataMapper> surface_mapper, edge_mapper;
    vtkNew<vtkActor> surface_actor, edge_actor;
    vtkNew<vtkScalarBarActor> legend;
    vtkNew<vtkTextActor> legend_title, legend_note, caption, title, scale_label;
    vtkNew<vtkPolyData> scale_line;
    vtkNew<vtkPolyDataMapper2D> scale_mapper;
    vtkNew<vtkActor2D> scale_actor;
    vtkNew<vtkAxesActor> axes;
    vtkNew<vtkRenderer> axes_renderer;
    vtkNew<vtkLightKit> lights;
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkRenderWindow> window;

    void make_body(const SceneSettings& settings);
    void make_legend(const SceneSettings& settings);
    void make_axes(const SceneSettings& settings);
    void make_scale(const SceneSettings& settings, double pixels_a_metre);
    void add_text(vtkTextActor& actor, int pixels, double x, double y);
};

void Scene::Parts::make_body(const SceneSettings& settings) {
    constexpr double sharp_edge = 35;  // degrees; larger angles between faces are not smoothed
    normals->SetInputData(body);
    normals->SetFeatureAngle(sharp_edge);
    normals->SplittingOn();
    normals->ConsistencyOff();  // normals of cell faces point outwards already
    surface_mapper->SetInputConnection(normals->GetOutputPort());
    if (settings.field.place == ColorField::Place::none) {
        surface_mapper->SetScalarModeToUseCellFieldData();
        surface_mapper->SelectColorArray(look_array);
        surface_mapper->SetColorModeToDirectScalars();
    } else {
        const bool is_at_points = settings.field.place == ColorField::Place::points;
        const auto colors = make_colors(settings.range, settings.limits);
        if (is_at_points)
            surface_mapper->SetScalarModeToUsePointFieldData();
        else
            surface_mapper->SetScalarModeToUseCellFieldData();
        surface_mapper->SelectColorArray(color_array);
        surface_mapper->SetLookupTable(colors);
        surface_mapper->UseLookupTableScalarRangeOn();
        surface_mapper->SetInterpolateScalarsBeforeMapping(!settings.range.is_categorical());
    }
    auto* look = surface_actor->GetProperty();
    look->SetInterpolationToPhong();
    look->SetAmbient(0.3);
    look->SetDiffuse(0.75);
    look->SetSpecular(0.12);
    look->SetSpecularPower(25);
    surface_actor->SetMapper(surface_mapper);
    renderer->AddActor(surface_actor);

    edges->SetInputData(body);
    edge_mapper->SetInputConnection(edges->GetOutputPort());
    edge_mapper->ScalarVisibilityOff();
    // Lines lie in the faces, so that they must be moved a little towards the eye.
    vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
    surface_mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(2, 2);
    edge_mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0, -4);
    auto* line = edge_actor->GetProperty();
    line->LightingOff();
    line->SetColor(0.05, 0.05, 0.08);
    line->SetLineWidth(static_cast<float>(oversampling));
    edge_actor->SetMapper(edge_mapper);
    line->SetOpacity(0.8);
    if (settings.has_edges) renderer->AddActor(edge_actor);
}

void Scene::Parts::add_text(vtkTextActor& actor, int pixels, double x, double y) {
    style_text(*actor.GetTextProperty(), pixels);
    actor.GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    actor.GetPositionCoordinate()->SetValue(x, y);
    renderer->AddActor2D(&actor);
}

void Scene::Parts::make_legend(const SceneSettings& settings) {
    const int text_height = oversampling * std::max(11, settings.size[1] / 44);
    add_text(*caption, text_height * 6 / 5, 0.025, 0.03);
    add_text(*title, text_height * 6 / 5, 0.025, 0.965);
    title->GetTextProperty()->SetVerticalJustificationToTop();
    title->GetTextProperty()->BoldOn();
    title->SetInput(settings.title.c_str());
    if (settings.field.place == ColorField::Place::none) return;

    const bool is_categorical = settings.range.is_categorical();
    const auto num_categories = static_cast<double>(settings.range.categories().size());
    const double left = 1 - legend_part + (is_categorical ? -0.02 : 0.02);
    const double height = is_categorical ? std::min(0.56, 0.07 * num_categories) : 0.56;
    const double bottom = 0.5 - height / 2;
    add_text(*legend_title, text_height, 0.975, bottom + height + 0.03);
    legend_title->GetTextProperty()->SetJustificationToRight();
    legend_title->SetInput(settings.field.title.c_str());
    add_text(*legend_note, text_height * 4 / 5, 0.975, bottom - 0.05);
    legend_note->GetTextProperty()->SetJustificationToRight();
    legend_note->GetTextProperty()->SetVerticalJustificationToTop();
    legend_note->SetInput(settings.note.c_str());

    legend->SetLookupTable(surface_mapper->GetLookupTable());
    legend->SetTitle("");
    legend->SetPosition(left, bottom);
    legend->SetWidth(legend_part - 0.04);
    legend->SetHeight(height);
    legend->SetBarRatio(0.2);
    legend->SetNumberOfLabels(5);
    legend->SetLabelFormat("%-.3g");
    legend->SetUnconstrainedFontSize(true);
    legend->SetTextPad(static_cast<int>(text_height / 3));
    legend->DrawFrameOff();
    legend->SetMaximumNumberOfColors(256);
    legend->SetDrawTickLabels(!is_categorical);
    legend->SetDrawAnnotations(is_categorical);
    if (is_categorical) legend->SetTextPositionToPrecedeScalarBar();  // annotations go opposite
    style_text(*legend->GetLabelTextProperty(), text_height);
    style_text(*legend->GetAnnotationTextProperty(), text_height);
    style_text(*legend->GetTitleTextProperty(), text_height);
    renderer->AddActor2D(legend);
}

/// Draws the directions of the axes in a corner, as the camera sees them.
void Scene::Parts::make_axes(const SceneSettings& settings) {
    constexpr double part = 0.16;  // of the picture's height
    const double width = part * settings.size[1] / settings.size[0];
    axes_renderer->SetViewport(0.015, 0.07, 0.015 + width, 0.07 + part);
    axes_renderer->SetLayer(1);
    axes_renderer->InteractiveOff();
    for (auto* label : {axes->GetXAxisCaptionActor2D(), axes->GetYAxisCaptionActor2D(),
                        axes->GetZAxisCaptionActor2D()})
        style_text(*label->GetCaptionTextProperty(), oversampling * 14);
    axes->SetShaftTypeToCylinder();
    axes->SetCylinderRadius(0.04);
    axes->SetConeRadius(0.3);
    axes_renderer->AddActor(axes);
    auto& camera = *axes_renderer->GetActiveCamera();
    const Vec3 eye = 5.5 * settings.view.normalized();
    camera.SetFocalPoint(0, 0, 0);
    camera.SetPosition(eye.data());
    camera.SetViewUp(renderer->GetActiveCamera()->GetViewUp());
    window->SetNumberOfLayers(2);
    window->AddRenderer(axes_renderer);
}

/// Draws a bar of a round length, as it is in the middle of the body.
void Scene::Parts::make_scale(const SceneSettings& settings, double pixels_a_metre) {
    const double longest = 0.2 * settings.size[0] / pixels_a_metre;  // m
    const double power = std::pow(10.0, std::floor(std::log10(longest)));
    const double length = longest >= 5 * power   ? 5 * power
                          : longest >= 2 * power ? 2 * power
                                                 : power;
    char text[32];
    if (length < 0.0095)
        std::snprintf(text, sizeof text, "%.3g mm", 1e3 * length);
    else if (length < 0.95)
        std::snprintf(text, sizeof text, "%.3g cm", 1e2 * length);
    else
        std::snprintf(text, sizeof text, "%.3g m", length);
    const double right = 0.975 * oversampling * settings.size[0];
    const double y = 0.03 * oversampling * settings.size[1];
    const double left = right - oversampling * pixels_a_metre * length;
    const double tick = 0.008 * oversampling * settings.size[1];
    vtkNew<vtkPoints> points;
    for (const auto& [x, height] : {std::pair(left, tick), std::pair(left, 0.0),
                                    std::pair(right, 0.0), std::pair(right, tick)})
        points->InsertNextPoint(x, y + height, 0.0);
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell({0, 1, 2, 3});
    scale_line->SetPoints(points);
    scale_line->SetLines(lines);
    scale_mapper->SetInputData(scale_line);
    scale_actor->SetMapper(scale_mapper);
    scale_actor->GetProperty()->SetColor(text_gray, text_gray, text_gray);
    scale_actor->GetProperty()->SetLineWidth(static_cast<float>(1.5 * oversampling));
    renderer->AddActor2D(scale_actor);
    add_text(*scale_label, oversampling * std::max(11, settings.size[1] / 44), 0.975, 0.045);
    scale_label->GetTextProperty()->SetJustificationToRight();
    scale_label->SetInput(text);
}

Scene::Scene(const SceneSettings& settings) : parts_(std::make_unique<Parts>()) {
    auto& parts = *parts_;
    const auto [width, height] = settings.size;
    parts.oversampling = oversampling(settings.size);
    parts.has_field = settings.field.place != ColorField::Place::none;
    parts.section = settings.section;
    parts.surface->PassThroughCellIdsOn();
    parts.surface->PassThroughPointIdsOn();
    parts.make_body(settings);
    parts.make_legend(settings);
    parts.lights->SetKeyLightElevation(40);
    parts.lights->SetKeyToFillRatio(1.8);
    parts.lights->AddLightsToRenderer(parts.renderer);
    parts.renderer->GradientBackgroundOn();
    parts.renderer->SetBackground(0.86, 0.88, 0.91);
    parts.renderer->SetBackground2(0.99, 0.99, 1.0);

    parts.window->SetOffScreenRendering(1);
    parts.window->SetMultiSamples(0);
    parts.window->SetSize(parts.oversampling * width, parts.oversampling * height);
    parts.window->AddRenderer(parts.renderer);

    auto& camera = *parts.renderer->GetActiveCamera();
    aim(camera, settings.bounds, settings.view, static_cast<double>(width) / height,
        settings.field.place != ColorField::Place::none);
    const double half_angle = camera.GetViewAngle() / 2 * std::numbers::pi / 180;
    parts.make_axes(settings);
    parts.make_scale(settings, height / (2 * camera.GetDistance() * std::tan(half_angle)));
}

Scene::~Scene() = default;

std::string Scene::png(vtkUnstructuredGrid& grid, const std::string& caption) {
    auto& parts = *parts_;
    parts.surface->SetInputData(&grid);
    parts.surface->Update();
    parts.body->ShallowCopy(parts.surface->GetOutput());
    if (!parts.has_field) add_tissue_look(grid, *parts.body);
    if (parts.section) cut_open(grid, *parts.section, *parts.body);
    parts.caption->SetInput(caption.c_str());
    parts.renderer->ResetCameraClippingRange();
    parts.window->Render();
    vtkNew<vtkWindowToImageFilter> grabber;
    grabber->SetInput(parts.window);
    grabber->ReadFrontBufferOff();
    grabber->Update();
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputData(reduce(*grabber->GetOutput(), parts.oversampling));
    writer->WriteToMemoryOn();
    writer->Write();
    auto* bytes = writer->GetResult();
    if (!bytes || bytes->GetNumberOfValues() == 0 ||
        writer->GetErrorCode() != vtkErrorCode::NoError)
        throw OutputError("the picture could not be drawn; choose a smaller --size");
    return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
            static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace incise::render
