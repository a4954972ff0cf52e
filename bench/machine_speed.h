// The limits of the machine, for comparison with the speed of the fast kernels.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>

#include "incise/physics/elements/processor.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// The limits of several threads together.
struct MachinePeak {
    double gigaflops = 0.0;  ///< additions and multiplications of doubles, fused, in lanes
    double gigabytes_per_second = 0.0;  ///< of sequential reading from memory
};

/// Measures the limits. This takes about a second and 256 MiB, of which each thread reads a part.
/// Throws std::system_error if the system cannot start so many threads.
MachinePeak measure_peak(int num_threads);

/// Returns the seconds per element that the arithmetic of forces takes on one core, without
/// fetching positions and adding up forces. The measured elements fit into the nearest cache.
/// @pre the law is SaintVenantKirchhoff, NeoHookean or MooneyRivlin
double measure_arithmetic(const physics::Law& law);

std::string_view name_of(physics::Processor processor);

}  // namespace incise::bench
