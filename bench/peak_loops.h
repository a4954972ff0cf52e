// What machine_speed.cpp times, once for each kind of processor.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "incise/physics/elements/simd_heml_elements.h"

namespace incise::bench {

/// Edges of the elements of a group from corner 0, and the forces on their other corners.
struct alignas(64) LinkGroupVectors {
    double edges[3][3][physics::LinkGroup<double>::size];   ///< m
    double forces[3][3][physics::LinkGroup<double>::size];  ///< N
};

/// So many operations at least, in chains that do not wait for each other.
using MultiplyAndAdd = double(std::size_t num_operations);
using SumUp = double(const double* numbers, std::size_t n);
/// The forces of each group, so many times. Of the three laws that are timed.
using WorkOutLinks = void(const physics::Law& law,
                          std::span<const physics::LinkGroup<double>> groups,
                          std::span<LinkGroupVectors> vectors, std::size_t num_passes);

namespace plain {
MultiplyAndAdd multiply_and_add;
SumUp sum_up;
WorkOutLinks work_out_links;
}  // namespace plain
namespace avx2 {
MultiplyAndAdd multiply_and_add;
SumUp sum_up;
WorkOutLinks work_out_links;
}  // namespace avx2
namespace avx512 {
MultiplyAndAdd multiply_and_add;
SumUp sum_up;
WorkOutLinks work_out_links;
}  // namespace avx512

}  // namespace incise::bench
