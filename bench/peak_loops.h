// The loops that machine_speed.cpp times, compiled once for each kind of processor.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "incise/physics/elements/simd_heml_elements.h"

namespace incise::bench {

/// The edges from corner 0 of the elements of a group, and the forces on the other corners.
struct alignas(64) LinkGroupVectors {
    double edges[3][3][physics::LinkGroup<double>::size];   ///< m
    double forces[3][3][physics::LinkGroup<double>::size];  ///< N
};

/// Executes at least `num_operations` additions and multiplications, in independent chains.
using MultiplyAndAdd = double(std::size_t num_operations);
/// Reads `n` numbers and adds them up by lane. Returns the sum of the first lane.
using SumUp = double(const double* numbers, std::size_t n);
/// Computes the forces of each group `num_passes` times. Does nothing for laws other than
/// SaintVenantKirchhoff, NeoHookean and MooneyRivlin.
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
