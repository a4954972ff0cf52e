// Which field colours the picture, its values, and the colours.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vtkDataSet.h>
#include <vtkScalarsToColors.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace incise::render {

/// A field, and how a number is made of its components.
struct ColorField {
    enum class Place { none, points, cells };
    enum class Measure { value, component, magnitude, von_mises };

    Place place = Place::none;  ///< none: one colour for all
    std::string array;
    Measure measure = Measure::value;
    int component = 0;  ///< where the measure is one
    std::string title;
};

/// The field that a user calls `wanted`: the name of an array of points or cells, one component
/// of it ("displacement_z"), or "none". Vectors give their length; tensors (9 components, or 6
/// in VTK's order) the von Mises stress. Without a wish: displacement, else region, else none.
/// Throws InputError that names the fields there are.
ColorField choose_color_field(vtkDataSet& data, const std::optional<std::string>& wanted);

/// The name of the array that add_color_values() makes.
inline constexpr const char* color_array = "incise color";

/// Adds the values of the field to the points or cells. Throws InputError if the field is not
/// there.
void add_color_values(vtkDataSet& data, const ColorField& field);

/// What the colours must span, gathered over frames.
class ColorRange {
  public:
    /// @pre add_color_values() was called on the data
    void include(vtkDataSet& data, const ColorField& field);

    /// Few whole numbers, such as regions, which get a colour each.
    bool is_categorical() const { return is_integer_ && !categories_.empty(); }
    const std::set<int>& categories() const { return categories_; }

    /// Lowest and highest finite value; (0, 1) if there is none, never of no extent.
    std::pair<double, double> limits() const;

  private:
    static constexpr std::size_t max_categories = 12;

    double lowest_ = std::numeric_limits<double>::infinity();
    double highest_ = -std::numeric_limits<double>::infinity();
    bool is_integer_ = true;
    std::set<int> categories_;
};

/// Colours for categories if the range has them; else a scale that is even to the eye, with white
/// at zero where values of both signs are of interest.
vtkSmartPointer<vtkScalarsToColors> make_colors(const ColorRange& range,
                                                std::pair<double, double> limits);

}  // namespace incise::render
