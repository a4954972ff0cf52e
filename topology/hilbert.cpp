// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/hilbert.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace incise::topology {

namespace {

constexpr unsigned bits = 20;  // per coordinate, so that three fit into 64 bits

std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
    // From coordinates to the transposed index: undo the excess rotations, then Gray encode.
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
        const std::uint32_t p = q - 1;
        for (std::uint32_t& xi : x) {
            if (xi & q) {
                x[0] ^= p;
            } else {
                const std::uint32_t t = (x[0] ^ xi) & p;
                x[0] ^= t;
                xi ^= t;
            }
        }
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    std::uint32_t t = 0;
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
        if (x[2] & q) t ^= q - 1;
    for (std::uint32_t& xi : x) xi ^= t;

    std::uint64_t index = 0;
    for (unsigned b = bits; b-- > 0;)
        for (const std::uint32_t xi : x) index = index << 1 | (xi >> b & 1u);
    return index;
}

}  // namespace

std::vector<std::size_t> hilbert_order(std::span<const Vec3> points) {
    if (points.empty()) return {};
    Vec3 low = points[0], high = points[0];
    for (const Vec3& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double side = (high - low).maxCoeff();
    const double scale = side > 0.0 ? static_cast<double>((1u << bits) - 1) / side : 0.0;

    std::vector<std::pair<std::uint64_t, std::size_t>> keyed(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 cell = (points[i] - low) * scale;
        keyed[i] = {hilbert_index({static_cast<std::uint32_t>(cell.x()),
                                   static_cast<std::uint32_t>(cell.y()),
                                   static_cast<std::uint32_t>(cell.z())}),
                    i};
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::size_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].second;
    return order;
}

}  // namespace incise::topology
