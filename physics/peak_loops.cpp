// What measure_peak times. Compiled for each kind of processor: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstddef>

#include "physics/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

/// So many operations at least, in chains that do not wait for each other.
double multiply_and_add(std::size_t num_operations) {
    constexpr std::size_t num_chains = 12;
    Lanes<double> chains[num_chains];
    for (std::size_t c = 0; c < num_chains; ++c) chains[c] = 1.0 + 0.1 * static_cast<double>(c);
    // The factor is such that chains neither grow nor vanish.
    const Lanes<double> factor = 0.999999, addend = 1e-6;
    for (std::size_t done = 0; done < num_operations; done += 2 * num_chains * num_lanes<double>)
        for (Lanes<double>& chain : chains) chain = chain * factor + addend;
    double sum = 0.0;
    for (const Lanes<double>& chain : chains) sum += chain.v[0];
    return sum;
}

double sum_up(const double* numbers, std::size_t n) {
    Lanes<double> sums[8];
    for (Lanes<double>& sum : sums) sum = 0.0;
    constexpr std::size_t lanes = num_lanes<double>;
    for (std::size_t i = 0; i + 8 * lanes <= n; i += 8 * lanes)
        for (std::size_t k = 0; k < 8; ++k) {
            Lanes<double>::Vector v;
            __builtin_memcpy(&v, numbers + i + k * lanes, sizeof v);
            sums[k] += v;
        }
    double sum = 0.0;
    for (const Lanes<double>& one : sums) sum += one.v[0];
    return sum;
}

}  // namespace incise::physics::INCISE_PROCESSOR
