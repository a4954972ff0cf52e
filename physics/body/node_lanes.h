// The step of nodes that nothing holds, several side by side: to the bit where Model would move
// them one after the other; but how work and energy are added up differs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "incise/base/types.h"
#include "incise/physics/elements/processor.h"

namespace incise::physics {

/// What a step adds up over nodes.
struct StepSums {
    double work = 0.0;                                     ///< of loads, gravity and constraints, J
    double mass_times_square = 0.0, largest_square = 0.0;  ///< of velocities: kg m2/s2, m2/s2

    bool is_finite() const { return std::isfinite(mass_times_square); }
    StepSums& operator+=(const StepSums& o) {
        work += o.work;
        mass_times_square += o.mass_times_square;
        largest_square = std::max(largest_square, o.largest_square);
        return *this;
    }
};

/// Arrays of as many nodes, from the first of them on.
struct FreeNodes {
    const double* masses;        ///< kg, above zero
    const Vec3* elastic_forces;  ///< N
    const Vec3* outer_forces;    ///< N
    Vec3* positions;             ///< m
    Vec3* velocities;            ///< m/s
};

inline constexpr std::size_t nodes_together = 8;

/// Moves `num_nodes`, a multiple of nodes_together, by semi-implicit Euler:
/// v' = slowing (v + dt/m f), x' = x + dt v'. The same bits on every processor.
/// @param dt      s
/// @param slowing 1/(1 + damping dt)
StepSums move_free_nodes(const FreeNodes& nodes, std::size_t num_nodes, double dt, double slowing);

using MoveFreeNodes = StepSums(const FreeNodes& nodes, std::size_t num_nodes, double dt,
                               double slowing);
/// What move_free_nodes calls, by processor.
MoveFreeNodes* free_node_moves_for(Processor processor);

}  // namespace incise::physics
