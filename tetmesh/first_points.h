// The points that a mesh begins with.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "incise/base/types.h"

namespace incise::tetmesh {

/// The furthest of many points in each of fourteen directions: those of the faces and the corners
/// of a box. They span any body that is not flat.
class ExtremePoints {
  public:
    static constexpr std::size_t num_directions = 14;

    static Vec3 direction(std::size_t d) {
        if (d < 6) return (d % 2 == 0 ? 1.0 : -1.0) * Vec3::Unit(static_cast<Eigen::Index>(d / 2));
        const std::size_t corner = d - 6;
        return {corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0};
    }

    ExtremePoints() { heights_.fill(-std::numeric_limits<double>::infinity()); }

    /// @param number  of the point, by which the caller knows it
    void add(const Vec3& x, std::size_t number) {
        for (std::size_t d = 0; d < num_directions; ++d) {
            const double height = direction(d).dot(x);
            if (height <= heights_[d]) continue;
            heights_[d] = height;
            numbers_[d] = number;
        }
    }

    /// Returns the numbers of the points; some may be equal.
    const std::array<std::size_t, num_directions>& numbers() const { return numbers_; }

  private:
    std::array<double, num_directions> heights_;
    std::array<std::size_t, num_directions> numbers_{};
};

}  // namespace incise::tetmesh
