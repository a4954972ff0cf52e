// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/size_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::tetmesh {

namespace {

constexpr double max_points = 4e6;

/// Replaces squared distances along one line of the lattice by those to the lower envelope of the
/// parabolas over its points. Lengths are in steps. Source: Felzenszwalb, Huttenlocher 2012.
void transform_line(std::vector<float>& values, std::vector<std::int64_t>& roots,
                    std::vector<double>& bounds) {
    const auto n = static_cast<std::int64_t>(values.size());
    const auto height = [&](std::int64_t q) {
        return static_cast<double>(values[static_cast<std::size_t>(q)]) +
               static_cast<double>(q) * static_cast<double>(q);
    };
    std::size_t last = 0;
    roots.assign(values.size(), 0);
    bounds.assign(values.size() + 1, std::numeric_limits<double>::infinity());
    bounds[0] = -bounds[0];
    for (std::int64_t q = 1; q < n; ++q) {
        double meet = 0.0;
        while (true) {
            const auto r = roots[last];
            meet = (height(q) - height(r)) / (2.0 * static_cast<double>(q - r));
            if (meet > bounds[last] || last == 0) break;
            --last;
        }
        if (meet > bounds[last]) ++last;
        roots[last] = q;
        bounds[last] = last == 0 ? -std::numeric_limits<double>::infinity() : meet;
        bounds[last + 1] = std::numeric_limits<double>::infinity();
    }
    std::vector<float> result(values.size());
    last = 0;
    for (std::int64_t q = 0; q < n; ++q) {
        while (bounds[last + 1] < static_cast<double>(q)) ++last;
        const auto away = static_cast<double>(q - roots[last]);
        result[static_cast<std::size_t>(q)] = static_cast<float>(
            away * away + static_cast<double>(values[static_cast<std::size_t>(roots[last])]));
    }
    values.swap(result);
}

}  // namespace

SizeField::SizeField(const BodyShape& body, double inside, double surface)
    : inside_(inside), surface_(surface) {
    for (const auto& [region, volume] : body.volumes) num_cubes_ += volume / std::pow(inside, 3);
    if (!(surface < inside)) return;
    const Vec3 extent = body.box.sizes();
    const double volume = std::max(extent.x(), surface) * std::max(extent.y(), surface) *
                          std::max(extent.z(), surface);
    step_ = std::max(0.5 * surface, std::cbrt(volume / max_points));
    corner_ = body.box.min() - Vec3::Constant(step_);
    for (std::size_t a = 0; a < 3; ++a)
        num_[a] =
            static_cast<std::int64_t>(std::ceil(extent[static_cast<Eigen::Index>(a)] / step_)) + 3;

    const auto [nx, ny, nz] = num_;
    std::vector<int> regions(static_cast<std::size_t>(nx * ny * nz));
    for (std::int64_t k = 0; k < nz; ++k)
        for (std::int64_t j = 0; j < ny; ++j)
            for (std::int64_t i = 0; i < nx; ++i)
                regions[index(i, j, k)] = body.region_at(
                    corner_ + step_ * Vec3(static_cast<double>(i), static_cast<double>(j),
                                           static_cast<double>(k)));

    // Far, but finite, so that differences of two of them are numbers.
    const auto far = static_cast<float>(nx * nx + ny * ny + nz * nz);
    distances_.assign(regions.size(), far);
    const std::array<std::size_t, 3> strides = {1, static_cast<std::size_t>(nx),
                                                static_cast<std::size_t>(nx * ny)};
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t p = 0; p + strides[a] < regions.size(); ++p) {
            if (regions[p] == regions[p + strides[a]]) continue;
            distances_[p] = distances_[p + strides[a]] = 0.0f;
        }

    std::vector<float> line;
    std::vector<std::int64_t> roots;
    std::vector<double> bounds;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto length = static_cast<std::size_t>(num_[a]);
        for (std::size_t p = 0; p < distances_.size(); ++p) {
            if (p / strides[a] % length != 0) continue;  // not the beginning of a line
            line.resize(length);
            for (std::size_t q = 0; q < length; ++q) line[q] = distances_[p + q * strides[a]];
            transform_line(line, roots, bounds);
            for (std::size_t q = 0; q < length; ++q) distances_[p + q * strides[a]] = line[q];
        }
    }
    for (float& d : distances_) d = std::sqrt(d);

    num_cubes_ = 0.0;
    for (std::size_t p = 0; p < regions.size(); ++p)
        if (regions[p] != 0)
            num_cubes_ +=
                std::pow(step_ / length_at(step_ * static_cast<double>(distances_[p])), 3);
}

double SizeField::length_at(double distance) const {
    return std::min(inside_, surface_ + growth * distance);
}

double SizeField::expected_nodes(const BodyShape& body) const {
    constexpr double inner_nodes_of_cube = 2.0, nodes_of_square = 0.6;
    return inner_nodes_of_cube * num_cubes_ + nodes_of_square * body.area / (surface_ * surface_);
}

double SizeField::distance_at(const Vec3& x) const {
    std::array<std::int64_t, 3> base;
    Vec3 share;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        const double place = std::clamp((x[axis] - corner_[axis]) / step_, 0.0,
                                        static_cast<double>(num_[a] - 1) - 1e-9);
        base[a] = static_cast<std::int64_t>(place);
        share[axis] = place - static_cast<double>(base[a]);
    }
    double distance = 0.0;
    for (int c = 0; c < 8; ++c) {
        const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2 & 1;
        const double weight = (dx ? share.x() : 1.0 - share.x()) *
                              (dy ? share.y() : 1.0 - share.y()) *
                              (dz ? share.z() : 1.0 - share.z());
        distance += weight * static_cast<double>(
                                 distances_[index(base[0] + dx, base[1] + dy, base[2] + dz)]);
    }
    return distance * step_;
}

double SizeField::at(const Vec3& x) const {
    if (distances_.empty()) return inside_;
    return length_at(distance_at(x));
}

}  // namespace incise::tetmesh
