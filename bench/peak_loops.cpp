// The loops that machine_speed.cpp times. Compiled for each kind of processor: see
// physics/simd/lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/bench/peak_loops.h"

#include <cstddef>

#include "incise/physics/simd/link_forces.h"

namespace incise::bench::INCISE_PROCESSOR {

using namespace physics;
using namespace physics::INCISE_PROCESSOR;

double multiply_and_add(std::size_t num_operations) {
    constexpr std::size_t num_chains = 12;
    Lanes<double> chains[num_chains];
    for (std::size_t c = 0; c < num_chains; ++c) chains[c] = 1.0 + 0.1 * static_cast<double>(c);
    // With these numbers the chains neither grow without bound nor vanish.
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

namespace {

template <class L>
void work_out(const L& law, std::span<const LinkGroup<double>> groups,
              std::span<LinkGroupVectors> vectors, std::size_t num_passes) {
    using Scalar = Lanes<double>;
    for (std::size_t pass = 0; pass < num_passes; ++pass) {
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (std::size_t first = 0; first < LinkGroup<double>::size; first += Scalar::size) {
                const auto edge = [&](std::size_t k) -> Lanes3<double> {
                    const auto& e = vectors[g].edges[k];
                    return {Scalar::load(e[0] + first), Scalar::load(e[1] + first),
                            Scalar::load(e[2] + first)};
                };
                const LinkVectors<double> f = link_forces<L, double>(
                    law, 0.4, groups[g], nullptr, first, {edge(0), edge(1), edge(2)});
                for (std::size_t k = 0; k < 3; ++k) {
                    auto& to = vectors[g].forces[k];
                    f[k].x.store(to[0] + first);
                    f[k].y.store(to[1] + first);
                    f[k].z.store(to[2] + first);
                }
            }
        asm volatile("" ::: "memory");  // so that each pass counts
    }
}

}  // namespace

void work_out_links(const Law& law, std::span<const LinkGroup<double>> groups,
                    std::span<LinkGroupVectors> vectors, std::size_t num_passes) {
    const auto of_law = [&]<class L>(const L* l) {
        if (l) work_out(*l, groups, vectors, num_passes);
    };
    of_law(std::get_if<SaintVenantKirchhoff>(&law));
    of_law(std::get_if<NeoHookean>(&law));
    of_law(std::get_if<MooneyRivlin>(&law));
}

}  // namespace incise::bench::INCISE_PROCESSOR
