// The field that colours a picture, its values, and the colours.
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
#include <vector>

namespace incise::render {

/// A field, and the measure that turns its components into one number.
struct ColorField {
    enum class Place { none, points, cells };
    enum class Measure { value, component, magnitude, von_mises };

    Place place = Place::none;  ///< none: one colour for the whole body
    std::string array;
    Measure measure = Measure::value;
    int component = 0;  ///< for Measure::component
    std::string title;
};

/// Returns the field with the name `wanted`: an array of points or cells, a component of an array
/// ("displacement_z"), or "none". The measure of vectors is their length. That of tensors (9
/// components, or 6 in the order of VTK) is the von Mises stress. Without `wanted`, it is none.
/// Throws InputError if there is no such field. The message lists the fields.
ColorField choose_color_field(vtkDataSet& data, const std::optional<std::string>& wanted);

/// The name of the array that add_color_values() adds.
inline constexpr const char* color_array = "incise color";

/// Adds an array with the measure of the field to the points or cells. Adds nothing for
/// Place::none. Throws InputError if the data do not have the field.
void add_color_values(vtkDataSet& data, const ColorField& field);

/// The range of values over all frames, for the scale of colours.
class ColorRange {
  public:
    /// Extends the range by the values of a frame.
    /// @pre  add_color_values() was called on the data
    void include(vtkDataSet& data, const ColorField& field);

    /// True if the values are at most 12 different whole numbers, such as regions. Each then has
    /// its own colour.
    bool is_categorical() const { return is_integer_ && !categories_.empty(); }
    const std::set<int>& categories() const { return categories_; }

    /// Returns the values of the first and the last colour, or (0, 1) if there is no value. The
    /// second is always above the first. Where few values are far beyond all others, it is the
    /// range of the others.
    std::pair<double, double> limits() const;
    /// Returns the lowest and the highest finite value.
    std::pair<double, double> extremes() const { return {lowest_, highest_}; }

  private:
    static constexpr std::size_t max_categories = 12;
    static constexpr vtkIdType samples_a_frame = 20000;

    double lowest_ = std::numeric_limits<double>::infinity();
    double highest_ = -std::numeric_limits<double>::infinity();
    bool is_integer_ = true;
    std::set<int> categories_;
    std::vector<double> samples_;  // at even steps, of all frames
};

/// Returns a colour for each category if the range is categorical, otherwise a perceptually uniform
/// scale. If the limits have both signs and neither is small against the other, the scale is white
/// at zero.
vtkSmartPointer<vtkScalarsToColors> make_colors(const ColorRange& range,
                                                std::pair<double, double> limits);

}  // namespace incise::render
