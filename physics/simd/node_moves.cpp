// The step of free nodes on lanes. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstring>

#include "incise/physics/simd/lanes.h"
#include "incise/physics/solve/node_lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using Numbers = Lanes<double>;
constexpr int nodes_at_once = Numbers::size;

// Vectors in space are stored one after another, x y z x y z: three times as many numbers as nodes.

/// The vectors of `nodes_at_once` nodes in this order. Memory needs no alignment.
struct Vectors {
    Numbers part[3];

    static Vectors load(const double* from) {
        Vectors v;
        std::memcpy(&v, from, sizeof v);
        return v;
    }
    void store(double* to) const { std::memcpy(to, this, sizeof *this); }
};

/// Returns the number of each node three times, in the order of the components of vectors.
[[gnu::always_inline]] inline Vectors spread_to_vectors(Numbers a) {
    return {shuffle<[](int l) { return l / 3; }>(a.v, a.v),
            shuffle<[](int l) { return (nodes_at_once + l) / 3; }>(a.v, a.v),
            shuffle<[](int l) { return (2 * nodes_at_once + l) / 3; }>(a.v, a.v)};
}

/// Returns component c of the vector of each node.
template <int c>
[[gnu::always_inline]] inline Numbers component_of(const Vectors& v) {
    // `low` selects from the first two parts, `high` adds those of the last part.
    constexpr auto low = [](int l) { return std::min(3 * l + c, 2 * nodes_at_once - 1); };
    constexpr auto high = [](int l) {
        return 3 * l + c < 2 * nodes_at_once ? l : 3 * l + c - nodes_at_once;
    };
    return shuffle<high>(shuffle<low>(v.part[0].v, v.part[1].v), v.part[2].v);
}

}  // namespace

StepSums move_free_nodes(const FreeNodes& nodes, std::size_t num_nodes, double dt, double slowing) {
    const double* const elastic = nodes.elastic_forces->data();
    const double* const outer = nodes.outer_forces->data();
    double* const positions = nodes.positions->data();
    double* const velocities = nodes.velocities->data();
    // Sums are kept by place within nodes_together, so that their order does not depend on
    // nodes_at_once.
    constexpr int num_rounds = static_cast<int>(nodes_together) / nodes_at_once;
    Numbers work[num_rounds][3], mass_times_square[num_rounds][3], largest_square = 0.0;
    for (int r = 0; r < num_rounds; ++r)
        for (int p = 0; p < 3; ++p) work[r][p] = mass_times_square[r][p] = 0.0;

    for (std::size_t n = 0; n < num_nodes; n += nodes_together)
        for (int r = 0; r < num_rounds; ++r) {
            const std::size_t first = n + static_cast<std::size_t>(r * nodes_at_once);
            Numbers masses;
            std::memcpy(&masses, nodes.masses + first, sizeof masses);
            const Vectors m = spread_to_vectors(masses),
                          per_mass = spread_to_vectors(Numbers(dt) / masses),
                          f = Vectors::load(elastic + 3 * first),
                          g = Vectors::load(outer + 3 * first);
            Vectors x = Vectors::load(positions + 3 * first),
                    v = Vectors::load(velocities + 3 * first), squares;
            for (int p = 0; p < 3; ++p) {
                const Numbers change = per_mass.part[p] * (f.part[p] + g.part[p]);
                v.part[p] = slowing * (v.part[p] + change);
                const Numbers move = dt * v.part[p], next = x.part[p] + move;
                work[r][p] += g.part[p] * (next - x.part[p]);
                x.part[p] = next;
                squares.part[p] = v.part[p] * v.part[p];
                mass_times_square[r][p] += m.part[p] * squares.part[p];
            }
            x.store(positions + 3 * first);
            v.store(velocities + 3 * first);
            const Numbers square =
                (component_of<0>(squares) + component_of<1>(squares)) + component_of<2>(squares);
            largest_square = max(largest_square, square);
        }

    StepSums sums;
    for (int r = 0; r < num_rounds; ++r)
        for (int p = 0; p < 3; ++p)
            for (int l = 0; l < nodes_at_once; ++l) {
                sums.work += work[r][p].v[l];
                sums.mass_times_square += mass_times_square[r][p].v[l];
            }
    for (int l = 0; l < nodes_at_once; ++l)
        sums.largest_square = std::max(sums.largest_square, largest_square.v[l]);
    return sums;
}

}  // namespace incise::physics::INCISE_PROCESSOR
