// The limits of the machine that fast kernels are measured against.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>

#include "incise/physics/elements/processor.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// Of as many threads as were asked for, together.
struct MachinePeak {
    double gigaflops = 0.0;  ///< additions and multiplications of doubles, fused, in lanes
    double gigabytes_per_second = 0.0;  ///< read from memory one after the other
};

/// Takes about a second and 256 MiB, of which each thread reads a part. Throws std::system_error if
/// the system allows no more threads.
MachinePeak measure_peak(int num_threads);

/// Seconds that an element's forces take by themselves, without fetching positions or adding up:
/// the arithmetic of some elements that the nearest cache holds, on one core. Of
/// SaintVenantKirchhoff, NeoHookean and MooneyRivlin.
double measure_arithmetic(const physics::Law& law);

std::string_view name_of(physics::Processor processor);

}  // namespace incise::bench
