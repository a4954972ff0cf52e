// Symmetric tensors as six numbers, as the history of viscous elements stores them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <type_traits>

#include "incise/physics/elements/heml_kernel.h"

namespace incise::physics {

/// A symmetric tensor by its components 11, 22, 33, 12, 23, 31.
using SymmetricTensor = Eigen::Matrix<double, 6, 1>;

inline Mat3 matrix_of(const SymmetricTensor& t) {
    Mat3 matrix;
    matrix << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
    return matrix;
}
inline SymmetricTensor symmetric_tensor(const Mat3& matrix) {
    SymmetricTensor t;
    t << matrix(0, 0), matrix(1, 1), matrix(2, 2), matrix(0, 1), matrix(1, 2), matrix(2, 0);
    return t;
}

/// Returns tensor `i` of the memory of an element.
template <class Number>
auto tensor(std::span<Number> memory, std::size_t i) {
    using Tensor =
        std::conditional_t<std::is_const_v<Number>, const SymmetricTensor, SymmetricTensor>;
    return Eigen::Map<Tensor>(memory.data() + 6 * i);
}

}  // namespace incise::physics
