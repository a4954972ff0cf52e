// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/part_shares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "incise/fragments/part_volumes.h"

namespace incise::fragments {

using topology::CellKind;
using topology::Mesh;

namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

/// Appends a face, divided into triangles. A plane one is divided from its corner with the lowest
/// id, another one about the mean of its corners, as rest_volume() does. So both cells at the face
/// divide it in the same way.
void add_face(const Mesh& material, FaceId face, Triangles& triangles) {
    const int size = material.face_size(face);
    int first = 0;
    for (int k = 1; k < size; ++k)
        if (material.face_corner(face, k) < material.face_corner(face, first)) first = k;
    const auto at = [&](int k) {
        return material.rest_position(material.face_corner(face, (first + k) % size));
    };
    Vec3 normal = Vec3::Zero(), middle = Vec3::Zero();
    for (int k = 0; k < size; ++k) middle += at(k) / size;
    for (int k = 2; k < size; ++k) normal += (at(k - 1) - at(0)).cross(at(k) - at(0));
    double height = 0.0, width = 0.0;
    for (int k = 1; k < size; ++k) {
        height = std::max(height, std::abs((at(k) - at(0)).dot(normal)));
        width = std::max(width, (at(k) - at(0)).norm());
    }
    constexpr double flatness = 1e-12;
    if (height <= flatness * width * normal.norm())
        for (int k = 2; k < size; ++k) triangles.push_back({at(0), at(k - 1), at(k)});
    else
        for (int k = 0; k < size; ++k) triangles.push_back({middle, at(k), at((k + 1) % size)});
}

/// Returns the boundary of some cells together.
Triangles boundary(const Mesh& material, std::span<const CellId> cells) {
    Triangles triangles;
    for (const CellId cell : cells)
        for (int f = 0; f < material.num_faces(cell); ++f)
            if (const CellId beyond = material.neighbor({cell, f}).cell;
                !beyond.is_valid() || !std::ranges::binary_search(cells, beyond))
                add_face(material, {cell, f}, triangles);
    return triangles;
}

double volume_of(std::span<const double> fractions, const PartNumbers& volumes) {
    return std::inner_product(fractions.begin(), fractions.end(), volumes.begin(), 0.0);
}

}  // namespace

std::vector<double> filled_fractions(CellKind kind, std::span<const Vec3> corners,
                                     const Mesh& material, std::span<const CellId> cells,
                                     topology::Diagonals diagonals) {
    const PartNumbers volumes = part_volumes(kind, corners, diagonals);
    const double whole = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    double filled = 0.0;
    for (const CellId cell : cells) filled += rest_volume(material, cell);
    constexpr double rounding = 1e-10;  // as FragmentParts::share_of
    if (std::abs(filled - whole) <= rounding * whole) return {};
    const PartNumbers fractions =
        part_fractions(kind, corners, boundary(material, cells), diagonals);
    constexpr double nothing = 1e-12;  // of the carrier
    if (volume_of(fractions, volumes) <= nothing * whole) return {};
    return {fractions.begin(), fractions.begin() + static_cast<std::ptrdiff_t>(num_parts(kind))};
}

void fit_together(std::vector<std::vector<double>>& fractions, std::span<const double> sums) {
    for (std::size_t t = 0; t < sums.size(); ++t) {
        double sum = 0.0;
        for (const auto& of_part : fractions) sum += of_part[t];
        for (auto& of_part : fractions)
            of_part[t] = sums[t] * (sum > 0.0 ? of_part[t] / sum
                                              : 1.0 / static_cast<double>(fractions.size()));
    }
}

}  // namespace incise::fragments
