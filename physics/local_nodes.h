// The nodes of a block of elements, by numbers of its own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace incise::physics {

/// What a block has of one of its nodes: a vector in space with a fourth number, which is zero, so
/// that all of it is loaded at once.
struct alignas(32) LocalVector {
    double numbers[4] = {};

    LocalVector() = default;
    LocalVector(const Eigen::Vector3d& v) : numbers{v[0], v[1], v[2], 0.0} {}

    auto vector() { return Eigen::Map<Eigen::Vector3d>(numbers); }
    auto vector() const { return Eigen::Map<const Eigen::Vector3d>(numbers); }
    double* data() { return numbers; }
    const double* data() const { return numbers; }
};

}  // namespace incise::physics
