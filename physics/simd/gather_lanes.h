// Transfer between the nodes of a block and the lanes of its elements: gathers positions and adds
// forces. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "incise/physics/elements/local_nodes.h"
#include "incise/physics/simd/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

using Quad = double __attribute__((vector_size(32)));  // a LocalVector
/// As many quads as fit in a vector: that of element i and, with AVX-512, that of element i + 4.
using Doubles = Lanes<double>::Vector;
using HalfFloats = float __attribute__((vector_size(vector_bytes / 2)));

inline Doubles load_quads(const LocalVector* nodes, const std::uint16_t* offsets) {
    const auto quad = [&](int l) {
        return *reinterpret_cast<const Quad*>(reinterpret_cast<const double*>(nodes) + offsets[l]);
    };
#ifdef __AVX512F__
    return __builtin_shufflevector(quad(0), quad(4), 0, 1, 2, 3, 4, 5, 6, 7);
#else
    return quad(0);
#endif
}

inline Lanes<float> joined(Doubles low, Doubles high) {
    const auto a = __builtin_convertvector(low, HalfFloats),
               b = __builtin_convertvector(high, HalfFloats);
#ifdef __AVX512F__
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}

/// Returns lanes 4q to 4q + 3.
template <std::size_t q>
Quad quad_of(Lanes<double> a) {
    return __builtin_shufflevector(a.v, a.v, 4 * q, 4 * q + 1, 4 * q + 2, 4 * q + 3);
}
template <std::size_t q>
Quad quad_of(Lanes<float> a) {
    const auto four = __builtin_shufflevector(a.v, a.v, 4 * q, 4 * q + 1, 4 * q + 2, 4 * q + 3);
#ifdef __AVX2__
    return _mm256_cvtps_pd(four);  // GCC 12 makes six instructions of the other form
#else
    return __builtin_convertvector(four, Quad);
#endif
}

/// Returns the edges of the elements from corner 0 to each other corner, by the offsets of corners
/// in `nodes`. Differences are computed in doubles for any type of result, so the distance of the
/// body from the origin does not matter. gather_edges() and scatter_add() are inlined in each loop,
/// since passing the vectors through memory would take a tenth of the time of the loop.
template <class Number, std::size_t num_corners, std::size_t size>
[[gnu::always_inline]] inline std::array<Lanes3<Number>, num_corners - 1> gather_edges(
    const LocalVector* nodes, const std::uint16_t (&offsets)[num_corners][size],
    std::size_t first) {
    constexpr std::size_t num_parts = sizeof(double) / sizeof(Number), part = num_lanes<double>;
    // Row p has the elements p, p + 4, p + 8, ...
    Doubles origins[4][num_parts];
    for (std::size_t p = 0; p < 4; ++p)
        for (std::size_t i = 0; i < num_parts; ++i)
            origins[p][i] = load_quads(nodes, offsets[0] + first + p + i * part);
    std::array<Lanes3<Number>, num_corners - 1> edges;
#pragma GCC unroll 7
    for (std::size_t k = 1; k < num_corners; ++k) {
        const auto edge = [&](std::size_t p, std::size_t i) -> Doubles {
            return load_quads(nodes, offsets[k] + first + p + i * part) - origins[p][i];
        };
        Lanes<Number> rows[4];
        for (std::size_t p = 0; p < 4; ++p)
            if constexpr (num_parts == 1)
                rows[p] = edge(p, 0);
            else
                rows[p] = joined(edge(p, 0), edge(p, 1));
        transpose(rows[0], rows[1], rows[2], rows[3]);
        edges[k - 1] = {rows[0], rows[1], rows[2]};
    }
    return edges;
}

/// Returns the corners of the elements, in doubles. The difference of any two of them is then
/// rounded only once.
template <std::size_t num_corners, std::size_t size>
[[gnu::always_inline]] inline std::array<Lanes3<double>, num_corners> gather_corners(
    const LocalVector* nodes, const std::uint16_t (&offsets)[num_corners][size],
    std::size_t first) {
    std::array<Lanes3<double>, num_corners> corners;
#pragma GCC unroll 8
    for (std::size_t k = 0; k < num_corners; ++k) {
        Lanes<double> rows[4];
        for (std::size_t p = 0; p < 4; ++p) rows[p] = load_quads(nodes, offsets[k] + first + p);
        transpose(rows[0], rows[1], rows[2], rows[3]);
        corners[k] = {rows[0], rows[1], rows[2]};
    }
    return corners;
}

/// Adds vectors of the elements to those of `nodes` at the offsets of corners. `f` has the vectors
/// of all corners but corner 0. Corner 0 gets minus their sum, computed in doubles, so that the
/// vectors of an element add up to zero.
///
/// The elements are processed in fours, and corner by corner within these. Elements may share
/// nodes, and the sums must not depend on the number of lanes.
template <class Number, std::size_t num_corners, std::size_t size>
[[gnu::always_inline]] inline void scatter_add(const std::array<Lanes3<Number>, num_corners - 1>& f,
                                               LocalVector* nodes,
                                               const std::uint16_t (&offsets)[num_corners][size],
                                               std::size_t first) {
    Lanes<Number> rows[num_corners][4];  // those of corner 0 are not used
#pragma GCC unroll 7
    for (std::size_t k = 1; k < num_corners; ++k) {
        const auto& [x, y, z] = f[k - 1];
        rows[k][0] = x, rows[k][1] = y, rows[k][2] = z, rows[k][3] = 0.0;
        transpose(rows[k][0], rows[k][1], rows[k][2], rows[k][3]);
    }
    const auto add_four = [&]<std::size_t q>(std::integral_constant<std::size_t, q>) {
        Quad all[num_corners][4];
#pragma GCC unroll 4
        for (std::size_t p = 0; p < 4; ++p) {
            Quad sum = all[1][p] = quad_of<q>(rows[1][p]);
#pragma GCC unroll 7
            for (std::size_t k = 2; k < num_corners; ++k) sum += all[k][p] = quad_of<q>(rows[k][p]);
            all[0][p] = -sum;
        }
#pragma GCC unroll 8
        for (std::size_t k = 0; k < num_corners; ++k)
#pragma GCC unroll 4
            for (std::size_t p = 0; p < 4; ++p)
                *reinterpret_cast<Quad*>(reinterpret_cast<double*>(nodes) +
                                         offsets[k][first + 4 * q + p]) += all[k][p];
    };
    [&]<std::size_t... q>(std::index_sequence<q...>) {
        (add_four(std::integral_constant<std::size_t, q>()), ...);
    }
    (std::make_index_sequence<num_lanes<Number> / 4>());
}

}  // namespace incise::physics::INCISE_PROCESSOR
