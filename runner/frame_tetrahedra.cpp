// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/frame_tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "incise/topology/tetrahedral_division.h"

namespace incise::runner {

namespace {

/// Appends the values of the new points.
void append_points(io::Field& field,
                   const std::vector<std::vector<topology::PointWeight>>& sources) {
    constexpr std::array<std::string_view, 3> sums = {"mass", "force", "contact_force"};
    const bool is_sum = std::ranges::find(sums, field.name) != sums.end();
    const auto width = static_cast<std::size_t>(field.components);
    std::visit(
        [&]<class T>(std::vector<T>& values) {
            values.reserve(values.size() + width * sources.size());
            for (const auto& of : sources)
                for (std::size_t k = 0; k < width; ++k) {
                    double mean = 0.0;
                    for (const auto& [p, weight] : of)
                        mean += weight * static_cast<double>(
                                             values[width * static_cast<std::size_t>(p) + k]);
                    values.push_back(std::is_integral_v<T> ? T{-1}
                                     : is_sum              ? T{0}
                                                           : static_cast<T>(mean));
                }
        },
        field.values);
}

void copy_cells(io::Field& field, const std::vector<std::size_t>& origins) {
    const auto width = static_cast<std::size_t>(field.components);
    std::visit(
        [&]<class T>(std::vector<T>& values) {
            std::vector<T> copied;
            copied.reserve(width * origins.size());
            for (const std::size_t c : origins) {
                const auto from = values.begin() + static_cast<std::ptrdiff_t>(width * c);
                copied.insert(copied.end(), from, from + field.components);
            }
            values = std::move(copied);
        },
        field.values);
}

/// Moves the points to their positions at rest, if the frame has these.
void put_at_rest(io::Frame& frame) {
    const auto found = std::ranges::find(frame.point_fields, "rest_position", &io::Field::name);
    if (found == frame.point_fields.end()) return;
    const auto& values = std::get<std::vector<double>>(found->values);
    for (std::size_t p = 0; p < frame.mesh.points.size(); ++p)
        frame.mesh.points[p] = Vec3(&values[3 * p]);
}

}  // namespace

io::Frame with_tetrahedra(io::Frame frame) {
    if (topology::has_only_tetrahedra(frame.mesh)) return frame;
    const std::vector<Vec3> positions = frame.mesh.points;
    put_at_rest(frame);
    topology::TetrahedralDivision division = topology::divide_into_tetrahedra(frame.mesh);
    std::ranges::copy(positions, division.mesh.points.begin());
    for (std::size_t p = 0; p < division.added.size(); ++p) {
        Vec3 mean = Vec3::Zero();
        for (const auto& [of, weight] : division.added[p])
            mean += weight * positions[static_cast<std::size_t>(of)];
        division.mesh.points[positions.size() + p] = mean;
    }
    for (io::Field& field : frame.point_fields) append_points(field, division.added);
    for (io::Field& field : frame.cell_fields) copy_cells(field, division.cells);
    frame.mesh = std::move(division.mesh);
    return frame;
}

}  // namespace incise::runner
