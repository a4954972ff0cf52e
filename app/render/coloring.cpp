// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/coloring.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "incise/base/error.h"

namespace incise::render {

namespace {

using Place = ColorField::Place;
using Measure = ColorField::Measure;
using Rgb = std::array<double, 3>;

constexpr Rgb rgb(std::uint32_t hex) {
    return {((hex >> 16) & 0xff) / 255.0, ((hex >> 8) & 0xff) / 255.0, (hex & 0xff) / 255.0};
}

// Viridis (S. van der Walt, N. Smith; CC0) at even steps, without the nearly black end, where
// lighting is not visible.
constexpr std::array sequential = {rgb(0x46327e), rgb(0x3f4a8a), rgb(0x365c8d), rgb(0x2e6e8e),
                                   rgb(0x277f8e), rgb(0x21918c), rgb(0x1fa187), rgb(0x2db27d),
                                   rgb(0x4ac16d), rgb(0x73d056), rgb(0xa0da39), rgb(0xd0e11c),
                                   rgb(0xfde725)};
// ColorBrewer's RdBu (C. Brewer; Apache 2.0), from blue to red.
constexpr std::array diverging = {rgb(0x2166ac), rgb(0x4393c3), rgb(0x92c5de),
                                  rgb(0xd1e5f0), rgb(0xf7f7f7), rgb(0xfddbc7),
                                  rgb(0xf4a582), rgb(0xd6604d), rgb(0xb2182b)};
// Twelve colours that colour-blind people can distinguish as far as possible (after Tableau and
// Paul Tol).
constexpr std::array qualitative = {rgb(0xd98880), rgb(0x5b8db8), rgb(0xe3b505), rgb(0x6aa84f),
                                    rgb(0x9467bd), rgb(0x4fb3a9), rgb(0xe08e45), rgb(0xb07aa1),
                                    rgb(0x8c6d5a), rgb(0x9aa0a6), rgb(0xbcbd22), rgb(0x2f4b7c)};

vtkDataSetAttributes& attributes(vtkDataSet& data, Place place) {
    if (place == Place::points) return *data.GetPointData();
    return *data.GetCellData();
}

std::string list_fields(vtkDataSet& data) {
    std::string list;
    for (const auto place : {Place::points, Place::cells}) {
        auto& arrays = attributes(data, place);
        for (int i = 0; i < arrays.GetNumberOfArrays(); ++i)
            if (arrays.GetArray(i) && arrays.GetArray(i)->GetName())
                list += arrays.GetArray(i)->GetName() + std::string(", ");
    }
    return list + "none";
}

struct Unit {
    std::string_view array, unit;
};

/// The units of the fields that a run writes.
constexpr Unit units[] = {{"displacement", "m"},  {"velocity", "m/s"},
                          {"force", "N"},         {"mass", "kg"},
                          {"stress", "Pa"},       {"von_mises", "Pa"},
                          {"contact_force", "N"}, {"contact_pressure", "Pa"},
                          {"rest_position", "m"}, {"energy_density", "J/m3"}};

/// Returns the title of an array, with its unit if that is known.
std::string with_unit(const std::string& title, std::string_view array) {
    for (const auto& [known, unit] : units)
        if (array == known) return title + ", " + std::string(unit);
    return title;
}

std::optional<ColorField> find_field(vtkDataSet& data, const std::string& name) {
    for (const auto place : {Place::points, Place::cells}) {
        auto* array = attributes(data, place).GetArray(name.c_str());
        if (!array) continue;
        switch (array->GetNumberOfComponents()) {
            case 1:
                return ColorField{place, name, Measure::value, 0, with_unit(name, name)};
            case 6:
            case 9:
                return ColorField{place, name, Measure::von_mises, 0,
                                  with_unit("von Mises " + name, name)};
            default:
                return ColorField{place, name, Measure::magnitude, 0, with_unit(name, name)};
        }
    }
    return std::nullopt;
}

/// Finds a component of a vector by its name: "name_x", "name_y" or "name_z".
std::optional<ColorField> find_component(vtkDataSet& data, const std::string& wanted) {
    constexpr std::string_view letters = "xyz";
    if (wanted.size() < 3 || wanted[wanted.size() - 2] != '_') return std::nullopt;
    const auto component = letters.find(wanted.back());
    auto field = find_field(data, wanted.substr(0, wanted.size() - 2));
    if (component == letters.npos || !field ||
        attributes(data, field->place).GetArray(field->array.c_str())->GetNumberOfComponents() != 3)
        return std::nullopt;
    field->measure = Measure::component;
    field->component = static_cast<int>(component);
    field->title = with_unit(field->array + " " + wanted.back(), field->array);
    return field;
}

/// Returns the von Mises stress. `s` has 9 components by rows, or 6 in the order xx, yy, zz, xy,
/// yz, xz.
double von_mises(const std::vector<double>& s) {
    const bool is_full = s.size() == 9;
    const double xx = s[0], yy = is_full ? s[4] : s[1], zz = is_full ? s[8] : s[2];
    const double xy = is_full ? (s[1] + s[3]) / 2 : s[3];
    const double yz = is_full ? (s[5] + s[7]) / 2 : s[4];
    const double xz = is_full ? (s[2] + s[6]) / 2 : s[5];
    const auto square = [](double x) { return x * x; };
    return std::sqrt((square(xx - yy) + square(yy - zz) + square(zz - xx)) / 2 +
                     3 * (square(xy) + square(yz) + square(xz)));
}

double magnitude(const std::vector<double>& tuple) {
    double sum = 0;
    for (const double x : tuple) sum += x * x;
    return std::sqrt(sum);
}

double measure(const ColorField& field, const std::vector<double>& tuple) {
    switch (field.measure) {
        case Measure::value:
            return tuple[0];
        case Measure::component:
            return tuple[static_cast<std::size_t>(field.component)];
        case Measure::magnitude:
            return magnitude(tuple);
        case Measure::von_mises:
            return von_mises(tuple);
    }
    return 0;
}

vtkSmartPointer<vtkLookupTable> make_category_colors(const std::set<int>& categories) {
    auto table = vtkSmartPointer<vtkLookupTable>::New();
    table->SetNumberOfTableValues(static_cast<vtkIdType>(categories.size()));
    table->IndexedLookupOn();
    vtkIdType index = 0;
    for (const int category : categories) {
        const auto& [r, g, b] = qualitative[static_cast<std::size_t>(index) % qualitative.size()];
        table->SetTableValue(index++, r, g, b);
        table->SetAnnotation(category, std::to_string(category));
    }
    return table;
}

template <std::size_t N>
vtkSmartPointer<vtkLookupTable> make_scale(const std::array<Rgb, N>& stops, double lowest,
                                           double highest) {
    constexpr int steps = 256;
    auto table = vtkSmartPointer<vtkLookupTable>::New();
    table->SetNumberOfTableValues(steps);
    table->SetTableRange(lowest, highest);
    table->SetNanColor(0.6, 0.6, 0.6, 1.0);
    for (int i = 0; i < steps; ++i) {
        const double place = i * static_cast<double>(N - 1) / (steps - 1);
        const auto below = std::min(static_cast<std::size_t>(place), N - 2);
        const double part = place - static_cast<double>(below);
        Rgb color;
        for (std::size_t k = 0; k < 3; ++k)
            color[k] = std::lerp(stops[below][k], stops[below + 1][k], part);
        table->SetTableValue(i, color[0], color[1], color[2]);
    }
    return table;
}

}  // namespace

ColorField choose_color_field(vtkDataSet& data, const std::optional<std::string>& wanted) {
    if (!wanted) return {};
    if (const auto field = find_field(data, *wanted)) return *field;
    if (const auto field = find_component(data, *wanted)) return *field;
    if (*wanted == "none") return {};
    throw InputError("no field is called '" + *wanted + "'; there are: " + list_fields(data));
}

void add_color_values(vtkDataSet& data, const ColorField& field) {
    if (field.place == Place::none) return;
    auto& arrays = attributes(data, field.place);
    auto* source = arrays.GetArray(field.array.c_str());
    const bool is_sound = source && source->GetNumberOfTuples() == (field.place == Place::points
                                                                        ? data.GetNumberOfPoints()
                                                                        : data.GetNumberOfCells());
    if (!is_sound)
        throw InputError("field '" + field.array + "' is missing; there are: " + list_fields(data));
    std::vector<double> tuple(static_cast<std::size_t>(source->GetNumberOfComponents()));
    vtkNew<vtkDoubleArray> values;
    values->SetName(color_array);
    values->SetNumberOfValues(source->GetNumberOfTuples());
    for (vtkIdType i = 0; i < source->GetNumberOfTuples(); ++i) {
        source->GetTuple(i, tuple.data());
        values->SetValue(i, measure(field, tuple));
    }
    arrays.AddArray(values);
}

void ColorRange::include(vtkDataSet& data, const ColorField& field) {
    if (field.place == Place::none) return;
    auto& arrays = attributes(data, field.place);
    const auto type = arrays.GetArray(field.array.c_str())->GetDataType();
    is_integer_ = is_integer_ && type != VTK_FLOAT && type != VTK_DOUBLE;
    // Scales of lengths and von Mises stresses begin at zero.
    if (field.measure == Measure::magnitude || field.measure == Measure::von_mises) lowest_ = 0;
    auto* values = vtkDoubleArray::SafeDownCast(arrays.GetArray(color_array));
    const vtkIdType stride = 1 + values->GetNumberOfValues() / samples_a_frame;
    for (vtkIdType i = 0; i < values->GetNumberOfValues(); ++i) {
        const double value = values->GetValue(i);
        if (!std::isfinite(value)) continue;
        if (i % stride == 0) samples_.push_back(value);
        lowest_ = std::min(lowest_, value);
        highest_ = std::max(highest_, value);
        if (!is_integer_) continue;
        is_integer_ = std::abs(value) <= std::numeric_limits<int>::max();
        if (is_integer_) categories_.insert(static_cast<int>(value));
        if (categories_.size() > max_categories) is_integer_ = false;
    }
}

std::pair<double, double> ColorRange::limits() const {
    if (!(lowest_ <= highest_)) return {0.0, 1.0};
    if (lowest_ < highest_) {
        constexpr double share = 0.001;  // of all values, at either end
        constexpr double far = 0.25;     // of the range of the others, beyond it
        std::vector<double> sorted = samples_;
        std::sort(sorted.begin(), sorted.end());
        const auto last = static_cast<double>(sorted.size() - 1);
        const double low = sorted[static_cast<std::size_t>(share * last)],
                     high = sorted[static_cast<std::size_t>((1.0 - share) * last)];
        const double beyond = far * (high - low);
        return {low > lowest_ + beyond && high > low && lowest_ != 0.0 ? low : lowest_,
                high < highest_ - beyond && high > low ? high : highest_};
    }
    const double margin = lowest_ == 0 ? 1.0 : std::abs(lowest_) * 1e-3;
    return {lowest_, lowest_ + margin};
}

vtkSmartPointer<vtkScalarsToColors> make_colors(const ColorRange& range,
                                                std::pair<double, double> limits) {
    if (range.is_categorical()) return make_category_colors(range.categories());
    const auto [lowest, highest] = limits;
    // Small negative values do not give a positive field the scale for two signs.
    const bool has_two_signs =
        lowest < 0 && highest > 0 && -lowest > 0.1 * highest && highest > 0.1 * -lowest;
    if (!has_two_signs) return make_scale(sequential, lowest, highest);
    const double extent = std::max(-lowest, highest);
    return make_scale(diverging, -extent, extent);
}

}  // namespace incise::render
