// Lengths of edges that grow with the distance from the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tetmesh/body_shape.h"

namespace incise::tetmesh {

/// The length of edges to aim at, by place. It is `surface` at the surface of the body and where
/// two regions meet. It grows by `growth` times the distance, up to `inside`.
class SizeField {
  public:
    /// A length of edges grows by this share of the distance: neighbours differ little then, and
    /// tetrahedra between large and small ones keep their angles.
    static constexpr double growth = 0.4;

    /// Samples the body on a lattice, unless both lengths are equal. Cost: O(points of the
    /// lattice), at most four million.
    SizeField(const BodyShape& body, double inside, double surface);

    double at(const Vec3& x) const;

    /// Returns about how many nodes a mesh of the body has with these lengths. A thin body may have
    /// fewer, and a body with sharp edges more.
    double expected_nodes(const BodyShape& body) const;

  private:
    double length_at(double distance) const;
    double distance_at(const Vec3& x) const;
    std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return static_cast<std::size_t>(i + num_[0] * (j + num_[1] * k));
    }

    double inside_, surface_;
    Vec3 corner_;
    double step_ = 0.0;
    std::array<std::int64_t, 3> num_{};
    double num_cubes_ = 0.0;        ///< of which the local length is the edge, in the body
    std::vector<float> distances_;  ///< by point of the lattice; empty if the lengths are equal
};

}  // namespace incise::tetmesh
