// Measurement of what contact adds to a step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>

namespace incise::bench {

/// The time of steps of a pressed block of tetrahedra that is cut right through, whose faces touch.
struct ContactRate {
    std::size_t elements = 0;  ///< before the cut
    std::size_t points = 0;    ///< of contact, with an impulse
    double friction = 0.0;
    double step_without = 0.0, step = 0.0;  ///< best times without and with contact, us
    double search = 0.0;                    ///< of all near pairs of the surface, ms
    std::size_t surface_nodes = 0;
};

/// Measures a block of about so many tetrahedra before the cut.
/// @param seconds  minimum time for each figure
ContactRate measure_contact(std::size_t num_elements, double friction, double seconds);

}  // namespace incise::bench
