// The picture of a frame: the body's surface, its mesh, a legend and the time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vtkBoundingBox.h>
#include <vtkScalarsToColors.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <memory>
#include <string>

#include "incise/app/render/coloring.h"
#include "incise/base/types.h"

namespace incise::render {

/// What stays the same over all pictures of a series, so that they make a film.
struct SceneSettings {
    std::array<int, 2> size{};  ///< pixels
    Vec3 view;                  ///< from the body to the eye; not zero
    bool has_edges = false;     ///< the mesh in full, not only a hint of it
    vtkBoundingBox bounds;      ///< of all frames
    ColorField field;
    ColorRange range;
    std::pair<double, double> limits{0, 1};
    std::string title;
};

/// @pre a display can be opened (display.h)
class Scene {
  public:
    explicit Scene(const SceneSettings& settings);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// The bytes of a PNG file. `grid` has its color values (coloring.h). Throws OutputError if
    /// VTK fails.
    std::string png(vtkUnstructuredGrid& grid, const std::string& caption);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace incise::render
