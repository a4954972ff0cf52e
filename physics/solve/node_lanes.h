// The explicit step of nodes without constraints, several at a time in SIMD lanes. Positions and
// velocities equal those of the single nodes of ExplicitStep bit for bit; sums are added in another
// order. SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "incise/base/types.h"
#include "incise/physics/elements/processor.h"

namespace incise::physics {

/// Sums of a step over nodes.
struct StepSums {
    double work = 0.0;          ///< of outer forces, constraints and impulses, J
    double impulse_work = 0.0;  ///< of impulses alone, J
    /// Sum of mass times squared speed, kg m2/s2; largest squared speed, m2/s2.
    double mass_times_square = 0.0, largest_square = 0.0;

    bool is_finite() const { return std::isfinite(mass_times_square); }
    StepSums& operator+=(const StepSums& o) {
        work += o.work;
        impulse_work += o.impulse_work;
        mass_times_square += o.mass_times_square;
        largest_square = std::max(largest_square, o.largest_square);
        return *this;
    }
};

/// Arrays of consecutive nodes without constraints; each pointer is that of the first node.
struct FreeNodes {
    const double* masses;        ///< kg, above 0
    const Vec3* elastic_forces;  ///< N
    const Vec3* outer_forces;    ///< N
    Vec3* positions;             ///< m
    Vec3* velocities;            ///< m/s
};

/// The number of nodes that are moved at the same time.
inline constexpr std::size_t nodes_together = 8;

/// Moves nodes by symplectic (semi-implicit) Euler: v' = slowing (v + dt/m f), x' = x + dt v'.
/// The results are the same bit for bit on every processor.
/// @param nodes      arrays of the nodes
/// @param num_nodes  a multiple of nodes_together
/// @param dt         s
/// @param slowing    1/(1 + damping dt)
StepSums move_free_nodes(const FreeNodes& nodes, std::size_t num_nodes, double dt, double slowing);

using MoveFreeNodes = StepSums(const FreeNodes& nodes, std::size_t num_nodes, double dt,
                               double slowing);
/// Returns the function that move_free_nodes() calls on a processor.
MoveFreeNodes* free_node_moves_for(Processor processor);

}  // namespace incise::physics
