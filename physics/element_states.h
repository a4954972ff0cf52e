// Between lanes and elements: what the fast kernels find of eight elements at a time, for the books
// and for frames.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "physics/element_result.h"
#include "physics/sum.h"

namespace incise::physics {

/// Elements of a group, for these purposes always in doubles. Those of a block lie in groups as
/// set_places_of_lanes has them; lanes that are left over have anything.
inline constexpr std::size_t elements_together = 8;

/// What the elements of a group have at given positions.
struct ElementStates {
    double energy[elements_together];        ///< J
    double volume_ratio[elements_together];  ///< present over rest volume
    /// Sum of the corners' forces times positions, f x^T, by rows: J.
    double virial[9][elements_together];
};

/// Room for one figure an element and what lanes are left over, until the thread asks again.
std::span<double> room_for_figures(std::size_t num_groups);
/// Their sum in the order of elements, but for rounding of the sum. Figures of left over lanes are
/// lost.
Sum sum_of_figures(std::span<double> figures, std::size_t num_elements);
/// Likewise the least of them; infinite if there are none.
double least_of_figures(std::span<double> figures, std::size_t num_elements);

/// Room for groups' states, until the thread asks again.
std::span<ElementStates> room_for_states(std::size_t num_groups);
/// Sets what the elements have, in their order, but volumes at rest, which are read.
void set_results(std::span<const ElementStates> groups, std::span<ElementResult> results);

}  // namespace incise::physics
