// The picture of a frame: surface of the body, mesh, legend and time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vtkBoundingBox.h>
#include <vtkScalarsToColors.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "incise/app/render/coloring.h"
#include "incise/app/render/section.h"
#include "incise/base/types.h"

namespace incise::render {

/// Settings that all pictures of a series share, so that the pictures can be shown as a film.
struct SceneSettings {
    std::array<int, 2> size{};  ///< pixels
    Vec3 view;                  ///< from the body to the eye, of any length above zero
    bool has_edges = false;     ///< if true, the lines of the mesh are drawn
    std::optional<SectionPlane> section;
    vtkBoundingBox bounds;  ///< of all frames
    ColorField field;
    ColorRange range;
    std::pair<double, double> limits{0, 1};
    std::string title;
    std::string note;  ///< below the legend: what its colours leave out
};

/// A renderer of pictures with the same settings.
/// @pre  a display can be opened (display.h)
class Scene {
  public:
    explicit Scene(const SceneSettings& settings);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Returns the picture of a frame as bytes of a PNG file. Throws OutputError if VTK fails.
    /// @pre  add_color_values() was called on `grid`
    std::string png(vtkUnstructuredGrid& grid, const std::string& caption);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace incise::render
